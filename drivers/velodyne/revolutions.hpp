#pragma once
// Packets to whole turns: one base::Sight a revolution, and what was lost on the way.
//
// Axes of S: the cable is at the back; x ahead, y left, z up. With range R, elevation w and azimuth
// a (clockwise): x = R cos w cos a, y = −R cos w sin a, z = R sin w.
//
// A turn begins where the azimuth falls back. A head that stands still, or creeps, would never
// begin one: after kLongestTurn_s what was seen is told all the same, as no whole turn.
//
// Time: the sensor counts microseconds, its packets arrive late. A firing's time is its count plus
// the smallest delay seen (rising by 100 ppm against clocks that drift apart), so that a packet
// that had to wait moves nothing. after_s is the sensor's own time alone.
//
// Directions without a return become Clear where Params::clear_to_m vouches for a range, else
// Unknown: black and wet things and mirrors send nothing back either. Pure state; what it allocates
// is the points of the turn, at most 300,000 a turn.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/least_delay.hpp"
#include "base/sight.hpp"
#include "velodyne/codec.hpp"
#include "velodyne/params.hpp"

namespace roverd::velodyne {

using base::Time;

/// What is told besides the points.
struct Turn {
  std::shared_ptr<const base::Sight> sight;
  bool whole = false;         ///< from one falling back of the azimuth to the next
  double duration_s = 0.0;    ///< whole turns: by the sensor's clock
  std::uint32_t missing = 0;  ///< directions without a usable return
  std::uint32_t firings = 0;  ///< directions
};

class Revolutions {
 public:
  static constexpr double kLongestTurn_s = 0.5;
  /// A count that goes back, or on, by more is a clock that was set.
  static constexpr double kJump_s = 0.2;
  using OnTurn = std::function<void(const Turn&)>;

  struct Counts {
    std::uint64_t packets = 0;     ///< used
    std::uint64_t lost = 0;        ///< by the time stamps
    std::uint64_t duplicates = 0;  ///< not used
    std::uint64_t late = 0;        ///< older than one that came before: not used
    std::uint64_t jumps = 0;       ///< of the sensor's clock
    std::uint64_t gaps = 0;        ///< packets with a step of azimuth that is none
    friend bool operator==(const Counts&, const Counts&) = default;
  };

  /// @param sensor its name in each Sight.
  Revolutions(std::string sensor, const Params& params, OnTurn on_turn);

  /// @param arrival of the datagram: later than its last firing.
  void add(const Packet& packet, Time arrival);
  /// Tells what was seen of the turn that has begun.
  void finish();
  /// The link was opened anew: nothing goes on.
  void forget();

  const Counts& counts() const noexcept { return counts_; }

 private:
  struct Laser {
    float cos_w = 1.0F;
    float sin_w = 0.0F;
    float height_m = 0.0F;
    std::uint8_t ring = 0;
  };

  bool follows(const Packet& packet, Time arrival);
  void choose(Product product);
  void take_blocks(const Packet& packet, const Steps& steps, std::size_t b, double block_us);
  void add_return(Return r, const Laser& laser, float sin_a, float cos_a, float after_s);
  void add_missing(const Laser& laser, float sin_a, float cos_a, float after_s);
  base::SightPoint& put(const Laser& laser, float sin_a, float cos_a, float range_m);
  void begin(double at_us);
  void tell(bool whole, double end_us);

  const std::string sensor_;
  const Params params_;
  const OnTurn on_turn_;
  std::optional<Product> product_;
  std::array<Laser, kLasers> lasers_{};

  // The sensor's clock.
  bool known_ = false;
  std::uint32_t last_us_ = 0;
  double period_us_ = 0.0;
  std::uint64_t total_us_ = 0;  ///< counted on over the hours
  base::LeastDelay delay_{kJump_s};
  Time arrived_{};
  Time first_firing_{};  ///< of the packet that is being read, at total_us_

  // The turn that has begun.
  std::shared_ptr<base::Sight> sight_;
  bool from_start_ = false;
  double began_us_ = 0.0;
  std::uint16_t azimuth_cdeg_ = 0;
  std::uint16_t step_cdeg_ = kNominalStep_cdeg;
  std::uint32_t missing_ = 0;
  std::uint32_t firings_ = 0;
  std::size_t expected_ = 32'000;
  std::uint64_t count_ = 0;
  Counts counts_;
};

}  // namespace roverd::velodyne
