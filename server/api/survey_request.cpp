#include "api/survey_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "api/body.hpp"
#include "api/json/measured.hpp"
#include "base/angle.hpp"
#include "mission/text.hpp"

namespace roverd::api {
namespace {

using base::Error;
using base::LatLon;
using mission::FieldCorner;
using mission::SurveyPattern;
using mission::SurveyTurn;

constexpr std::size_t kMostComplaints = 100;

/// One of the words, or a complaint that lists them.
template <class E, std::size_t N>
E word_of(Members& members, const char* name, E usual,
          const std::array<std::pair<std::string_view, E>, N>& words) {
  const auto given = members.text(name);
  if (!given) return usual;
  std::string known = "must be one of";
  for (const auto& [word, value] : words) {
    if (word == *given) return value;
    known += ' ' + std::string(word);
  }
  members.complain(name, std::move(known));
  return usual;
}

constexpr std::array<std::pair<std::string_view, FieldCorner>, 4> kCorners{
    {{"south_west", FieldCorner::SouthWest},
     {"south_east", FieldCorner::SouthEast},
     {"north_west", FieldCorner::NorthWest},
     {"north_east", FieldCorner::NorthEast}}};

/// Reads rings of {lat, lon}, or of [lon, lat] as GeoJSON has them.
class PolygonReader {
 public:
  using Rings = std::vector<std::vector<LatLon>>;

  /// @param at where `rings` stands in the body
  base::Result<Rings> read(const Json& rings, const std::string& at, bool geojson) {
    Rings out;
    if (!rings.is_array()) add(at, "must be a list of rings");
    for (std::size_t r = 0; rings.is_array() && r < rings.size(); ++r) {
      const std::string ring_at = at + "/" + std::to_string(r);
      auto& ring = out.emplace_back();
      if (!rings[r].is_array()) add(ring_at, "must be a list of points");
      for (std::size_t i = 0; rings[r].is_array() && i < rings[r].size(); ++i) {
        const Json& point = rings[r][i];
        const auto p = geojson ? pair_of(point) : object_of(point);
        if (!p) {
          add(ring_at + "/" + std::to_string(i),
              geojson ? "must be [lon, lat], degrees" : "must be {lat, lon}, degrees");
        }
        ring.push_back(p.value_or(LatLon{}));
      }
    }
    if (errors_.empty()) return out;
    return base::fail(base::Code::Invalid, errors_[0].pointer + " " + errors_[0].detail, errors_);
  }

 private:
  void add(const std::string& at, const char* detail) {
    if (errors_.size() < kMostComplaints) errors_.push_back({at, detail});
  }
  static std::optional<LatLon> pair_of(const Json& p) {
    if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number()) return {};
    return LatLon{p[1].get<double>(), p[0].get<double>()};
  }
  static std::optional<LatLon> object_of(const Json& p) {
    const bool good = p.is_object() && p.size() == 2 && p.contains("lat") && p.contains("lon") &&
                      p["lat"].is_number() && p["lon"].is_number();
    if (!good) return {};
    return LatLon{p["lat"].get<double>(), p["lon"].get<double>()};
  }

  std::vector<base::FieldError> errors_;
};

class SurveyReader {
 public:
  SurveyReader(const Json& body, const SurveyFacts& facts) : members_(body), facts_(facts) {}

  base::Result<SurveyOrder> read() {
    auto& r = order_.request;
    read_polygon();
    members_.require("spacing_m");
    r.spacing_m = members_.number("spacing_m", 0.05, 1000.0).value_or(1.0);
    read_direction();
    r.pattern = word_of<SurveyPattern, 3>(members_, "pattern", SurveyPattern::Tracks,
                                          {{{"tracks", SurveyPattern::Tracks},
                                            {"perimeter", SurveyPattern::Perimeter},
                                            {"spiral", SurveyPattern::Spiral}}});
    r.turn = word_of<SurveyTurn, 2>(members_, "turn", SurveyTurn::Pivot,
                                    {{{"pivot", SurveyTurn::Pivot}, {"arc", SurveyTurn::Arc}}});
    const auto radius = members_.number("radius_m", 0.1, 100.0);
    if (r.turn == SurveyTurn::Arc) members_.require("radius_m");
    r.radius_m = radius.value_or(0.0);
    read_start();
    const int least = r.pattern == SurveyPattern::Perimeter ? 1 : 0;
    r.headland_passes = static_cast<int>(members_.whole("headland_passes", least, 100).value_or(1));
    r.border_m = members_.number("border_m", 0.0, 1000.0);
    r.overshoot_m = members_.number("overshoot_m", 0.0, 100.0).value_or(0.0);
    read_order();
    order_.speed_mps = members_.number("speed_mps", 0.05, 10.0);
    r.speed_mps = order_.speed_mps.value_or(facts_.speed_mps);
    r.turn_rate_radps = facts_.turn_rate_radps;
    order_.name = members_.text("name");
    if (order_.name) {
      if (auto problem = mission::name_problem(*order_.name); !problem.empty()) {
        members_.complain("name", std::move(problem));
      }
    }
    if (auto fine = members_.finish(); !fine) return tl::unexpected<Error>(fine.error());
    if (needs_vehicle_ && !facts_.vehicle) {
      return base::fail(base::Code::Conflict, "the vehicle's position is not known: give start");
    }
    return std::move(order_);
  }

