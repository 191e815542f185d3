// What the vehicle is and has: profile, drivers, lights.

#include <algorithm>
#include <utility>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"

namespace roverd::api {

namespace {

Json guard_json(const std::optional<GuardProfile>& g) {
  if (!g) return nullptr;
  Json rays = nullptr;
  if (g->rays) {
    rays = {{"instead", g->rays->instead},
            {"stop_m", rounded(g->rays->stop_m, kPlaces3)},
            {"slow_m", rounded(g->rays->slow_m, kPlaces3)},
            {"fan_deg", degrees(g->rays->fan_rad)},
            {"rays", g->rays->rays}};
  }
  return {{"back_m", rounded(g->back_m, kPlaces3)},
          {"side_m", rounded(g->side_m, kPlaces3)},
          {"gap_m", rounded(g->gap_m, kPlaces3)},
          {"delay_s", rounded(g->delay_s, kPlaces3)},
          {"decel_mps2", rounded(g->decel_mps2, kPlaces3)},
          {"turn_decel_dps2", degrees(g->turn_decel_radps2)},
          {"rays", std::move(rays)}};
}

}  // namespace

Json capabilities_json(const Profile& p, const std::string& version) {
  Json modes = Json::array();
  for (const base::Mode mode : p.modes) modes.push_back(base::to_string(mode));
  Json formats = Json::array();
  Json written = Json::array();
  for (const mission::Format format : mission::kFormats) {
    formats.push_back(mission::to_string(format));
    if (mission::is_written(format)) written.push_back(mission::to_string(format));
  }
  return {{"vehicle", p.name},
          {"title", p.title},
          {"version", version},
          {"kinematics", p.kinematics},
          {"size", {{"length_m", p.length_m}, {"width_m", p.width_m}, {"mass_kg", p.mass_kg}}},
          {"limits",
           {{"max_speed_mps", p.max_speed_mps},
            {"max_yaw_rate_dps", degrees(p.max_yaw_rate_radps)},
            {"max_acceleration_mps2", p.max_acceleration_mps2},
            {"pivot_angle_deg", degrees(p.pivot_angle_rad)}}},
          {"guard", guard_json(p.guard)},
          {"modes", std::move(modes)},
          {"drivers", p.drivers},
          {"lights", p.lights},
          {"error_clear", p.clears_errors},
          {"item_types", p.item_types},
          {"radio", p.radio},
          {"import_formats", formats},
          {"export_formats", written}};
}

Json driver_json(const base::DriverStatus& d, std::optional<double> rate_hz, base::Time now) {
  constexpr double kPlaces1 = 1e1;
  Json out = {
      {"name", d.name},
      {"state", base::to_string(d.phase)},
      {"reason", d.reason},
      {"link", {{"address", d.link.empty() ? Json(nullptr) : Json(d.link)}, {"open", d.link_open}}},
      {"received", d.received},
      {"refused", d.refused},
      {"sent", d.sent},
      {"rate_hz", rounded(rate_hz, kPlaces1)},
      {"rates_hz", Json::object()},
      {"counts", Json::object()},
      {"facts", Json::object()},
      {"hazards", Json::array()},
      {"restarts", d.restarts},
      {"last_error", nullptr},
      {"recording", base::to_string(d.recording)},
      {"recording_problem", d.recording_problem}};
  if (d.detail) {
    for (const auto& [message, hz] : d.detail->rates_hz) {
      out["rates_hz"][message] = rounded(hz, kPlaces1);
    }
    out["counts"] = d.detail->counts;
    out["facts"] = d.detail->facts;
    out["hazards"] = d.detail->hazards;
  }
  if (d.last_error_at) {
    const double age_s = std::max(0.0, base::seconds(now - *d.last_error_at));
    out["last_error"] = {{"detail", d.last_error}, {"age_s", rounded(age_s, kPlaces3)}};
  }
  set_age(out, d.last_received, now, StaleAfter::kDriver_s);
  return out;
}

Json drivers_json(const base::Snapshot& s, const std::map<std::string, double>& rates,
                  base::Time now) {
  Json items = Json::array();
  for (const auto& driver : s.drivers) {
    const auto rate = rates.find(driver.name);
    items.push_back(
        driver_json(driver, rate == rates.end() ? std::nullopt : std::optional(rate->second), now));
  }
  // In an order that does not depend on who spoke first.
  std::sort(items.begin(), items.end(),
            [](const Json& a, const Json& b) { return a["name"] < b["name"]; });
  return {{"items", std::move(items)}, {"next_cursor", nullptr}};
}

namespace {

Json light_json(int mode, int pct) {
  const auto known = static_cast<std::size_t>(mode);
  return {{"mode", known < kLightModes.size() ? Json(kLightModes[known]) : Json(nullptr)},
          {"brightness_pct", pct}};
}

}  // namespace

Json lights_json(const base::Snapshot& s, base::Time now) {
  Json out = {{"commanded", nullptr}, {"front", nullptr}, {"rear", nullptr}};
  set_age(out, stamp_of(s.lights), now, StaleAfter::kLights_s);
  if (!s.lights) return out;
  out["commanded"] = s.lights->commanded;
  out["front"] = light_json(s.lights->front_mode, s.lights->front_pct);
  out["rear"] = light_json(s.lights->rear_mode, s.lights->rear_pct);
  return out;
}

}  // namespace roverd::api
