#include "nav/sense/trailer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/angle.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kStands_mps = 1e-3;
constexpr double kStands_radps = 1e-3;
constexpr double kFine_s = 0.05;  // (1) is followed so finely
constexpr int kSteps = 64;
constexpr int kMostAngles = 8;
constexpr double kApart_m = 0.15;  // between neighbouring angles, at the trailer's end
constexpr double kNearerBy_m = 1e-4;
constexpr double kLeeway_m = 0.02;

double turned(const Trailer& t, double angle_rad, const base::BodyTwist& twist,
              double dt_s) noexcept {
  const double v = twist.linear_mps;
  const double w = twist.angular_radps;
  const int n = std::max(1, static_cast<int>(std::ceil(dt_s / kFine_s)));
  for (int i = 0; i < n; ++i) {
    const double rate =
        -w - (v * std::sin(angle_rad) + t.hitch_m * w * std::cos(angle_rad)) / t.axle_m;
    angle_rad += rate * dt_s / n;
  }
  return std::clamp(angle_rad, -Coupling::kMost_rad, Coupling::kMost_rad);
}

/// Where the trailer may be at one time: in B now, as a few of the angles that it may have.
struct Places {
  struct Place {
    double x_m = 0.0;  ///< of H in B
    double y_m = 0.0;
    double cos = 1.0;
    double sin = 0.0;
  };
  std::array<Place, kMostAngles> of{};
  int size = 0;
  double between_m = 0.0;  ///< no place of it is farther from the nearest of these
};

Places places_of(const Trailer& t, const Pose2& vehicle, const Coupling& c) noexcept {
  Places out;
  const double range = c.high_rad() - c.low_rad();
  const double wide_m = range * t.body.reach_m();
  out.size = std::clamp(static_cast<int>(wide_m / kApart_m) + 1, 2, kMostAngles);
  out.between_m = 0.5 * wide_m / (out.size - 1);
  const Pose2 hitch = vehicle * Pose2{-t.hitch_m, 0.0, 0.0};
  for (int i = 0; i < out.size; ++i) {
    const double angle = c.low_rad() + range * i / (out.size - 1);
    const double yaw = vehicle.yaw_rad + angle;
    out.of[static_cast<std::size_t>(i)] = {hitch.x_m, hitch.y_m, std::cos(yaw), std::sin(yaw)};
  }
  return out;
}

/// From the nearest of its places, at least.
double distance_m(const Trailer& t, const Places& places, Vec2 p) noexcept {
  double least = 1e9;
  for (int i = 0; i < places.size; ++i) {
    const Places::Place& h = places.of[static_cast<std::size_t>(i)];
    const double x = p.x - h.x_m;
    const double y = p.y - h.y_m;
    least = std::min(least, t.body.distance_m({h.cos * x + h.sin * y, -h.sin * x + h.cos * y}));
  }
  return least - places.between_m;
}

struct Sweep {
  std::array<Places, kSteps + 1> at{};  ///< the first is now
  double step_s = 0.0;
  double step_m = 0.0;   ///< no point of it moves farther in a step
  double reach_m = 0.0;  ///< from the vehicle's origin now, whatever it does
  double margin_m = 0.0;
  double grown_m = 0.0;  ///< the margin, or what is left of it now
  double clear_m = 0.0;
};

Sweep sweep_of(const Trailer& t, const base::BodyTwist& twist, const ProtectParams& p,
               double cell_m) noexcept {
  Sweep s;
  const double v = std::abs(twist.linear_mps);
  const double w = std::abs(twist.angular_radps);
  const double hitch_mps = v + w * t.hitch_m;
  const double fastest = hitch_mps + t.body.reach_m() * hitch_mps / t.axle_m;
  const double brake_s = std::max(0.5 * v / p.decel_mps2, 0.5 * w / p.turn_decel_radps2);
  const double horizon_s =
      std::min({p.horizon_s, p.reach_m / std::max(fastest, 1e-3), p.delay_s + brake_s + 0.5});
  s.step_s = horizon_s / kSteps;
  s.step_m = fastest * s.step_s;
  s.margin_m = p.side_m + cell_m * std::sqrt(0.5);
  s.grown_m = s.clear_m = s.margin_m;
  s.reach_m = t.hitch_m + t.body.reach_m() + fastest * horizon_s + s.margin_m;
  return s;
}

void lay_sweep(Sweep& s, const Trailer& t, Coupling coupling,
               const base::BodyTwist& twist) noexcept {
  for (int i = 0; i <= kSteps; ++i) {
    if (i > 0) coupling.drive(t, twist, s.step_s);
    const Pose2 vehicle = along(twist.linear_mps, twist.angular_radps, i * s.step_s);
    s.at[static_cast<std::size_t>(i)] = places_of(t, vehicle, coupling);
  }
}

