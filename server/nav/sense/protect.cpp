#include "nav/sense/protect.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "nav/sense/protect_parts.hpp"
#include "nav/sense/sweep.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kStill_mps = 1e-3;
constexpr double kStill_radps = 1e-3;
// Within the margin nothing may come nearer than the nearest is: looked at so much later, by so
// much. A larger tolerance would be used up in every tick.
constexpr double kSoon_s = 0.05;
constexpr double kNearer_m = 1e-4;
// And the margin for all else shrinks with it, so that a wall beside the robot does not hold it.
constexpr double kLess_m = 0.02;
// A dock may be seen so much before where it is come to: half a cell, and what a range is out.
constexpr double kBefore_m = 0.05;

Drive drive_of(const Footprint& body, const base::BodyTwist& twist, const ProtectParams& p,
               double cell_m) noexcept {
  Drive d;
  d.twist = twist;
  const double v = std::abs(twist.linear_mps);
  const double w = std::abs(twist.angular_radps);
  d.turning = turns_on_the_spot(twist, body);
  d.straight = w < 1e-5;
  // As far as it takes to stop with the margin, and no farther: beyond nothing limits.
  const double brake_s = std::max(0.5 * v / p.decel_mps2, 0.5 * w / p.turn_decel_radps2);
  const double fastest = std::max({v + w * body.reach_m(), 1e-3});
  d.horizon_s = std::min({p.horizon_s, p.reach_m / fastest, p.delay_s + brake_s + 1.0});
  // The gap lies beyond the place where it stands still.
  const double gap_s = std::max(0.0, p.gap_m - p.side_m) / fastest;
  d.horizon_s = std::min(d.horizon_s + gap_s, p.reach_m / fastest);
  // A full turn sees everything.
  if (w > 1e-5) d.horizon_s = std::min(d.horizon_s, 2.0 * base::kPi / w);
  d.margin_m = beside_m(p, cell_m);
  d.grown_m = d.margin_m;
  d.clear_m = d.margin_m;
  if (d.straight) return d;
  d.centre = {0.0, twist.linear_mps / twist.angular_radps};
  const double inside = body.distance_m(d.centre);
  const double least = std::max(0.0, inside - d.margin_m);
  double most = 0.0;
  for (const Vec2 c : body.corners()) {
    most = std::max(most, std::hypot(c.x - d.centre.x, c.y - d.centre.y));
  }
  d.least2 = least * least;
  d.most2 = (most + d.margin_m) * (most + d.margin_m);
  return d;
}

/// Time until the grown body touches it; 0 if it is within the margin and comes nearer than the
/// nearest is.
std::optional<double> touches(const Footprint& body, Vec2 p, const Drive& d) noexcept {
  if (!d.straight) {
    const Vec2 off = p - d.centre;
    const double away2 = dot(off, off);
    if (away2 < d.least2 || away2 > d.most2) return std::nullopt;
  }
  const double now_m = body.distance_m(p);
  if (now_m <= 0.0) return std::nullopt;  // the body stands there
  if (now_m < d.margin_m &&
      body.distance_m(seen_after(p, d.twist, kSoon_s)) < std::min(now_m, d.clear_m) - kNearer_m) {
    return 0.0;
  }
  return touch_s(body, p, d.grown_m, d.twist, d.horizon_s);
}

/// The square of cells that the sweep can reach.
struct Reach {
  double x0, x1, y0, y1;  // in B
};

Reach reach_of(const Footprint& body, const Drive& d) noexcept {
  Reach r{0.0, 0.0, 0.0, 0.0};
  constexpr int kLooks = 12;
  double between = 0.0;
  for (int i = 0; i <= kLooks; ++i) {
    const double t = d.horizon_s * i / kLooks;
    const Pose2 at = along(d.twist.linear_mps, d.twist.angular_radps, t);
    const double c = std::cos(at.yaw_rad);
    const double s = std::sin(at.yaw_rad);
    for (const Vec2 corner : body.corners()) {
      const double x = at.x_m + c * corner.x - s * corner.y;
      const double y = at.y_m + s * corner.x + c * corner.y;
      r = {std::min(r.x0, x), std::max(r.x1, x), std::min(r.y0, y), std::max(r.y1, y)};
    }
  }
  // Between two looks a corner's arc goes beyond its chord by its rise, l w dt / 8.
  const double dt = d.horizon_s / kLooks;
  const double w = std::abs(d.twist.angular_radps);
  const double v = std::abs(d.twist.linear_mps) + w * body.reach_m();
  between = 0.125 * v * dt * w * dt + d.margin_m;
  return {r.x0 - between, r.x1 + between, r.y0 - between, r.y1 + between};
}

