#include "config/settings.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "badge/badge.hpp"
#include "base/params.hpp"
#include "config/ears.hpp"
#include "config/reach.hpp"

namespace roverd {
namespace {

using base::ParamValue;
using base::Result;

/// One key with its value and where it was said, for the error message.
struct Entry {
  std::string key;                  ///< "nav.track.lookahead_min_m"
  std::optional<ParamValue> value;  ///< none: the head of a section
  std::string place;                ///< "config/robot.toml:12"
};

std::optional<ParamValue> value_of(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return ParamValue(flag->get());
  if (const auto* number = node.as_floating_point()) return ParamValue(number->get());
  if (const auto* number = node.as_integer()) return ParamValue(static_cast<double>(number->get()));
  if (const auto* text = node.as_string()) return ParamValue(text->get());
  return std::nullopt;
}

Result<void> flatten(const toml::table& table, const std::string& prefix, const std::string& file,
                     std::vector<Entry>& out) {
  for (const auto& [key, node] : table) {
    std::string name = prefix;
    name += key.str();
    std::string place = file + ":" + std::to_string(key.source().begin.line);
    if (const auto* inner = node.as_table()) {
      out.push_back({name, std::nullopt, place});
      if (auto done = flatten(*inner, name + ".", file, out); !done) return done;
    } else if (auto value = value_of(node)) {
      out.push_back({name, *value, place});
    } else {
      place += ": " + name;
      return base::fail(base::Code::Invalid, place + " must be a number, a text or true/false");
    }
  }
  return {};
}

/// "ntrip://USER:PASSWORD@HOST:PORT/MOUNTPOINT" somewhere in it.
bool has_login(std::string_view text) {
  const auto scheme = text.find("://");
  return scheme != std::string_view::npos && text.find('@', scheme) != std::string_view::npos;
}

/// A file with somebody's login is for its owner alone.
Result<void> check_logins(const std::filesystem::path& file, const std::vector<Entry>& entries) {
  namespace fs = std::filesystem;
  constexpr fs::perms kOthers = fs::perms::group_all | fs::perms::others_all;
  std::error_code ec;
  const fs::perms mode = fs::status(file, ec).permissions();
  if (ec || (mode & kOthers) == fs::perms::none) return {};
  for (const auto& entry : entries) {
    const auto* text = entry.value ? std::get_if<std::string>(&*entry.value) : nullptr;
    if (text == nullptr || !has_login(*text)) continue;
    std::array<char, 8> octal{};
    std::snprintf(octal.data(), octal.size(), "%04o", static_cast<unsigned>(mode) & 07777U);
    return base::fail(base::Code::Invalid, entry.place + ": " + entry.key +
                                               " has a login, and the file can be read or changed "
                                               "by others (mode " +
                                               octal.data() + "): chmod go= " + file.string());
  }
  return {};
}

Result<std::vector<Entry>> read_file(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) {
    return base::fail(base::Code::NotFound, "no config file " + file.string());
  }
  try {
    const toml::table table = toml::parse_file(file.string());
    std::vector<Entry> entries;
    if (auto done = flatten(table, "", file.string(), entries); !done) {
      return tl::unexpected(done.error());
    }
    if (auto closed = check_logins(file, entries); !closed) {
      return tl::unexpected(closed.error());
    }
    return entries;
  } catch (const toml::parse_error& error) {
    return base::fail(base::Code::Malformed, file.string() + ":" +
                                                 std::to_string(error.source().begin.line) + ": " +
                                                 std::string(error.description()));
  }
}

/// "--set key=value": a number or true/false where it reads as one, text otherwise.
Result<Entry> read_override(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return base::fail(base::Code::Malformed, "--set " + text + ": must be key=value");
  }
  const std::string key = text.substr(0, equals);
  const std::string raw = text.substr(equals + 1);
  // What is wrong with it is told with its place.
  const std::string place = "--set " + (has_login(raw) ? key + "=..." : text);
  if (raw == "true" || raw == "false") return Entry{key, raw == "true", place};
  char* end = nullptr;
  const double number = std::strtod(raw.c_str(), &end);
  if (!raw.empty() && *end == '\0') return Entry{key, number, place};
  return Entry{key, raw, place};
}

using Section = std::function<Result<void>(std::string_view name, const ParamValue& value)>;

