#include "config/cameras.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/angle.hpp"
#include "camera/source.hpp"
#include "v4l2/camera.hpp"

namespace roverd {
namespace {

base::Result<void> refuse_camera(const std::string& name, const std::string& member,
                                 std::string detail) {
  const std::string key = "cameras." + name + "." + member;
  std::string whole = key + " " + detail;
  return base::fail(base::Code::Invalid, std::move(whole), {{key, std::move(detail)}});
}

std::string same_device(const std::string& path) {
  std::error_code ec;
  const auto real = std::filesystem::canonical(path, ec);  // by-id and video0 may be one
  return ec ? path : real.string();
}

base::Result<void> check_camera(const std::string& name, const CameraSetup& camera) {
  if (is_driver_name(name)) return refuse_camera(name, "link", "is of a name that a driver has");
  if (auto good = validate(camera.params); !good) {
    const auto& field = good.error().fields.at(0);
    return refuse_camera(name, field.pointer, field.detail);
  }
  const std::string& link = camera.said.link;
  if (!camera.said.enabled) return {};
  if (camera.said.tags && camera.params.fx <= 0.0 && camera.params.fov_deg <= 0.0) {
    return refuse_camera(name, "tags", "needs the lens: fx and fy, or fov_deg");
  }
  if (link.empty()) return refuse_camera(name, "link", "must say where the camera is");
  if (link.starts_with("v4l2:")) {
    if (v4l2::path_of(link).starts_with('/')) return {};
    return refuse_camera(name, "link", "must name a device: v4l2:/dev/videoN");
  }
  // What is wrong is told without the address, which may hold a login.
  if (auto source = camera::parse_source(link); !source) {
    return refuse_camera(name, "link", "(or v4l2:/dev/videoN): " + source.error().detail);
  }
  return {};
}

}  // namespace

base::Mount CameraSettings::mount() const noexcept {
  return {x_m,
          y_m,
          z_m,
          base::rad_from_deg(roll_deg),
          base::rad_from_deg(pitch_deg),
          base::rad_from_deg(yaw_deg)};
}

bool read_tags(const Cameras& cameras) noexcept {
  return std::ranges::any_of(
      cameras, [](const auto& one) { return one.second.said.enabled && one.second.said.tags; });
}

base::Result<void> check(const Cameras& cameras, const Sensors& sensors) {
  std::map<std::string, std::string> taken;  // device to the key that has it
  for (const auto& [name, sensor] : sensors) {
    const std::string path = v4l2::path_of(sensor.said.link);
    if (sensor.said.enabled && !path.empty()) taken[same_device(path)] = "sensors." + name;
  }
  for (const auto& [name, camera] : cameras) {
    if (auto good = check_camera(name, camera); !good) return good;
    if (sensors.contains(name)) {
      return refuse_camera(name, "link", "is of a name that a sensor has");
    }
    const std::string path = v4l2::path_of(camera.said.link);
    if (!camera.said.enabled || path.empty()) continue;
    const auto [other, is_new] = taken.emplace(same_device(path), "cameras." + name);
    if (!is_new) {
      return refuse_camera(name, "link",
                           "takes " + other->first + ", which " + other->second + " has, too");
    }
  }
  return {};
}

}  // namespace roverd
