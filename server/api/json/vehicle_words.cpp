#include <algorithm>
#include <cmath>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"
#include "api/validity.hpp"
#include "base/angle.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

Json heading_json(double yaw_rad) {
  const double heading_deg = std::round(base::heading_from_yaw(yaw_rad) * kPlaces2) / kPlaces2;
  return heading_deg >= 360.0 ? 0.0 : heading_deg;
}

/// An axis has no front: [0, 180).
Json axis_json(double yaw_rad) {
  const double heading_deg = std::fmod(base::heading_from_yaw(yaw_rad), 180.0);
  const double shown_deg = std::round(heading_deg * kPlaces2) / kPlaces2;
  return shown_deg >= 180.0 ? 0.0 : shown_deg;
}

void set_position(Json& group, const std::optional<base::LatLon>& at) {
  group["lat"] = at ? rounded(at->lat, kPlaces9) : Json(nullptr);
  group["lon"] = at ? rounded(at->lon, kPlaces9) : Json(nullptr);
}

Json position_json(const std::optional<base::Pose>& pose, base::Time now) {
  Json out = {{"alt_m", nullptr},
              {"heading_deg", nullptr},
              {"speed_mps", nullptr},
              {"yaw_rate_dps", nullptr},
              {"source", nullptr},
              {"horizontal_accuracy_m", nullptr},
              {"heading_accuracy_deg", nullptr},
              {"ellipse", nullptr}};
  set_position(out, pose ? std::optional(pose->global) : std::nullopt);
  set_age(out, stamp_of(pose), now, StaleAfter::kPosition_s);
  if (!pose) return out;
  out["alt_m"] = rounded(pose->alt_msl_m, kPlaces3);
  if (pose->heading_known) {
    out["heading_deg"] = heading_json(pose->yaw_rad);
    out["heading_accuracy_deg"] = degrees(pose->heading_sigma_rad);
  }
  out["speed_mps"] = rounded(pose->speed_mps, kPlaces3);
  out["yaw_rate_dps"] = degrees(pose->yaw_rate_radps);
  out["horizontal_accuracy_m"] = rounded(pose->horizontal_sigma_m, kPlaces3);
  out["ellipse"] = {{"major_m", rounded(pose->ellipse.major_m, kPlaces3)},
                    {"minor_m", rounded(pose->ellipse.minor_m, kPlaces3)},
                    {"orientation_deg", axis_json(pose->ellipse.major_yaw_rad)}};
  out["source"] = pose->source;
  return out;
}

/// In the map that is in use.
Json place_json(const std::optional<base::PlaceState>& place, base::Time now) {
  Json out = {{"state", base::to_string(place ? place->phase : base::PlacePhase::Off)},
              {"map", nullptr},
              {"map_id", nullptr},  // whoever keeps the maps says it
              {"placed", nullptr},
              {"reason", nullptr},
              {"x_m", nullptr},
              {"y_m", nullptr},
              {"yaw_deg", nullptr},
              {"accuracy_m", nullptr},
              {"heading_accuracy_deg", nullptr}};
  const bool looks = place && place->phase != base::PlacePhase::Off;
  set_age(out, looks ? stamp_of(place) : std::nullopt, now, StaleAfter::kPosition_s);
  if (!looks) return out;
  out["map"] = place->map;
  if (!place->reason.empty()) out["reason"] = place->reason;
  if (place->in_map) {
    out["x_m"] = rounded(place->in_map->x_m, kPlaces3);
    out["y_m"] = rounded(place->in_map->y_m, kPlaces3);
    out["yaw_deg"] = degrees(place->in_map->yaw_rad);
  }
  out["accuracy_m"] = rounded(place->sigma_m, kPlaces3);
  out["heading_accuracy_deg"] = degrees(place->sigma_rad);
  return out;
}

/// The position's source, and what the map in use has to say of it. @param place of place_json
Json localisation_json(const base::Snapshot& s, const Json& place) {
  using base::PlacePhase;
  const PlacePhase phase = s.place ? s.place->phase : PlacePhase::Off;
  const char* state = phase == PlacePhase::Known       ? "tracking"
                      : phase == PlacePhase::Searching ? "searching"
                      : phase == PlacePhase::Lost      ? "lost"
                                                       : "unknown";
  return {{"source", s.pose ? Json(s.pose->source) : Json(nullptr)},
          {"map_id", nullptr},  // whoever keeps the maps says it
          {"state", state},
          {"accuracy", place["accuracy_m"]},
          {"age_s", place["age_s"]},
          {"stale", place["stale"]}};
}