template <class... P>
Section section(P&... params) {
  // A section may spread over several structs (wiring and parameters of one driver): the first
  // that knows the key takes it.
  return [&params...](std::string_view name, const ParamValue& value) -> Result<void> {
    Result<void> result = base::fail(base::Code::Invalid, "unknown key");
    const auto offer = [&](auto& p) {
      result = base::set_param(p, name, value);
      return result || result.error().detail != "unknown key";
    };
    (void)(offer(params) || ...);
    return result;
  };
}

using Sections = std::map<std::string, Section, std::less<>>;

/// robot::sections lists the robot's own.
struct Collect {
  Sections& out;

  template <class P>
  void operator()(const char* name, P& params) {
    out.emplace(name, section(params));
  }
};

Result<void> set_tiles(Settings& settings, std::string_view name, const ParamValue& value) {
  const auto* path = std::get_if<std::string>(&value);
  if (path == nullptr) {
    return base::fail(base::Code::Invalid,
                      std::string(name) + " must be the path of an MBTiles file");
  }
  settings.tiles[std::string(name)] = *path;
  return {};
}

Sections sections_of(Settings& s) {
  Sections out{
      {"server", section(s.server)},
      {"robot", section(s.badge, s.robot.robot)},
      {"vehicle", section(s.vehicle, s.robot.vehicle)},
      {"recording", section(s.recording)},
      {"missions", section(s.missions)},
      {"runs", section(s.runs)},
      {"events", section(s.events)},
      {"backups", section(s.backups)},
      {"map", section(s.map)},
      {"tiles", [&s](std::string_view name, const ParamValue& v) { return set_tiles(s, name, v); }},
  };
  drivers(
      [&out](const std::string& name, auto& driver) {
        out.emplace("drivers." + name, section(driver.wiring, driver.params));
      },
      s);
  for (auto& [name, sensor] : s.sensors) {
    Sensor* one = &sensor;
    out.emplace("sensors." + name, [one](std::string_view key, const ParamValue& value) {
      Result<void> done = base::set_param(one->said, key, value);
      if (done || done.error().detail != "unknown key") return done;
      with_kind(*one, [&](auto& params) {
        if (done || done.error().detail != "unknown key") return;
        done = base::set_param(params, key, value);
      });
      return done;
    });
  }
  for (auto& [name, camera] : s.cameras) {
    out.emplace("cameras." + name, section(camera.said, camera.params));
  }
  for (auto& [name, layer] : s.layers) out.emplace("layers." + name, section(layer));
  for (auto& [name, place] : s.known_places) out.emplace("known_places." + name, section(place));
  Collect collect{out};
  robot::sections(collect, s.robot);
  sections(collect, s.sense);
  out.insert_or_assign("nav.tool", section(s.robot.tool, s.sense.outline));
  return out;
}

/// A section of a group makes what is named in it. @param most of them.
template <class T>
Result<T*> named_part(std::map<std::string, T>& all, const Entry& entry, std::string_view group,
                      std::size_t most) {
  const std::string name(part_of(entry.key, group));
  if (name.empty()) return nullptr;
  const std::string one(group.substr(0, group.size() - 1));  // "sensors", "cameras"
  if (!is_sensor_name(name)) {
    return base::fail(
        base::Code::Invalid,
        entry.place + ": a " + one + "'s name has a to z, 0 to 9 and _, 24 signs at most");
  }
  T& part = all[name];
  if (all.size() <= most) return &part;
  return base::fail(base::Code::Invalid,
                    entry.place + ": more than " + std::to_string(most) + " " + std::string(group));
}

/// A sensor's kind is read first, for it says which other keys there are.
Result<void> make_parts(Settings& s, const std::vector<Entry>& entries) {
  for (const auto& entry : entries) {
    const auto camera = named_part(s.cameras, entry, "cameras", kMostCameras);
    if (!camera) return tl::unexpected(camera.error());
    const auto layer = named_part(s.layers, entry, "layers", kMostLayers);
    if (!layer) return tl::unexpected(layer.error());
    const auto place = named_part(s.known_places, entry, "known_places", base::kMostKnownPlaces);
    if (!place) return tl::unexpected(place.error());
    const auto sensor = named_part(s.sensors, entry, "sensors", kMostSensors);
    if (!sensor) return tl::unexpected(sensor.error());
    if (*sensor == nullptr || !entry.key.ends_with(".kind") || !entry.value) continue;
    if (const auto* kind = std::get_if<std::string>(&*entry.value)) (*sensor)->said.kind = *kind;
  }
  return {};
}

