// What a fence may be.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/tangent_plane.hpp"
#include "mission/fence/fence.hpp"
#include "mission/fence/plane_lines.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

using base::Code;
using base::Error;
using base::LatLon;
using base::Result;

namespace {

/// Sides nearer than this touch.
constexpr double kTouch_m = 1e-5;
constexpr Range kFenceRadius_m{0.0, kMaxFenceRadius_m, true};

class AreaCheck {
 public:
  AreaCheck(std::string where, Problems& problems)
      : where_(std::move(where)), problems_(problems) {}

  void operator()(const FenceCircle& circle) {
    position("/circle", circle.center);
    number("/circle/radius_m", circle.radius_m, kFenceRadius_m);
  }

  void operator()(const FencePolygon& polygon) {
    const auto& points = polygon.points;
    if (points.size() < 3) {
      add("/polygon", "must have at least 3 corners, has " + std::to_string(points.size()));
    }
    bool fine = points.size() >= 3;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::string corner = "/polygon/" + std::to_string(i);
      fine = position(corner, points[i]) && fine;
    }
    if (fine && is_small(points)) check_figure(points);
  }

  bool position(const std::string& where, LatLon at) {
    const bool lat = number(where + "/lat", at.lat, kLat);
    return number(where + "/lon", at.lon, kLon) && lat;
  }

  bool number(const std::string& where, double value, const Range& range) {
    if (range.holds(value)) return true;
    add(where, range_problem(range, value));
    return false;
  }

 private:
  void add(const std::string& where, std::string detail) {
    problems_.add(where_ + where, std::move(detail));
  }

  bool is_small(const std::vector<LatLon>& points) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      // From the first corner to any other; two others can be twice as far apart.
      if (base::distance_bearing(points[0], points[i]).distance_m <= kMaxFenceSize_m) continue;
      add("/polygon/" + std::to_string(i), "lies more than 20 km from the first corner");
      return false;
    }
    return true;
  }

  void check_figure(const std::vector<LatLon>& points) {
    const base::TangentPlane plane(points.front());
    std::vector<EnuPoint> corners;
    corners.reserve(points.size());
    for (const LatLon at : points) corners.push_back(plane.to_local(at));
    bool fine = true;
    double twice_area_m2 = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const EnuPoint next = corners[(i + 1) % corners.size()];
      twice_area_m2 += cross(corners[i], next);
      if (base::distance_m(corners[i], next) > kTouch_m) continue;
      fine = false;
      add("/polygon/" + std::to_string((i + 1) % corners.size()),
          i + 1 < corners.size() ? "is the same place as the corner before"
                                 : "is the last corner's place, too: do not repeat it");
    }
    if (!fine) return;
    constexpr double kLeast_m2 = 0.01;
    if (const auto meet = self_meeting(corners)) {
      const auto side = [&](std::size_t i) {
        return std::to_string(i + 1) + " to " + std::to_string((i + 1) % corners.size() + 1);
      };
      add("/polygon", "crosses or touches itself: the side from corner " + side(meet->first) +
                          " meets the one from " + side(meet->second));
    } else if (std::abs(twice_area_m2) / 2.0 < kLeast_m2) {
      add("/polygon", "covers nothing");
    }
  }

  struct Side {
    std::size_t index;
    EnuPoint a;
    EnuPoint b;
    double west_m;
    double east_m;
  };

  /// Two sides that meet elsewhere than where they join, the first such by place.
  static std::optional<std::pair<std::size_t, std::size_t>> self_meeting(
      const std::vector<EnuPoint>& corners) {
    std::vector<Side> sides;
    sides.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const EnuPoint a = corners[i];
      const EnuPoint b = corners[(i + 1) % corners.size()];
      sides.push_back({i, a, b, std::min(a.east_m, b.east_m), std::max(a.east_m, b.east_m)});
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& l, const Side& r) { return l.west_m < r.west_m; });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t k = i + 1; k < sides.size() && sides[k].west_m <= sides[i].east_m + kTouch_m;
           ++k) {
        if (!meet(sides[i], sides[k], corners.size())) continue;
        return std::minmax(sides[i].index, sides[k].index);
      }
    }
    return std::nullopt;
  }

  static bool meet(const Side& one, const Side& other, std::size_t count) {
    if (std::min(one.a.north_m, one.b.north_m) >
            std::max(other.a.north_m, other.b.north_m) + kTouch_m ||
        std::min(other.a.north_m, other.b.north_m) >
            std::max(one.a.north_m, one.b.north_m) + kTouch_m) {
      return false;
    }
    const bool one_first = (one.index + 1) % count == other.index;
    const bool other_first = (other.index + 1) % count == one.index;
    if (!one_first && !other_first) {
      return meeting(one.a, one.b, other.a, other.b).has_value() ||
             distance_to_side_m(one.a, other.a, other.b) < kTouch_m ||
             distance_to_side_m(other.a, one.a, one.b) < kTouch_m;
    }
    // Neighbours share a corner; they must not fold back onto each other.
    const Side& first = one_first ? one : other;
    const Side& next = one_first ? other : one;
    return dot(first.b - first.a, next.b - next.a) < 0.0 &&
           (distance_to_side_m(first.a, next.a, next.b) < kTouch_m ||
            distance_to_side_m(next.b, first.a, first.b) < kTouch_m);
  }

  const std::string where_;
  Problems& problems_;
};

Error more_than_possible(const char* where, std::size_t count, std::size_t most) {
  const std::string detail =
      "has " + std::to_string(count) + ", at most " + std::to_string(most) + " are possible";
  return {Code::TooLarge, std::string(where) + " " + detail, {{where, detail}}};
}

}  // namespace

Result<void> check_fence(const Fence& fence) {
  std::size_t corners = 0;
  for (const FenceArea& area : fence.areas) {
    if (const auto* p = std::get_if<FencePolygon>(&area.shape)) corners += p->points.size();
  }
  for (const auto& [where, count, most] : {std::tuple{"/areas", fence.areas.size(), kMaxAreas},
                                           std::tuple{"/rally", fence.rally.size(), kMaxRally},
                                           std::tuple{"/areas", corners, kMaxFencePoints}}) {
    if (count > most) return tl::unexpected<Error>(more_than_possible(where, count, most));
  }
  Problems problems;
  if (std::string problem = name_problem(fence.name); !problem.empty()) {
    problems.add("/name", std::move(problem));
  }
  if (fence.areas.empty() && fence.rally.empty()) {
    problems.add("/areas", "must have an area, or rally a point: this is no fence");
  }
  for (std::size_t i = 0; i < fence.areas.size(); ++i) {
    AreaCheck check("/areas/" + std::to_string(i), problems);
    std::visit(check, fence.areas[i].shape);
  }
  for (std::size_t i = 0; i < fence.rally.size(); ++i) {
    AreaCheck check("/rally/" + std::to_string(i), problems);
    check.position("", fence.rally[i].at);
    if (const auto alt_m = fence.rally[i].alt_m) check.number("/alt_m", *alt_m, kAlt_m);
  }
  if (problems.none()) return {};
  return tl::unexpected<Error>(std::move(problems).error("the fence"));
}

}  // namespace roverd::mission
