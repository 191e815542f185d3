// What is seen of landmarks, walls, and by cameras, in JSON.

#include <algorithm>

#include "api/json/measured.hpp"
#include "api/json/words.hpp"

namespace roverd::api {
namespace {

using robot::Outlook;

Json millimetres(double m) {
  return rounded(m, kPlaces3);
}

/// Of one of them now. @param more since the outlook was made
Json aged(double age_s, double more_s) {
  return rounded(std::max(0.0, age_s + more_s), kPlaces2);
}

const char* source_of(const Outlook::Mark& m) noexcept {
  if (m.by_scan && m.by_vision) return "both";
  return m.by_vision ? "vision" : "scan";
}

Json mark_json(const Outlook::Mark& m, double more_s) {
  return {{"id", m.id},
          {"name", m.name.empty() ? Json() : Json(m.name)},
          {"ahead_m", millimetres(m.ahead_m)},
          {"left_m", millimetres(m.left_m)},
          {"sigma_m", millimetres(m.sigma_m)},
          {"radius_m", m.radius_m > 0.0 ? Json(millimetres(m.radius_m)) : Json()},
          {"source", source_of(m)},
          {"believed", m.believed},
          {"age_s", aged(m.age_s, more_s)}};
}

Json wall_json(const Outlook::Wall& w, double more_s) {
  const auto end = [](double ahead_m, double left_m) -> Json {
    return {{"ahead_m", millimetres(ahead_m)}, {"left_m", millimetres(left_m)}};
  };
  return {{"id", w.id},
          {"source", w.by_vision ? "vision" : "scan"},
          {"believed", w.believed},
          {"distance_m", millimetres(w.distance_m)},
          {"from", end(w.from_ahead_m, w.from_left_m)},
          {"to", end(w.to_ahead_m, w.to_left_m)},
          {"sigma_m", millimetres(w.sigma_m)},
          {"age_s", aged(w.age_s, more_s)}};
}

Json spot_json(const Outlook::CameraSpot& p, double more_s) {
  return {{"sensor", p.sensor},
          {"ahead_m", millimetres(p.ahead_m)},
          {"left_m", millimetres(p.left_m)},
          {"up_m", millimetres(p.up_m)},
          {"age_s", aged(p.age_s, more_s)}};
}

Json plane_json(const Outlook::CameraPlane& p, double more_s) {
  Json out = spot_json(p.centre, more_s);
  out["normal"] = {{"ahead", millimetres(p.normal_ahead)},
                   {"left", millimetres(p.normal_left)},
                   {"up", millimetres(p.normal_up)}};
  out["size"] = p.size;
  return out;
}

/// Clockwise positive, as all turns here.
Json tag_json(const base::TagState& t, base::Time now) {
  return {{"id", t.id},
          {"ahead_m", millimetres(t.ahead_m)},
          {"left_m", millimetres(t.left_m)},
          {"sigma_m", millimetres(t.sigma_m)},
          {"turn_deg", t.yaw_rad ? degrees(-*t.yaw_rad) : Json(nullptr)},
          {"turn_sigma_deg", t.yaw_sigma_rad ? degrees(*t.yaw_sigma_rad) : Json(nullptr)},
          {"camera", t.camera},
          {"sights", t.sights},
          {"age_s", aged(base::seconds(now - t.seen_at), 0.0)}};
}

}  // namespace

Json landmarks_json(const Outlook* seen, const base::Snapshot& s, base::Time now) {
  Json tags = Json::array();
  if (s.tags) {
    for (const base::TagState& t : *s.tags) tags.push_back(tag_json(t, now));
  }
  Json landmarks = Json::array();
  Json walls = Json::array();
  Json obstacles = Json::array();
  Json planes = Json::array();
  const double more_s = seen != nullptr ? base::seconds(now - seen->stamp) : 0.0;
  if (seen != nullptr) {
    for (const auto& m : seen->landmarks) landmarks.push_back(mark_json(m, more_s));
    for (const auto& w : seen->walls) walls.push_back(wall_json(w, more_s));
    for (const auto& p : seen->spots) obstacles.push_back(spot_json(p, more_s));
    for (const auto& p : seen->planes) planes.push_back(plane_json(p, more_s));
  }
  return {{"landmarks", std::move(landmarks)},
          {"walls", std::move(walls)},
          {"obstacles", std::move(obstacles)},
          {"planes", std::move(planes)},
          {"tags", std::move(tags)}};
}

}  // namespace roverd::api
