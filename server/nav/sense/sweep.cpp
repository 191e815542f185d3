#include "nav/sense/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kStraight_radps = 1e-5;  // slower turns are lines: 0.1 mm in 6 s at 1 m/s

/// The earliest of what is offered.
struct First {
  double t = 0.0;
  bool found = false;
  void offer(double when, double horizon_s) noexcept {
    if (when < 0.0 || when > horizon_s || (found && when >= t)) return;
    t = when;
    found = true;
  }
};

// The point goes on p − v t x.
void line_meets(First& first, Vec2 p, double v, Vec2 a, Vec2 b, double horizon_s) noexcept {
  const Vec2 e = b - a;
  const Vec2 d{-v, 0.0};
  const double across = cross(d, e);
  if (std::abs(across) < 1e-12) return;  // along the edge: a disc at its end is met first
  const double t = cross(a - p, e) / across;
  const double u = cross(a - p, d) / across;
  if (u >= 0.0 && u <= 1.0) first.offer(t, horizon_s);
}

void line_meets_disc(First& first, Vec2 p, double v, Vec2 c, double r, double horizon_s) noexcept {
  const double off = p.y - c.y;
  const double half2 = r * r - off * off;
  if (half2 < 0.0) return;
  const double half = std::sqrt(half2);
  first.offer((p.x - c.x - half) / v, horizon_s);
  first.offer((p.x - c.x + half) / v, horizon_s);
}

/// The circle that the point goes on.
struct Round {
  Vec2 centre;
  double radius = 0.0;
  double start_rad = 0.0;
  double rate_radps = 0.0;  ///< of the point about the centre: −ω
};

void offer_angle(First& first, const Round& c, double angle_rad, double horizon_s) noexcept {
  double turn = (angle_rad - c.start_rad) * (c.rate_radps > 0.0 ? 1.0 : -1.0);
  turn -= 2.0 * base::kPi * std::floor(turn / (2.0 * base::kPi));
  first.offer(turn / std::abs(c.rate_radps), horizon_s);
}

void round_meets(First& first, const Round& c, Vec2 a, Vec2 b, double horizon_s) noexcept {
  const Vec2 e = b - a;
  const Vec2 d = a - c.centre;
  const double ee = dot(e, e);
  const double ed = dot(e, d);
  const double under = ed * ed - ee * (dot(d, d) - c.radius * c.radius);
  if (under < 0.0) return;
  const double root = std::sqrt(under);
  for (const double u : {(-ed - root) / ee, (-ed + root) / ee}) {
    if (u < 0.0 || u > 1.0) continue;
    const Vec2 at = d + u * e;
    offer_angle(first, c, std::atan2(at.y, at.x), horizon_s);
  }
}

void round_meets_disc(First& first, const Round& c, Vec2 disc, double r,
                      double horizon_s) noexcept {
  const Vec2 d = disc - c.centre;
  const double away = std::hypot(d.x, d.y);
  if (away < 1e-12 || c.radius < 1e-12) return;
  const double cosine = (away * away + c.radius * c.radius - r * r) / (2.0 * away * c.radius);
  if (cosine < -1.0 || cosine > 1.0) return;
  const double middle = std::atan2(d.y, d.x);
  const double half = std::acos(cosine);
  offer_angle(first, c, middle - half, horizon_s);
  offer_angle(first, c, middle + half, horizon_s);
}

}  // namespace

std::optional<double> touch_s(const Footprint& body, Vec2 p, double r_m,
                              const base::BodyTwist& twist, double horizon_s) noexcept {
  if (body.distance_m(p) <= r_m) return 0.0;
  const double v = twist.linear_mps;
  const double w = twist.angular_radps;
  const bool straight = std::abs(w) < kStraight_radps;
  if (straight && std::abs(v) < 1e-9) return std::nullopt;
  Round round;
  if (!straight) {
    round.centre = {0.0, v / w};
    const Vec2 d = p - round.centre;
    round.radius = std::hypot(d.x, d.y);
    round.start_rad = std::atan2(d.y, d.x);
    round.rate_radps = -w;
  }
  First first;
  const auto corners = body.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 b = corners[i + 1 == corners.size() ? 0 : i + 1];
    const Vec2 e = b - a;
    const double length = std::hypot(e.x, e.y);
    const Vec2 out{r_m * e.y / length, -r_m * e.x / length};
    if (straight) {
      line_meets(first, p, v, a + out, b + out, horizon_s);
      line_meets_disc(first, p, v, a, r_m, horizon_s);
    } else {
      round_meets(first, round, a + out, b + out, horizon_s);
      round_meets_disc(first, round, a, r_m, horizon_s);
    }
  }
  if (!first.found) return std::nullopt;
  return first.t;
}

Vec2 seen_after(Vec2 p, const base::BodyTwist& twist, double t_s) noexcept {
  const double v = twist.linear_mps;
  const double w = twist.angular_radps;
  if (std::abs(w) < kStraight_radps) return {p.x - v * t_s, p.y};
  const Vec2 centre{0.0, v / w};
  const Vec2 d = p - centre;
  const double c = std::cos(w * t_s);
  const double s = std::sin(w * t_s);
  return centre + Vec2{c * d.x + s * d.y, -s * d.x + c * d.y};
}

}  // namespace roverd::nav::sense
