#include "nav/identify/brake_meter.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

constexpr std::size_t kWindow = 14;   // ticks: 0.28 s
constexpr double kFloor_mps2 = 0.08;  // a slope below is none: it coasts, or has not begun
constexpr double kSlow_mps = 0.12;    // below, tracks stick and lags round the end off
constexpr double kUnmet_mps = 0.02;   // told and seen differ by this at least
constexpr double kAsSteep = 0.85;     // of what was told: it follows
constexpr double kEven = 0.3;         // the two halves of a look differ no more
constexpr double kEvenFloor_mps2 = 0.06;
constexpr double kStep_mps2 = 1e3;   // asked for, where the command jumped
constexpr double kShare = 0.25;      // of a further look
constexpr double kShownShare = 0.5;  // of one that shows more than the limit
constexpr int kPause = 4;            // ticks

}  // namespace

double BrakeMeter::sigma_mps2() const noexcept {
  return 0.1 * limit_mps2_.value_or(0.0) / std::sqrt(std::clamp(looks_, 1, 16));
}

/// The order was given before the window, the delay counted, and not carried out in all of it.
bool BrakeMeter::wants(std::size_t delay) const noexcept {
  const double s = sign();
  for (std::size_t i = 0; i <= kWindow; i += 2) {
    if (s * (seen(i) - told(i)) < kUnmet_mps) return false;
  }
  const std::size_t then = kWindow + delay;
  const double before = told(then + 2);
  return s * (before - told(then)) > 2.0 * kTick_s * kFloor_mps2 ||
         (way_ == Way::Braking && told(then) == 0.0);
}

/// The slope of the command that acted over the window, whichever delay up to the longest.
double BrakeMeter::asked_mps2(std::size_t delay) const noexcept {
  double least = kStep_mps2;
  for (std::size_t d = 0; d <= delay; d += 2) {
    if (way_ == Way::Braking && told(d + kWindow) == 0.0) continue;  // to stand, at once
    const double slope =
        sign() * (told(d + kWindow) - told(d)) / (kTick_s * static_cast<double>(kWindow));
    least = std::min(least, slope);
  }
  return least;
}

void BrakeMeter::take(double slope_mps2, double asked) noexcept {
  shown_mps2_ = std::max(shown_mps2_.value_or(0.0), slope_mps2);
  if (slope_mps2 >= kAsSteep * asked) {
    if (limit_mps2_ && slope_mps2 > *limit_mps2_) {
      looks_ = std::max(looks_, 1);
      *limit_mps2_ += kShownShare * (slope_mps2 - *limit_mps2_);
    }
    return;
  }
  looks_ = limit_mps2_ ? std::min(looks_ + 1, 1000) : 1;
  limit_mps2_ = limit_mps2_ ? *limit_mps2_ + kShare * (slope_mps2 - *limit_mps2_) : slope_mps2;
}

void BrakeMeter::step(double told_mps, std::optional<double> seen_mps, double delay_s) noexcept {
  const double before = seen(0);
  at_ = (at_ + 1) % kKept;
  told_[at_] = told_mps;
  seen_[at_] = seen_mps.value_or(before);
  silent_ = seen_mps ? silent_ : std::min(silent_ + 1, kKept - 1);
  filled_ = std::min(filled_ + 1, kKept);
  if (pause_ > 0) --pause_;
  if (!seen_mps) return;
  for (std::size_t i = 1; i <= silent_; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(silent_ + 1);
    seen_[(at_ + kKept - i) % kKept] = *seen_mps + part * (before - *seen_mps);
  }
  silent_ = 0;
  const auto delay = static_cast<std::size_t>(
      std::clamp(std::ceil(delay_s / kTick_s), 0.0, static_cast<double>(kKept - kWindow - 4)));
  if (pause_ > 0 || filled_ < kKept || std::min(seen(0), seen(kWindow)) < kSlow_mps) return;
  if (!wants(delay)) return;
  const double half_s = kTick_s * static_cast<double>(kWindow / 2);
  const double first = sign() * (seen(kWindow) - seen(kWindow / 2)) / half_s;
  const double second = sign() * (seen(kWindow / 2) - seen(0)) / half_s;
  const double slope = 0.5 * (first + second);
  if (std::abs(first - second) > std::max(kEven * slope, kEvenFloor_mps2)) return;
  const double asked = asked_mps2(delay);
  if (slope < kFloor_mps2 || asked < kFloor_mps2) return;
  take(slope, asked);
  pause_ = kPause;
}

}  // namespace roverd::nav
