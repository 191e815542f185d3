#pragma once
// A yard of straight walls and round posts, a scanner that looks at it, and a robot that obeys
// late: the truth for tests of what is seen and driven along.

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "nav/marks/scan.hpp"
#include "nav/marks/sight_drive.hpp"

namespace roverd::nav::marks {

struct Slab {
  Vec2 a{};
  Vec2 b{};
  bool black = false;  ///< it gives no echo
};
struct Pole {
  Vec2 at{};
  double radius_m = 0.1;
};

struct Yard {
  std::vector<Slab> slabs;
  std::vector<Pole> poles;

  /// Metres along a ray to the first thing; infinite: nothing, or what gives no echo.
  double cast(Vec2 from, double yaw_rad) const {
    const Vec2 d{std::cos(yaw_rad), std::sin(yaw_rad)};
    const double never = std::numeric_limits<double>::infinity();
    double best = never;
    bool black = false;
    for (const Slab& s : slabs) {
      const Vec2 e = s.b - s.a;
      const double det = sense::cross(d, e);
      if (std::abs(det) < 1e-12) continue;
      const double t = sense::cross(s.a - from, e) / det;
      const double u = sense::cross(s.a - from, d) / det;
      if (t <= 0.0 || u < 0.0 || u > 1.0 || t >= best) continue;
      best = t;
      black = s.black;
    }
    for (const Pole& p : poles) {
      const Vec2 to = p.at - from;
      const double along = sense::dot(to, d);
      const double off = sense::cross(d, to);
      if (along <= 0.0 || std::abs(off) >= p.radius_m) continue;
      const double far_m = along - std::sqrt(p.radius_m * p.radius_m - off * off);
      if (far_m >= best) continue;
      best = far_m;
      black = false;
    }
    return black ? never : best;
  }
  /// To the nearest wall.
  double wall_m(Vec2 p) const {
    double best = std::numeric_limits<double>::infinity();
    for (const Slab& s : slabs) {
      const Vec2 e = s.b - s.a;
      const double part = std::clamp(sense::dot(p - s.a, e) / sense::dot(e, e), 0.0, 1.0);
      const Vec2 off = p - (s.a + part * e);
      best = std::min(best, std::hypot(off.x, off.y));
    }
    return best;
  }
};

/// A scanner of 270 deg, half a degree a step, 30 m, eye_m ahead of the body's origin.
struct Scanner {
  double noise_m = 0.012;
  double lost_part = 0.01;
  double eye_m = 0.0;
  std::mt19937_64 random{7};

  base::Sight look(const Yard& yard, const Pose2& truth, base::Time stamp) {
    const Vec2 eye = placed(truth, {eye_m, 0.0});
    base::Sight sight;
    sight.stamp = stamp;
    std::normal_distribution<double> noise(0.0, noise_m);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (int i = -270; i <= 270; ++i) {
      const double yaw_rad = base::rad_from_deg(0.5 * i);
      const double true_m = yard.cast(eye, truth.yaw_rad + yaw_rad);
      const bool lost = !(true_m < 30.0) || chance(random) < lost_part;
      const double range_m = lost ? 1.0 : true_m + noise(random);
      base::SightPoint p;
      p.x_m = static_cast<float>(range_m * std::cos(yaw_rad));
      p.y_m = static_cast<float>(range_m * std::sin(yaw_rad));
      p.echo = lost ? base::Echo::Unknown : base::Echo::Hit;
      sight.points.push_back(p);
    }
    return sight;
  }
};

/// What is commanded happens `delay` ticks of 20 ms later; the odometry is a little wrong.
struct Rover {
  Pose2 truth;
  Pose2 odometry;
  double slip = 1.02;        ///< told over true travel
  double turn_scale = 1.01;  ///< told over true turning
  base::Time now{std::chrono::hours(1)};
  sense::PoseHistory history;
  double speed_mps = 0.0;
  double rate_radps = 0.0;
  std::deque<base::BodyTwist> pipe = std::deque<base::BodyTwist>(7);

  void step(const base::BodyTwist& command) {
    pipe.push_back(command);
    const base::BodyTwist t = pipe.front();
    pipe.pop_front();
    now += std::chrono::milliseconds(20);
    speed_mps = t.linear_mps;
    rate_radps = t.angular_radps;
    truth = truth * sense::along(speed_mps, rate_radps, 0.02);
    odometry = odometry * sense::along(speed_mps * slip, rate_radps * turn_scale, 0.02);
    history.push({now, odometry, speed_mps * slip, rate_radps * turn_scale});
  }
  /// In O, as the tracker wants it.
  Vehicle vehicle() const {
    Vehicle v;
    v.at = {odometry.x_m, odometry.y_m};
    v.yaw_rad = odometry.yaw_rad;
    v.speed_mps = speed_mps * slip;
    v.yaw_rate_radps = rate_radps * turn_scale;
    return v;
  }
};

inline PlanarScan scan_of(const base::Sight& sight, const Rover& rover, double eye_m = 0.0) {
  PlanarScan out;
  const base::Mount mount{eye_m, 0.0, 0.3, 0.0, 0.0, 0.0};
  const auto good = planar_of(sight, mount, rover.history, 8.0, 0.5, out);
  if (!good) out.beams.clear();
  return out;
}

}  // namespace roverd::nav::marks
