#include "api/json/map_words.hpp"

#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/time.hpp"

namespace roverd::api {

Json anchor_json(const std::optional<maps::Anchor>& anchor) {
  if (!anchor) return nullptr;
  return {{"lat", anchor->at.lat},
          {"lon", anchor->at.lon},
          {"heading_deg", anchor->heading_deg},
          {"accuracy_m", anchor->accuracy_m},
          {"heading_accuracy_deg", anchor->heading_accuracy_deg}};
}

Json map_json(const maps::About& a, const MapsNow& now, bool whole) {
  const bool configured = a.id == maps::kConfigured;
  const bool in_use = now.in_use == a.id;
  Json out = {{"id", a.id},
              {"name", a.name},
              {"created_at", configured ? Json(nullptr) : Json(base::to_rfc3339(a.created))},
              {"revision", a.revision},
              {"width", a.shape.columns},
              {"height", a.shape.rows},
              {"resolution_m", a.shape.resolution_m},
              {"origin",
               {{"x_m", a.shape.origin.x_m},
                {"y_m", a.shape.origin.y_m},
                {"yaw_deg", base::deg_from_rad(a.shape.origin.yaw_rad)}}},
              {"anchor", anchor_json(a.anchor)},
              {"placed", in_use ? anchor_json(now.placed) : Json(nullptr)},
              {"in_use", in_use},
              {"size_bytes", a.size_bytes},
              {"solid", a.solid},
              {"problem", a.problem.empty() ? Json(nullptr) : Json(a.problem)}};
  if (!whole) return out;
  Json& areas = out["forbidden"] = Json::array();
  for (const maps::Area& area : a.forbidden) {
    Json corners = Json::array();
    for (const maps::Corner& c : area) corners.push_back({{"x_m", c.x_m}, {"y_m", c.y_m}});
    areas.push_back(std::move(corners));
  }
  return out;
}

Json making_json(const std::optional<maps::Making>& making) {
  if (!making) return nullptr;
  return {{"scans", making->scans},
          {"clouds", making->clouds},
          {"way_m", std::round(making->way_m * 10.0) / 10.0},
          {"trouble", making->trouble.empty() ? Json(nullptr) : Json(making->trouble)}};
}

Json map_list_json(const std::vector<maps::About>& list, const MapsNow& now) {
  Json items = Json::array();
  for (const maps::About& about : list) items.push_back(map_json(about, now, false));
  return {{"items", std::move(items)},
          {"in_use", now.in_use ? Json(*now.in_use) : Json(nullptr)},
          {"from_configuration", now.in_use == maps::kConfigured},
          {"making", making_json(now.making)}};
}

}  // namespace roverd::api
