#include "api/json/run_words.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "api/json/plain_json.hpp"
#include "base/angle.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

Json places(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, digits);
  const double out = std::round(value * scale) / scale;
  return out == 0.0 ? 0.0 : out;
}

Json places(const std::optional<double>& value, int digits) {
  return value ? places(*value, digits) : Json(nullptr);
}

std::string number_text(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

base::WallTime time_of(const store::RunHead& run, const store::RunPoint& p) {
  return run.begun + base::from_seconds(p.t_s);
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20;
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (control) {
      out += ' ';
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

Json run_head_json(const store::RunHead& run) {
  return {{"id", run.id},
          {"begun", base::to_rfc3339(run.begun)},
          {"ended", run.ended ? Json(base::to_rfc3339(*run.ended)) : Json(nullptr)},
          {"outcome", store::to_string(run.outcome)},
          {"mission_id", run.mission_id},
          {"revision", run.revision},
          {"name", run.name},
          {"vehicle", run.vehicle},
          {"first_item", run.first_item}};
}

Json run_json(const store::StoredRun& run) {
  Json out = run_head_json(run.head);
  out["plan"] = mission::plan_to_json(run.plan);
  out["parameters"] = Json::object();
  for (const store::RunParameter& p : run.parameters) {
    out["parameters"][p.name] = std::visit([](const auto& v) { return Json(v); }, p.value);
  }
  out["events"] = Json::array();
  for (const base::Event& e : run.events) {
    out["events"].push_back({{"time", base::to_rfc3339(e.wall)},
                             {"level", base::to_string(e.level)},
                             {"kind", e.kind},
                             {"detail", e.detail}});
  }
  return out;
}

base::Result<robot::RunReport> report_of(const store::StoredRun& run,
                                         const std::vector<store::RunPoint>& points) {
  std::vector<robot::ReportPoint> track;
  track.reserve(points.size());
  for (const store::RunPoint& p : points) {
    track.push_back({p.t_s, p.at, p.yaw_rad, p.speed_mps, p.yaw_rate_radps, p.lap, p.by_itself,
                     p.power_w, p.item, p.cross_m});
  }
  std::vector<std::pair<std::string, base::ParamValue>> parameters;
  for (const store::RunParameter& p : run.parameters) parameters.emplace_back(p.name, p.value);
  return robot::report_run(run.plan, track, run.head.first_item, parameters);
}

Json report_json(const store::RunHead& run, const robot::RunReport& r) {
  const nav::RunMeasure& m = r.measure;
  // A figure is told where there is enough to tell it of.
  const auto of_way = [&r](double v, int digits) {
    return r.tells_way() ? places(v, digits) : Json(nullptr);
  };
  const auto of_corners = [&r](double v) {
    return r.tells_corners() ? places(v, 3) : Json(nullptr);
  };
  const auto of_straights = [&r](double v) {
    return r.tells_straights() ? places(v, 3) : Json(nullptr);
  };
  Json approach = nullptr;
  if (r.approach) {
    approach = {{"time_s", places(r.approach->time_s, 1)},
                {"driven_m", places(r.approach->driven_m, 2)}};
  }
  Json corners = Json::array();
  for (std::size_t i = 0; i < m.corners.size(); ++i) {
    const nav::CornerMeasure& c = m.corners[i];
    corners.push_back({{"item", r.corner_items[i]},
                       {"turn_deg", places(-base::deg_from_rad(c.deflection_rad), 1)},
                       {"distance_m", places(c.distance_m, 3)},
                       {"cut_m", places(c.inside_m, 3)},
                       {"overshoot_m", places(c.outside_m, 3)}});
  }
  Json straights = Json::array();
  for (std::size_t i = 0; i < m.straights.size(); ++i) {
    const nav::StraightMeasure& s = m.straights[i];
    straights.push_back({{"item", r.straight_items[i]},
                         {"length_m", places(s.to_m - s.from_m, 2)},
                         {"slalom_m", places(s.slalom_m, 3)}});
  }
  Json by_sight = Json::array();
  for (const robot::SightMeasure& s : r.by_sight) {
    const auto seen = [&s](double v) { return s.tells() ? places(v, 4) : Json(nullptr); };
    by_sight.push_back({{"item", s.item},
                        {"type", s.type},
                        {"driven_m", places(s.driven_m, 2)},
                        {"judged_m", places(s.judged_m, 2)},
                        {"rms_m", seen(s.cross.rms_m)},
                        {"mean_m", seen(s.cross.mean_m)},
                        {"p95_m", seen(s.cross.p95_m)},
                        {"max_m", seen(s.cross.max_m)}});
  }
  return {{"id", run.id},
          {"name", run.name},
          {"outcome", store::to_string(run.outcome)},
          {"time_s", places(r.time_s, 1)},
          {"driving_s", places(r.driving_s, 1)},
          {"driven_m", places(r.driven_m, 2)},
          {"energy_wh", places(r.energy_wh, 2)},
          {"laps", r.laps},
          {"approach", std::move(approach)},
          {"judged_m", places(m.driven_m, 2)},
          {"cross_track",
           {{"rms_m", of_way(m.cross.rms_m, 4)},
            {"mean_m", of_way(m.cross.mean_m, 4)},
            {"p95_m", of_way(m.cross.p95_m, 4)},
            {"max_m", of_way(m.cross.max_m, 4)}}},
          {"corner_mean_m", of_corners(m.corner_mean_m)},
          {"corner_max_m", of_corners(m.corner_max_m)},
          {"cut_max_m", of_corners(m.cut_max_m)},
          {"overshoot_max_m", of_corners(m.overshoot_max_m)},
          {"slalom_max_m", of_straights(m.slalom_max_m)},
          {"slalom_mean_m", of_straights(m.slalom_mean_m)},
          {"heading_rms_deg", of_way(base::deg_from_rad(m.heading_rms_rad), 2)},
          {"yaw_accel_rms_dps2", of_way(base::deg_from_rad(m.yaw_accel_rms_radps2), 2)},
          {"jerk_rms_mps3", of_way(m.jerk_rms_mps3, 3)},
          {"end_m", of_way(m.end_m, 3)},
          {"corners", std::move(corners)},
          {"straights", std::move(straights)},
          {"by_sight", std::move(by_sight)}};
}

std::string track_geojson(const store::RunHead& run, const std::vector<store::RunPoint>& points) {
  Json features = Json::array();
  int lap = 0;
  for (const store::RunPoint& p : points) {
    if (features.empty() || p.lap != lap) {
      lap = p.lap;
      features.push_back({{"type", "Feature"},
                          {"geometry", {{"type", "LineString"}, {"coordinates", Json::array()}}},
                          {"properties",
                           {{"run", run.id},
                            {"name", run.name},
                            {"lap", lap},
                            {"times", Json::array()},
                            {"heading_deg", Json::array()},
                            {"speed_mps", Json::array()},
                            {"cross_track_m", Json::array()}}}});
    }
    Json& feature = features.back();
    feature["geometry"]["coordinates"].push_back({places(p.at.lon, 9), places(p.at.lat, 9)});
    Json& values = feature["properties"];
    values["times"].push_back(base::to_rfc3339(time_of(run, p)));
    values["heading_deg"].push_back(places(base::heading_from_yaw(p.yaw_rad), 2));
    values["speed_mps"].push_back(places(p.speed_mps, 3));
    values["cross_track_m"].push_back(places(p.cross_m, 3));
  }
  return plain_json({{"type", "FeatureCollection"}, {"features", std::move(features)}});
}

std::string track_csv(const store::RunHead& run, const std::vector<store::RunPoint>& points) {
  std::string out =
      "time,t_s,lat,lon,heading_deg,speed_mps,yaw_rate_dps,accuracy_m,cross_track_m,item,lap,"
      "power_w,by_itself\n";
  for (const store::RunPoint& p : points) {
    out += base::to_rfc3339(time_of(run, p)) + ',' + number_text(p.t_s, 3) + ',' +
           number_text(p.at.lat, 9) + ',' + number_text(p.at.lon, 9) + ',' +
           number_text(base::heading_from_yaw(p.yaw_rad), 2) + ',' + number_text(p.speed_mps, 3) +
           ',' + number_text(base::deg_from_rad(p.yaw_rate_radps), 2) + ',' +
           number_text(p.sigma_m, 3) + ',' + (p.cross_m ? number_text(*p.cross_m, 3) : "") + ',' +
           (p.item ? std::to_string(*p.item) : "") + ',' + std::to_string(p.lap) + ',' +
           (p.power_w ? number_text(*p.power_w, 1) : "") + ',' + (p.by_itself ? "1" : "0") + '\n';
  }
  return out;
}

std::string track_gpx(const store::RunHead& run, const std::vector<store::RunPoint>& points) {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<gpx version=\"1.1\" creator=\"roverd\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      " <trk>\n  <name>" +
      xml_text(run.name) + "</name>\n";
  int lap = 0;
  for (const store::RunPoint& p : points) {
    if (p.lap != lap) {
      out += lap == 0 ? "  <trkseg>\n" : "  </trkseg>\n  <trkseg>\n";
      lap = p.lap;
    }
    out += "   <trkpt lat=\"" + number_text(p.at.lat, 9) + "\" lon=\"" + number_text(p.at.lon, 9) +
           "\"><time>" + base::to_rfc3339(time_of(run, p)) + "</time></trkpt>\n";
  }
  if (lap != 0) out += "  </trkseg>\n";
  return out + " </trk>\n</gpx>\n";
}

}  // namespace roverd::api
