#pragma once
// Where the ground lies that somebody has seen: what a scanner of one plane meets on a hill is told
// from what stands there.
//
//   a cloud's ground ─▶ heights in O, cells of kCell_m, kKnown_s ─▶ a plane's echo no higher than
//   low_m over the highest of them in three by three cells is ground
//
// Only a sensor that lays the ground tells it (ground.hpp): a bank that is too steep is none, and
// where nobody saw the ground a plane's echo stays an obstacle. An echo farther than kInside_m
// below the ground shows that the heights do not agree; then it stays one, too.
//
// Heights in O are compared within seconds: over those it drifts by centimetres. Not shared between
// threads.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

class Hills {
 public:
  static constexpr double kCell_m = 0.1;
  static constexpr double kKnown_s = 8.0;
  static constexpr float kInside_m = 0.15F;

  /// @param range_m what lies farther from the body is not asked. @param low_m what is lower over
  /// the ground is no obstacle
  Hills(double range_m, double low_m);

  /// Of a piece whose ground was judged.
  void learn(const Reduced& in);
  /// Of one plane: sets what is an Obstacle and lies on known ground to Ground. @return how many
  std::size_t judge(Reduced& in) const;
  void forget() noexcept;

 private:
  struct Place {
    float z_m = 0.0F;
    float at_s = -1e9F;
  };
  std::size_t index(std::int32_t x, std::int32_t y) const noexcept;

  float low_m_;
  std::int32_t mask_;
  std::vector<Place> places_;
  bool begun_ = false;
  base::Time begin_;
};

}  // namespace roverd::nav::sense