Json attitude_json(const std::optional<base::Attitude>& a, base::Time now) {
  Json out = {{"roll_deg", nullptr}, {"pitch_deg", nullptr}};
  set_age(out, stamp_of(a), now, StaleAfter::kAttitude_s);
  if (!a) return out;
  out["roll_deg"] = degrees(a->roll_rad);
  out["pitch_deg"] = degrees(a->pitch_rad);
  return out;
}

/// The larger of two sigmas, if the receiver gives both.
std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

Json gnss_json(const base::Snapshot& s, base::Time now) {
  const auto& fix = s.gnss;
  Json out = {{"fix", base::to_string(fix ? fix->fix : base::FixType::None)},
              {"alt_m", nullptr},
              {"satellites", nullptr},
              {"hdop", nullptr},
              {"horizontal_accuracy_m", nullptr},
              {"correction_age_s", nullptr},
              {"speed_mps", nullptr}};
  set_position(out, fix ? fix->position : std::nullopt);
  set_age(out, stamp_of(fix), now, StaleAfter::kGnss_s);
  if (s.gnss_velocity) {
    out["speed_mps"] =
        rounded(std::hypot(s.gnss_velocity->east_mps, s.gnss_velocity->north_mps), kPlaces3);
  }
  if (!fix) return out;
  out["alt_m"] = rounded(fix->alt_msl_m, kPlaces3);
  if (fix->satellites) out["satellites"] = *fix->satellites;
  out["hdop"] = rounded(fix->hdop, kPlaces2);
  out["horizontal_accuracy_m"] = rounded(larger(fix->sigma_east_m, fix->sigma_north_m), kPlaces3);
  out["correction_age_s"] = rounded(fix->correction_age_s, kPlaces2);
  return out;
}

Json base_json(const base::Snapshot& s, base::Time now) {
  Json out = {{"state", nullptr},        {"control_mode", nullptr}, {"error_code", nullptr},
              {"errors", Json::array()}, {"speed_mps", nullptr},    {"yaw_rate_dps", nullptr}};
  set_age(out, stamp_of(s.base), now, StaleAfter::kBase_s);
  if (s.base) {
    out["state"] = base::to_string(s.base->vehicle_state);
    out["control_mode"] = base::to_string(s.base->control_mode);
    out["error_code"] = s.base->error_code;
    out["errors"] = s.base->errors;
  }
  const bool moves = s.motion && base::seconds(now - s.motion->stamp) <= StaleAfter::kBase_s;
  if (moves) {  // its age is not told beside the state's
    out["speed_mps"] = rounded(s.motion->twist.linear_mps, kPlaces3);
    out["yaw_rate_dps"] = degrees(s.motion->twist.angular_radps);
  }
  return out;
}

/// Voltage from the battery's own message, else from the base's status.
Json battery_json(const base::Snapshot& s, base::Time now) {
  Json out = {{"battery_v", nullptr},
              {"charge_pct", nullptr},
              {"current_a", nullptr},
              {"temperature_c", nullptr},
              {"fault", s.base ? Json(s.base->battery_fault) : Json(nullptr)}};
  std::optional<base::Time> stamp = stamp_of(s.base);
  if (s.base && s.base->battery_v) out["battery_v"] = rounded(*s.base->battery_v, kPlaces2);
  if (s.battery) {
    stamp = s.battery->stamp;
    out["battery_v"] = rounded(s.battery->voltage_v, kPlaces2);
    out["charge_pct"] = rounded(s.battery->charge_pct, kPlaces2);
    out["current_a"] = rounded(s.battery->current_a, kPlaces2);
    out["temperature_c"] = rounded(s.battery->temperature_c, kPlaces2);
  }
  set_age(out, stamp, now, StaleAfter::kBattery_s);
  return out;
}

