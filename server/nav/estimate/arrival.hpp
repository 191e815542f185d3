#pragma once
// A receiver's clock against ours: which epochs came later than usual, and which ones are no new
// ones at all.

#include <algorithm>
#include <optional>

#include "base/time.hpp"

namespace roverd::nav {

/// The least difference of arrival and epoch is the usual latency; what comes later is older by as
/// much. A receiver whose time jumps (leap second, week rollover, restart) is believed again after
/// kPatience epochs. Receivers without time: nothing is known, nothing refused.
class Arrival {
 public:
  static constexpr double kOldest_s = 0.8;  ///< later than usual: of no use
  static constexpr int kPatience = 5;

  /// @return how much later than usual it came; empty: doubled, out of order or too old.
  std::optional<double> late_s(base::Time stamp,
                               const std::optional<base::WallTime>& utc) noexcept {
    if (!utc) return 0.0;
    const double offset_s =
        base::seconds(stamp.time_since_epoch()) -
        base::seconds(std::chrono::duration_cast<base::Duration>(utc->time_since_epoch()));
    if (!least_s_) begin(offset_s);
    // Both clocks drift against each other by less than this.
    if (utc_) *least_s_ += 2e-4 * std::clamp(base::seconds(stamp - stamp_), 0.0, 10.0);
    if (utc_ && *utc == *utc_) return std::nullopt;  // the same epoch, however often
    const bool backwards = utc_ && *utc < *utc_;
    if (backwards || offset_s - *least_s_ > kOldest_s || *least_s_ - offset_s > kOldest_s) {
      if (++strange_ < kPatience) return std::nullopt;
      begin(offset_s);
    }
    strange_ = 0;
    utc_ = utc;
    stamp_ = stamp;
    least_s_ = std::min(*least_s_, offset_s);
    return offset_s - *least_s_;
  }

 private:
  void begin(double offset_s) noexcept { least_s_ = offset_s; }

  std::optional<double> least_s_;
  std::optional<base::WallTime> utc_;
  base::Time stamp_{};
  int strange_ = 0;
};

}  // namespace roverd::nav
