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
constexpr double kFineArc_m = 0.01;

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
  double low_rad = 0.0;    ///< of the first, in B now
  double range_rad = 0.0;
};

Places places_of(const Trailer& t, const Pose2& vehicle, const Coupling& c) noexcept {
  Places out;
  const double range = c.high_rad() - c.low_rad();
  const double wide_m = range * t.body.reach_m();
  out.size = std::clamp(static_cast<int>(wide_m / kApart_m) + 1, 2, kMostAngles);
  out.between_m = 0.5 * wide_m / (out.size - 1);
  out.low_rad = vehicle.yaw_rad + c.low_rad();
  out.range_rad = range;
  const Pose2 hitch = vehicle * Pose2{-t.hitch_m, 0.0, 0.0};
  for (int i = 0; i < out.size; ++i) {
    const double angle = c.low_rad() + range * i / (out.size - 1);
    const double yaw = vehicle.yaw_rad + angle;
    out.of[static_cast<std::size_t>(i)] = {hitch.x_m, hitch.y_m, std::cos(yaw), std::sin(yaw)};
  }
  return out;
}

double to_place_m(const Trailer& t, const Places::Place& h, Vec2 p) noexcept {
  const double x = p.x - h.x_m;
  const double y = p.y - h.y_m;
  return t.body.distance_m({h.cos * x + h.sin * y, -h.sin * x + h.cos * y});
}

/// From the nearest of these places; less between_m it is that from any place, at least.
double least_m(const Trailer& t, const Places& places, Vec2 p) noexcept {
  double least = 1e9;
  for (int i = 0; i < places.size; ++i) {
    least = std::min(least, to_place_m(t, places.of[static_cast<std::size_t>(i)], p));
  }
  return least;
}

/// It lies in one of its places, those between the angles too. @param least as told by least_m()
bool within(const Trailer& t, const Places& places, Vec2 p, double least) noexcept {
  if (least <= 0.0) return true;
  if (least > places.between_m) return false;
  Places::Place h = places.of[0];
  const double far_m = std::max(std::hypot(p.x - h.x_m, p.y - h.y_m), kFineArc_m);
  // Turned by an angle the body comes nearer by no more than the arc.
  for (double turned_rad = 0.0; turned_rad <= places.range_rad;) {
    h.cos = std::cos(places.low_rad + turned_rad);
    h.sin = std::sin(places.low_rad + turned_rad);
    const double away_m = to_place_m(t, h, p);
    if (away_m <= 0.0) return true;
    turned_rad += std::max(away_m, kFineArc_m) / far_m;
  }
  return false;
}

struct Sweep {
  std::array<Places, kSteps + 1> at{};  ///< the first is now
  double step_s = 0.0;
  double step_m = 0.0;     ///< no point of it moves farther in a step
  double reach_m = 0.0;    ///< from the vehicle's origin now, whatever it does
  double hitch_mps = 0.0;  ///< H moves no faster
  Vec2 low{1e9, 1e9};      ///< the box of all its places, and the margin about them
  Vec2 high{-1e9, -1e9};
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
  s.hitch_mps = hitch_mps;
  s.step_s = horizon_s / kSteps;
  s.step_m = fastest * s.step_s;
  s.margin_m = beside_m(p, cell_m);
  s.grown_m = s.clear_m = s.margin_m;
  s.reach_m = t.hitch_m + t.body.reach_m() + fastest * horizon_s + s.margin_m;
  return s;
}

void lay_sweep(Sweep& s, const Trailer& t, Coupling coupling,
               const base::BodyTwist& twist) noexcept {
  for (int i = 0; i <= kSteps; ++i) {
    if (i > 0) coupling.drive(t, twist, s.step_s);
    const Pose2 vehicle = along(twist.linear_mps, twist.angular_radps, i * s.step_s);
    Places& places = s.at[static_cast<std::size_t>(i)];
    places = places_of(t, vehicle, coupling);
    const double about_m = places.between_m + s.margin_m;
    for (int k = 0; k < places.size; ++k) {
      const Places::Place& h = places.of[static_cast<std::size_t>(k)];
      for (const Vec2 c : t.body.corners()) {
        const Vec2 at{h.x_m + h.cos * c.x - h.sin * c.y, h.y_m + h.sin * c.x + h.cos * c.y};
        s.low = {std::min(s.low.x, at.x - about_m), std::min(s.low.y, at.y - about_m)};
        s.high = {std::max(s.high.x, at.x + about_m), std::max(s.high.y, at.y + about_m)};
      }
    }
  }
}