/// Calls back with every cell that is taken within a rectangle of B.
template <class Each>
void each_taken(const Picture& seen, const Pose2& pose, const Reach& r, const Each& each) noexcept {
  const Patch& patch = seen.patch;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  // The rectangle, turned into the grid's axes.
  double low_x = 1e9;
  double high_x = -1e9;
  double low_y = 1e9;
  double high_y = -1e9;
  for (const Vec2 q : {Vec2{r.x0, r.y0}, {r.x0, r.y1}, {r.x1, r.y0}, {r.x1, r.y1}}) {
    const double x = pose.x_m + c * q.x - s * q.y;
    const double y = pose.y_m + s * q.x + c * q.y;
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y);
  }
  const auto cell_of = [&patch](double v) {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m));
  };
  const std::int32_t x_from = std::max(cell_of(low_x), patch.x0);
  const std::int32_t x_to = std::min(cell_of(high_x), patch.x0 + patch.side - 1);
  const std::int32_t y_from = std::max(cell_of(low_y), patch.y0);
  const std::int32_t y_to = std::min(cell_of(high_y), patch.y0 + patch.side - 1);
  const auto offer = [&](std::int32_t ix, std::int32_t iy) {
    const double x = (ix + 0.5) * patch.cell_m - pose.x_m;
    const double y = (iy + 0.5) * patch.cell_m - pose.y_m;
    const Vec2 p{c * x + s * y, -s * x + c * y};
    if (p.x >= r.x0 && p.x <= r.x1 && p.y >= r.y0 && p.y <= r.y1) each(p, patch.at(ix, iy));
  };
  if (seen.marks != nullptr) {
    seen.marks->each_taken(x_from, x_to, y_from, y_to, offer);
    return;
  }
  for (std::int32_t iy = y_from; iy <= y_to; ++iy) {
    for (std::int32_t ix = x_from; ix <= x_to; ++ix) {
      if (patch.at(ix, iy).known >= Known::Occupied) offer(ix, iy);
    }
  }
}

/// So long it takes at least until the margin can come to a place: a turn brings nothing nearer to
/// the origin.
double soonest_s(const Footprint& body, Vec2 p, const Drive& d) noexcept {
  const double way = std::hypot(p.x, p.y) - body.reach_m() - d.margin_m;
  return way / std::max(std::abs(d.twist.linear_mps), 1e-9);
}

/// Obstacles, exactly: every cell that is taken. @param dock the nearest that is spared
Nearest nearest_taken(const Picture& seen, const Pose2& pose, const Footprint& body, Drive& d,
                      const Spared* spared, Nearest& dock) noexcept {
  const double about = body.reach_m() + d.margin_m;
  each_taken(seen, pose, {-about, about, -about, about}, [&](Vec2 p, const Patch::Cell& cell) {
    const double now_m = body.distance_m(p);
    if (now_m > 0.0 && !is_spared(spared, p, cell.known)) d.clear_m = std::min(d.clear_m, now_m);
  });
  if (d.clear_m < d.margin_m) d.grown_m = std::max(0.0, d.clear_m - kLess_m);
  Nearest best;
  each_taken(seen, pose, reach_of(body, d), [&](Vec2 p, const Patch::Cell& cell) {
    Nearest& whose = is_spared(spared, p, cell.known) ? dock : best;
    if (whose.touch_s && soonest_s(body, p, d) > *whose.touch_s) return;
    if (const auto t = touches(body, p, d)) nearer(whose, *t, p, cell);
  });
  return best;
}

/// The part of the twist that is a creep into what nobody has seen.
double creep_part(const Drive& d, const ProtectParams& p) noexcept {
  if (d.turning) return p.creep_turn_radps / std::max(std::abs(d.twist.angular_radps), 1e-9);
  const double creep = d.twist.linear_mps > 0.0 ? p.creep_mps : p.creep_back_mps;
  return creep / std::abs(d.twist.linear_mps);
}