Json rc_json(const base::Snapshot& s, base::Time now) {
  Json out = {{"lost", s.base ? Json(s.base->radio_lost) : Json(nullptr)}};
  for (const char* name :
       {"swa", "swb", "swc", "swd", "right_lr", "right_ud", "left_ud", "left_lr", "vra"}) {
    out[name] = nullptr;
  }
  set_age(out, stamp_of(s.radio), now, StaleAfter::kRc_s);
  const auto words = [](std::string_view text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  const base::RadioMeaning& m = s.radio_meaning;
  out["meaning"] = {{"swa", words(m.swa)},
                    {"swb", words(m.swb)},
                    {"swc", words(m.swc)},
                    {"swd", words(m.swd)},
                    {"vra", words(m.vra)}};
  if (!s.radio) return out;
  const base::RadioState& r = *s.radio;
  out["swa"] = base::to_string(r.swa);
  out["swb"] = base::to_string(r.swb);
  out["swc"] = base::to_string(r.swc);
  out["swd"] = base::to_string(r.swd);
  out["right_lr"] = rounded(r.right_lr, kPlaces2);
  out["right_ud"] = rounded(r.right_ud, kPlaces2);
  out["left_ud"] = rounded(r.left_ud, kPlaces2);
  out["left_lr"] = rounded(r.left_lr, kPlaces2);
  out["vra"] = rounded(r.vra, kPlaces2);
  return out;
}

Json lead_json(const std::optional<base::Lead>& lead) {
  if (!lead) return nullptr;
  const char* source = lead->scan && lead->vision ? "both"
                       : lead->scan               ? "scan"
                       : lead->vision             ? "vision"
                                                  : nullptr;
  return {{"what", lead->what},
          {"source", source != nullptr ? Json(source) : Json(nullptr)},
          {"by", lead->by}};
}

/// @param id_word "id" in the vehicle's state, "mission_id" under /execution.
Json progress_json(const base::MissionProgress& p, const char* id_word) {
  const bool none = p.mission_id.empty();
  return {{id_word, none ? Json(nullptr) : Json(p.mission_id)},
          {"revision", none ? Json(nullptr) : Json(p.revision)},
          {"name", none ? Json(nullptr) : Json(p.name)},
          {"state", base::to_string(p.state)},
          {"reason", p.reason},
          {"lead", lead_json(p.lead)},
          {"waits_for_word", p.waits_for_word},
          {"current_item", p.current_item ? Json(*p.current_item) : Json(nullptr)},
          {"items", p.items},
          {"distance_to_item_m", rounded(p.distance_to_item_m, kPlaces3)},
          {"bearing_to_item_deg", rounded(p.bearing_to_item_deg, kPlaces2)},
          {"cross_track_m", rounded(p.cross_track_m, kPlaces3)},
          {"arrival_radius_m", rounded(p.arrival_radius_m, kPlaces3)},
          {"cross_track_limit_m", rounded(p.cross_track_limit_m, kPlaces3)},
          {"distance_left_m", rounded(p.distance_left_m, kPlaces3)},
          {"eta_s", rounded(p.eta_s, kPlaces2)}};
}

Json point_json(const std::optional<base::LatLon>& at) {
  if (!at) return nullptr;
  Json out;
  set_position(out, at);
  return out;
}

Json activity_json(const base::Activity& a) {
  return {{"id", a.id},
          {"kind", a.kind.empty() ? Json(nullptr) : Json(a.kind)},
          {"state", base::to_string(a.state)},
          {"reason", a.reason},
          {"goal", point_json(a.goal)},
          {"goal_heading_deg", a.goal_yaw_rad ? heading_json(*a.goal_yaw_rad) : Json(nullptr)},
          {"distance_m", rounded(a.distance_m, kPlaces3)},
          {"tag", a.tag ? Json(*a.tag) : Json(nullptr)},
          // Compass turns count clockwise.
          {"turn_deg", a.turn_rad ? degrees(-*a.turn_rad) : Json(nullptr)},
          {"radius_m", rounded(a.radius_m, kPlaces3)},
          {"turns", rounded(a.turns, kPlaces3)},
          {"clockwise", a.clockwise ? Json(*a.clockwise) : Json(nullptr)},
          {"target", point_json(a.target)},
          {"target_age_s", rounded(a.target_age_s, kPlaces2)}};
}

Json fence_json(const std::optional<base::FenceState>& fence) {
  if (!fence) return nullptr;
  return {{"name", fence->name},
          {"inside", fence->inside},
          {"distance_m", rounded(fence->distance_m, kPlaces2)}};
}

/// Pieces of points [lat, lon, age_s]; to a millimetre, for drawing.
Json track_json(const services::Track& track, base::Time now) {
  Json pieces = Json::array();
  for (const services::Track::Point& p : track.points()) {
    if (p.begins) pieces.push_back(Json::array());
    const double age_s = std::max(0.0, base::seconds(now - p.stamp));
    pieces.back().push_back(
        {rounded(p.at.lat, kPlaces8), rounded(p.at.lon, kPlaces8), rounded(age_s, kPlaces2)});
  }
  return pieces;
}

Json loop_json(const base::LoopHealth& loop) {
  return {{"ticks", loop.ticks}, {"late_ticks", loop.late_ticks}, {"faults", loop.faults}};
}

}  // namespace