/// From the coupling as it is at a step: the trailer itself is no nearer than this less its reach.
double to_hitch_m(const Places& places, Vec2 p) noexcept {
  return std::hypot(p.x - places.of[0].x_m, p.y - places.of[0].y_m);
}

bool in_box(const Sweep& s, Vec2 p) noexcept {
  return p.x >= s.low.x && p.x <= s.high.x && p.y >= s.low.y && p.y <= s.high.y;
}

/// As near as the trailer may be now; empty: it lies in it, and is it. What is nearer than its
/// angles are apart would be touched already by one that lies between them: that is not known, and
/// would hold it for ever. So much may be left of it.
struct Now {
  double away_m = 0.0;
  double off_m = 0.0;  ///< taken off the distance to those places that are looked at
};
std::optional<Now> now_of(const Trailer& t, const Places& now, Vec2 p) noexcept {
  const double least = least_m(t, now, p);
  if (within(t, now, p, least)) return std::nullopt;
  if (least > now.between_m) return Now{least - now.between_m, now.between_m};
  return Now{least, 0.0};
}

/// Time until it comes as near as it may. What has room is not looked at before that is used up.
/// @param before_s later it does not matter
std::optional<double> touches_trailer(const Trailer& t, const Sweep& s, Vec2 p,
                                      double before_s) noexcept {
  const double reach_m = t.body.reach_m();
  double near_m = to_hitch_m(s.at[0], p) - reach_m;  // no nearer than that now
  bool ambiguous = false;
  if (near_m <= s.margin_m + s.at[0].between_m) {
    const auto now = now_of(t, s.at[0], p);
    if (!now) return std::nullopt;
    ambiguous = now->off_m == 0.0;
    const auto then_m = [&] {
      return least_m(t, s.at[1], p) - (ambiguous ? 0.0 : s.at[1].between_m);
    };
    const bool close = now->away_m < s.margin_m;
    if (close && then_m() < std::min(now->away_m, s.clear_m) - kNearerBy_m) return 0.0;
  }
  for (int i = 1; i <= kSteps && (i - 1) * s.step_s < before_s;) {
    const Places& places = s.at[static_cast<std::size_t>(i)];
    const double off_m = s.grown_m + (ambiguous ? 0.0 : places.between_m);
    double away = to_hitch_m(places, p) - reach_m - s.grown_m;
    if (away < s.step_m) away = std::max(away, least_m(t, places, p) - off_m);
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
  const double reach_m = trailer.body.reach_m();
  const double about_m = s.margin_m + s.at[0].between_m;
  each_within(patch, marks, pose, s.reach_m, [&](Vec2 p, const Patch::Cell&) {
    if (!in_box(s, p) || to_hitch_m(s.at[0], p) > reach_m + about_m) return;
    const auto now = now_of(trailer, s.at[0], p);
    if (now) s.clear_m = std::min(s.clear_m, now->away_m);
  });
  if (s.clear_m < s.margin_m) s.grown_m = std::max(0.0, s.clear_m - kLeeway_m);
  Patch::Cell what;
  each_within(patch, marks, pose, s.reach_m, [&](Vec2 p, const Patch::Cell& cell) {
    if (!in_box(s, p)) return;
    const double before_s = v.found ? v.touch_s : 1e9;
    // Sooner the coupling does not come near enough; a step is what it is told too early.
    const double way_m = to_hitch_m(s.at[0], p) - reach_m - about_m;
    if (way_m > s.hitch_mps * (before_s + s.step_s)) return;
    const auto t = touches_trailer(trailer, s, p, before_s);
    if (!t || *t >= before_s) return;
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
