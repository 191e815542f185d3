#pragma once
// How far a gyro says that the robot turned between two moments, and whether it says that it
// stands.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/time.hpp"

namespace roverd::nav {

/// The last 0.6 s of samples at 100 Hz, as their running integral (trapezoid rule). A gap of more
/// than kGap_s begins anew: nobody knows what happened in it. No allocation.
class Gyro {
 public:
  static constexpr double kGap_s = 0.1;

  /// @param stamp later than the last one. @param rate_radps of the heading, bias included.
  void put(base::Time stamp, double rate_radps) noexcept {
    if (size_ > 0) {
      const double dt_s = base::seconds(stamp - last().stamp);
      if (dt_s > kGap_s) size_ = 0;
      if (size_ > 0) angle_rad_ += 0.5 * (last().rate_radps + rate_radps) * dt_s;
    }
    head_ = (head_ + 1) % ring_.size();
    ring_[head_] = {stamp, rate_radps, angle_rad_};
    if (size_ < ring_.size()) ++size_;
  }

  bool fresh(base::Time at) const noexcept {
    return size_ > 0 && base::seconds(at - last().stamp) < kGap_s;
  }
  /// Newest sample; 0 without any.
  double rate_radps() const noexcept { return size_ > 0 ? last().rate_radps : 0.0; }

  /// Empty where the samples do not cover the time. The newest rate holds on for kGap_s.
  std::optional<double> turned_rad(base::Time from, base::Time to) const noexcept {
    const auto a = angle_at(from);
    const auto b = angle_at(to);
    if (!a || !b) return std::nullopt;
    return *b - *a;
  }

  struct Spread {
    double mean_radps = 0.0;
    double deviation_radps = 0.0;  ///< 1σ of single samples
  };
  /// Over the samples since `from`; empty if fewer than five.
  std::optional<Spread> spread(base::Time from) const noexcept {
    double sum = 0.0;
    double squares = 0.0;
    std::size_t n = 0;
    for (; n < size_ && entry(n).stamp >= from; ++n) {
      sum += entry(n).rate_radps;
      squares += entry(n).rate_radps * entry(n).rate_radps;
    }
    if (n < 5) return std::nullopt;
    const double count = static_cast<double>(n);
    const double mean = sum / count;
    return Spread{mean, std::sqrt(std::fmax(0.0, squares / count - mean * mean))};
  }

 private:
  struct Sample {
    base::Time stamp;
    double rate_radps = 0.0;
    double angle_rad = 0.0;
  };

  const Sample& entry(std::size_t back) const noexcept {
    return ring_[(head_ + ring_.size() - back) % ring_.size()];
  }
  const Sample& last() const noexcept { return entry(0); }

  std::optional<double> angle_at(base::Time t) const noexcept {
    if (size_ == 0) return std::nullopt;
    const double after_s = base::seconds(t - last().stamp);
    if (after_s >= kGap_s) return std::nullopt;
    if (after_s >= 0.0) return last().angle_rad + last().rate_radps * after_s;
    for (std::size_t i = 1; i < size_; ++i) {
      const Sample& a = entry(i);
      if (a.stamp > t) continue;
      const Sample& b = entry(i - 1);
      const double part = base::seconds(t - a.stamp) / base::seconds(b.stamp - a.stamp);
      return a.angle_rad + part * (b.angle_rad - a.angle_rad);
    }
    // A little before the first sample is as good as at it.
    const Sample& first = entry(size_ - 1);
    const double before_s = base::seconds(first.stamp - t);
    if (before_s > 0.03) return std::nullopt;
    return first.angle_rad - first.rate_radps * before_s;
  }

  std::array<Sample, 64> ring_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
  double angle_rad_ = 0.0;
};

}  // namespace roverd::nav
