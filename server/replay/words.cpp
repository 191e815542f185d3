// The replay command: its arguments, and what it prints.

#include <array>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/angle.hpp"
#include "replay/run.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kNotWritten = 1;
constexpr int kArgumentsWrong = 2;

[[gnu::format(printf, 2, 3)]] void append_f(std::string& out, const char* format, ...) {
  std::array<char, 256> text{};
  va_list args;
  va_start(args, format);
  std::vsnprintf(text.data(), text.size(), format, args);
  va_end(args);
  out += text.data();
}

double heading_of(const base::Pose& pose) {
  const double deg = std::round(base::heading_from_yaw(pose.yaw_rad) * 100.0) / 100.0;
  return deg >= 360.0 ? 0.0 : deg;
}

double rounded_to(double value, double places) {
  return std::round(value * places) / places + 0.0;
}

double mean_nis(const ReplayInput& in) {
  return in.used > 0 ? in.nis_sum / static_cast<double>(in.used) : 0.0;
}
double rms(const ReplayInput& in) {
  return in.used > 0 ? std::sqrt(in.square_sum / static_cast<double>(in.used)) : 0.0;
}

Json report_json(const ReplayReport& r) {
  Json out = {{"files", r.files},
              {"paced_by_the_device", r.by_device},
              {"left_out", r.left_out},
              {"duration_s", rounded_to(r.duration_s, 1e3)},
              {"items", r.items},
              {"poses", r.poses},
              {"way_m", rounded_to(r.way_m, 1e3)},
              {"resets", r.health.resets}};
  for (const auto& [name, in] : r.inputs) {
    out["innovations"][name] = {{"taken", in.taken},
                                {"used", in.used},
                                {"rejected", in.rejected},
                                {"mean_nis", rounded_to(mean_nis(in), 1e4)},
                                {"rms", rounded_to(rms(in), 1e4)},
                                {"largest", rounded_to(in.largest, 1e4)}};
  }
  for (std::size_t i = 0; i < r.health.refusals.size(); ++i) {
    if (r.health.refusals[i] == 0) continue;
    out["refusals"][std::string(base::to_string(static_cast<base::Refusal>(i)))] =
        r.health.refusals[i];
  }
  for (const base::DriverStatus& d : r.drivers) {
    out["drivers"][d.name] = {{"received", d.received}, {"refused", d.refused}};
    if (d.detail) out["drivers"][d.name]["counts"] = d.detail->counts;
  }
  for (const auto& [name, n] : r.sights) out["sights"][name] = n;
  return out;
}

int tell(int code, const std::string& cause) {
  std::fprintf(stderr, "roverd: %s\n", cause.c_str());
  return code;
}

}  // namespace

std::string csv_head() {
  return "time,t_s,lat,lon,east_m,north_m,heading_deg,speed_mps,horizontal_accuracy_m,"
         "heading_accuracy_deg,source,fix\n";
}

std::string csv_line(const ReplayPose& p) {
  std::string out = p.wall ? base::to_rfc3339(*p.wall) : "";
  append_f(out, ",%.3f,%.9f,%.9f,%.4f,%.4f,%.2f,", p.t_s, p.pose.global.lat, p.pose.global.lon,
           p.pose.at.east_m, p.pose.at.north_m, heading_of(p.pose));
  if (p.pose.speed_mps) append_f(out, "%.3f", *p.pose.speed_mps);
  append_f(out, ",%.4f,%.3f,", p.pose.horizontal_sigma_m,
           base::deg_from_rad(p.pose.heading_sigma_rad));
  out += p.pose.source;
  out += ',';
  out += base::to_string(p.fix);
  out += '\n';
  return out;
}

