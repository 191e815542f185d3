#pragma once
// The first metres of a drive whose heading is not found yet. A compass may be 20 degrees off:
// steering by it swerves, driving straight on shows where the robot really points.
//
//   Steered ──heading uncertain──▶ Straight ──found──▶ Steered
//                                     └──kFar_m driven, not found──▶ GivenUp ──found──▶ Steered
//
// Straight is held by the gyro, without one by the tracks. Turns on the spot and the end of a leg
// are not touched. Control thread.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geo.hpp"

namespace roverd::robot {

class StraightStart {
 public:
  static constexpr double kFar_m = 3.0;       ///< a heading that is not found by then is not found
  static constexpr double kHold_1ps = 1.5;    ///< turn rate for a radian off the line
  static constexpr double kMost_radps = 0.2;  ///< of it

  struct State {
    bool found = false;     ///< the heading
    bool driving = false;   ///< along a leg, its end not near
    double turned_rad = 0;  ///< all turning so far, the jumps of corrections left out
    double driven_m = 0;    ///< all way so far, backwards negative
  };

  void reset() noexcept {
    begun_.reset();
    way_m_ = 0.0;
    last_m_.reset();
  }

  /// Once a tick while a mission drives. @return the turn rate to drive with; empty: steer.
  std::optional<double> step(const State& s) noexcept {
    if (s.found) {
      reset();
      return std::nullopt;
    }
    if (begun_ && last_m_) way_m_ += std::abs(s.driven_m - *last_m_);
    last_m_ = s.driven_m;
    if (!s.driving || given_up()) {
      begun_.reset();
      return std::nullopt;
    }
    if (!begun_) begun_ = s.turned_rad;
    return std::clamp(kHold_1ps * (*begun_ - s.turned_rad), -kMost_radps, kMost_radps);
  }

  bool given_up() const noexcept { return way_m_ > kFar_m; }

 private:
  std::optional<double> begun_;  ///< turned_rad on the line
  std::optional<double> last_m_;
  double way_m_ = 0.0;
};

}  // namespace roverd::robot
