#pragma once
// Have the receiver's positions moved, all at once and for good? A base station that was set up
// anew, or corrections from another one, shift every position by the same way: the robot did not
// move, and what it says of itself is as exact as before, only of another place. An error that
// wanders, or that goes away again, is none.
//
// Pure but for its memory; time is an argument; no allocation.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::nav {

class ShiftWatch {
 public:
  static constexpr double kLasts_s = 6.5;     ///< reflections last for seconds
  static constexpr double kLeast_m = 0.3;     ///< less is approached by the filter
  static constexpr double kAlike_m = 0.15;    ///< from one position to the next ones
  static constexpr double kAlikeShare = 0.1;  ///< and of the way driven meanwhile: slip
  static constexpr int kLeast = 8;            ///< positions

  /// One position. @param off what it says minus where the robot is believed to be, ENU.
  /// @param surprising it lies farther off than both honestly err. @param driven_m counted way,
  /// only growing.
  void take(base::EnuPoint off, bool surprising, double driven_m, base::Time stamp) noexcept {
    if (!surprising || std::hypot(off.east_m, off.north_m) < kLeast_m) {
      forget();
      agrees_ = true;
      return;
    }
    agrees_ = false;
    const bool alike =
        count_ > 0 && base::distance_m(mean_, off) < kAlike_m + kAlikeShare * (driven_m - began_m_);
    if (!alike) {
      count_ = 0;
      began_ = stamp;
      began_m_ = driven_m;
    }
    ++count_;
    const double part = 1.0 / static_cast<double>(std::min(count_, 25));
    if (count_ == 1) mean_ = off;
    mean_ = {mean_.east_m + part * (off.east_m - mean_.east_m),
             mean_.north_m + part * (off.north_m - mean_.north_m)};
    shifted_ = count_ >= kLeast && base::seconds(stamp - began_) >= kLasts_s;
  }
  void forget() noexcept {
    count_ = 0;
    shifted_ = agrees_ = false;
  }

  /// The way by which they have moved; empty: they have not.
  std::optional<base::EnuPoint> shift() const noexcept {
    return shifted_ ? std::optional(mean_) : std::nullopt;
  }
  base::Time since() const noexcept { return began_; }
  /// The last one lay where it was expected.
  bool agrees() const noexcept { return agrees_; }

 private:
  base::EnuPoint mean_;
  base::Time began_{};
  double began_m_ = 0.0;
  int count_ = 0;
  bool shifted_ = false;
  bool agrees_ = false;
};

}  // namespace roverd::nav
