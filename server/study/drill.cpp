// A drill's lines.

#include "study/drill.hpp"

#include <cmath>

#include "base/angle.hpp"

namespace roverd::study {
namespace {

using nlohmann::json;

constexpr int kDone = 0;
constexpr int kRefusedDrill = 2;

json or_null(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

json pose_json(const DrillPose& p) {
  return {{"lat", p.at.lat}, {"lon", p.at.lon}, {"heading_deg", p.heading_deg}};
}

std::string error_line(const base::Error& error) {
  json fields = json::array();
  for (const auto& f : error.fields)
    fields.push_back({{"pointer", f.pointer}, {"detail", f.detail}});
  return json{{"error", {{"detail", error.detail}, {"fields", fields}}}}.dump();
}

}  // namespace

std::string_view to_string(DrillEnd end) noexcept {
  switch (end) {
    case DrillEnd::Stands:
      return "stands";
    case DrillEnd::Finished:
      return "finished";
    case DrillEnd::Home:
      return "home";
    case DrillEnd::GoesOn:
      return "goes_on";
    case DrillEnd::NotPlayed:
      return "not_played";
  }
  return "";
}

json begins_json(const DrillOrder& order, const DrillPlace& place) {
  const base::LatLon at = place.frame.to_global(place.path.at(place.at_m));
  json failures = json::array();
  for (const auto id : failures_of(order)) failures.push_back(id);
  return {{"at_m", place.at_m},
          {"length_m", place.length_m},
          {"speed_mps", place.speed_mps},
          {"lat", at.lat},
          {"lon", at.lon},
          {"failures", std::move(failures)}};
}

json result_json(const DrillResult& r) {
  json out{{"failure", r.failure},
           {"title", base::drill_failure(r.failure)->title},
           {"end", to_string(r.end)},
           {"reason", r.reason}};
  if (r.end == DrillEnd::NotPlayed) return out;
  json said = json::array();
  for (const auto& c : r.said) said.push_back({{"id", c.id}, {"detail", c.detail}});
  json track = json::array();
  for (const auto& p : r.track) track.push_back({{"lat", p.lat}, {"lon", p.lon}});
  out.update({{"zero_s", or_null(r.zero_s)},
              {"stands_s", or_null(r.stands_s)},
              {"way_m", r.way_m},
              {"speed_mps", r.speed_mps},
              {"begins", pose_json(r.begins)},
              {"last", pose_json(r.last)},
              {"off_way_m", std::isfinite(r.off_way_m) ? json(r.off_way_m) : json(nullptr)},
              {"fence_distance_m", or_null(r.fence_m)},
              {"inside_fence", r.fence_m ? json(*r.fence_m > 0.0) : json(nullptr)},
              {"mode", r.mode.empty() ? json(nullptr) : json(r.mode)},
              {"armed", r.mode.empty() ? json(nullptr) : json(r.armed)},
              {"estop", r.mode.empty() ? json(nullptr) : json(r.estop)},
              {"said", std::move(said)},
              {"track", std::move(track)}});
  return out;
}

int drill(std::string_view text, const std::function<void(const std::string&)>& tell) {
  const auto refuse = [&tell](const base::Error& error) {
    tell(error_line(error));
    return kRefusedDrill;
  };
  const auto order = read_drill(text);
  if (!order) return refuse(order.error());
  const auto place = place_of(*order);
  if (!place) return refuse(place.error());
  tell(json{{"begins", begins_json(*order, *place)}}.dump());
  for (const std::string_view failure : failures_of(*order)) {
    const auto result = play(*order, *place, failure);
    if (!result) return refuse(result.error());
    tell(json{{"result", result_json(*result)}}.dump());
  }
  return kDone;
}

}  // namespace roverd::study