 private:
  void read_polygon() {
    members_.require("polygon");
    const Json* polygon = members_.any("polygon");
    if (polygon == nullptr) return;
    const bool geojson = polygon->is_object();
    if (geojson &&
        (polygon->value("type", Json()) != "Polygon" || !polygon->contains("coordinates"))) {
      return members_.complain("polygon", "must be a list of rings or a GeoJSON Polygon");
    }
    auto rings = geojson ? PolygonReader().read(polygon->at("coordinates"), "/coordinates", true)
                         : PolygonReader().read(*polygon, "", false);
    if (!rings) return members_.complain_inside("polygon", rings.error());
    order_.request.rings = std::move(*rings);
  }

  void read_direction() {
    const Json* value = members_.any("direction_deg");
    if (value == nullptr || *value == "best") return;
    if (value->is_string()) {
      return members_.complain("direction_deg", "must be a number or \"best\"");
    }
    order_.request.direction_deg = members_.number("direction_deg", -360.0, 360.0);
  }

  void read_start() {
    const Json* value = members_.any("start");
    if (value == nullptr) return;
    if (value->is_object()) {
      Members point(*value);
      for (const char* name : {"lat", "lon"}) point.require(name);
      const auto lat = point.number("lat", -90.0, 90.0);
      const auto lon = point.number("lon", -180.0, 180.0);
      if (auto fine = point.finish(); !fine) {
        return members_.complain_inside("start", fine.error());
      }
      order_.request.start = LatLon{*lat, *lon};
      return;
    }
    if (*value == "vehicle") {
      needs_vehicle_ = true;
      order_.request.start = facts_.vehicle.value_or(LatLon{});
      return;
    }
    for (const auto& [word, corner] : kCorners) {
      if (*value != word) continue;
      order_.request.start = corner;
      return;
    }
    members_.complain("start",
                      "must be {lat, lon}, vehicle, south_west, south_east, north_west or "
                      "north_east");
  }

  void read_order() {
    auto& r = order_.request;
    const bool skips =
        word_of<bool, 2>(members_, "order", false, {{{"back_and_forth", false}, {"skip", true}}});
    const auto given = members_.whole("skip", 1, 50);
    if (!skips) {
      if (given) members_.complain("skip", "needs order \"skip\"");
      return;
    }
    // As wide as the arcs are.
    const double needed = std::ceil(2.0 * r.radius_m / r.spacing_m - 1e-9) - 1.0;
    r.skip =
        static_cast<int>(given.value_or(static_cast<std::int64_t>(std::clamp(needed, 1.0, 50.0))));
  }

  Members members_;
  const SurveyFacts& facts_;
  SurveyOrder order_;
  bool needs_vehicle_ = false;
};

}  // namespace

base::Result<SurveyOrder> read_survey(const Json& body, const SurveyFacts& facts) {
  return SurveyReader(body, facts).read();
}

Json survey_json(const mission::Survey& s) {
  constexpr double kPlaces4 = 1e4;
  return {{"direction_deg", rounded(s.direction_deg, kPlaces2)},
          {"length_m", rounded(s.length_m, kPlaces2)},
          {"time_s", rounded(s.time_s, 10.0)},
          {"field_m2", rounded(s.field_m2, kPlaces2)},
          {"reachable_share", rounded(s.reachable_share, kPlaces4)},
          {"covered_share", rounded(s.covered_share, kPlaces4)},
          {"tracks", s.tracks},
          {"cells", s.cells},
          {"tight_turns", s.tight_turns},
          {"notes", s.notes}};
}

}  // namespace roverd::api
