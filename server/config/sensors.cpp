#include "config/sensors.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <utility>

#include "base/angle.hpp"

namespace roverd {
namespace {

base::Result<void> refuse(const std::string& name, const std::string& member, std::string detail) {
  const std::string key = "sensors." + name + "." + member;
  std::string whole = key + " " + detail;
  return base::fail(base::Code::Invalid, std::move(whole), {{key, std::move(detail)}});
}

/// By what a kind is heard.
struct Way {
  std::string_view kind;
  std::array<std::string_view, 2> schemes;
  std::string_view form;
};
constexpr std::array<Way, 6> kWays{{
    {"cloud", {"tcp", "listen"}, "tcp:HOST:PORT or listen:PORT"},
    {"depth", {"v4l2", "v4l2"}, "v4l2:/dev/videoN"},
    {"ranges", {"serial", "serial"}, "serial:DEVICE:BAUD"},
    {"sick", {"tcp", "tcp"}, "tcp:HOST:PORT"},
    {"velodyne", {"udp", "udp"}, "udp:PORT or udp:PORT:HOST:PORT"},
    {"vision", {"udp", "udp"}, "udp:PORT or udp:PORT:HOST:PORT"},
}};

std::string_view scheme_of(std::string_view link) noexcept {
  const auto colon = link.find(':');
  return colon == std::string_view::npos ? std::string_view{} : link.substr(0, colon);
}

/// What of this computer a link takes for itself: "UDP port 2368", "TCP port 5000", "/dev/ttyUSB0".
/// Empty: nothing (tcp:HOST:PORT may be there twice, if the device lets two in). A pattern of
/// serial devices meets the same pattern only.
std::string taken_by(std::string_view link) {
  const std::string_view scheme = scheme_of(link);
  const std::string_view rest = link.substr(std::min(link.size(), scheme.size() + 1));
  const auto device = [](std::string_view path) {
    std::error_code ec;
    const auto real = std::filesystem::canonical(path, ec);  // by-id and ttyUSB0 may be one
    return ec ? std::string(path) : real.string();
  };
  if (scheme == "listen") return "TCP port " + std::string(rest);
  if (scheme == "serial") return device(rest.substr(0, rest.rfind(':')));
  if (scheme == "slcan") return device(rest.substr(0, rest.find(':')));
  if (scheme == "v4l2") return device(rest);
  if (scheme != "udp") return {};
  // udp:PORT and udp:LOCALPORT:HOST:PORT listen there, udp:HOST:PORT at a port of the kernel's.
  const std::string_view first = rest.substr(0, rest.find(':'));
  int port = 0;
  const auto [end, bad] = std::from_chars(first.data(), first.data() + first.size(), port);
  const bool number = bad == std::errc{} && end == first.data() + first.size();
  return number ? "UDP port " + std::to_string(port) : std::string{};
}

base::Result<void> check_link(const std::string& name, const SensorSettings& said) {
  const auto way = std::ranges::find(kWays, said.kind, &Way::kind);
  const std::string_view scheme = scheme_of(said.link);
  if (scheme == "replay") return {};
  if (std::ranges::find(way->schemes, scheme) == way->schemes.end()) {
    return refuse(name, "link",
                  "must be " + std::string(way->form) + " for the kind " + said.kind + ", is \"" +
                      said.link + "\"");
  }
  if (scheme == "listen" && said.listens() == 0) {
    return refuse(name, "link", "must name a port of 1 to 65535: listen:PORT");
  }
  // A peer alone is heard at a port of the kernel's choice, where nobody sends to.
  if (scheme == "udp" && taken_by(said.link).empty()) {
    return refuse(
        name, "link",
        "must name the port here, too: udp:PORT or udp:PORT:HOST:PORT, is \"" + said.link + "\"");
  }
  if (scheme == "v4l2" && !std::string_view(said.link).starts_with("v4l2:/")) {
    return refuse(name, "link", "must name a device: v4l2:/dev/videoN");
  }
  return {};
}

/// Two that hear one device disturb each other, even where the system lets them.
bool same_peer(std::string_view a, std::string_view b) noexcept {
  return a == b && scheme_of(a) != "replay";
}

base::Result<void> check_one(const std::string& name, const Sensor& sensor) {
  if (is_driver_name(name)) return refuse(name, "kind", "is of a name that a driver has");
  bool known = false;
  base::Result<void> good;
  with_kind(sensor, [&](const auto& params) {
    known = true;
    if (good) good = validate(params);
  });
  if (!known) {
    return refuse(
        name, "kind",
        "must be cloud, depth, ranges, sick, velodyne or vision, is \"" + sensor.said.kind + "\"");
  }
  if (!good) {
    const auto& fields = good.error().fields;
    return refuse(name, fields.empty() ? "kind" : fields[0].pointer,
                  fields.empty() ? good.error().detail : fields[0].detail);
  }
  if (sensor.said.kind == "vision" && sensor.said.roll_deg != 0.0) {
    return refuse(name, "roll_deg", "must be 0: the vision program tells places upright");
  }
  if (sensor.said.kind == "vision" && sensor.said.pitch_deg != 0.0) {
    return refuse(name, "pitch_deg", "must be 0: the vision program tells places upright");
  }
  if (!sensor.said.enabled) return {};
  if (sensor.said.link.empty()) {
    return refuse(name, "link", "must say where the sensor is heard");
  }
  return check_link(name, sensor.said);
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

cloud::Params as_heard(const Sensor& sensor) {
  cloud::Params out = sensor.cloud;
  out.mount = sensor.said.mount();
  if (sensor.said.kind != "depth") return out;
  out.same_clock = !sensor.recorded;
  out.max_points = std::max(out.max_points, sensor.depth.width * sensor.depth.height);
  return out;
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

std::string_view part_of(std::string_view key, std::string_view group) noexcept {
  if (!key.starts_with(group) || key.size() <= group.size() || key[group.size()] != '.') return {};
  key.remove_prefix(group.size() + 1);
  return key.substr(0, key.find('.'));
}

bool is_driver_name(std::string_view name) noexcept {
  constexpr std::array<std::string_view, 9> kDrivers{
      "bunker", "ackermann", "ratio", "twist", "bumper", "gnss", "mti", "ntrip", "gpsd"};
  return std::ranges::find(kDrivers, name) != kDrivers.end();
}

bool is_sensor_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= 24 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

base::Result<void> check(const SenseSettings& sense) {
  const auto good = robot::check(sense.outline);
  if (good) return {};
  const base::FieldError& field = good.error().fields.front();
  const std::string key = "nav.tool." + field.pointer;
  return base::fail(base::Code::Invalid, key + " " + field.detail, {{key, field.detail}});
}

base::Result<void> check(const Sensors& sensors, const std::vector<Ear>& drivers) {
  std::vector<Ear> heard = drivers;
  for (const auto& [name, sensor] : sensors) {
    if (auto good = check_one(name, sensor); !good) return good;
    if (!sensor.said.enabled) continue;
    const Ear one{"sensors." + name + ".link", sensor.said.link};
    const std::string takes = taken_by(one.link);
    for (const Ear& other : heard) {
      const bool both = !takes.empty() && takes == taken_by(other.link);
      if (!both && !same_peer(one.link, other.link)) continue;
      return refuse(name, "link",
                    (both ? "takes " + takes + ", which " : "is the same that ") + other.key +
                        " (" + other.link + ") has, too");
    }
    heard.push_back(one);
  }
  return {};
}

}  // namespace roverd
