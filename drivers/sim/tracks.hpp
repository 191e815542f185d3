#pragma once
// Motors, tracks and ground: from the twist the base wants to the motion over ground.
//
//   wanted ─▶ delay ─▶ lag ─▶ limits ─▶ left, right track ─▶ slip, scrub ─▶ true twist
//                                          └─▶ encoders see this

#include <cmath>
#include <cstdint>

#include "base/geo.hpp"
#include "sim/motion.hpp"
#include "sim/noise.hpp"
#include "sim/params.hpp"

namespace roverd::sim {

struct MotorState {
  double track_mps = 0.0;
  double travel_m = 0.0;   ///< since power-up, what the odometer counts
  double current_a = 0.0;  ///< positive drives forward
  double power_w = 0.0;    ///< drawn from the battery
};

class Tracks {
 public:
  explicit Tracks(std::uint64_t seed)
      : left_slip_(seed, Stream::LeftSlip), right_slip_(seed, Stream::RightSlip) {}

  /// @param wanted already cut to the base's limits. @param brake the e-stop: both tracks are
  /// braked at once, whatever is wanted.
  void step(const DriveParams& p, base::BodyTwist wanted, bool brake, double dt_s);

  /// Somebody else moves them: they only count.
  void follow(const DriveParams& p, double left_mps, double right_mps, double dt_s);

  GroundMotion ground() const noexcept { return ground_; }
  /// What the base reports: from the tracks, with the nominal width, blind to slip.
  base::BodyTwist measured() const noexcept { return measured_; }
  double travel_mps() const noexcept {
    return (std::abs(left_.track_mps) + std::abs(right_.track_mps)) / 2.0;
  }
  const MotorState& left() const noexcept { return left_; }
  const MotorState& right() const noexcept { return right_; }

  /// At once and without memory.
  void halt() noexcept;
  void zero_odometer() noexcept { left_.travel_m = right_.travel_m = 0.0; }

 private:
  void count(const DriveParams& p, double left_mps, double right_mps, double dt_s);
  void set_tracks(const DriveParams& p, double left_mps, double right_mps, double dt_s);
  void load(const DriveParams& p, double left_mps2, double right_mps2);

  Delay<base::BodyTwist> delay_;  ///< commands on their way
  base::BodyTwist lagged_;
  base::BodyTwist driven_;  ///< after the limits
  base::BodyTwist measured_;
  MotorState left_;
  MotorState right_;
  GroundMotion ground_;
  Drift left_slip_;
  Drift right_slip_;
};

}  // namespace roverd::sim
