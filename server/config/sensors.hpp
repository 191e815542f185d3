#pragma once
// What looks around: sections [sensors.NAME], as many as the robot has (16 at most).
//
//   [sensors.front]
//   kind = "velodyne"           # which driver; its parameters stand in the same section
//   link = "udp:2368"
//   x_m = 0.35                  # how it stands on the body: base/sight.hpp, Mount
//   z_m = 0.60
//   pitch_deg = 5.0
//
// Mount angles: yaw left positive, pitch nose down positive, roll left side up positive.

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "cloud/params.hpp"
#include "nav/sense/params.hpp"
#include "nav/tags/params.hpp"
#include "ranges/params.hpp"
#include "robot/guard/outline.hpp"
#include "sick/params.hpp"
#include "v4l2/params.hpp"
#include "velodyne/params.hpp"
#include "vision/params.hpp"

namespace roverd {

struct SensorSettings {
  bool enabled = true;
  std::string kind;
  std::string link;
  bool required = true;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.5;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  double rate_hz = 10.0;

  base::Mount mount() const noexcept;
  /// It sees one plane only.
  bool planar() const noexcept { return kind == "sick" || kind == "ranges"; }
  /// And in it thin beams: what it met lies where it says. A cone's echo may lie anywhere across
  /// it.
  bool thin() const noexcept { return kind == "sick"; }
  /// It is part of the picture of what is free and what is not. What a vision program recognised
  /// tells of neither.
  bool ranging() const noexcept { return kind != "vision"; }
  /// Of "listen:PORT"; 0: it says something else.
  int listens() const noexcept;
};

template <class V>
void fields(V& v, SensorSettings& p) {
  v("enabled", p.enabled, "false: it is not there");
  v("kind", p.kind, "which driver hears it: cloud, depth, ranges, sick, velodyne or vision");
  v("link", p.link,
    "velodyne, vision: udp:PORT, udp:PORT:HOST:PORT; sick: tcp:HOST:PORT; ranges: "
    "serial:DEVICE:BAUD|auto; "
    "cloud: "
    "tcp:HOST:PORT, or listen:PORT, where the camera's program on this computer comes to that "
    "port; "
    "depth: v4l2:/dev/videoN; any: replay:FILE");
  v("required", p.required,
    base::higher_is_stricter(
        "nothing drives by itself while it is silent, dirty or blinded; not of the kind vision"));
  v("x_m", p.x_m, -5.0, 5.0, "ahead of the vehicle's origin");
  v("y_m", p.y_m, -5.0, 5.0, "left of it");
  v("z_m", p.z_m, 0.02, 5.0, "above the ground");
  v("roll_deg", p.roll_deg, -180.0, 180.0, "left side up positive");
  v("pitch_deg", p.pitch_deg, -180.0, 180.0, "nose down positive");
  v("yaw_deg", p.yaw_deg, -180.0, 180.0, "to the left positive");
  v("rate_hz", p.rate_hz, 0.5, 200.0, "pieces a second that it should give");
}

/// One of them, with the parameters of every kind; those of its own count.
struct Sensor {
  SensorSettings said;
  cloud::Params cloud;
  v4l2::Params depth;  ///< what hears its images is the cloud driver, with its own
  ranges::Params ranges;
  sick::Params sick;
  velodyne::Params velodyne;
  vision::Params vision;
  bool recorded = false;  ///< no setting: it is a recording that is heard
};

/// The cloud driver's parameters for a camera of kind cloud or depth.
cloud::Params as_heard(const Sensor& sensor);

/// How what they see is made one picture. Sections [sense], [sense.ground], … What the guard makes
/// of it stands in robot::Config.
struct SenseSettings {
  nav::sense::ReduceParams reduce;
  nav::sense::GroundParams ground;
  nav::sense::PersistParams persist;
  nav::sense::GridParams grid;
  nav::sense::HealthParams health;
  nav::tags::TagParams tags;
  robot::OutlineParams outline;  ///< further keys of [nav.tool]
};

template <class V>
void sections(V& v, SenseSettings& s) {
  v("sense", s.reduce);
  v("sense.ground", s.ground);
  v("sense.persist", s.persist);
  v("sense.grid", s.grid);
  v("sense.health", s.health);
  v("nav.tags", s.tags);
}

using Sensors = std::map<std::string, Sensor>;

inline constexpr std::size_t kMostSensors = 16;

/// The parameters of its kind, as sections are read: v(params), once for each struct that they
/// stand in. Nothing for an unknown kind.
template <class S, class V>
void with_kind(S& s, V&& v) {
  if (s.said.kind == "cloud" || s.said.kind == "depth") v(s.cloud);
  if (s.said.kind == "depth") v(s.depth);
  if (s.said.kind == "ranges") v(s.ranges);
  if (s.said.kind == "sick") v(s.sick);
  if (s.said.kind == "velodyne") v(s.velodyne);
  if (s.said.kind == "vision") v(s.vision);
}

/// "sensors.front.link" is of "front" in the group "sensors"; empty: it is no key of that group.
std::string_view part_of(std::string_view key, std::string_view group) noexcept;
/// Drivers, sensors and cameras stand in one list.
bool is_driver_name(std::string_view name) noexcept;
/// A name that a section may have: a to z, 0 to 9 and _, 24 signs at most.
bool is_sensor_name(std::string_view name) noexcept;

/// Words; the field is the key.
base::Result<void> check(const SenseSettings& sense);
/// What listens or opens something at this computer, for the question whether two meet there.
struct Ear {
  std::string key;  ///< "drivers.gnss.link"
  std::string link;
};

/// What only the whole tells: kinds and links that do not fit, ranges that contradict each other,
/// two that hear one port or open one device. Invalid; the field is the key ("sensors.front.kind").
/// @param drivers the enabled ones.
base::Result<void> check(const Sensors& sensors, const std::vector<Ear>& drivers = {});

}  // namespace roverd
