#pragma once
// The last seconds of states: a GNSS sentence tells of a moment about 0.1 s before its bytes
// arrive, the receiver in an inertial unit of one up to 2.5 s ago.

#include <array>
#include <cstddef>
#include <optional>

#include "base/angle.hpp"
#include "base/time.hpp"
#include "nav/estimate/ekf.hpp"

namespace roverd::nav {

struct Past {
  base::Time stamp;
  StateVector x = StateVector::Zero();
  double ahead_m = 0.0;     ///< sum of all travel as the tracks measure it
  double turned_rad = 0.0;  ///< sum of all turning as it was believed then, not wrapped
};

/// A ring of 192 states, about 3.8 s at 50 Hz. Oldest goes first. No allocation.
/// What is kept lies below the sum of all corrections, so that one costs the same however long the
/// past is: three of them in a tick that hears a receiver were half of its time.
class History {
 public:
  void clear() noexcept {
    size_ = 0;
    shifted_.setZero();
  }
  bool empty() const noexcept { return size_ == 0; }
  /// It was kept once and is not any more.
  bool forgotten(base::Time t) const noexcept {
    return size_ == ring_.size() && t < entry(size_ - 1).stamp;
  }

  void push(const Past& past) noexcept {
    head_ = (head_ + 1) % ring_.size();
    ring_[head_] = past;
    ring_[head_].x -= shifted_;
    if (size_ < ring_.size()) ++size_;
  }

  /// Interpolated; the oldest or newest one outside of what is kept. Empty if nothing is kept.
  std::optional<Past> at(base::Time t) const noexcept {
    if (size_ == 0) return std::nullopt;
    const Past* later = &entry(0);
    if (t >= later->stamp) return corrected(*later);
    for (std::size_t i = 1; i < size_; ++i) {
      const Past& earlier = entry(i);
      if (earlier.stamp <= t) return between(corrected(earlier), corrected(*later), t);
      later = &earlier;
    }
    return corrected(*later);
  }

  /// A correction of the present is one of the recent past as well.
  void shift(const StateVector& change) noexcept { shifted_ += change; }

 private:
  const Past& entry(std::size_t back) const noexcept {
    return ring_[(head_ + ring_.size() - back) % ring_.size()];
  }

  Past corrected(const Past& kept) const noexcept {
    Past p = kept;
    p.x += shifted_;
    p.x(kYaw) = base::wrap_rad(p.x(kYaw));
    return p;
  }

  static Past between(const Past& a, const Past& b, base::Time t) noexcept {
    const double span_s = base::seconds(b.stamp - a.stamp);
    const double part = span_s > 0.0 ? base::seconds(t - a.stamp) / span_s : 1.0;
    Past p;
    p.stamp = t;
    p.x = a.x + part * (b.x - a.x);
    p.x(kYaw) = base::wrap_rad(a.x(kYaw) + part * base::angle_diff_rad(a.x(kYaw), b.x(kYaw)));
    p.ahead_m = a.ahead_m + part * (b.ahead_m - a.ahead_m);
    p.turned_rad = a.turned_rad + part * (b.turned_rad - a.turned_rad);
    return p;
  }

  std::array<Past, 192> ring_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
  StateVector shifted_ = StateVector::Zero();  ///< sum of all corrections
};

}  // namespace roverd::nav
