#pragma once
// A speed that rises or falls evenly, as the base shows it: the slope of its middle half.
//
//   v │──╮           begin(v) at the command; put() whatever is heard; slope() between three
//     │   ╲  ◀ 3/4   quarters and one quarter of v: neither the delay nor the lags at both ends
//     │    ╲ ◀ 1/4   count
//     └─────╲─────▶ t
//
// Pure but for its memory; no allocation; control thread.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace roverd::nav {

class SlopeTrace {
 public:
  /// @param of_mps the speed that falls to nothing, or that is reached. A size.
  void begin(double of_mps) noexcept {
    *this = SlopeTrace{};
    of_mps_ = of_mps;
  }
  /// @param t_s any clock. @param mps a size
  void put(double t_s, double mps) noexcept {
    if (of_mps_ <= 0.0 || mps < 0.25 * of_mps_ || mps > 0.75 * of_mps_) return;
    if (n_ == 0) from_s_ = t_s;
    const double t = t_s - from_s_;
    ++n_;
    t_ += t;
    v_ += mps;
    tt_ += t * t;
    tv_ += t * mps;
  }
  /// m/s², a size; empty: too little was seen of it.
  std::optional<double> slope() const noexcept {
    const double n = static_cast<double>(n_);
    const double spread = n_ > 0 ? tt_ - t_ * t_ / n : 0.0;
    if (n_ < kLeast || spread <= 1e-6) return std::nullopt;
    return std::abs((tv_ - t_ * v_ / n) / spread);
  }

 private:
  static constexpr std::size_t kLeast = 4;
  double of_mps_ = 0.0;
  double from_s_ = 0.0;
  double t_ = 0.0, v_ = 0.0, tt_ = 0.0, tv_ = 0.0;
  std::size_t n_ = 0;
};

/// The mean of several looks, and how sure it is.
class Looks {
 public:
  void take(double value) noexcept {
    ++n_;
    const double change = value - mean_;
    mean_ += change / n_;
    squares_ += change * (value - mean_);
  }
  int count() const noexcept { return n_; }
  double mean() const noexcept { return mean_; }
  /// Of the mean. @param one of a single look, at least
  double sigma(double one) const noexcept {
    const double spread = n_ > 1 ? std::sqrt(squares_ / (n_ - 1)) : one;
    return std::max(spread, one) / std::sqrt(std::max(1, n_));
  }

 private:
  int n_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace roverd::nav
