#pragma once
// A patch of ground to plan in, and a judge of ways that shares nothing with the planner.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "nav/around/around.hpp"

namespace roverd::nav::around::tests {

using sense::Footprint;
using sense::Known;
using sense::Patch;
using sense::Pose2;

/// 20 x 20 m at 5 cm about the origin.
struct Scene {
  Patch patch;

  explicit Scene(Known all = Known::Free, double cell_m = 0.05, double reach_m = 10.0) {
    const auto reach = static_cast<std::int32_t>(std::lround(reach_m / cell_m));
    patch.cell_m = cell_m;
    patch.x0 = patch.y0 = -reach;
    patch.side = 2 * reach;
    const auto n = static_cast<std::size_t>(patch.side);
    patch.cells.assign(n * n, {all, 0, 0});
  }
  void set(std::int32_t ix, std::int32_t iy, Known k) {
    if (ix < patch.x0 || iy < patch.y0 || ix >= patch.x0 + patch.side ||
        iy >= patch.y0 + patch.side) {
      return;
    }
    const auto n = static_cast<std::size_t>(patch.side);
    patch
        .cells[static_cast<std::size_t>(iy - patch.y0) * n +
               static_cast<std::size_t>(ix - patch.x0)]
        .known = k;
  }
  std::int32_t cell(double v) const {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m + 1e-9));
  }
  void box(double x0, double y0, double x1, double y1, Known k = Known::Occupied) {
    for (std::int32_t y = cell(y0); y < cell(y1) + (y1 > y0 ? 0 : 1); ++y) {
      for (std::int32_t x = cell(x0); x < cell(x1) + (x1 > x0 ? 0 : 1); ++x) set(x, y, k);
    }
  }
  void pole(double x, double y, double radius, Known k = Known::Occupied) {
    for (std::int32_t iy = cell(y - radius); iy <= cell(y + radius); ++iy) {
      for (std::int32_t ix = cell(x - radius); ix <= cell(x + radius); ++ix) {
        const double dx = (ix + 0.5) * patch.cell_m - x;
        const double dy = (iy + 0.5) * patch.cell_m - y;
        if (dx * dx + dy * dy <= radius * radius) set(ix, iy, k);
      }
    }
  }
};

inline double segment_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 e = b - a;
  const double t = std::clamp(dot(p - a, e) / std::max(1e-12, dot(e, e)), 0.0, 1.0);
  const Vec2 d = p - a - t * e;
  return std::hypot(d.x, d.y);
}

/// The body to a cell's square; 0 where they meet. Exact for convex shapes of which one is small.
inline double to_square(const Footprint& body, const Pose2& pose, double x, double y, double side) {
  const Pose2 bo = sense::inverse(pose);
  double least = 1e9;
  for (const Vec2 k :
       {Vec2{x, y}, Vec2{x + side, y}, Vec2{x, y + side}, Vec2{x + side, y + side}}) {
    const Pose2 in = bo * Pose2{k.x, k.y, 0.0};
    least = std::min(least, body.distance_m({in.x_m, in.y_m}));
  }
  for (const Vec2 c : body.corners()) {
    const Pose2 o = pose * Pose2{c.x, c.y, 0.0};
    const double dx = std::max({x - o.x_m, 0.0, o.x_m - x - side});
    const double dy = std::max({y - o.y_m, 0.0, o.y_m - y - side});
    least = std::min(least, std::hypot(dx, dy));
  }
  return std::max(0.0, least);
}

inline double clearance_of(const Patch& patch, const Footprint& body, const Pose2& pose,
                           double look = 0.4) {
  const double reach = body.reach_m() + look;
  const auto cell = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m));
  };
  double least = look;
  for (std::int32_t y = cell(pose.y_m - reach); y <= cell(pose.y_m + reach); ++y) {
    for (std::int32_t x = cell(pose.x_m - reach); x <= cell(pose.x_m + reach); ++x) {
      const Known k = patch.at(x, y).known;
      if (k != Known::Occupied && k != Known::Drop) continue;
      least =
          std::min(least, to_square(body, pose, x * patch.cell_m, y * patch.cell_m, patch.cell_m));
    }
  }
  return least;
}

/// Poses every 2 cm (or 1°) along an answer, by the arcs that it tells.
inline std::vector<Pose2> swept(const std::vector<Place>& path) {
  std::vector<Pose2> out;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Pose2& a = path[i - 1].pose;
    const Pose2& b = path[i].pose;
    const double turn = base::angle_diff_rad(a.yaw_rad, b.yaw_rad);
    const double way = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const int n = 1 + static_cast<int>(std::max(way / 0.02, std::abs(turn) / 0.0175));
    for (int k = 0; k < n; ++k) {
      const double t = static_cast<double>(k) / n;
      // Between two places 10 cm apart a chord differs from the arc by a millimetre.
      out.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m),
                     base::wrap_rad(a.yaw_rad + t * turn)});
    }
  }
  if (!path.empty()) out.push_back(path.back().pose);
  return out;
}

inline bool inside(const Ring& ring, Vec2 p) {
  double turns = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - p;
    const Vec2 b = ring[(i + 1) % ring.size()] - p;
    turns += std::atan2(cross(a, b), dot(a, b));
  }
  return std::abs(turns) > 3.0;
}

