#include "nav/sense/mount.hpp"

#include <cmath>
#include <string>

#include "base/angle.hpp"

namespace roverd::nav::sense {

Eigen::Matrix3d rotation(const base::Mount& mount) noexcept {
  const double cr = std::cos(mount.roll_rad);
  const double sr = std::sin(mount.roll_rad);
  const double cp = std::cos(mount.pitch_rad);
  const double sp = std::sin(mount.pitch_rad);
  const double cy = std::cos(mount.yaw_rad);
  const double sy = std::sin(mount.yaw_rad);
  Eigen::Matrix3d r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return r;
}

base::Result<void> check_mount(const base::Mount& mount) {
  constexpr double kFar_m = 5.0;
  constexpr double kLow_m = 0.02;
  std::vector<base::FieldError> wrong;
  const auto look = [&wrong](const char* name, double value, double low, double high,
                             const char* says) {
    if (!(value >= low && value <= high)) wrong.push_back({std::string("/") + name, says});
  };
  look("x_m", mount.x_m, -kFar_m, kFar_m, "must lie within 5 m of the body's origin");
  look("y_m", mount.y_m, -kFar_m, kFar_m, "must lie within 5 m of the body's origin");
  look("z_m", mount.z_m, kLow_m, kFar_m,
       "must lie between 0.02 and 5 m above the ground: lower, the sensor stands in it");
  const double turn = 2.0 * base::kPi;
  look("roll_rad", mount.roll_rad, -turn, turn, "must lie within a full turn");
  look("pitch_rad", mount.pitch_rad, -turn, turn, "must lie within a full turn");
  look("yaw_rad", mount.yaw_rad, -turn, turn, "must lie within a full turn");
  if (wrong.empty()) return {};
  std::string detail =
      "a sensor cannot stand so: " + wrong.front().pointer.substr(1) + " " + wrong.front().detail;
  return base::fail(base::Code::Invalid, std::move(detail), std::move(wrong));
}

}  // namespace roverd::nav::sense
