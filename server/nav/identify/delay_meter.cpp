#include "nav/identify/delay_meter.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

constexpr double kSlow_s = 1.0;          // what changes more slowly is not looked at
constexpr double kForget_s = 20.0;       // of driving that tells something
constexpr double kEnough_s = 0.8;        // of it, before anything is said
constexpr double kExplained = 0.5;       // of the motion, by the command
constexpr double kSure_s = 0.04;         // a delay less certain than this is not told
constexpr double kLeastSigma_s = 0.005;  // a tick is 0.02 s long
constexpr int kRough = 60;               // ticks after a command that may not have been followed
constexpr double kAlikeTicks = 8.0;      // ticks whose errors are one and the same

}  // namespace

void DelayMeter::sent(double x, double gentle) noexcept {
  rough_ = std::abs(x - raw_x_) > gentle * kTick_s ? kRough : std::max(0, rough_ - 1);
  raw_x_ = x;
  since_ = std::min(since_ + 1, 1000);
  slow_x_ += (x - slow_x_) * kTick_s / kSlow_s;
  at_ = (at_ + 1) % kKept;
  sent_[at_] = x - slow_x_;
}

/// The filtered command so many ticks before the last one, between two of them on the line.
double DelayMeter::before(double age_ticks) const noexcept {
  const double age = std::clamp(age_ticks, 0.0, static_cast<double>(kKept - 2));
  const auto whole = static_cast<std::size_t>(age);
  const double part = age - static_cast<double>(whole);
  const std::size_t newer = (at_ + kKept - whole) % kKept;
  const std::size_t older = (newer + kKept - 1) % kKept;
  return sent_[newer] + part * (sent_[older] - sent_[newer]);
}

void DelayMeter::measured(double y, double age_s, bool counts) noexcept {
  if (!heard_) slow_y_ = y;
  heard_ = true;
  const double ticks = std::clamp(since_, 1, 20);
  since_ = 0;
  slow_y_ += (y - slow_y_) * ticks * kTick_s / kSlow_s;
  if (!counts || rough_ > 0) return;
  double least = 1e300;
  double most = 0.0;
  std::array<double, kCandidates> x;
  // The last command was sent a tick ago and holds until now: its middle is half a tick old.
  const double since = age_s / kTick_s - 0.5;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    x[i] = before(static_cast<double>(i) + since);
    least = std::min(least, x[i]);
    most = std::max(most, x[i]);
  }
  if ((most - least) * (most - least) < excited_) return;
  const double keep = 1.0 - ticks * kTick_s / kForget_s;
  const double fast = y - slow_y_;
  yy_ = keep * yy_ + ticks * fast * fast;
  weight_ = keep * weight_ + ticks;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    xx_[i] = keep * xx_[i] + ticks * x[i] * x[i];
    xy_[i] = keep * xy_[i] + ticks * x[i] * fast;
  }
}

void DelayMeter::forget() noexcept {
  xx_.fill(0.0);
  xy_.fill(0.0);
  yy_ = weight_ = 0.0;
}

std::optional<DelayFound> DelayMeter::found() const noexcept {
  if (weight_ * kTick_s < kEnough_s || yy_ <= 0.0) return std::nullopt;
  std::array<double, kCandidates> left;
  std::size_t best = 0;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const bool follows = xy_[i] > 0.0 && xx_[i] > 0.0;
    left[i] = yy_ - (follows ? xy_[i] * xy_[i] / xx_[i] : 0.0);
    if (left[i] < left[best]) best = i;
  }
  if (best == 0 || best + 1 == kCandidates) return std::nullopt;
  if (left[best] > (1.0 - kExplained) * yy_) return std::nullopt;
  // A parabola through the valley's bottom: R = R0 + c·(d − d0)².
  const double c = 0.5 * (left[best - 1] - 2.0 * left[best] + left[best + 1]);
  if (c <= 0.0) return std::nullopt;
  const double shift = 0.25 * (left[best - 1] - left[best + 1]) / c;
  const double bottom = std::max(0.0, left[best] - c * shift * shift);
  const double sigma = kTick_s * std::sqrt(kAlikeTicks * bottom / weight_ / c);
  DelayFound out;
  out.delay_s = kTick_s * (static_cast<double>(best) + shift);
  out.sigma_s = std::max(sigma, kLeastSigma_s);
  out.gain = xy_[best] / xx_[best];
  if (out.sigma_s > kSure_s) return std::nullopt;
  return out;
}

}  // namespace roverd::nav