/// All fields of a section under their full names.
struct Tell {
  std::vector<robot::NamedValue>& out;

  template <class P>
  void operator()(const std::string& section, const P& params) {
    for (auto& field : base::describe(params)) {
      if (field.name == "link" && section.starts_with("drivers.")) continue;
      out.emplace_back(section + "." + field.name, std::move(field.value));
    }
  }
};

/// "drivers" is none itself, but leads to some.
bool leads_to_section(const Sections& sections, const std::string& key) {
  return sections.contains(key) ||
         std::any_of(sections.begin(), sections.end(), [start = key + "."](const auto& section) {
           return section.first.starts_with(start);
         });
}

Result<void> set_all(Settings& settings, const std::vector<Entry>& entries) {
  if (auto made = make_parts(settings, entries); !made) return made;
  const auto sections = sections_of(settings);
  for (const auto& entry : entries) {
    if (!entry.value) {
      if (leads_to_section(sections, entry.key)) continue;
      return base::fail(base::Code::Invalid, entry.place + ": unknown section [" + entry.key + "]");
    }
    const auto dot = entry.key.rfind('.');
    const std::string where = dot == std::string::npos ? "" : entry.key.substr(0, dot);
    const std::string name = dot == std::string::npos ? entry.key : entry.key.substr(dot + 1);
    const auto found = sections.find(where);
    if (found == sections.end()) {
      return base::fail(base::Code::Invalid, entry.place + ": unknown key " + entry.key);
    }
    settings.places[entry.key] = entry.place;
    if (auto done = found->second(name, *entry.value); !done) {
      const std::string& detail = done.error().detail;
      return base::fail(base::Code::Invalid,
                        entry.place + ": " +
                            (detail == "unknown key" ? "unknown key " + entry.key
                                                     : entry.key.substr(0, dot + 1) + detail));
    }
  }
  return {};
}

/// What a check of a part has to say, at the place where it was written.
Result<void> at_its_place(const Settings& s, const Result<void>& good) {
  if (good) return {};
  const base::Error& error = good.error();
  if (error.fields.empty()) return tl::unexpected(error);
  const std::string& key = error.fields.front().pointer;
  std::string detail = error.detail;
  if (detail.starts_with(key)) detail.erase(0, key.size());
  return base::fail(error.code, s.where(key) + detail);
}

Result<void> check_server(const Settings& s) {
  const ServerSettings& server = s.server;
  if (server.tls_certificate.empty() == server.tls_key.empty()) return {};
  return base::fail(base::Code::Invalid,
                    s.where(server.tls_key.empty() ? "server.tls_certificate" : "server.tls_key") +
                        " needs the other one, too: server.tls_certificate and server.tls_key");
}

Result<void> check_badge(const Settings& s) {
  if (auto good = badge::check_name(s.badge.name); !good) {
    return base::fail(good.error().code, s.where("robot.name") + " " + good.error().detail);
  }
  if (auto good = badge::colour_of(s.badge.colour, s.badge.name); !good) {
    return base::fail(good.error().code, s.where("robot.colour") + " " + good.error().detail);
  }
  return {};
}

Result<void> check_map(const Settings& s) {
  const std::string& eye = s.map.sensor;
  if (eye.empty()) return {};
  const auto sensor = s.sensors.find(eye);
  const char* why =
      sensor == s.sensors.end()        ? " names no sensor: there is no [sensors."
      : !sensor->second.said.enabled   ? " names a sensor that is not enabled: [sensors."
      : !sensor->second.said.ranging() ? " names a sensor that sees no walls: [sensors."
                                       : nullptr;
  if (why == nullptr) return {};
  return base::fail(base::Code::Invalid, s.where("map.sensor") + why + eye + "]");
}

