#include "replay/sensors.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace roverd {
namespace {

/// Longer than any recording.
constexpr double kNever_s = 1e9;

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

bool is_sensor_kind(std::string_view speaker) noexcept {
  constexpr std::array<std::string_view, 5> kKinds{"cloud", "ranges", "sick", "velodyne", "vision"};
  return std::ranges::find(kKinds, speaker) != kKinds.end();
}

std::string_view named_in(std::string_view path) noexcept {
  constexpr std::string_view kMoment = "20260301T120000Z-";
  const auto slash = path.rfind('/');
  std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
  if (name.size() <= kMoment.size() || name[8] != 'T' || !name.substr(15).starts_with("Z-")) {
    return {};
  }
  name.remove_prefix(kMoment.size());
  // A sensor's name has neither a dot nor a dash: what follows them is a number, or the ending.
  return name.substr(0, name.find_first_of(".-"));
}

base::Result<std::string> sensor_of_recording(const std::string& path, std::string_view kind,
                                              const Sensors& sensors) {
  std::vector<std::string> fit;
  for (const auto& [name, sensor] : sensors) {
    const bool image = sensor.said.kind == "depth" && kind == "cloud";  // recorded as its frames
    if (sensor.said.kind == kind || image) fit.push_back(name);
  }
  if (fit.empty()) return std::string();
  const auto named = std::ranges::find(fit, named_in(path));
  if (named != fit.end()) return *named;
  if (fit.size() == 1) return fit.front();
  return base::fail(base::Code::Invalid,
                    path + " may be of " + listed(fit) +
                        ": the file's name must tell which, as in 20260301T120000Z-" + fit.front() +
                        ".pcap");
}

Sensor as_recorded(Sensor sensor) {
  sensor.cloud.silent_reopen_s = 0.0;
  sensor.ranges.silent_reopen_s = 0.0;
  sensor.velodyne.silent_reopen_s = 0.0;
  sensor.vision.silent_reopen_s = 0.0;
  sensor.sick.silent_after_s = kNever_s;  // then the connection would be made anew
  sensor.sick.configure = false;
  sensor.recorded = true;
  return sensor;
}

}  // namespace roverd