/// Time until it comes as near as it may. What has room is not looked at before that is used up.
std::optional<double> touches_trailer(const Trailer& t, const Sweep& s, Vec2 p) noexcept {
  const double now_m = distance_m(t, s.at[0], p);
  if (now_m <= 0.0) return std::nullopt;
  const bool within = now_m < s.margin_m;
  if (within && distance_m(t, s.at[1], p) < std::min(now_m, s.clear_m) - kNearerBy_m) return 0.0;
  for (int i = 1; i <= kSteps;) {
    const double away = distance_m(t, s.at[static_cast<std::size_t>(i)], p) - s.grown_m;
    if (away <= 0.0) return (i - 1) * s.step_s;
    i += std::max(1, static_cast<int>(away / s.step_m));
  }
  return std::nullopt;
}

template <class Each>
void each_within(const Patch& patch, const Marks* marks, const Pose2& pose, double reach_m,
                 const Each& each) noexcept {
  const auto cell = [&patch](double v) {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m));
  };
  const std::int32_t x_from = std::max(cell(pose.x_m - reach_m), patch.x0);
  const std::int32_t x_to = std::min(cell(pose.x_m + reach_m), patch.x0 + patch.side - 1);
  const std::int32_t y_from = std::max(cell(pose.y_m - reach_m), patch.y0);
  const std::int32_t y_to = std::min(cell(pose.y_m + reach_m), patch.y0 + patch.side - 1);
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const auto offer = [&](std::int32_t ix, std::int32_t iy) {
    const double x = (ix + 0.5) * patch.cell_m - pose.x_m;
    const double y = (iy + 0.5) * patch.cell_m - pose.y_m;
    if (x * x + y * y > reach_m * reach_m) return;
    each(Vec2{c * x + s * y, -s * x + c * y}, patch.at(ix, iy));
  };
  if (marks != nullptr && marks->fit(patch)) {
    return marks->each_taken(x_from, x_to, y_from, y_to, offer);
  }
  for (std::int32_t iy = y_from; iy <= y_to; ++iy) {
    for (std::int32_t ix = x_from; ix <= x_to; ++ix) {
      if (patch.at(ix, iy).known >= Known::Occupied) offer(ix, iy);
    }
  }
}

}  // namespace

void Coupling::drive(const Trailer& trailer, const base::BodyTwist& twist, double dt_s) noexcept {
  const double low = turned(trailer, low_rad_, twist, dt_s);
  const double high = turned(trailer, high_rad_, twist, dt_s);
  const double middle = 0.5 * (low + high);
  low_rad_ = std::max(-kMost_rad, std::min(low, middle - kSure_rad));
  high_rad_ = std::min(kMost_rad, std::max(high, middle + kSure_rad));
}

Verdict protect_trailer(const Patch& patch, const Pose2& pose, const Trailer& trailer,
                        const Coupling& coupling, const base::BodyTwist& twist,
                        const ProtectParams& params, const Marks* marks) noexcept {
  Verdict v;
  if (std::abs(twist.linear_mps) < kStands_mps && std::abs(twist.angular_radps) < kStands_radps) {
    return v;
  }
  Sweep s = sweep_of(trailer, twist, params, patch.cell_m);
  bool any = false;
  each_within(patch, marks, pose, s.reach_m, [&](Vec2, const Patch::Cell&) { any = true; });
  if (!any) return v;
  lay_sweep(s, trailer, coupling, twist);
  each_within(patch, marks, pose, s.reach_m, [&](Vec2 p, const Patch::Cell&) {
    const double now_m = distance_m(trailer, s.at[0], p);
    if (now_m > 0.0) s.clear_m = std::min(s.clear_m, now_m);
  });
  if (s.clear_m < s.margin_m) s.grown_m = std::max(0.0, s.clear_m - kLeeway_m);
  Patch::Cell what;
  each_within(patch, marks, pose, s.reach_m, [&](Vec2 p, const Patch::Cell& cell) {
    const auto t = touches_trailer(trailer, s, p);
    if (!t || (v.found && *t >= v.touch_s)) return;
    v.found = true;
    v.touch_s = *t;
    v.at = p;
    what = cell;
  });
  if (!v.found) return v;
  v.distance_m = std::abs(twist.linear_mps) * v.touch_s;
  v.turn_rad = twist.angular_radps * v.touch_s;
  v.bearing_rad = std::atan2(v.at.y, v.at.x);
  v.sensor = what.sensor;
  v.age_s = 0.1 * what.age_ds;
  v.part = part_for(v.touch_s, twist, params);
  if (v.part < 1.0) v.limit = what.known == Known::Drop ? Limit::Drop : Limit::Obstacle;
  return v;
}

}  // namespace roverd::nav::sense
