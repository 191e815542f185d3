#pragma once
// How much the ground gives way, by what the positions say of it: a filter that expects a firm
// floor is too sure of itself on loose ground, and one that expects loose ground follows every
// error of the receiver.
//
// Each axis of the body has a level, 1 to kMost, by which its slip changes more than on a firm
// floor. An innovation larger than its own sigma raises it, smaller ones lower it, until they are
// as large as they are said to be (innovation-based adaptive estimation; Mehra 1970). It is raised
// within some fixes and falls within seconds.
//
// Pure state, no allocation.

#include <algorithm>
#include <cmath>

namespace roverd::nav {

class SlipWatch {
 public:
  static constexpr double kMostAlong = 200.0;
  static constexpr double kMostAside = 30.0;

  /// One position. @param along, aside y²/S of the innovation in the body's axes, of a fix whose
  /// errors are independent from one to the next. @param dt_s since the one before.
  void take(double along, double aside, double dt_s) noexcept {
    along_ = next(along_, along, dt_s, kMostAlong);
    aside_ = next(aside_, aside, dt_s, kMostAside);
  }
  /// More than was thought possible happened at once.
  void burst() noexcept {
    along_ = std::max(along_, 0.3 * kMostAlong);
    aside_ = std::max(aside_, 0.3 * kMostAside);
  }

  double along() const noexcept { return along_; }
  double aside() const noexcept { return aside_; }

 private:
  static constexpr double kRate_1ps = 0.6;
  static constexpr double kLargest = 9.0;   // of one fix, so that an outlier says no more
  static constexpr double kExpected = 0.4;  // of y²/S, at which the level stays

  static double next(double level, double squares, double dt_s, double most) noexcept {
    if (!std::isfinite(squares)) return level;
    const double off = std::min(squares, kLargest) - kExpected;
    const double step = kRate_1ps * std::clamp(dt_s, 0.0, 0.5) * off;
    return std::clamp(level * std::exp(step), 1.0, most);
  }

  double along_ = 1.0;
  double aside_ = 1.0;
};

}  // namespace roverd::nav
