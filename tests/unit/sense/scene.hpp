#pragma once
// A world of boxes on a height field, and sensors that look at it: rays cast one by one, in the
// frames of base/sight.hpp, written apart from the sense chain.

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "base/angle.hpp"
#include "base/sight.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::sense {

inline base::Time at(double s) {
  return base::Time{} + base::from_seconds(s);
}

struct Block {  // upright, sides along the axes
  double x0, x1, y0, y1, z0, z1;
};

struct Scene {
  std::function<double(double, double)> ground = [](double, double) { return 0.0; };
  std::vector<Block> blocks;
  double noise_m = 0.0;  ///< of the ground's height, from ray to ray

  /// Metres along the unit direction to the first surface; infinity: none within 30 m.
  double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& d, std::mt19937& random) const {
    double best = std::numeric_limits<double>::infinity();
    for (const Block& b : blocks) best = std::min(best, to_block(b, from, d));
    double rough = 0.0;
    if (noise_m > 0.0) rough = std::uniform_real_distribution<>(-noise_m, noise_m)(random);
    const auto above = [&](double s) {
      const Eigen::Vector3d p = from + s * d;
      return p.z() - ground(p.x(), p.y()) - rough;
    };
    double before = 0.0;
    const double far = std::min(best, 30.0);
    for (double s = 0.05; s <= far + 0.05; s += 0.05) {
      if (above(s) < 0.0) {
        double low = before;
        double high = s;
        for (int i = 0; i < 20; ++i)
          (above(0.5 * (low + high)) < 0.0 ? high : low) = 0.5 * (low + high);
        return std::min(best, high);
      }
      before = s;
    }
    return best;
  }

  static double to_block(const Block& b, const Eigen::Vector3d& from, const Eigen::Vector3d& d) {
    const double low[] = {b.x0, b.y0, b.z0};
    const double high[] = {b.x1, b.y1, b.z1};
    double in = 0.0;
    double out = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      if (std::abs(d(i)) < 1e-12) {
        if (from(i) < low[i] || from(i) > high[i]) return std::numeric_limits<double>::infinity();
        continue;
      }
      const double t0 = (low[i] - from(i)) / d(i);
      const double t1 = (high[i] - from(i)) / d(i);
      in = std::max(in, std::min(t0, t1));
      out = std::min(out, std::max(t0, t1));
    }
    return in <= out && in > 0.0 ? in : std::numeric_limits<double>::infinity();
  }
};

/// Directions in S, one after the other, the last of them `lasts_s` after the first.
struct Rays {
  std::vector<Eigen::Vector3d> directions;
  double lasts_s = 0.0;
  float half_step_rad = 0.004F;
  std::vector<std::uint8_t> rings{};
};

inline Eigen::Vector3d towards(double bearing_rad, double up_rad) {
  return {std::cos(up_rad) * std::cos(bearing_rad), std::cos(up_rad) * std::sin(bearing_rad),
          std::sin(up_rad)};
}

/// 541 beams over 270 degrees at 50 Hz.
inline Rays planar() {
  Rays r;
  for (int i = 0; i < 541; ++i) {
    r.directions.push_back(towards(base::rad_from_deg(-135.0 + 0.5 * i), 0.0));
  }
  r.lasts_s = 0.015;
  r.half_step_rad = static_cast<float>(base::rad_from_deg(0.25));
  return r;
}

/// Sixteen rings from -15 to 15 degrees; the real one has 1800 steps.
inline Rays sixteen_rings(int steps = 900) {
  Rays r;
  for (int i = 0; i < steps; ++i) {
    for (int ring = 0; ring < 16; ++ring) {
      r.directions.push_back(
          towards(-2.0 * base::kPi * i / steps, base::rad_from_deg(2.0 * ring - 15.0)));
    }
  }
  r.lasts_s = 0.1;
  r.half_step_rad = static_cast<float>(base::kPi / steps);
  return r;
}

/// A depth camera: 86 by 57 degrees, every pixel at one time.
inline Rays camera(int across = 160, int up = 120) {
  Rays r;
  for (int v = 0; v < up; ++v) {
    for (int u = 0; u < across; ++u) {
      const double y = std::tan(base::rad_from_deg(43.0)) * (1.0 - 2.0 * (u + 0.5) / across);
      const double z = std::tan(base::rad_from_deg(28.5)) * (1.0 - 2.0 * (v + 0.5) / up);
      r.directions.push_back(Eigen::Vector3d(1.0, y, z).normalized());
    }
  }
  r.half_step_rad = static_cast<float>(base::rad_from_deg(43.0 / across));
  return r;
}

inline Eigen::Isometry3d placed(const base::Mount& m) {
  return Eigen::Translation3d(m.x_m, m.y_m, m.z_m) *
         Eigen::AngleAxisd(m.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(m.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(m.roll_rad, Eigen::Vector3d::UnitX());
}

/// What the rays see. The body stands on `where` at the time of each ray; z of B is the world's.
/// @param body (time in s) X_WB
inline base::Sight look(const Scene& scene, const Rays& rays, const base::Mount& mount,
                        double start_s, const std::function<Eigen::Isometry3d(double)>& body,
                        std::mt19937& random, double range_m = 30.0) {
  base::Sight sight;
  sight.sensor = "eye";
  sight.stamp = at(start_s);
  sight.half_step_rad = rays.half_step_rad;
  const Eigen::Isometry3d x_bs = placed(mount);
  const std::size_t n = rays.directions.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double after =
        n > 1 ? rays.lasts_s * static_cast<double>(i) / static_cast<double>(n - 1) : 0.0;
    const Eigen::Isometry3d x_ws = body(start_s + after) * x_bs;
    const double s = scene.cast(x_ws.translation(), x_ws.linear() * rays.directions[i], random);
    base::SightPoint p;
    p.after_s = static_cast<float>(after);
    p.echo = s <= range_m ? base::Echo::Hit : base::Echo::Unknown;
    const Eigen::Vector3d at_s = rays.directions[i] * (s <= range_m ? s : 1.0);
    p.x_m = static_cast<float>(at_s.x());
    p.y_m = static_cast<float>(at_s.y());
    p.z_m = static_cast<float>(at_s.z());
    sight.points.push_back(p);
  }
  return sight;
}

inline Eigen::Isometry3d planar_pose(const Pose2& p, double z_m = 0.0, double pitch_rad = 0.0) {
  return Eigen::Translation3d(p.x_m, p.y_m, z_m) *
         Eigen::AngleAxisd(p.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY());
}

/// A body that stands at a place.
inline auto standing(const Pose2& where = {}, double z_m = 0.0, double pitch_rad = 0.0) {
  return [=](double) { return planar_pose(where, z_m, pitch_rad); };
}

/// What the odometry told from 0 to `until_s`, every 20 ms. @param pose (time in s) X_OB.
/// @param lie (time in s) how the body lies; empty: nothing tells
inline PoseHistory driven(double until_s, const std::function<Pose2(double)>& pose,
                          const std::function<Lie3(double)>& lie = {}) {
  PoseHistory h;
  for (double t = std::max(0.0, until_s - 4.0); t < until_s + 0.021; t += 0.02)
    h.push({at(t), pose(t), 0.0, 0.0, lie ? lie(t) : Lie3{}});
  return h;
}

}  // namespace roverd::nav::sense