void tell(Verdict& v, const Nearest& n, const Drive& d) noexcept {
  v.found = true;
  v.touch_s = *n.touch_s;
  v.distance_m = d.turning ? 0.0 : std::abs(d.twist.linear_mps) * *n.touch_s;
  v.turn_rad = d.twist.angular_radps * *n.touch_s;
  v.at = n.at;
  v.bearing_rad = std::atan2(n.at.y, n.at.x);
  v.sensor = n.cell.sensor;
  v.age_s = 0.1 * n.cell.age_ds;
}

}  // namespace

bool turns_on_the_spot(const base::BodyTwist& twist, const Footprint& body) noexcept {
  const double v = std::abs(twist.linear_mps);
  return v < kStill_mps || v < 0.2 * std::abs(twist.angular_radps) * body.reach_m();
}

bool is_spared(const Spared* spared, Vec2 p, Known known) noexcept {
  if (spared == nullptr || known == Known::Drop) return false;
  const Vec2 e = spared->to - spared->from;
  const Vec2 d = p - spared->from;
  if (dot(d, spared->ahead) < -kBefore_m) return false;
  const double length2 = dot(e, e);
  const double part = length2 > 0.0 ? std::clamp(dot(d, e) / length2, 0.0, 1.0) : 0.0;
  const Vec2 off = d - part * e;
  return dot(off, off) <= spared->within_m * spared->within_m;
}

std::string_view to_string(Limit limit) noexcept {
  switch (limit) {
    case Limit::None:
      return "none";
    case Limit::Obstacle:
      return "obstacle";
    case Limit::Drop:
      return "drop";
    case Limit::Unseen:
      return "unseen";
  }
  return "none";
}

double part_for(double touch_s, const base::BodyTwist& twist,
                const ProtectParams& params) noexcept {
  const double b = std::max(0.5 * std::abs(twist.linear_mps) / params.decel_mps2,
                            0.5 * std::abs(twist.angular_radps) / params.turn_decel_radps2);
  const double delay = params.delay_s;
  if (touch_s <= 0.0) return 0.0;
  if (touch_s >= delay + b) return 1.0;
  // λ²b + λ·delay − t = 0, in the form that does not cancel and takes b = 0 as well.
  return std::clamp(2.0 * touch_s / (delay + std::sqrt(delay * delay + 4.0 * b * touch_s)), 0.0,
                    1.0);
}

Verdict protect(const Patch& patch, const Pose2& pose, const Footprint& body,
                const base::BodyTwist& twist, const ProtectParams& params, const Spared* spared,
                const Marks* marks) noexcept {
  Verdict verdict;
  if (std::abs(twist.linear_mps) < kStill_mps && std::abs(twist.angular_radps) < kStill_radps) {
    return verdict;
  }
  Drive d = drive_of(body, twist, params, patch.cell_m);
  const Picture seen{patch, marks != nullptr && marks->fit(patch) ? marks : nullptr};
  Nearest dock;
  const Nearest taken = nearest_taken(seen, pose, body, d, spared, dock);
  const double speed =
      std::max(std::abs(twist.linear_mps), std::abs(twist.angular_radps) * body.reach_m());
  if (taken.touch_s) {
    tell(verdict, taken, d);
    // The gap ahead is larger than that beside: the rest of it is way, at this speed.
    const double rest_s = std::max(0.0, params.gap_m - d.grown_m) / speed;
    verdict.part = part_for(*taken.touch_s - (d.turning ? 0.0 : rest_s), twist, params);
    if (verdict.part < 1.0) {
      verdict.limit = taken.cell.known == Known::Drop ? Limit::Drop : Limit::Obstacle;
    }
  }
  const double creeps = creep_part(d, params);
  Nearest unseen;
  if (creeps < 1.0 || spared != nullptr) {
    unseen = nearest_unseen(seen, pose, body, d, spared, dock);
  }
  if (unseen.touch_s) {
    const double part = std::max(part_for(*unseen.touch_s, twist, params), std::min(1.0, creeps));
    if (part < verdict.part) {
      verdict.part = part;
      verdict.limit = Limit::Unseen;
      tell(verdict, unseen, d);
    }
  }
  // The dock is come to so slowly that it may be touched.
  if (dock.touch_s && spared->most_mps < verdict.part * speed) {
    verdict.part = spared->most_mps / speed;
    verdict.limit = dock.cell.known == Known::Unknown ? Limit::Unseen : Limit::Obstacle;
    tell(verdict, dock, d);
  }
  return verdict;
}

}  // namespace roverd::nav::sense
