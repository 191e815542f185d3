#include "pwm/codec.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::pwm {
namespace {

constexpr double kSpan_us = kHighest_us - kCentre_us;

double share(int us) noexcept {
  return (us - kCentre_us) / kSpan_us;
}

int pulse(double share) noexcept {
  return kCentre_us + static_cast<int>(std::lround(share * kSpan_us));
}

bool in_range(int us) noexcept {
  return us >= kLowest_us && us <= kHighest_us;
}

}  // namespace

std::optional<base::BodyTwist> to_twist(Pulses p, const Factors& f) noexcept {
  if (!in_range(p.left_us) || !in_range(p.right_us)) return {};
  const double left = share(p.left_us);
  const double right = share(p.right_us);
  return base::BodyTwist{f.speed_mps * (right + left) / 2.0, f.turn_radps * (right - left)};
}

Pulses to_pulses(base::BodyTwist t, const Factors& f) noexcept {
  const double mean = t.linear_mps / f.speed_mps;
  const double half = t.angular_radps / f.turn_radps / 2.0;
  if (!std::isfinite(mean) || !std::isfinite(half)) return {};
  const double most = std::max(1.0, std::abs(mean) + std::abs(half));
  return {pulse((mean - half) / most), pulse((mean + half) / most)};
}

}  // namespace roverd::pwm