/// What only the whole tells.
Result<void> check_all(const Settings& s) {
  if (auto good = at_its_place(s, robot::check(s.robot)); !good) return good;
  if (auto good = at_its_place(s, check(s.sense)); !good) return good;
  if (auto good = at_its_place(s, check(s.sensors, ears_of(s))); !good) return good;
  if (auto good = check_map(s); !good) return good;
  if (auto good = at_its_place(s, check(s.cameras, s.sensors)); !good) return good;
  if (auto good = at_its_place(s, check(s.layers)); !good) return good;
  if (auto good = at_its_place(s, check(s.known_places, s.robot.estimate)); !good) return good;
  if (auto good = check_server(s); !good) return good;
  if (auto good = check_badge(s); !good) return good;
  const std::string& level = s.server.log_level;
  if (level != "debug" && level != "info" && level != "warning" && level != "error") {
    return base::fail(base::Code::Invalid, s.where("server.log_level") +
                                               " must be debug, info, warning or error, is \"" +
                                               level + "\"");
  }
  for (const auto& [set, path] : s.tiles) {
    std::error_code ec;
    if (std::filesystem::is_regular_file(path, ec)) continue;
    return base::fail(base::Code::NotFound,
                      s.where("tiles." + set) + ": there is no file " + path.string());
  }
  return {};
}

/// The profiles beside the config file, for the message when a name is wrong.
std::string known_vehicles(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  for (const auto& file : std::filesystem::directory_iterator(folder, ec)) {
    if (file.path().extension() == ".toml") names.push_back(file.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

Result<std::vector<Entry>> read_profile(const std::filesystem::path& config,
                                        const std::string& vehicle) {
  const auto folder = config.parent_path() / "vehicles";
  const bool plain = !vehicle.empty() && vehicle.find_first_of("/\\.") == std::string::npos;
  const auto file = folder / (vehicle + ".toml");
  if (!plain || !std::filesystem::exists(file)) {
    return base::fail(base::Code::NotFound, "unknown vehicle \"" + vehicle + "\"; known in " +
                                                folder.string() + ": " + known_vehicles(folder));
  }
  return read_file(file);
}

}  // namespace

std::string Settings::where(const std::string& key) const {
  const auto place = places.find(key);
  if (place == places.end()) return key;
  // "--set key=value" names the key already.
  return place->second.starts_with("--set ") ? place->second : place->second + ": " + key;
}

Result<Settings> load_settings(const SettingsSource& source) {
  auto config = read_file(source.config);
  if (!config) return tl::unexpected(config.error());
  std::vector<Entry> overrides;
  for (const auto& text : source.overrides) {
    auto entry = read_override(text);
    if (!entry) return tl::unexpected(entry.error());
    overrides.push_back(*entry);
  }
  std::string vehicle = source.vehicle;
  if (vehicle.empty()) {
    Settings said;
    if (auto done = set_all(said, *config); !done) return tl::unexpected(done.error());
    vehicle = said.vehicle.name;
  }
  auto profile = read_profile(source.config, vehicle);
  if (!profile) return tl::unexpected(profile.error());

  Settings settings;
  const std::vector<Entry> chosen{Entry{"vehicle.name", vehicle, "--vehicle"}};
  using Layer = const std::vector<Entry>*;
  for (const Layer layer : {Layer{&*profile}, Layer{&*config}, Layer{&overrides}, Layer{&chosen}}) {
    if (auto done = set_all(settings, *layer); !done) return tl::unexpected(done.error());
  }
  if (auto good = check_all(settings); !good) return tl::unexpected(good.error());
  if (auto done = settle_server(settings); !done) return tl::unexpected(done.error());
  return settings;
}

std::vector<robot::NamedValue> told(Settings settings) {
  std::vector<robot::NamedValue> out;
  Tell tell{out};
  tell("vehicle", settings.vehicle);
  tell("vehicle", settings.robot.vehicle);
  drivers(
      [&tell](const std::string& name, const auto& driver) {
        tell("drivers." + name, driver.wiring);
        tell("drivers." + name, driver.params);
      },
      settings);
  robot::sections(tell, settings.robot);
  return out;
}

Result<Settings> settings_from(const std::vector<robot::NamedValue>& values) {
  std::vector<Entry> entries;
  entries.reserve(values.size());
  for (const auto& [key, value] : values) entries.push_back({key, value, "settings"});
  Settings settings;
  if (auto done = set_all(settings, entries); !done) return tl::unexpected(done.error());
  if (auto good = check_all(settings); !good) return tl::unexpected(good.error());
  return settings;
}

}  // namespace roverd
