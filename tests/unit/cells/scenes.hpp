#pragma once
// Places made of planes, sampled at random with the noise of a scanner.

#include <random>

#include <Eigen/Geometry>

#include "nav/cells/align.hpp"

namespace roverd::nav::cells {

class Scene {
 public:
  explicit Scene(unsigned seed) : random_(seed) {}
  /// A parallelogram from `at` along u and v, with so many points a square metre.
  Scene& plane(const Eigen::Vector3d& at, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
               double density = 100.0) {
    const auto count = static_cast<std::size_t>(u.cross(v).norm() * density);
    const Eigen::Vector3d normal = u.cross(v).normalized();
    std::uniform_real_distribution<double> part;
    std::normal_distribution<double> noise(0.0, 0.01);
    for (std::size_t i = 0; i < count; ++i) {
      const double a = part(random_);
      const double b = part(random_);
      const double off = noise(random_);
      cloud_.push_back((at + a * u + b * v + off * normal).cast<float>());
    }
    return *this;
  }
  Scene& box(const Eigen::Vector3d& corner, const Eigen::Vector3d& size) {
    const Eigen::Vector3d x(size.x(), 0, 0);
    const Eigen::Vector3d y(0, size.y(), 0);
    const Eigen::Vector3d z(0, 0, size.z());
    return plane(corner, x, z).plane(corner, y, z).plane(corner + y, x, z).plane(corner + x, y, z);
  }
  const Cloud& cloud() const { return cloud_; }
  /// As seen from another place: X_TS takes what is returned back to where it was.
  Cloud seen_from(const Eigen::Isometry3d& x_ts) const {
    Cloud out;
    const Eigen::Isometry3f x = x_ts.inverse().cast<float>();
    for (const auto& p : cloud_) out.push_back(x * p);
    return out;
  }

 private:
  std::mt19937 random_;
  Cloud cloud_;
};

/// A yard of 20 x 14 m with a house corner, crates and a post.
inline Scene yard(unsigned seed) {
  Scene s(seed);
  s.plane({-10, -7, 0}, {20, 0, 0}, {0, 14, 0}, 30.0);
  s.plane({-10, -7, 0}, {20, 0, 0}, {0, 0, 3}).plane({-10, -7, 0}, {0, 14, 0}, {0, 0, 3});
  s.plane({10, -7, 0}, {0, 6, 0}, {0, 0, 3}).plane({10, -1, 0}, {-3, 2, 0}, {0, 0, 3});
  s.box({2, 2, 0}, {1.2, 0.8, 1})
      .box({-5, 3, 0}, {0.8, 2.0, 1.5})
      .box({-3, -4, 0}, {0.4, 0.4, 2.5});
  return s;
}

inline Relief relief_of(const Cloud& cloud, double cell_m = 0.2) {
  CellMap map(cell_m);
  map.add(cloud);
  return Relief(map);
}

inline Eigen::Isometry3d pose(double x_m, double y_m, double z_m, double turn_rad,
                              const Eigen::Vector3d& about = Eigen::Vector3d::UnitZ()) {
  Eigen::Isometry3d x = Eigen::Isometry3d::Identity();
  x.linear() = Eigen::AngleAxisd(turn_rad, about.normalized()).toRotationMatrix();
  x.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return x;
}

struct Off {
  double m = 0.0;
  double deg = 0.0;
};
inline Off off(const Eigen::Isometry3d& is, const Eigen::Isometry3d& should) {
  return {(is.translation() - should.translation()).norm(),
          Eigen::AngleAxisd(should.linear().transpose() * is.linear()).angle() * 57.29577951};
}

/// Length up to `m`, angle up to `deg`, about any axis.
inline Eigen::Isometry3d random_offset(std::mt19937& random, double m, double deg) {
  std::normal_distribution<double> axis;
  std::uniform_real_distribution<double> part;
  const Eigen::Vector3d to =
      Eigen::Vector3d(axis(random), axis(random), axis(random)).normalized() * part(random) * m;
  const double a = part(random) * deg / 57.29577951;
  const Eigen::Vector3d about(axis(random), axis(random), axis(random));
  return pose(to.x(), to.y(), to.z(), a, about);
}

}  // namespace roverd::nav::cells
