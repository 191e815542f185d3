#include "sim/config.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

#include "sim/port.hpp"
#include "sim/world/random.hpp"

namespace roverd::sim {
namespace {

using base::ParamValue;
using base::Result;

struct StartFields {
  Start& start;
};

template <class V>
void fields(V& v, StartFields& p) {
  v("lat", p.start.at.lat, -89.0, 89.0, "where the robot stands at first");
  v("lon", p.start.at.lon, -180.0, 180.0, "where the robot stands at first");
  v("heading_deg", p.start.heading_deg, -360.0, 360.0, "where it looks at first");
}

tl::unexpected<base::Error> refuse(std::string detail) {
  return base::fail(base::Code::Invalid, std::move(detail));
}

/// One key of one sensor; what it then is must be good as a whole.
Result<void> set_sensor_key(world::SensorParams& sensor, const std::string& key,
                            const ParamValue& value) {
  auto done = base::set_param(sensor, key, value);
  if (done) return done;
  return refuse(done.error().detail == "unknown key" ? "unknown key sensor." + key
                                                     : "sensor." + done.error().detail);
}

Result<void> check_port(const world::SensorParams& sensor) {
  if (sensor.port.empty()) return {};
  const auto spec = read_port(sensor.port);
  if (!spec) return refuse("port " + spec.error().detail);
  const bool datagrams = spec->kind == PortSpec::Kind::Udp;
  if (datagrams != (sensor.kind == "vlp16" || sensor.kind == "vision")) {
    return refuse(datagrams ? "port must be tcp or pty, udp is a vlp16's and a vision program's"
                            : "port must be udp:PORT");
  }
  return {};
}

/// "sensor.NAME.rate_hz"
Result<void> set_sensor(Config& config, const std::string& key, const ParamValue& value) {
  const auto name_at = key.find('.') + 1;
  const auto dot = key.rfind('.');
  for (world::SensorParams& sensor : config.sensors) {
    if (dot < name_at || sensor.name != key.substr(name_at, dot - name_at)) continue;
    world::SensorParams draft = sensor;
    if (auto done = set_sensor_key(draft, key.substr(dot + 1), value); !done) return done;
    if (auto good = world::check(draft); !good) return refuse("sensor." + good.error().detail);
    if (auto good = check_port(draft); !good) return refuse("sensor." + good.error().detail);
    sensor = draft;
    return {};
  }
  return refuse("unknown key " + key);
}

Result<void> set_key(Config& config, const std::string& key, const ParamValue& value) {
  constexpr std::string_view kStart = "start.";
  constexpr std::string_view kSensor = "sensor.";
  if (key == "world.file") {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) return refuse("world.file must be text");
    config.world = *text;
    return {};
  }
  if (key.starts_with(kSensor)) return set_sensor(config, key, value);
  if (!key.starts_with(kStart)) return set_param(config.params, key, value);
  StartFields start{config.start};
  auto done = base::set_param(start, key.substr(kStart.size()), value);
  if (done) return done;
  const std::string& detail = done.error().detail;
  return refuse(detail == "unknown key" ? "unknown key " + key : "start." + detail);
}

std::optional<ParamValue> value_of(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return ParamValue(flag->get());
  if (const auto* number = node.as_floating_point()) return ParamValue(number->get());
  if (const auto* number = node.as_integer()) return ParamValue(static_cast<double>(number->get()));
  if (const auto* text = node.as_string()) return ParamValue(text->get());
  return std::nullopt;
}

Result<void> read_node(Config& config, const std::string& key, const toml::node& node) {
  if (const auto value = value_of(node)) return set_key(config, key, *value);
  return refuse(key + " must be a number, a text or true/false");
}

std::string place(const std::string& file, const toml::source_region& source) {
  return file + ":" + std::to_string(source.begin.line) + ": ";
}

/// One [[sensor]]. Its kind comes first: it says what is usual.
Result<void> read_sensor(Config& config, const toml::table& table, const std::string& file) {
  const auto* kind = table.get_as<std::string>("kind");
  world::SensorParams sensor = world::usual(kind != nullptr ? kind->get() : "lms");
  for (const auto& [name, node] : table) {
    const auto value = value_of(node);
    const auto done = value ? set_sensor_key(sensor, std::string(name.str()), *value)
                            : Result<void>(refuse("sensor." + std::string(name.str()) +
                                                  " must be a number, a text or true/false"));
    if (!done) return refuse(place(file, name.source()) + done.error().detail);
  }
  if (sensor.name.empty()) sensor.name = sensor.kind;
  const auto bad = [&](const std::string& what) {
    return refuse(place(file, table.source()) + "sensor." + what);
  };
  if (auto good = world::check(sensor); !good) return bad(good.error().detail);
  if (auto good = check_port(sensor); !good) return bad(good.error().detail);
  for (const world::SensorParams& other : config.sensors) {
    if (other.name == sensor.name) return bad("name " + sensor.name + " is there twice");
    if (!sensor.port.empty() && other.port == sensor.port &&
        sensor.port.find(':') != std::string::npos) {
      return bad("port " + sensor.port + " is " + other.name + "'s");
    }
  }
  if (config.sensors.size() == kMaxSensors) return bad("is there more than 16 times");
  config.sensors.push_back(std::move(sensor));
  return {};
}

Result<void> read_sensors(Config& config, const toml::array& list, const std::string& file) {
  config.sensors.clear();
  for (const toml::node& node : list) {
    const auto* one = node.as_table();
    if (one == nullptr) return refuse(place(file, node.source()) + "sensor must be tables");
    if (auto done = read_sensor(config, *one, file); !done) return done;
  }
  return {};
}

Result<void> read_table(Config& config, const toml::table& table, const std::string& file) {
  for (const auto& [section, node] : table) {
    if (const auto* list = node.as_array(); list != nullptr && section.str() == "sensor") {
      if (auto done = read_sensors(config, *list, file); !done) return done;
      continue;
    }
    const auto* inner = node.as_table();
    if (inner == nullptr) {
      return refuse(place(file, section.source()) + "unknown key " + std::string(section.str()));
    }
    for (const auto& [name, value] : *inner) {
      const std::string key = std::string(section.str()) + "." + std::string(name.str());
      if (auto done = read_node(config, key, value); !done) {
        return refuse(place(file, name.source()) + done.error().detail);
      }
    }
  }
  return {};
}

/// The whole text must be the number; no locale, no hexadecimal, no blanks.
std::optional<double> number_in(std::string_view text) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, number);
  if (ec != std::errc{} || ptr != end || text.empty()) return std::nullopt;
  return number;
}

