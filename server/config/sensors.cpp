#include "config/sensors.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/angle.hpp"

namespace roverd {
namespace {

base::Result<void> refuse(const std::string& name, const std::string& member, std::string detail) {
  const std::string key = "sensors." + name + "." + member;
  std::string whole = key + " " + detail;
  return base::fail(base::Code::Invalid, std::move(whole), {{key, std::move(detail)}});
}

/// They stand in one list with the drivers.
bool is_driver(const std::string& name) noexcept {
  constexpr std::array<std::string_view, 9> kDrivers{
      "bunker", "ackermann", "ratio", "twist", "bumper", "gnss", "mti", "ntrip", "gpsd"};
  return std::ranges::find(kDrivers, name) != kDrivers.end();
}

base::Result<void> check_one(const std::string& name, const Sensor& sensor) {
  if (is_driver(name)) return refuse(name, "kind", "is of a name that a driver has");
  bool known = false;
  base::Result<void> good;
  with_kind(sensor, [&](const auto& params) {
    known = true;
    good = validate(params);
  });
  if (!known) {
    return refuse(name, "kind",
                  "must be cloud, ranges, sick or velodyne, is \"" + sensor.said.kind + "\"");
  }
  if (!good) {
    const auto& fields = good.error().fields;
    return refuse(name, fields.empty() ? "kind" : fields[0].pointer,
                  fields.empty() ? good.error().detail : fields[0].detail);
  }
  if (!sensor.said.enabled) return {};
  if (sensor.said.link.empty()) {
    return refuse(name, "link", "must say where the sensor is heard");
  }
  const bool listens = std::string_view(sensor.said.link).starts_with("listen:");
  if (listens && (sensor.said.kind != "cloud" || sensor.said.listens() == 0)) {
    return refuse(name, "link", "may be listen:PORT (1 to 65535) for a cloud only");
  }
  return {};
}

}  // namespace

base::Mount SensorSettings::mount() const noexcept {
  return {x_m,
          y_m,
          z_m,
          base::rad_from_deg(roll_deg),
          base::rad_from_deg(pitch_deg),
          base::rad_from_deg(yaw_deg)};
}

int SensorSettings::listens() const noexcept {
  constexpr std::string_view kListen = "listen:";
  if (!std::string_view(link).starts_with(kListen)) return 0;
  int port = 0;
  const char* begin = link.data() + kListen.size();
  const char* end = link.data() + link.size();
  const auto [last, bad] = std::from_chars(begin, end, port);
  return bad == std::errc{} && last == end && port > 0 && port < 65536 ? port : 0;
}

std::string_view sensor_of(std::string_view key) noexcept {
  constexpr std::string_view kBefore = "sensors.";
  if (!key.starts_with(kBefore)) return {};
  key.remove_prefix(kBefore.size());
  return key.substr(0, key.find('.'));
}

bool is_sensor_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= 24 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

base::Result<void> check(const SenseSettings& sense) {
  std::string section = "sense.blocked.";
  auto good = robot::check(sense.blocked);
  if (good) {
    section = "nav.tool.";
    good = robot::check(sense.outline);
  }
  if (good) return {};
  const base::FieldError& field = good.error().fields.front();
  const std::string key = section + field.pointer;
  return base::fail(base::Code::Invalid, key + " " + field.detail, {{key, field.detail}});
}

base::Result<void> check(const Sensors& sensors) {
  std::map<std::string, std::string> heard;
  for (const auto& [name, sensor] : sensors) {
    if (auto good = check_one(name, sensor); !good) return good;
    if (!sensor.said.enabled) continue;
    const auto [other, alone] = heard.emplace(sensor.said.link, name);
    if (!alone) {
      return refuse(name, "link", "is that of sensor \"" + other->second + "\", too");
    }
  }
  return {};
}

}  // namespace roverd
