#include "nav/track/law.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

/// sin of the steepest approach to the path.
constexpr double kSteepest = 0.5;
/// An oscillator with the delay T left to prediction is stable for L > 1.5·v·T (model exact); the
/// rest is for a delay that is not quite the one in the profile.
constexpr double kDelayRoom = 1.9;
constexpr double kCalmest = 2.5;
const double kMostWheel_rad = base::rad_from_deg(70.0);

double approach(double cross_m, double settle_m, double damping) noexcept {
  return std::clamp(cross_m / (2.0 * damping * settle_m), -kSteepest, kSteepest);
}

}  // namespace

std::optional<TrackLaw> law_from(std::string_view word) noexcept {
  if (word == "path_frame") return TrackLaw::PathFrame;
  if (word == "pure_pursuit") return TrackLaw::PurePursuit;
  if (word == "stanley") return TrackLaw::Stanley;
  return std::nullopt;
}

double calm_of(double yaw_sigma_rad, double known_sigma_rad) noexcept {
  return std::clamp(yaw_sigma_rad / std::max(known_sigma_rad, 1e-6), 1.0, kCalmest);
}

double settle_length_m(double speed_mps, const TrackParams& p) noexcept {
  const double v = std::abs(speed_mps);
  return std::max({p.settle_min_m, p.settle_time_s * v, kDelayRoom * p.delay_s * v});
}

double course_error_rad(double cross_m, double heading_rad, double settle_m,
                        double damping) noexcept {
  return base::wrap_rad(heading_rad + std::asin(approach(cross_m, settle_m, damping)));
}

double path_frame_1pm(const BesidePath& at, const TrackParams& p) noexcept {
  const double settle_m = at.calm * settle_length_m(at.speed_mps, p);
  // Beyond the centre of the bend the path's frame has no sense.
  const double beside = std::max(0.3, 1.0 - at.curvature_1pm * at.cross_m);
  const double ahead = std::max(0.0, std::cos(at.heading_rad));
  const bool away = std::abs(at.heading_rad) > base::kPi / 2.0;
  const double heading = away ? std::copysign(1.0, at.heading_rad) : std::sin(at.heading_rad);
  return at.curvature_1pm * ahead / beside -
         2.0 * p.damping / settle_m * (heading + approach(at.cross_m, settle_m, p.damping));
}

double stanley_1pm(const BesidePath& at, double wheelbase_m, const TrackParams& p) noexcept {
  const double front_m = at.cross_m + wheelbase_m * std::sin(at.heading_rad);
  const double wheel =
      -at.heading_rad - std::atan(p.stanley_gain_1ps * front_m / (at.speed_mps + 0.5));
  return at.curvature_1pm +
         std::tan(std::clamp(wheel, -kMostWheel_rad, kMostWheel_rad)) / wheelbase_m;
}

}  // namespace roverd::nav
