// What looks around, and what stands in the way.

#include <algorithm>
#include <cmath>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"
#include "base/angle.hpp"

namespace roverd::api {

Json detour_json(const base::Snapshot& s) {
  if (!s.detour) return nullptr;
  constexpr std::size_t kMost = 200;
  Json out = Json::array();
  const std::size_t every = s.detour->size() / kMost + 1;
  for (std::size_t i = 0; i < s.detour->size(); ++i) {
    if (i % every != 0 && i + 1 != s.detour->size()) continue;
    const base::LatLon& at = (*s.detour)[i];
    out.push_back({rounded(at.lat, kPlaces9), rounded(at.lon, kPlaces9)});
  }
  return out;
}

Json row_json(const std::optional<base::RowState>& row) {
  if (!row) return nullptr;
  Json out = {{"item", row->item},
              {"side", row->side},
              {"seeing", row->seeing},
              {"state", row->state},
              {"driven_m", rounded(row->driven_m, kPlaces2)},
              {"left_m", rounded(row->left_m, kPlaces2)},
              {"seen", nullptr}};
  if (!row->seen) return out;
  const base::RowInSight& seen = *row->seen;
  out["seen"] = {{"offset_m", rounded(seen.offset_m, kPlaces3)},
                 // Angles of the outside count clockwise.
                 {"angle_deg", degrees(-seen.angle_rad)},
                 {"sigma_m", rounded(seen.sigma_m, kPlaces3)},
                 {"certainty", rounded(seen.certainty, kPlaces2)},
                 {"width_m", rounded(seen.width_m, kPlaces3)},
                 {"width_sigma_m", rounded(seen.width_sigma_m, kPlaces3)},
                 {"to_end_m", rounded(seen.to_end_m, kPlaces2)},
                 {"age_s", rounded(seen.age_s, kPlaces2)}};
  return out;
}

Json row_now_json(const std::optional<base::RowState>& row) {
  const Json whole = row_json(row);
  const Json seen = whole.is_null() ? Json() : whole["seen"];
  Json out = Json::object();
  for (const char* name : {"offset_m", "angle_deg", "width_m", "certainty", "to_end_m", "age_s"}) {
    out[name] = seen.is_null() ? Json() : seen[name];
  }
  for (const char* name : {"item", "side", "seeing", "state"}) {
    out[name] = whole.is_null() ? Json() : whole[name];
  }
  return out;
}

Json obstacle_json(const std::optional<base::Obstacle>& o, base::Time now) {
  if (!o) return nullptr;
  return {
      {"action", base::to_string(o->action)},
      {"what", o->what},
      {"distance_m", rounded(std::hypot(o->ahead_m, o->left_m), kPlaces2)},
      // Bearings on the body count clockwise.
      {"bearing_deg", degrees(-o->bearing_rad)},
      {"ahead_m", rounded(o->ahead_m, kPlaces2)},
      {"left_m", rounded(o->left_m, kPlaces2)},
      {"way_m", rounded(o->distance_m, kPlaces2)},
      {"sensor", o->sensor.empty() ? Json(nullptr) : Json(o->sensor)},
      {"age_s", rounded(o->age_s, kPlaces2)},
      {"stopped_s", o->stopped_since
                        ? Json(rounded(base::seconds(now - *o->stopped_since), kPlaces2))
                        : Json(nullptr)},
      {"since_s",
       o->since ? Json(rounded(base::seconds(now - *o->since), kPlaces2)) : Json(nullptr)},
      {"blocked", o->blocked},
      {"then", o->then.empty() ? Json(nullptr) : Json(o->then)},
      {"decides_in_s",
       o->decides_at ? Json(rounded(std::max(0.0, base::seconds(*o->decides_at - now)), kPlaces2))
                     : Json(nullptr)},
      {"no_way", o->no_way.empty() ? Json(nullptr) : Json(o->no_way)},
      {"reason", o->reason}};
}

/// What came over the sensor's link and was not what it should be; its driver has its name.
void add_losses(Json& out, const base::Snapshot& s, const std::string& name, base::Time now) {
  static const base::DriverDetail kNone;
  const auto driver = std::ranges::find(s.drivers, name, &base::DriverStatus::name);
  const bool known = driver != s.drivers.end();
  const base::DriverDetail& detail = known && driver->detail ? *driver->detail : kNone;
  out["lost"] = detail.lost;
  out["duplicates"] = detail.twice;
  out["malformed"] = known ? driver->refused : 0;
  out["foreign"] = detail.foreign;
  out["malformed_last"] = detail.refused_last.empty() ? Json(nullptr) : Json(detail.refused_last);
  out["malformed_age_s"] =
      detail.refused_last_at ? Json(rounded(base::seconds(now - *detail.refused_last_at), kPlaces2))
                             : Json(nullptr);
}

Json sensors_json(const base::Snapshot& s, base::Time now) {
  Json items = Json::array();
  static const std::vector<base::SensorState> kNone;
  const std::string_view silent = base::to_string(base::SensorHealth::Silent);
  for (const base::SensorState& one : s.sensors ? *s.sensors : kNone) {
    const base::Mount& m = one.mount;
    items.push_back({{"name", one.name},
                     {"kind", one.kind},
                     {"required", one.required},
                     {"health", s.sensors_stale ? silent : base::to_string(one.health)},
                     {"reason", s.sensors_stale ? "nothing has been seen lately" : one.reason},
                     {"window", base::to_string(one.window)},
                     {"age_s", one.seen ? Json(rounded(base::seconds(now - *one.seen), kPlaces2))
                                        : Json(nullptr)},
                     {"rate_hz", rounded(one.rate_hz, kPlaces2)},
                     {"unknown_part", rounded(one.unknown_part, kPlaces3)},
                     {"points", one.points},
                     {"refused", one.refused},
                     {"mount",
                      {{"x_m", rounded(m.x_m, kPlaces3)},
                       {"y_m", rounded(m.y_m, kPlaces3)},
                       {"z_m", rounded(m.z_m, kPlaces3)},
                       {"roll_deg", degrees(m.roll_rad)},
                       {"pitch_deg", degrees(m.pitch_rad)},
                       {"yaw_deg", degrees(m.yaw_rad)}}}});
    add_losses(items.back(), s, one.name, now);
  }
  return {{"items", std::move(items)}};
}

}  // namespace roverd::api
