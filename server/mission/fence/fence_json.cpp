#include "mission/fence/fence_json.hpp"

#include <utility>

#include "mission/json/json.hpp"
#include "mission/json/object.hpp"

namespace roverd::mission {

template <>
inline constexpr std::array kWordsOf<AreaKind>{AreaKind::Inclusion, AreaKind::Exclusion};

namespace {

using base::Error;
using base::Result;
using nlohmann::json;

// Ranges are left to check_fence, so that a value made in memory meets the same.
constexpr Range kAnyNumber{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};

class FenceReader {
 public:
  Result<Fence> read(const json& value) {
    if (!value.is_object()) {
      problems_.add("", "must be an object");
      return tl::unexpected<Error>(std::move(problems_).error("the fence"));
    }
    Members reader(value, Place{}, problems_);
    reader.name("name", fence_.name);
    each(reader, "areas", kMaxAreas,
         [this](const json& one, const std::string& where) { area(one, where); });
    each(reader, "rally", kMaxRally,
         [this](const json& one, const std::string& where) { rally(one, where); });
    reader.refuse_unknown();
    if (!problems_.none()) return tl::unexpected<Error>(std::move(problems_).error("the fence"));
    if (auto fine = check_fence(fence_); !fine) return tl::unexpected<Error>(fine.error());
    return std::move(fence_);
  }

 private:
  /// Calls `one` for each element. More than can be are left to check_fence to count.
  template <class F>
  void each(Members& reader, const char* name, std::size_t most, F one) {
    const json* list = reader.known(name);
    if (list == nullptr || list->is_null()) return;
    if (!list->is_array()) return reader.complain(name, "must be a list");
    if (list->size() > most) {
      return reader.complain(name, "has " + std::to_string(list->size()) + ", at most " +
                                       std::to_string(most) + " are possible");
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      one((*list)[i], "/" + std::string(name) + "/" + std::to_string(i));
    }
  }

  bool object(const json& value, const std::string& where) {
    if (value.is_object()) return true;
    problems_.add(where, "must be an object");
    return false;
  }

  void area(const json& value, const std::string& where) {
    if (!object(value, where)) return;
    FenceArea& made = fence_.areas.emplace_back();
    Members reader(value, Place{where}, problems_);
    reader.word("kind", made.kind);
    const json* polygon = reader.known("polygon");
    const json* circle = reader.known("circle");
    if ((polygon == nullptr) == (circle == nullptr)) {
      reader.complain("polygon", polygon == nullptr ? "or circle is required"
                                                    : "and circle exclude each other");
    } else if (circle != nullptr) {
      made.shape = circle_in(*circle, where + "/circle");
    } else if (!polygon->is_array()) {
      reader.complain("polygon", "must be a list of corners {lat, lon}");
    } else if (polygon->size() > kMaxFencePoints) {
      reader.complain("polygon", "has more than 10000 corners");
    } else {
      FencePolygon& corners = std::get<FencePolygon>(made.shape);
      corners.points.reserve(polygon->size());
      for (std::size_t i = 0; i < polygon->size(); ++i) {
        const std::string corner = where + "/polygon/" + std::to_string(i);
        corners.points.push_back(corner_in((*polygon)[i], corner));
      }
    }
    reader.refuse_unknown();
  }

  FenceCircle circle_in(const json& value, const std::string& where) {
    FenceCircle out;
    if (!object(value, where)) return out;
    Members reader(value, Place{where}, problems_);
    reader.number("lat", out.center.lat, kAnyNumber);
    reader.number("lon", out.center.lon, kAnyNumber);
    reader.number("radius_m", out.radius_m, kAnyNumber);
    reader.refuse_unknown();
    return out;
  }

  base::LatLon corner_in(const json& value, const std::string& where) {
    base::LatLon out;
    if (!object(value, where)) return out;
    Members reader(value, Place{where}, problems_);
    reader.number("lat", out.lat, kAnyNumber);
    reader.number("lon", out.lon, kAnyNumber);
    reader.refuse_unknown();
    return out;
  }

  void rally(const json& value, const std::string& where) {
    if (!object(value, where)) return;
    RallyPoint& made = fence_.rally.emplace_back();
    Members reader(value, Place{where}, problems_);
    reader.number("lat", made.at.lat, kAnyNumber);
    reader.number("lon", made.at.lon, kAnyNumber);
    reader.number("alt_m", made.alt_m, kAnyNumber);
    reader.refuse_unknown();
  }

  Fence fence_;
  Problems problems_;
};

json position_json(base::LatLon at) {
  return {{"lat", at.lat}, {"lon", at.lon}};
}

}  // namespace

Result<Fence> fence_from_json(const json& value) {
  return FenceReader().read(value);
}

Result<Fence> fence_from_text(std::string_view text) {
  auto value = parse_json(text);
  if (!value) return tl::unexpected<Error>(std::move(value).error());
  return fence_from_json(*value);
}

json fence_to_json(const Fence& fence) {
  json areas = json::array();
  for (const FenceArea& area : fence.areas) {
    json one{{"kind", to_string(area.kind)}};
    if (const auto* circle = std::get_if<FenceCircle>(&area.shape)) {
      one["circle"] = position_json(circle->center);
      one["circle"]["radius_m"] = circle->radius_m;
    } else {
      json& corners = one["polygon"] = json::array();
      for (const base::LatLon at : std::get<FencePolygon>(area.shape).points) {
        corners.push_back(position_json(at));
      }
    }
    areas.push_back(std::move(one));
  }
  json rally = json::array();
  for (const RallyPoint& point : fence.rally) {
    rally.push_back(position_json(point.at));
    if (point.alt_m) rally.back()["alt_m"] = *point.alt_m;
  }
  return {{"name", fence.name}, {"areas", std::move(areas)}, {"rally", std::move(rally)}};
}

std::string_view to_string(AreaKind kind) noexcept {
  switch (kind) {
    case AreaKind::Inclusion:
      return "inclusion";
    case AreaKind::Exclusion:
      return "exclusion";
  }
  return "inclusion";
}

}  // namespace roverd::mission
