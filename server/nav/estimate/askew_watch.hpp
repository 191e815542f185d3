#pragma once
// Do two antennas point where the robot drives? Mounted askew, they are off by the same angle
// always, and claim a tenth of a degree. What a slope or the robot's own crab make of it stays
// below kMost_rad.
//
// Pure but for its memory; no allocation.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.hpp"

namespace roverd::nav {

class AskewWatch {
 public:
  static constexpr double kMost_rad = 0.15;  ///< 8.6 deg
  static constexpr double kLeastWay_m = 1.0;
  static constexpr double kProved_m = 3.0;
  static constexpr int kLeast = 6;
  static constexpr int kMemory = 100;
  static constexpr double kFirmRad = 0.01;  ///< nor is a course better known than so

  struct Offset {
    double rad = 0.0;  ///< heading of the antennas minus course, left positive
    double sigma_rad = 0.0;
    double way_m = 0.0;  ///< over which it was measured
  };

  /// One heading while driving straight. @param off_rad it minus the course, wrapped. @param
  /// sigma_rad of the two. @param way_m since the last one.
  void take(double off_rad, double sigma_rad, double way_m) noexcept {
    if (count_ == 0) about_rad_ = off_rad;
    const double off = base::angle_diff_rad(about_rad_, off_rad);
    count_ = std::min(count_ + 1, kMemory);
    const double part = 1.0 / count_;
    const double change = off - mean_;
    mean_ += part * change;
    variance_ += part * (change * (off - mean_) - variance_);
    noise_ += part * (sigma_rad * sigma_rad - noise_);
    way_m_ += way_m;
  }
  void forget() noexcept { *this = AskewWatch{}; }

  /// Enough to judge by.
  std::optional<Offset> measured() const noexcept {
    if (count_ < kLeast || way_m_ < kLeastWay_m) return std::nullopt;
    const double spread = std::sqrt(std::max(variance_, noise_) / count_);
    return Offset{base::wrap_rad(about_rad_ + mean_), std::hypot(spread, kFirmRad), way_m_};
  }
  /// They are askew, beyond doubt.
  bool askew() const noexcept {
    const auto m = measured();
    return m && std::abs(m->rad) > kMost_rad &&
           std::abs(m->rad) - 3.0 * m->sigma_rad > kMost_rad / 2;
  }
  /// They point where it drives, as far as a slope lets one say.
  bool proved() const noexcept {
    const auto m = measured();
    return m && way_m_ >= kProved_m && std::abs(m->rad) < kMost_rad;
  }

 private:
  double about_rad_ = 0.0;
  double mean_ = 0.0;
  double variance_ = 0.0;
  double noise_ = 0.0;
  double way_m_ = 0.0;
  int count_ = 0;
};

}  // namespace roverd::nav
