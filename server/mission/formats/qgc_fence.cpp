#include "mission/formats/qgc_fence.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mission/formats/track_points.hpp"

namespace roverd::mission {

namespace {

using nlohmann::json;

const json* section_list(const json& root, const char* section, const char* list) {
  const auto part = root.find(section);
  if (part == root.end() || !part->is_object()) return nullptr;
  const auto at = part->find(list);
  return at == part->end() || !at->is_array() ? nullptr : &*at;
}

/// [latitude, longitude, …]
std::optional<base::LatLon> position_in(const json& value) {
  if (!value.is_array() || value.size() < 2 || !value[0].is_number() || !value[1].is_number()) {
    return std::nullopt;
  }
  return base::LatLon{value[0].get<double>(), value[1].get<double>()};
}

class FenceSections {
 public:
  FenceSections(const json& root, std::vector<FileRow>& rows, Problems& problems)
      : root_(root), rows_(rows), problems_(problems) {}

  std::optional<Fence> read() {
    known_versions();
    each("geoFence", "polygons", [this](const json& value, const std::string& where) {
      FencePolygon polygon;
      const auto corners = value.is_object() ? value.find("polygon") : value.end();
      if (!value.is_object() || corners == value.end() || !corners->is_array()) {
        return problems_.add(where + "/polygon", "must be a list of corners");
      }
      for (std::size_t i = 0; i < corners->size(); ++i) {
        const auto at = position_in((*corners)[i]);
        if (!at) {
          return problems_.add(where + "/polygon/" + std::to_string(i),
                               "must be latitude and longitude");
        }
        polygon.points.push_back(*at);
      }
      // Some programs close the figure.
      if (polygon.points.size() > 3 && polygon.points.front() == polygon.points.back()) {
        polygon.points.pop_back();
      }
      area(value, std::move(polygon), where, "geofence polygon");
    });
    each("geoFence", "circles", [this](const json& value, const std::string& where) {
      const auto circle = value.is_object() ? value.find("circle") : value.end();
      if (!value.is_object() || circle == value.end() || !circle->is_object()) {
        return problems_.add(where + "/circle", "must be an object");
      }
      const auto center = position_in(circle->value("center", json()));
      const json radius = circle->value("radius", json());
      if (!center) return problems_.add(where + "/circle/center", "must be latitude and longitude");
      if (!radius.is_number()) return problems_.add(where + "/circle/radius", "must be a number");
      area(value, FenceCircle{*center, radius.get<double>()}, where, "geofence circle");
    });
    each("rallyPoints", "points", [this](const json& value, const std::string& where) {
      const auto at = position_in(value);
      if (!at) return problems_.add(where, "must be latitude, longitude and altitude");
      RallyPoint point{*at, std::nullopt};
      if (value.size() > 2 && value[2].is_number()) point.alt_m = value[2].get<double>();
      if (takes({"fence", {}, {point}}, where)) {
        fence_.rally.push_back(point);
        rows_.push_back({where, "rally point", Outcome::Taken, {}, std::nullopt});
      }
    });
    breach_return();
    if (fence_.areas.empty() && fence_.rally.empty()) return std::nullopt;
    return std::move(fence_);
  }

 private:
  /// Of both sections there is version 2. QGroundControl passes over version 1, which had other
  /// members, and so do we, in words.
  void known_versions() {
    for (const char* section : {"geoFence", "rallyPoints"}) {
      const auto part = root_.find(section);
      if (part == root_.end() || !part->is_object()) continue;
      const auto version = part->find("version");
      if (version == part->end() || *version == 2) continue;
      const std::string where = "/" + std::string(section);
      if (*version != 1) {
        problems_.add(where + "/version", "must be 2");
      } else if (part->size() > 1) {
        rows_.push_back({where, section, Outcome::LeftOut,
                         "is of version 1: only version 2 can be read", std::nullopt});
      }
      skipped_.emplace_back(section);
    }
  }

