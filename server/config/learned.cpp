#include "config/learned.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/angle.hpp"

namespace roverd {
namespace {

using base::Code;
using base::Result;
using Json = nlohmann::ordered_json;
using nav::LearnedValue;

constexpr std::size_t kLongestFile = 4096;
constexpr double kDay_s = 86'400.0;

/// What a value of this kind may be, and how it ages.
struct Kind {
  const char* name;
  const char* sigma_name;
  double least, most;     ///< of any robot
  double per_root_day;    ///< sigma that comes with the root of the days
  double forgotten_days;  ///< older is as none
};
constexpr Kind kScaleKind{"odometry_scale", "odometry_scale_sigma", 0.6, 1.15, 0.005, 365.0};
constexpr Kind kBiasKind{"gyro_bias_dps", "gyro_bias_sigma_dps", -3.0, 3.0, 0.05, 60.0};

constexpr Kind kDelayKind{"delay_s", "delay_sigma_s", 0.0, 0.8, 0.003, 90.0};
constexpr Kind kBrakingKind{"braking_mps2", "braking_sigma_mps2", 0.05, 10.0, 0.02, 90.0};
constexpr Kind kSpeedingKind{
    "acceleration_mps2", "acceleration_sigma_mps2", 0.05, 10.0, 0.02, 90.0};
constexpr Kind kTurnKind{"yaw_scale", "yaw_scale_sigma", 0.3, 1.5, 0.005, 90.0};
constexpr Kind kPullKind{"pull_1pm", "pull_sigma_1pm", -0.3, 0.3, 0.001, 90.0};
constexpr Kind kPivotKind{"pivot_m", "pivot_sigma_m", -1.0, 1.0, 0.003, 90.0};

std::optional<double> number(const Json& json, const char* name) {
  const auto at = json.find(name);
  if (at == json.end() || !at->is_number()) return std::nullopt;
  const double value = at->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<LearnedValue> value_of(const Json& json, const Kind& kind, double days) {
  const auto value = number(json, kind.name);
  const auto sigma = number(json, kind.sigma_name);
  if (!value || !sigma || *value < kind.least || *value > kind.most || *sigma <= 0.0) return {};
  if (days > kind.forgotten_days) return {};
  return LearnedValue{*value, std::hypot(*sigma, kind.per_root_day * std::sqrt(days))};
}

/// Days since 1970; by the second.
double days_of(base::WallTime t) {
  return base::seconds(std::chrono::duration_cast<base::Duration>(t.time_since_epoch())) / kDay_s;
}

struct Fd {
  int fd;
  ~Fd() {
    if (fd >= 0) ::close(fd);
  }
};

Result<void> refused(const std::filesystem::path& file) {
  return base::fail(Code::Unavailable, file.string() + ": " + std::strerror(errno));
}

Json parse_kept(std::string_view text, const std::string& vehicle) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("vehicle", Json()) != vehicle) return Json::object();
  return json;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(kLongestFile, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return text;
}

void put(Json& json, const Kind& kind, const LearnedValue& value, double scale, double days) {
  json[kind.name] = value.value * scale;
  json[kind.sigma_name] = value.sigma * scale;
  json[std::string(kind.name) + "_day"] = days - value.age_s / kDay_s;
}

/// What a person said is to be forgotten; the gyro's bias is the sensor's, not the vehicle's.
void forget(Json& json) {
  for (const Kind& kind :
       {kScaleKind, kDelayKind, kBrakingKind, kSpeedingKind, kTurnKind, kPullKind, kPivotKind}) {
    json.erase(kind.name);
    json.erase(kind.sigma_name);
    json.erase(std::string(kind.name) + "_day");
  }
}

Json merged(Json json, const nav::Learned& learned, const std::string& vehicle,
            base::WallTime now) {
  json["vehicle"] = vehicle;
  json["time"] = base::to_rfc3339(now);
  const double days = days_of(now);
  if (learned.forgotten) forget(json);
  if (learned.odometry_scale) put(json, kScaleKind, *learned.odometry_scale, 1.0, days);
  if (learned.gyro_bias_radps) {
    put(json, kBiasKind, *learned.gyro_bias_radps, base::deg_from_rad(1.0), days);
  }
  if (learned.delay_s) put(json, kDelayKind, *learned.delay_s, 1.0, days);
  if (learned.braking_mps2) put(json, kBrakingKind, *learned.braking_mps2, 1.0, days);
  if (learned.acceleration_mps2) put(json, kSpeedingKind, *learned.acceleration_mps2, 1.0, days);
  if (learned.yaw_scale) put(json, kTurnKind, *learned.yaw_scale, 1.0, days);
  if (learned.pull_1pm) put(json, kPullKind, *learned.pull_1pm, 1.0, days);
  if (learned.pivot_m) put(json, kPivotKind, *learned.pivot_m, 1.0, days);
  return json;
}

}  // namespace

Result<void> replace_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path next = file;
  next += ".new";
  {
    const Fd out{::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (out.fd < 0) return refused(next);
    const auto done = ::write(out.fd, text.data(), text.size());
    if (done != static_cast<ssize_t>(text.size()) || ::fsync(out.fd) != 0) return refused(next);
  }
  if (::rename(next.c_str(), file.c_str()) != 0) return refused(file);
  const Fd folder{::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.fd >= 0) ::fsync(folder.fd);
  return {};
}

std::string learned_text(const nav::Learned& learned, const std::string& vehicle,
                         base::WallTime now) {
  return merged(Json::object(), learned, vehicle, now).dump(2) + "\n";
}

nav::Learned learned_from(std::string_view text, const std::string& vehicle, base::WallTime now) {
  const Json json = parse_kept(text, vehicle);
  const auto kept = [&](const Kind& kind) -> std::optional<LearnedValue> {
    const auto day = number(json, (std::string(kind.name) + "_day").c_str());
    if (!day) return std::nullopt;
    // A computer without a clock of its own may start in the past: then nobody knows the age.
    const double age = days_of(now) - *day;
    return value_of(json, kind, age >= 0.0 ? age : 0.5 * kind.forgotten_days);
  };
  nav::Learned out;
  out.odometry_scale = kept(kScaleKind);
  out.delay_s = kept(kDelayKind);
  out.braking_mps2 = kept(kBrakingKind);
  out.acceleration_mps2 = kept(kSpeedingKind);
  out.yaw_scale = kept(kTurnKind);
  out.pull_1pm = kept(kPullKind);
  out.pivot_m = kept(kPivotKind);
  if (const auto bias = kept(kBiasKind)) {
    out.gyro_bias_radps =
        LearnedValue{base::rad_from_deg(bias->value), base::rad_from_deg(bias->sigma)};
  }
  return out;
}

nav::Learned read_learned(const std::filesystem::path& file, const std::string& vehicle,
                          base::WallTime now) {
  return learned_from(text_of(file), vehicle, now);
}

Result<void> write_learned(const std::filesystem::path& file, const nav::Learned& learned,
                           const std::string& vehicle, base::WallTime now) {
  const Json kept = parse_kept(text_of(file), vehicle);
  return replace_file(file, merged(kept, learned, vehicle, now).dump(2) + "\n");
}

}  // namespace roverd
