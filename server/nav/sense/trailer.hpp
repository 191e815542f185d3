#pragma once
// What is pulled, along the commanded curve. Nobody measures the coupling: what is known is between
// which angles it is, from how the vehicle was driven.
//
//        ┌───┐                φ: of the trailer against the vehicle, left positive; H: the
//        coupling,
//    B ──┤ H ├──╮             hitch_m behind B, x along the trailer's drawbar
//        └───┘   ╲ φ          φ' = −ω − (v sin φ + hitch ω cos φ) / axle_m (1)
//                 ▭
//
// One angle never overtakes another in (1), so two that bound it go on bounding it: driven ahead
// they come together within a few trailer's lengths, in reverse they part.
// Source: LaValle, Planning Algorithms, 13.1.2.4.
//
// Swept are things that stand there; the ground that nobody has seen is the vehicle's business,
// which drives there first. What stands within the trailer's place now, wherever that may be, is
// taken for the trailer. Pure; allocates nothing.

#include "base/angle.hpp"
#include "nav/sense/protect.hpp"

namespace roverd::nav::sense {

struct Trailer {
  Footprint body;  ///< in H, its drawbar too: the axle lies at −axle_m
  double hitch_m = 0.0;
  double axle_m = 1.0;  ///< more than 0
};

/// Between which angles the coupling is.
class Coupling {
 public:
  static constexpr double kBegins_rad = base::kPi / 3.0;  ///< to either side, before it was driven
  /// Farther it does not turn, or is not followed: a jackknife.
  static constexpr double kMost_rad = base::kPi / 2.0;
  static constexpr double kSure_rad = 0.05;  ///< not told better, to either side: play, and slip

  /// It drove so for dt_s. @param dt_s 0 to 1
  void drive(const Trailer& trailer, const base::BodyTwist& twist, double dt_s) noexcept;
  double low_rad() const noexcept { return low_rad_; }
  double high_rad() const noexcept { return high_rad_; }

 private:
  double low_rad_ = -kBegins_rad;
  double high_rad_ = kBegins_rad;
};

/// As protect(), for the trailer alone; what it touches between two of 64 steps of the horizon is
/// told as of the first.
/// @param marks of the patch, or null
Verdict protect_trailer(const Patch& patch, const Pose2& pose, const Trailer& trailer,
                        const Coupling& coupling, const base::BodyTwist& twist,
                        const ProtectParams& params, const Marks* marks = nullptr) noexcept;

}  // namespace roverd::nav::sense
