#pragma once
// Tips of grass that a scanner's plane grazes, told from what stands there: most rays go between
// them.
//
// A plane that leans over a crest meets the grass of the hollow behind it, where no lidar has seen
// the ground: farther from known ground than hills.hpp takes an echo for it. There a thin thing and
// a tip look alike in one scan. Over half a second they do not: of the rays that come to its place
// a tip stops few, and others each time; a stake as thin as 2 cm stops two of five.
//
//   met / (met + through) ≤ kFew   of the rays to each width of a cell from beside it to
//                                  beside it, over kSees_s and kRays rays; met: within kAbout_m
//
// What may be grass at all Hills says (low over the ground within 0.6 m); what was found to be
// grass is told to it, and taken back where what is met there by then stops more than kMany: within
// a second, where no tips share its place. Between the two it stays what it was, for as long as
// ground is known.
// Of one sensor of one plane with thin beams. Not shared between threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/hills.hpp"
#include "nav/sense/reduce.hpp"
#include "nav/sense/sectors.hpp"

namespace roverd::nav::sense {

class Grass {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr double kSees_s = 0.5;
  static constexpr double kRays = 30.0;
  static constexpr double kFew = 0.16;
  static constexpr double kMany = 0.28;  ///< what stops more is no grass any more
  static constexpr float kAbout_m = 0.1F;

  Grass() : places_(kPlaces) {}

  /// A piece, judged, and how its rays went.
  void see(const Reduced& in, const Sectors& rays, Hills& hills);
  void forget() noexcept;

 private:
  static constexpr std::size_t kPlaces = 1024;
  struct Place {
    std::int32_t x = 0;
    std::int32_t y = 0;
    float top_m = 0.0F;  ///< of what was met, in O
    bool taken = false;
    std::array<Sectors::Share, 5> shares{};  ///< of the rays from beside it to beside it
    base::Time since;
    base::Time last;  ///< that something was met there
  };
  void meet(const Reduced& in, const Hills& hills);
  enum class Thin : std::uint8_t { Unknown, Yes, No };
  void judge(base::Time now, Hills& hills);
  static Thin thin_of(const Place& p) noexcept;
  void look_through(const Reduced& in, const Sectors& rays);

  /// By cell; what is not known yet goes before ground that is asked on.
  std::vector<Place> places_;
};

}  // namespace roverd::nav::sense
