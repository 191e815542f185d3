#include "sim/config.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

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

Result<void> set_key(Config& config, const std::string& key, const ParamValue& value) {
  constexpr std::string_view kStart = "start.";
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

Result<void> read_table(Config& config, const toml::table& table, const std::string& file) {
  for (const auto& [section, node] : table) {
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
  return out.str();
}

}  // namespace roverd::sim
