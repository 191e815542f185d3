#pragma once
// Two receivers that speak in turn and mean different places.

#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::nav {

/// Positions that go there and back again, and again, are of two receivers: nothing drives so.
/// They are not believed until only one of the places was told for kCalm_s.
class Receivers {
 public:
  static constexpr double kApart_m = 10.0;
  static constexpr double kTogether_m = 5.0;
  static constexpr int kTurns = 3;
  static constexpr double kCalm_s = 3.0;

  void put(base::EnuPoint at, base::Time stamp) noexcept {
    if (one_ && two_) {
      const bool there = base::distance_m(at, *one_) > kApart_m;
      const bool back = base::distance_m(at, *two_) < kTogether_m;
      if (there && back) {
        ++turns_;
        turned_ = stamp;
      }
    }
    if (turned_ && base::seconds(stamp - *turned_) > kCalm_s) turns_ = 0;
    two_ = one_;
    one_ = at;
  }

  bool disagree() const noexcept { return turns_ >= kTurns; }

 private:
  std::optional<base::EnuPoint> one_;  ///< the last position
  std::optional<base::EnuPoint> two_;  ///< the one before
  std::optional<base::Time> turned_;
  int turns_ = 0;
};

}  // namespace roverd::nav
