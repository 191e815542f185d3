#include "api/json/teach_words.hpp"

#include "api/json/measured.hpp"

namespace roverd::api {

Json teach_brief_json(const services::TeachView& teach) {
  return {{"state", services::to_string(teach.state)},
          {"points", teach.points},
          {"length_m", rounded(teach.length_m, 1e2)}};
}

Json teach_json(const services::TeachView& teach) {
  Json out = teach_brief_json(teach);
  const bool none = teach.state == services::TeachState::Idle;
  out["name"] = none ? Json(nullptr) : Json(teach.name);
  out["started"] = none ? Json(nullptr) : Json(base::to_rfc3339(teach.started));
  out["gaps"] = teach.gaps;
  out["unsaved_points"] = teach.unsaved_points;
  out["waiting"] = teach.waiting.empty() ? Json(nullptr) : Json(teach.waiting);
  const mission::TeachSettings& s = teach.settings;
  out["settings"] = {{"step_m", s.step_m},
                     {"heading_deg", s.heading_deg},
                     {"tolerance_m", s.tolerance_m},
                     {"sigma_max_m", s.sigma_max_m}};
  return out;
}

}  // namespace roverd::api
