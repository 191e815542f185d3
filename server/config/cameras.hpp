#pragma once
// Cameras of pictures: sections [cameras.NAME], as many as the robot has (8 at most).
//
//   [cameras.front]
//   link = "http://USER:PASSWORD@192.168.0.20/video.mjpg"   # or "v4l2:/dev/video0"
//   x_m = 0.40                  # how it stands on the body, as of [sensors.NAME]
//   z_m = 0.60
//   pitch_deg = 10.0
//   fov_deg = 70.0              # or fx, fy, cx, cy for width, height: camera/params.hpp

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.hpp"
#include "base/sight.hpp"
#include "camera/params.hpp"
#include "config/sensors.hpp"

namespace roverd {

struct CameraSettings {
  bool enabled = true;
  std::string link;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.5;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  bool tags = false;
  double latency_s = 0.0;

  base::Mount mount() const noexcept;
};

template <class V>
void fields(V& v, CameraSettings& p) {
  v("enabled", p.enabled, "false: it is not there");
  v("link", p.link,
    "http://USER:PASSWORD@HOST:PORT/PATH or https:, a stream of JPEG pictures or a single one; or "
    "v4l2:/dev/videoN");
  v("x_m", p.x_m, -5.0, 5.0, "ahead of the vehicle's origin");
  v("y_m", p.y_m, -5.0, 5.0, "left of it");
  v("z_m", p.z_m, 0.02, 5.0, "above the ground");
  v("roll_deg", p.roll_deg, -180.0, 180.0, "left side up positive");
  v("pitch_deg", p.pitch_deg, -180.0, 180.0, "nose down positive");
  v("yaw_deg", p.yaw_deg, -180.0, 180.0, "to the left positive");
  v("tags", p.tags, "tags are looked for in its pictures ([nav.tags]); needs its lens");
  v("latency_s", p.latency_s, 0.0, 2.0,
    "from the moment that a picture shows to its first byte here; by so much tags are seen late");
}

struct CameraSetup {
  CameraSettings said;
  camera::Params params;
};

using Cameras = std::map<std::string, CameraSetup>;

inline constexpr std::size_t kMostCameras = 8;

/// Does one of them read tags?
bool read_tags(const Cameras& cameras) noexcept;

/// What only the whole tells: links that are none, names that a sensor or driver has, two that open
/// one device. Invalid; the field is the key ("cameras.front.link").
base::Result<void> check(const Cameras& cameras, const Sensors& sensors);

}  // namespace roverd
