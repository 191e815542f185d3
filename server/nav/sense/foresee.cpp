#include "nav/sense/foresee.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "nav/sense/sweep.hpp"

namespace roverd::nav::sense {

namespace {

constexpr std::array kParts{1.0, 0.8, 0.6, 0.4, 0.2, 0.0};
constexpr double kLookEvery_s = 0.075;
constexpr double kMostUnsure_m = 0.4;  // what is known of him, is known better than this
constexpr double kComesNearer_m = 0.01;
constexpr std::size_t kMostOf = 16;

/// Of the moment, in B as it is now.
struct Foreseeable {
  Vec2 at;
  Vec2 v;
  double radius_m;
  double sigma_mps;
  double now_m;  ///< between him and the body
};

/// How much of the twist is driven, by time.
struct Pace {
  double part = 0.0;
  double for_s = 0.0;    ///< before it brakes
  double brake_s = 0.0;  ///< from the whole twist; 0: it never brakes

  /// Time of the whole twist that is driven by then.
  double driven_s(double t_s) const noexcept {
    if (brake_s <= 0.0) return part * t_s;
    const double keeps_s = std::min(t_s, for_s);
    const double brakes_s = std::clamp(t_s - for_s, 0.0, part * brake_s);
    return part * keeps_s + brakes_s * (part - 0.5 * brakes_s / brake_s);
  }
};

/// The first moment at which he is nearer than he may be.
std::optional<double> meets(const Foreseeable& who, const Footprint& body,
                            const base::BodyTwist& twist, const Pace& pace, double gap_m,
                            double horizon_s) noexcept {
  const double allowed_m = std::min(gap_m, who.now_m - kComesNearer_m);
  for (double t = kLookEvery_s; t <= horizon_s; t += kLookEvery_s) {
    const Vec2 seen = seen_after(who.at + t * who.v, twist, pace.driven_s(t));
    const double unsure_m = std::min(kMostUnsure_m, who.sigma_mps * t);
    if (body.distance_m(seen) - who.radius_m - unsure_m < allowed_m) return t;
  }
  return std::nullopt;
}

/// Behind who drives away from him.
bool behind(Vec2 at, double radius_m, const Footprint& body,
            const base::BodyTwist& twist) noexcept {
  const double v = twist.linear_mps;
  if (std::abs(v) < std::abs(twist.angular_radps) * body.reach_m()) return false;  // it turns
  double end = 0.0;
  for (const Vec2 c : body.corners()) end = std::min(end, v > 0.0 ? c.x : -c.x);
  return (v > 0.0 ? at.x : -at.x) + radius_m < end;
}

}  // namespace

Foreseen foresee(std::span<const Mover> movers, const Odometry& now, const Footprint& body,
                 const base::BodyTwist& twist, const ProtectParams& params) noexcept {
  Foreseen out;
  const double v = std::abs(twist.linear_mps);
  const double w = std::abs(twist.angular_radps);
  if (movers.empty() || params.foresee_s <= 0.0 || (v < 1e-3 && w < 1e-3)) return out;
  const double fastest_mps = v + w * body.reach_m();
  const double c = std::cos(now.pose.yaw_rad);
  const double s = std::sin(now.pose.yaw_rad);
  const auto in_body = [&](Vec2 p) { return Vec2{c * p.x + s * p.y, -s * p.x + c * p.y}; };
  std::array<Foreseeable, kMostOf> who;
  std::array<const Mover*, kMostOf> of{};
  std::size_t n = 0;
  for (const Mover& m : movers) {
    if (n == who.size()) break;
    const double age_s = std::max(0.0, base::seconds(now.stamp - m.seen));
    const Vec2 to = m.at + age_s * m.v_mps - Vec2{now.pose.x_m, now.pose.y_m};
    Foreseeable one{in_body(to), in_body(m.v_mps), m.radius_m, m.sigma_mps, 0.0};
    if (behind(one.at, one.radius_m, body, twist)) continue;
    one.now_m = body.distance_m(one.at) - one.radius_m;
    const double most_m = (fastest_mps + std::hypot(one.v.x, one.v.y)) * params.foresee_s;
    if (one.now_m > most_m + params.foresee_gap_m + kMostUnsure_m) continue;
    of[n] = &m;
    who[n++] = one;
  }
  // Slower than it is it cannot be at once.
  const double goes_on =
      v > 1e-3 ? now.v_mps / twist.linear_mps : now.yaw_rate_radps / twist.angular_radps;
  const double brake_s = std::max(v / params.decel_mps2, w / params.turn_decel_radps2);
  const double gap_m = std::max(params.foresee_gap_m, params.side_m);
  const auto may = [&](double part) {
    const Pace brake{std::max(part, std::clamp(goes_on, 0.0, 1.2)), params.delay_s, brake_s};
    bool keeps = part > 0.0;
    bool brakes = true;
    for (std::size_t i = 0; i < n && (keeps || brakes); ++i) {
      if (const auto t = keeps
                             ? meets(who[i], body, twist, {part, 0.0, 0.0}, gap_m, params.foresee_s)
                             : std::nullopt) {
        keeps = false;
        if (!out.found) {
          out.found = true;
          out.meets_s = *t;
          out.at = who[i].at;
          out.sensor = of[i]->sensor;
          out.age_s = base::seconds(now.stamp - of[i]->seen);
        }
      }
      brakes = brakes && !meets(who[i], body, twist, brake, params.side_m, params.foresee_s);
    }
    return keeps || brakes;
  };
  for (const double part : kParts) {
    out.part = part;
    if (may(part)) break;
  }
  return out;
}

}  // namespace roverd::nav::sense