Json vehicle_json(const base::Snapshot& s, const std::string& name, base::Time now) {
  Json safety = Json::array();
  for (const auto& condition : s.safety) {
    safety.push_back({{"id", condition.id}, {"detail", condition.detail}});
  }
  Json place = place_json(s.place, now);
  return {{"name", name},
          {"time", base::to_rfc3339(s.wall)},
          {"mono_s", mono_s(now)},
          {"mode", base::to_string(s.mode)},
          {"armed", s.armed},
          {"armed_by_hand", s.armed_by_hand},
          {"estop", s.estop},
          {"control", base::to_string(s.control)},
          {"teleop",
           {{"state", base::to_string(s.teleop.phase)},
            {"reason", s.teleop.reason},
            {"delay_s", rounded(s.teleop.delay_s, kPlaces3)},
            {"auto_share", rounded(s.teleop.auto_share, kPlaces3)}}},
          {"speed_reason", s.speed_reason},
          {"command",
           {{"speed_mps", rounded(s.command.twist.linear_mps, kPlaces3)},
            {"yaw_rate_dps", degrees(s.command.twist.angular_radps)}}},
          {"position", position_json(s.pose, now)},
          {"localisation", localisation_json(s, place)},
          {"place", std::move(place)},
          {"attitude", attitude_json(s.attitude, now)},
          {"gnss", gnss_json(s, now)},
          {"base", base_json(s, now)},
          {"battery", battery_json(s, now)},
          {"rc", rc_json(s, now)},
          {"mission", progress_json(s.mission, "id")},
          {"activity", activity_json(s.activity)},
          {"fence", fence_json(s.fence)},
          {"detour", detour_json(s)},
          {"obstacle", obstacle_json(s.obstacle, now)},
          {"row", row_json(s.row)},
          {"safety", std::move(safety)},
          {"home", point_json(s.home)},
          {"origin", point_json(s.frame ? std::optional(s.frame->origin()) : std::nullopt)},
          // A compass that reads too far clockwise has a smaller yaw than the truth.
          {"compass_bias_deg", s.pose ? degrees(-s.estimator.compass_bias_rad) : Json(nullptr)},
          {"pull_1pm", s.pose ? rounded(s.estimator.pull_1pm, 1e4) : Json(nullptr)},
          {"estimator", estimator_json(s)},
          {"learned", learned_json(s.learned)},
          {"ready_to_arm", s.ready_to_arm},
          {"loop", loop_json(s.loop)}};
}

Json trail_json(const services::Trail& trail, const base::Snapshot& s) {
  return {{"time", base::to_rfc3339(s.wall)},
          {"estimated", track_json(trail.estimated(), s.now)},
          {"received", track_json(trail.received(), s.now)}};
}

Json checks_json(const base::Snapshot& s) {
  Json checks = Json::array();
  for (const auto& check : s.checks) {
    checks.push_back({{"id", check.id},
                      {"ok", check.ok},
                      {"severity", base::to_string(check.severity)},
                      {"detail", check.detail}});
  }
  return {{"ready", s.ready_to_arm}, {"checks", std::move(checks)}};
}