  bool is_skipped(const char* section) const {
    return std::find(skipped_.begin(), skipped_.end(), section) != skipped_.end();
  }

  template <class F>
  void each(const char* section, const char* list, F one) {
    if (is_skipped(section)) return;
    const json* found = section_list(root_, section, list);
    if (found == nullptr) return;
    const std::string where = "/" + std::string(section) + "/" + list;
    if (found->size() > kMaxAreas) {
      return problems_.add(where,
                           "has " + std::to_string(found->size()) + ", at most 100 are possible");
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
      one((*found)[i], where + "/" + std::to_string(i));
    }
  }

  template <class Shape>
  void area(const json& value, Shape shape, const std::string& where, const char* what) {
    const auto inclusion = value.find("inclusion");
    if (inclusion != value.end() && !inclusion->is_boolean()) {
      return problems_.add(where + "/inclusion", "must be true or false");
    }
    const bool in = inclusion == value.end() || inclusion->get<bool>();
    FenceArea made{in ? AreaKind::Inclusion : AreaKind::Exclusion, std::move(shape)};
    if (!takes({"fence", {made}, {}}, where)) return;
    fence_.areas.push_back(std::move(made));
    rows_.push_back({where, what, Outcome::Taken, {}, std::nullopt});
    if (in && inclusions_++ > 0) {
      change_row(rows_.back(),
                 "it is enough to be inside any one inclusion here, where others may demand all");
    }
  }

  /// One alone is what a fence may have? Its problems are told by the place in the file.
  bool takes(const Fence& alone, const std::string& where) {
    const auto fine = check_fence(alone);
    if (!fine)
      problems_.add(
          where, fine.error().fields.empty() ? fine.error().detail : fine.error().fields[0].detail);
    return fine.has_value();
  }

  void breach_return() {
    const auto part = root_.find("geoFence");
    if (part == root_.end() || !part->is_object() || !part->contains("breachReturn")) return;
    if (is_skipped("geoFence")) return;
    rows_.push_back({"/geoFence/breachReturn", "breach return point", Outcome::LeftOut,
                     "the robot stops at a fence; rally points are where it can be sent",
                     std::nullopt});
  }

  const json& root_;
  std::vector<FileRow>& rows_;
  Problems& problems_;
  std::vector<std::string> skipped_;  ///< sections of an old version
  int inclusions_ = 0;
  Fence fence_;
};

}  // namespace

std::optional<Fence> fence_in_plan(const json& root, std::vector<FileRow>& rows,
                                   Problems& problems) {
  return FenceSections(root, rows, problems).read();
}

json geo_fence_json(const Fence* fence) {
  json circles = json::array();
  json polygons = json::array();
  for (std::size_t i = 0; fence != nullptr && i < fence->areas.size(); ++i) {
    const FenceArea& area = fence->areas[i];
    const bool in = area.kind == AreaKind::Inclusion;
    if (const auto* circle = std::get_if<FenceCircle>(&area.shape)) {
      circles.push_back(
          {{"circle",
            {{"center", {circle->center.lat, circle->center.lon}}, {"radius", circle->radius_m}}},
           {"inclusion", in},
           {"version", 1}});
      continue;
    }
    json corners = json::array();
    for (const base::LatLon at : std::get<FencePolygon>(area.shape).points) {
      corners.push_back({at.lat, at.lon});
    }
    polygons.push_back({{"polygon", std::move(corners)}, {"inclusion", in}, {"version", 1}});
  }
  return {{"version", 2}, {"circles", std::move(circles)}, {"polygons", std::move(polygons)}};
}

json rally_points_json(const Fence* fence) {
  json points = json::array();
  for (std::size_t i = 0; fence != nullptr && i < fence->rally.size(); ++i) {
    const RallyPoint& point = fence->rally[i];
    points.push_back({point.at.lat, point.at.lon, point.alt_m.value_or(0.0)});
  }
  return {{"version", 2}, {"points", std::move(points)}};
}

}  // namespace roverd::mission
