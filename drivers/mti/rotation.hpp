#pragma once
// The little of rotations that an inertial unit needs. R_AB turns a vector from B's axes into A's;
// adjacent letters cancel: R_AC = R_AB · R_BC.
//
//   S sensor   B body FLU   L the unit's local frame (ENU, NED or NWU)   E ENU   H level, body's
//   yaw

#include <array>
#include <cmath>
#include <cstddef>

#include "mti/data2.hpp"

namespace roverd::mti {

using Vec3 = std::array<double, 3>;

struct Mat3 {
  std::array<Vec3, 3> row{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

  Vec3 operator*(const Vec3& v) const noexcept {
    Vec3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = row[i][0] * v[0] + row[i][1] * v[1] + row[i][2] * v[2];
    }
    return out;
  }
  Mat3 operator*(const Mat3& m) const noexcept {
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        out.row[i][j] = row[i][0] * m.row[0][j] + row[i][1] * m.row[1][j] + row[i][2] * m.row[2][j];
      }
    }
    return out;
  }
  Mat3 transposed() const noexcept {
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) out.row[i][j] = row[j][i];
    }
    return out;
  }
};

// Right-handed about one axis, rad.
inline Mat3 about_x(double a) noexcept {
  const double c = std::cos(a);
  const double s = std::sin(a);
  return {{Vec3{1, 0, 0}, Vec3{0, c, -s}, Vec3{0, s, c}}};
}
inline Mat3 about_y(double a) noexcept {
  const double c = std::cos(a);
  const double s = std::sin(a);
  return {{Vec3{c, 0, s}, Vec3{0, 1, 0}, Vec3{-s, 0, c}}};
}
inline Mat3 about_z(double a) noexcept {
  const double c = std::cos(a);
  const double s = std::sin(a);
  return {{Vec3{c, -s, 0}, Vec3{s, c, 0}, Vec3{0, 0, 1}}};
}

/// R_HB of a body that leans. @param roll_rad right side down positive. @param pitch_rad nose up
/// positive (right-handed about the left axis would be nose down).
inline Mat3 leaning(double roll_rad, double pitch_rad) noexcept {
  return about_y(-pitch_rad) * about_x(roll_rad);
}

/// R_LS of the Euler angles that the unit tells, rad: first roll about x, then pitch, then yaw.
inline Mat3 from_euler(double roll_rad, double pitch_rad, double yaw_rad) noexcept {
  return about_z(yaw_rad) * about_y(pitch_rad) * about_x(roll_rad);
}

/// @param q w x y z, of length one.
inline Mat3 from_quaternion(const std::array<double, 4>& q) noexcept {
  const auto [w, x, y, z] = q;
  return {{Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           Vec3{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           Vec3{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/// w x y z with w >= 0. Source: Shepperd 1978, the largest of the four first.
inline std::array<double, 4> to_quaternion(const Mat3& m) noexcept {
  const double xx = m.row[0][0];
  const double yy = m.row[1][1];
  const double zz = m.row[2][2];
  const std::array<double, 4> square{1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz,
                                     1 - xx - yy + zz};
  std::size_t most = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (square[i] > square[most]) most = i;
  }
  const double a = std::sqrt(square[most]) / 2.0;
  const double b = 0.25 / a;
  const double wx = (m.row[2][1] - m.row[1][2]) * b;
  const double wy = (m.row[0][2] - m.row[2][0]) * b;
  const double wz = (m.row[1][0] - m.row[0][1]) * b;
  const double xy = (m.row[0][1] + m.row[1][0]) * b;
  const double xz = (m.row[0][2] + m.row[2][0]) * b;
  const double yz = (m.row[1][2] + m.row[2][1]) * b;
  std::array<double, 4> q{};
  if (most == 0) q = {a, wx, wy, wz};
  if (most == 1) q = {wx, a, xy, xz};
  if (most == 2) q = {wy, xy, a, yz};
  if (most == 3) q = {wz, xz, yz, a};
  if (q[0] < 0.0) {
    for (double& v : q) v = -v;
  }
  return q;
}

/// R_EL: the unit's local frame into ENU. @param axes not Unknown.
inline Mat3 to_enu(Axes axes) noexcept {
  switch (axes) {
    case Axes::Ned:
      return {{Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}}};
    case Axes::Nwu:
      return {{Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}};
    case Axes::Enu:
    case Axes::Unknown:
      break;
  }
  return {};
}

inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace roverd::mti
