#pragma once
// A body that skids does not drive the curve that it is told.
//
// It turns by less than it is told, on a slope by far less, and slides aside; and as it brakes, its
// turn dies before it stands. So it leaves the commanded curve outwards, where protect() has not
// looked (a steered one is late to turn, too, but keeps its curve while it brakes):
//
//   ▭ ═══════▶ ▪    straight: the turn is dead
//     ╲═════▶ ▪     as it moves: its curve and its slide, as measured
//       ╲═══▶       commanded: protect()
//
// It drives no faster than it would stand beside what lies along each of them, side_m before it,
// but never slower than 0.2 m/s for that: there it has hardly a way to leave the commanded curve,
// which is looked along anew in each tick, and what stands beside something may turn away from it.
// What nobody has seen is a matter of where it is told to go.
//
// A turn on the spot, and what is pulled, are not looked at here. Pure; allocates nothing: for the
// control tick, at most twice protect().

#include "base/geo.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/protect.hpp"

namespace roverd::nav::sense {

/// How the body has moved of late: smoothed over 0.15 s, for a curve is told by noise otherwise.
class Lately {
 public:
  void move(const Odometry& now, double dt_s) noexcept;
  double v_mps() const noexcept { return v_mps_; }
  // Where v_mps() is not 0:
  double curve_pm() const noexcept { return yaw_rate_radps_ / v_mps_; }  ///< rad in a metre's way
  double aside_rad() const noexcept;  ///< of its way from its axis, left positive; 0.35 at most

 private:
  double v_mps_ = 0.0;
  double left_mps_ = 0.0;
  double yaw_rate_radps_ = 0.0;
};

/// @param steered its turn does not die. All else as of protect().
/// @return Limit::Obstacle, Drop or None; the part may be 1 where it is driven at 0.2 m/s already
Verdict protect_skidding(const Patch& patch, const Pose2& pose, const Footprint& body,
                         const base::BodyTwist& twist, const Lately& lately, bool steered,
                         const ProtectParams& params, const Marks* marks = nullptr) noexcept;

}  // namespace roverd::nav::sense
