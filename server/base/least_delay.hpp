#pragma once
// Times of a device's own clock on ours, for devices that count on evenly and whose bytes arrive
// late:
//
//   stamp = count + min(arrival − count), the minimum rising by 100 ppm against clocks that drift
//   apart
//
// so that what had to wait on its way moves nothing. Pure state.

#include <algorithm>
#include <optional>

#include "base/time.hpp"

namespace roverd::base {

class LeastDelay {
 public:
  static constexpr double kDrift = 100e-6;

  /// @param jump_s a count that far off the arrivals was set: the delay is learned anew.
  explicit LeastDelay(double jump_s) noexcept : jump_s_(jump_s) {}

  /// @param count of the device, from any origin, not falling. @param arrival not falling.
  /// @return when it was measured; never after the arrival.
  Time at(Duration count, Time arrival) noexcept {
    const Duration raw = arrival.time_since_epoch() - count;
    if (!delay_ || std::max(raw - *delay_, *delay_ - raw) > from_seconds(jump_s_)) {
      delay_ = raw;
    } else {
      const double aged_s = std::max(0.0, seconds(arrival - arrived_));
      delay_ = std::min(raw, *delay_ + from_seconds(aged_s * kDrift));
    }
    arrived_ = arrival;
    return Time{count + *delay_};
  }
  void forget() noexcept { delay_.reset(); }

 private:
  double jump_s_;
  std::optional<Duration> delay_;
  Time arrived_{};
};

}  // namespace roverd::base
