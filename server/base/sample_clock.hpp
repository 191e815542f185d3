#pragma once
// A device tells when it measured by a counter of 32 bits that ticks evenly and wraps; bytes arrive
// late and in bursts. The smallest delay ever seen is the closest to the truth, so a sample's time
// is its count plus that:
//
//   stamp = count + min(arrival − count), the minimum rising by 100 ppm against two clocks that
//   drift apart
//
// Stamps never lie after the arrival and go on as evenly as the device counts. A device whose clock
// stood still for a moment is late by that from then on: where no sample of kStood_s came earlier
// than kShift_s after its stamp, the delay is that of the least late one. What is told of an
// earlier sample (a receiver's position) is read against it and moves nothing. Pure state.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/time.hpp"

namespace roverd::base {

/// @tparam kTick_us how far apart two counts are, microseconds.
template <int kTick_us>
class SampleClock {
 public:
  /// What the count says about the sample before. Back: the unit began anew, or its messages are
  /// out of order; what comes after is measured against this one.
  enum class Step { First, On, Same, Back };
  static constexpr double kDrift = 100e-6;
  /// A count this far off the arrivals has jumped: the delay is learned anew.
  static constexpr double kJump_s = 0.5;
  static constexpr double kOldest_s = 5.0;
  static constexpr double kStood_s = 2.0;
  static constexpr double kShift_s = 0.03;

  struct Read {
    Step step = Step::First;
    Time stamp;
  };

  /// @param follows a device whose clock stood still for a moment. Not where a stamp that is too
  /// young is worse than one that is too old, and a link may be slow for long: a scanner's points
  /// would lie where they are not.
  explicit SampleClock(bool follows = true) noexcept : follows_(follows) {}

  Read read(std::uint32_t count, Time arrival) noexcept {
    const Step step = step_to(count);
    if (step == Step::First || step == Step::Back) {
      delay_.reset();
      total_ = {};
    } else {
      total_ += kTick * static_cast<std::int32_t>(count - last_);
    }
    last_ = count;
    known_ = true;
    const Duration raw = arrival.time_since_epoch() - total_;
    if (!delay_ || std::abs(seconds(raw - *delay_)) > kJump_s) {
      delay_ = raw;
      least_.reset();
    } else {
      const double aged_s = std::max(0.0, seconds(arrival - arrived_));
      delay_ = std::min(raw, *delay_ + from_seconds(aged_s * kDrift));
    }
    arrived_ = arrival;
    follow(raw);
    return {step, Time{total_ + *delay_}};
  }
  /// When that sample was taken, if it lies at most kOldest_s before the arrival and not after it;
  /// empty: it does not, or nothing was read yet.
  std::optional<Time> at(std::uint32_t count, Time arrival) const noexcept {
    if (!known_) return {};
    const auto on = static_cast<std::int32_t>(count - last_);
    const Time stamp{total_ + *delay_ + kTick * on};
    const double age_s = seconds(arrival - stamp);
    if (age_s < -kJump_s || age_s > kOldest_s) return {};
    return std::min(stamp, arrival);
  }
  bool known() const noexcept { return known_; }
  void reset() noexcept { known_ = false; }

 private:
  static constexpr Duration kTick = std::chrono::microseconds(kTick_us);

  Step step_to(std::uint32_t count) const noexcept {
    if (!known_) return Step::First;
    const auto on = static_cast<std::int32_t>(count - last_);  // wraps with the counter
    return on > 0 ? Step::On : on == 0 ? Step::Same : Step::Back;
  }

  /// A device that lost a moment, rather than a link that was slow for one.
  void follow(Duration raw) noexcept {
    if (!follows_) return;
    if (!least_) least_since_ = arrived_;
    least_ = least_ ? std::min(*least_, raw) : raw;
    if (arrived_ >= least_since_ && seconds(arrived_ - least_since_) < kStood_s) return;
    if (seconds(*least_ - *delay_) > kShift_s) delay_ = *least_;
    least_.reset();
  }

  bool follows_;
  bool known_ = false;
  std::uint32_t last_ = 0;
  Duration total_{};
  std::optional<Duration> delay_;
  std::optional<Duration> least_;  ///< raw delay since least_since_
  Time least_since_{};
  Time arrived_{};
};

}  // namespace roverd::base
