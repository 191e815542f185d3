#include "tools/failsafes.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <type_traits>

#include "robot/safety/failsafes.hpp"

namespace roverd {
namespace {

using robot::Failsafe;

constexpr std::string_view kBegin = "<!-- failsafes: written by roverd failsafes -->";
constexpr std::string_view kEnd = "<!-- end of failsafes -->";

/// "0.4 s" of base_timeout_s, "20 %" of battery_warn_pct; the name says the unit.
std::string with_unit(const std::string& name, double value) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnits{
      {{"_pct", " %"}, {"_deg", " deg"}, {"_s", " s"}, {"_m", " m"}}};
  char number[32];
  std::snprintf(number, sizeof number, "%g", value);
  for (const auto& [ending, unit] : kUnits) {
    if (name.ends_with(ending)) return number + std::string(unit);
  }
  return number;
}

/// The defaults of robot.safety in words, by name.
struct Defaults {
  std::map<std::string, std::string> text;
  template <class T, class... More>
  void operator()(const char* name, const T& value, const More&...) {
    if constexpr (std::is_same_v<T, bool>) {
      text[name] = value ? "yes" : "no";
    } else if constexpr (std::is_same_v<T, std::string>) {
      text[name] = value;
    } else {
      text[name] = with_unit(name, static_cast<double>(value));
    }
  }
};

std::string with_defaults(std::string_view words, const Defaults& defaults) {
  std::string out;
  while (true) {
    const auto open = words.find('{');
    out += words.substr(0, open);
    if (open == std::string_view::npos) return out;
    const auto close = words.find('}', open);
    const std::string name(words.substr(open + 1, close - open - 1));
    const auto known = defaults.text.find(name);
    if (known != defaults.text.end()) out += known->second + " (`" + name + "`)";
    words.remove_prefix(close + 1);
  }
}

std::string line_of(const Failsafe& row, const Defaults& defaults) {
  const bool follows = row.response != robot::Response::None;
  std::string out = "| `" + std::string(row.id) + "` | " + with_defaults(row.seen, defaults) +
                    " | " + with_defaults(row.after, defaults) + " | " +
                    (follows ? "**" + std::string(to_string(row.response)) + "**" : "show");
  if (follows && row.acts != robot::Acts::Always) out += " " + std::string(to_string(row.acts));
  return out + " | " + std::string(row.ends) + " | " + std::string(row.over) + " |\n";
}

int refuse(const std::string& cause) {
  std::fprintf(stderr, "roverd: %s\n", cause.c_str());
  return 1;
}

}  // namespace

std::string failsafes_table() {
  robot::SafetyParams params;
  Defaults defaults;
  fields(defaults, params);
  std::string out =
      "| condition or event | what is seen | after | what follows | ends | who may override |\n"
      "|---|---|---|---|---|---|\n";
  for (const Failsafe& row : robot::failsafes()) out += line_of(row, defaults);
  for (const Failsafe& row : robot::failsafes_elsewhere()) out += line_of(row, defaults);
  return out;
}

base::Result<std::string> with_failsafes(std::string_view page) {
  const auto begin = page.find(kBegin);
  const auto end = page.find(kEnd);
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) {
    return base::fail(base::Code::Invalid, "it has no place for the table, marked by " +
                                               std::string(kBegin) + " and " + std::string(kEnd));
  }
  return std::string(page.substr(0, begin)) + std::string(kBegin) + "\n\n" + failsafes_table() +
         "\n" + std::string(page.substr(end));
}

int failsafes(const std::string& into) {
  if (into.empty()) {
    std::fputs(failsafes_table().c_str(), stdout);
    return 0;
  }
  std::ifstream in(into, std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  if (!in) return refuse(into + ": cannot be read");
  in.close();
  const auto made = with_failsafes(page);
  if (!made) return refuse(into + ": " + made.error().detail);
  if (*made == page) return 0;
  std::ofstream out(into, std::ios::binary);
  out << *made;
  out.close();
  return out ? 0 : refuse(into + ": cannot be written");
}

}  // namespace roverd