/// Room of a point to a fence, negative outside.
inline double fence_room(const Question& q, Vec2 p) {
  const auto edge = [p](const Ring& r) {
    double least = 1e9;
    for (std::size_t i = 0; i < r.size(); ++i) {
      least = std::min(least, segment_distance(p, r[i], r[(i + 1) % r.size()]));
    }
    return least;
  };
  double room = q.keep_in.empty() ? 1e9 : -1e9;
  for (const Ring& r : q.keep_in) room = std::max(room, inside(r, p) ? edge(r) : -edge(r));
  for (const Ring& r : q.keep_out) room = std::min(room, inside(r, p) ? -edge(r) : edge(r));
  return room;
}

/// The first thing that is wrong with an answer; empty: nothing. @param start_m nearer to the
/// question's pose than this, the body may be as near to things as it is there
inline std::string objection(const Patch& patch, const Question& q, const Answer& a,
                             double start_m = 0.0) {
  const auto at = [](const char* what, const Pose2& p, double v) {
    return std::string(what) + " at " + std::to_string(p.x_m) + ", " + std::to_string(p.y_m) +
           ": " + std::to_string(v);
  };
  if (a.found != Found::Way && a.found != Found::Part) {
    return a.path.empty() ? "" : "a path without a way";
  }
  if (a.path.size() < 2) return "no path";
  const Pose2& first = a.path.front().pose;
  if (std::hypot(first.x_m - q.pose.x_m, first.y_m - q.pose.y_m) > 1e-6) return "begins elsewhere";
  const double at_start = clearance_of(patch, q.body, q.pose);
  for (const Pose2& p : swept(a.path)) {
    const bool near = std::hypot(p.x_m - q.pose.x_m, p.y_m - q.pose.y_m) < start_m;
    const double least = near ? std::min(q.least_m, at_start - 0.01) : q.least_m;
    const double clear = clearance_of(patch, q.body, p);
    if (clear < least - 0.002 || clear <= 0.0) return at("too near", p, clear);
    for (const Vec2 corner : q.body.corners()) {
      const Pose2 c = p * Pose2{corner.x, corner.y, 0.0};
      double off = 1e9;
      bool left = true;
      for (std::size_t i = 0; i + 1 < q.route.size(); ++i) {
        const double d = segment_distance({c.x_m, c.y_m}, q.route[i], q.route[i + 1]);
        if (d < off) {
          off = d;
          left = cross(q.route[i + 1] - q.route[i], Vec2{c.x_m, c.y_m} - q.route[i]) > 0.0;
        }
      }
      if (off > (left ? q.left_m : q.right_m) + 0.01) return at("outside of the corridor", p, off);
      const double room = fence_room(q, {c.x_m, c.y_m});
      if (room < q.fence_margin_m - 0.02) return at("outside of the fence", p, room);
    }
  }
  double length = 0.0;
  for (std::size_t i = 1; i < a.path.size(); ++i) {
    const Pose2& f = a.path[i - 1].pose;
    const Place& t = a.path[i];
    const double way = std::hypot(t.pose.x_m - f.x_m, t.pose.y_m - f.y_m);
    const double turn = base::angle_diff_rad(f.yaw_rad, t.pose.yaw_rad);
    length += way;
    if (way > 0.1) return at("a step too long", f, way);
    if (std::abs(turn) > 0.09) return at("a turn too wide", f, turn);
    if (t.reverse && !q.kinematics.may_reverse) return at("backwards", f, way);
    if (t.pivot) {
      if (!q.kinematics.pivots) return at("turns on the spot", f, turn);
      if (way > 1e-6) return at("a pivot that moves", f, way);
      continue;
    }
    if (way < 1e-6) continue;
    const double heading = std::atan2(t.pose.y_m - f.y_m, t.pose.x_m - f.x_m);
    const double middle = f.yaw_rad + 0.5 * turn + (t.reverse ? base::kPi : 0.0);
    if (std::abs(base::angle_diff_rad(middle, heading)) > 0.02) return at("sideways", f, heading);
    const double bend = std::abs(turn) / way;
    if (q.kinematics.min_radius_m > 0.0 && bend > 1.0 / q.kinematics.min_radius_m + 1e-3) {
      return at("a bend too narrow", f, bend);
    }
  }
  if (std::abs(length - a.length_m) > 1e-3) return "length " + std::to_string(length);
  if (a.found == Found::Part) return "";
  const Pose2& last = a.path.back().pose;
  double off = 1e9;
  double heading = 0.0;
  for (std::size_t i = 0; i + 1 < q.route.size(); ++i) {
    const double d = segment_distance({last.x_m, last.y_m}, q.route[i], q.route[i + 1]);
    if (d >= off) continue;
    off = d;
    const Vec2 e = q.route[i + 1] - q.route[i];
    heading = std::atan2(e.y, e.x);
  }
  if (off > 0.02) return at("ends beside the route", last, off);
  if (std::abs(base::angle_diff_rad(heading, last.yaw_rad)) > base::rad_from_deg(10.0)) {
    return at("ends askew", last, last.yaw_rad);
  }
  return "";
}

/// Along x, the robot at the origin.
inline Question along_x(double half_m = 5.0) {
  Question q;
  q.route = {{-2.0, 0.0}, {30.0, 0.0}};
  q.here_m = 2.0;
  q.left_m = q.right_m = half_m;
  return q;
}

}  // namespace roverd::nav::around::tests