std::string shown(const ParamValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return "\"" + *text + "\"";
  std::ostringstream out;
  out.precision(10);
  out << std::get<double>(value);
  return out.str();
}

}  // namespace

Result<void> read_config(Config& config, std::string_view text, const std::string& file) {
  Config draft = config;
  try {
    const toml::table table = toml::parse(text, file);
    if (auto done = read_table(draft, table, file); !done) return done;
  } catch (const toml::parse_error& error) {
    return base::fail(base::Code::Malformed,
                      place(file, error.source()) + std::string(error.description()));
  }
  config = draft;
  return {};
}

Result<void> read_config_file(Config& config, const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    return base::fail(base::Code::NotFound, "cannot read the configuration file " + file);
  }
  return read_config(config, text.str(), file);
}

Result<void> apply_override(Config& config, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return base::fail(base::Code::Malformed, "--set " + text + ": must be key=value");
  }
  const std::string raw = text.substr(equals + 1);
  ParamValue value = raw;
  if (raw == "true" || raw == "false") value = raw == "true";
  if (const auto number = number_in(raw)) value = *number;
  if (auto done = set_key(config, text.substr(0, equals), value); !done) {
    return refuse("--set " + text + ": " + done.error().detail);
  }
  return {};
}

Result<void> read_start(Start& start, const std::string& text) {
  constexpr const char* kNames[] = {"lat", "lon", "heading_deg"};
  Start draft = start;
  StartFields target{draft};
  const auto misshapen = [&] {
    return refuse("--start " + text + ": must be LAT,LON or LAT,LON,HEADING in degrees");
  };
  std::string_view rest = text;
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    const auto comma = rest.find(',');
    const auto number = number_in(rest.substr(0, comma));
    if (count == std::size(kNames) || !number) return misshapen();
    if (auto done = base::set_param(target, kNames[count], *number); !done) {
      return refuse("--start " + text + ": " + done.error().detail);
    }
    more = comma != std::string_view::npos;
    if (more) rest.remove_prefix(comma + 1);
  }
  if (count < 2) return misshapen();
  start = draft;
  return {};
}

Result<world::World> load_world(const std::string& name) {
  if (auto random = world::random_world_named(name)) return std::move(*random);
  if (name.starts_with("random:")) {
    return refuse(name +
                  ": must be random:N or random:N:KIND with static, moving, grass or crowded");
  }
  std::ifstream in(name, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    return base::fail(base::Code::NotFound, "cannot read the world " + name);
  }
  auto world = world::read_world(text.str());
  if (!world) return base::fail(world.error().code, name + ": " + world.error().detail);
  return world;
}

std::string parameter_list(const Config& config) {
  Start start = config.start;
  std::ostringstream out;
  const auto print = [&](const std::string& name, const base::ParamInfo& info) {
    out << name << " = " << shown(info.value);
    if (info.min) out << " (" << shown(*info.min) << " .. " << shown(*info.max) << ")";
    out << ": " << info.description << "\n";
  };
  for (const auto& info : base::describe(StartFields{start})) print("start." + info.name, info);
  for (const auto& info : describe(config.params)) print(info.name, info);
  for (const world::SensorParams& sensor : config.sensors) {
    for (const auto& info : base::describe(sensor)) {
      print("sensor." + sensor.name + "." + info.name, info);
    }
  }
  return out.str();
}

}  // namespace roverd::sim
