#pragma once
// Points and frames of the simulated world: metres, east north up (E) about the start. The sim has
// its own: what it shared with the navigation could be wrong in both and cancel.

#include <cmath>

namespace roverd::sim::world {

struct Vec2 {
  double x = 0.0;  ///< east
  double y = 0.0;  ///< north
  friend bool operator==(const Vec2&, const Vec2&) = default;
};
inline Vec2 operator+(Vec2 a, Vec2 b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(Vec2 a, Vec2 b) noexcept {
  return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator*(double k, Vec2 a) noexcept {
  return {k * a.x, k * a.y};
}
inline double dot(Vec2 a, Vec2 b) noexcept {
  return a.x * b.x + a.y * b.y;
}
inline double cross(Vec2 a, Vec2 b) noexcept {
  return a.x * b.y - a.y * b.x;
}
inline double length(Vec2 a) noexcept {
  return std::hypot(a.x, a.y);
}

struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;  ///< up
};
inline Vec3 operator+(Vec3 a, Vec3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator*(double k, Vec3 a) noexcept {
  return {k * a.x, k * a.y, k * a.z};
}
inline double dot(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Where a body stands and how it is turned: first rolled, then pitched, then yawed, right-handed
/// about forward, left, up (FLU). So nose *down* and left side *up* are positive.
struct Pose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// X_EB: turns and moves what is expressed in the inner frame (B) to the outer one (E).
struct Frame {
  double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 p;

  Frame() = default;
  /// R = Rz(yaw) Ry(pitch) Rx(roll).
  explicit Frame(const Pose& at) noexcept : p{at.x_m, at.y_m, at.z_m} {
    const double cr = std::cos(at.roll_rad);
    const double sr = std::sin(at.roll_rad);
    const double cp = std::cos(at.pitch_rad);
    const double sp = std::sin(at.pitch_rad);
    const double cy = std::cos(at.yaw_rad);
    const double sy = std::sin(at.yaw_rad);
    const double turned[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                                 {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                                 {-sp, cp * sr, cp * cr}};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) r[i][k] = turned[i][k];
    }
  }
  Vec3 turn(Vec3 v) const noexcept {
    return {r[0][0] * v.x + r[0][1] * v.y + r[0][2] * v.z,
            r[1][0] * v.x + r[1][1] * v.y + r[1][2] * v.z,
            r[2][0] * v.x + r[2][1] * v.y + r[2][2] * v.z};
  }
  Vec3 operator*(Vec3 v) const noexcept { return turn(v) + p; }
  Frame operator*(const Frame& inner) const noexcept {
    Frame out;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        out.r[i][k] = r[i][0] * inner.r[0][k] + r[i][1] * inner.r[1][k] + r[i][2] * inner.r[2][k];
      }
    }
    out.p = *this * inner.p;
    return out;
  }
};

}  // namespace roverd::sim::world