Json execution_json(const base::MissionProgress& progress,
                    const std::optional<store::StoredPlace>& offer) {
  Json out = progress_json(progress, "mission_id");
  out["left_behind"] = nullptr;
  if (!offer) return out;
  out["left_behind"] = {{"mission_id", offer->mission_id},
                        {"revision", offer->revision},
                        {"name", offer->name},
                        {"item", offer->item ? Json(*offer->item) : Json(nullptr)},
                        {"items", offer->items},
                        {"time", base::to_rfc3339(offer->time)}};
  return out;
}

Json way_home_json(const robot::WayHomePreview& p) {
  Json line = Json::array();
  for (const base::LatLon& at : p.line) line.push_back(point_json(at));
  return {{"target", point_json(p.target)},
          {"target_is", p.end.empty() ? Json(nullptr) : Json(p.end)},
          {"distance_m", rounded(p.distance_m, kPlaces3)},
          {"line", std::move(line)},
          {"possible", p.possible},
          {"reason", p.reason}};
}

Json smoothed_json(const std::vector<robot::SmoothedItems>& stretches) {
  Json out = Json::array();
  for (const robot::SmoothedItems& s : stretches) {
    out.push_back({{"first_item", s.first},
                   {"last_item", s.last},
                   {"deviation_m", rounded(s.deviation_m, kPlaces3)}});
  }
  return out;
}

namespace {

Json pace_json(const robot::WayPace& pace) {
  Json out = point_json(pace.at);
  out["distance_m"] = rounded(pace.distance_m, kPlaces3);
  out["speed_mps"] = rounded(pace.speed_mps, kPlaces3);
  out["set_mps"] = rounded(pace.set_mps, kPlaces3);
  out["item"] = pace.item;
  out["reverse"] = pace.reverse;
  return out;
}

Json way_stop_json(const robot::WayStop& stop) {
  Json out = point_json(stop.at);
  out["distance_m"] = rounded(stop.distance_m, kPlaces3);
  out["item"] = stop.item;
  Json turns = Json::array();
  for (const robot::WayTurn& turn : stop.turns) {
    const auto& from = turn.from_yaw_rad;
    const double turn_deg = -base::deg_from_rad(turn.by_rad);
    turns.push_back({{"from_heading_deg", from ? heading_json(*from) : Json(nullptr)},
                     {"to_heading_deg", heading_json(turn.to_yaw_rad)},
                     {"turn_deg", from ? rounded(turn_deg, kPlaces2) : Json(nullptr)},
                     {"above_deg", rounded(base::deg_from_rad(turn.above_rad), kPlaces2)}});
  }
  out["turns"] = std::move(turns);
  return out;
}

}  // namespace

Json mission_way_json(const robot::MissionWay& way) {
  Json line = Json::array();
  for (const base::LatLon& at : way.line) line.push_back(point_json(at));
  Json pace = Json::array();
  for (const robot::WayPace& each : way.pace) pace.push_back(pace_json(each));
  Json stops = Json::array();
  for (const robot::WayStop& each : way.stops) stops.push_back(way_stop_json(each));
  return {{"mission_id", way.mission_id},
          {"revision", way.revision},
          {"length_m", rounded(way.length_m, kPlaces3)},
          {"within_m", way.within_m},
          {"line", std::move(line)},
          {"pace", std::move(pace)},
          {"stops", std::move(stops)},
          {"stops_left_out", way.stops_left_out}};
}

Json preview_json(const robot::Preview& p, base::ExecutionState state) {
  return {{"smoothed", smoothed_json(p.smoothed)},
          {"mission_id", p.mission_id},
          {"revision", p.revision},
          {"name", p.name},
          {"first_item", p.first_item},
          {"first_target", point_json(p.first_target)},
          {"joins_after_m", rounded(p.joins_after_m, kPlaces3)},
          {"left_out", p.left_out},
          {"distance_m", rounded(p.distance_m, kPlaces3)},
          {"bearing_deg", rounded(p.bearing_deg, kPlaces2)},
          {"speed_mps", rounded(p.speed_mps, kPlaces3)},
          {"at_end", mission::to_string(p.at_end)},
          {"state", base::to_string(state)}};
}

}  // namespace roverd::api