std::string report_text(const ReplayReport& r) {
  std::string out;
  for (const std::string& file : r.files) out += "# file " + file + "\n";
  for (const std::string& file : r.by_device) {
    out += "# file " + file + " has no time stamps: paced by the time that the device told\n";
  }
  for (const std::string& sentence : r.left_out) out += "# " + sentence + "\n";
  append_f(out, "# duration_s %.3f, items %llu, poses %llu, way_m %.3f, resets %llu\n",
           r.duration_s, static_cast<unsigned long long>(r.items),
           static_cast<unsigned long long>(r.poses), r.way_m,
           static_cast<unsigned long long>(r.health.resets));
  for (const auto& [name, in] : r.inputs) {
    append_f(out,
             "# input %s: taken %llu, used %llu, rejected %llu, mean_nis %.4f, rms %.4f, "
             "largest %.4f\n",
             name.c_str(), static_cast<unsigned long long>(in.taken),
             static_cast<unsigned long long>(in.used), static_cast<unsigned long long>(in.rejected),
             mean_nis(in), rms(in), in.largest);
  }
  for (std::size_t i = 0; i < r.health.refusals.size(); ++i) {
    if (r.health.refusals[i] == 0) continue;
    out += "# refused " + std::string(base::to_string(static_cast<base::Refusal>(i))) + ": " +
           std::to_string(r.health.refusals[i]) + "\n";
  }
  for (const base::DriverStatus& d : r.drivers) {
    out += "# driver " + d.name + ": received " + std::to_string(d.received) + ", refused " +
           std::to_string(d.refused) + "\n";
    if (!d.detail) continue;
    for (const auto& [what, n] : d.detail->counts) {
      out += "# driver " + d.name + ": " + what + ": " + std::to_string(n) + "\n";
    }
  }
  for (const auto& [name, n] : r.sights) {
    out += "# sensor " + name + ": " + std::to_string(n) + " sights\n";
  }
  return out;
}

std::string geojson_text(const std::vector<ReplayPose>& poses, const ReplayReport* report) {
  Json line = Json::array();
  Json times = Json::array();
  Json headings = Json::array();
  for (const ReplayPose& p : poses) {
    line.push_back({rounded_to(p.pose.global.lon, 1e9), rounded_to(p.pose.global.lat, 1e9)});
    times.push_back(p.wall ? Json(base::to_rfc3339(*p.wall)) : Json(rounded_to(p.t_s, 1e3)));
    headings.push_back(heading_of(p.pose));
  }
  // A line wants two places; of a robot that never knew where it is there is none.
  const Json geometry = line.size() < 2
                            ? Json(nullptr)
                            : Json{{"type", "LineString"}, {"coordinates", std::move(line)}};
  Json feature = {
      {"type", "Feature"},
      {"geometry", geometry},
      {"properties", {{"times", std::move(times)}, {"headings_deg", std::move(headings)}}}};
  Json out = {{"type", "FeatureCollection"}, {"features", Json::array({std::move(feature)})}};
  if (report != nullptr) out["report"] = report_json(*report);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

int replay(const ReplayCommand& a) {
  const auto settings = load_settings(a.source);
  if (!settings) return tell(kArgumentsWrong, settings.error().detail);
  std::string out = a.geojson ? "" : csv_head();
  std::vector<ReplayPose> poses;
  const auto began = std::chrono::steady_clock::now();
  const auto report = run_replay(a.plan, *settings, [&](const ReplayPose& p) {
    if (a.geojson) {
      poses.push_back(p);
    } else {
      out += csv_line(p);
    }
  });
  if (!report) return tell(kArgumentsWrong, "replay: " + report.error().detail);
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (a.geojson) {
    out = geojson_text(poses, a.report ? &*report : nullptr);
  } else if (a.report) {
    out += report_text(*report);
  }
  const bool written =
      std::fwrite(out.data(), 1, out.size(), stdout) == out.size() && std::fflush(stdout) == 0;
  if (!written) return tell(kNotWritten, "standard output cannot be written");
  std::fprintf(stderr, "%.1f s played in %.3f s: %.0f times real time\n", report->duration_s,
               took_s, took_s > 0.0 ? report->duration_s / took_s : 0.0);
  return 0;
}

}  // namespace roverd
