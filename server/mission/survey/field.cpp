#include "mission/survey/field.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mission/json/pointer.hpp"
#include "mission/survey/survey.hpp"

namespace roverd::mission::survey {
namespace {

using base::Error;
using base::LatLon;
using base::Result;

std::string place_of(std::size_t ring) {
  return "/polygon/" + std::to_string(ring);
}
std::string place_of(std::size_t ring, std::size_t point) {
  return place_of(ring) + "/" + std::to_string(point);
}

tl::unexpected<Error> refuse(Problems& problems) {
  return tl::unexpected<Error>(std::move(problems).error("the field"));
}

/// An edge, and which one it is: from point `point` of ring `ring` to the next.
struct Side {
  EnuPoint a;
  EnuPoint b;
  std::size_t ring = 0;
  std::size_t point = 0;
  std::size_t next = 0;

  double west_m() const noexcept { return std::min(a.east_m, b.east_m); }
  double east_m() const noexcept { return std::max(a.east_m, b.east_m); }
};

double side_of(EnuPoint a, EnuPoint b, EnuPoint p) noexcept {
  return (b.east_m - a.east_m) * (p.north_m - a.north_m) -
         (b.north_m - a.north_m) * (p.east_m - a.east_m);
}

bool over_each_other(double a, double b, double c, double d) noexcept {
  return std::max(a, b) >= std::min(c, d) && std::max(c, d) >= std::min(a, b);
}

/// Touching counts; of neighbours only what they share beyond their common point.
bool cross(const Side& x, const Side& y) noexcept {
  if (!over_each_other(x.a.north_m, x.b.north_m, y.a.north_m, y.b.north_m)) return false;
  if (x.ring == y.ring && (x.next == y.point || y.next == x.point)) {
    // Back over itself: in one line, and in the opposite direction.
    const Side& first = x.next == y.point ? x : y;
    const Side& then = x.next == y.point ? y : x;
    if (side_of(first.a, first.b, then.b) != 0.0) return false;
    const EnuPoint u = first.b - first.a;
    const EnuPoint v = then.b - then.a;
    return u.east_m * v.east_m + u.north_m * v.north_m < 0.0;
  }
  const double c = side_of(x.a, x.b, y.a);
  const double d = side_of(x.a, x.b, y.b);
  if ((c > 0.0 && d > 0.0) || (c < 0.0 && d < 0.0)) return false;
  const double e = side_of(y.a, y.b, x.a);
  const double f = side_of(y.a, y.b, x.b);
  return !((e > 0.0 && f > 0.0) || (e < 0.0 && f < 0.0));
}

/// By a line that sweeps from west to east.
std::optional<std::pair<Side, Side>> first_crossing(std::vector<Side> sides) {
  std::sort(sides.begin(), sides.end(),
            [](const Side& x, const Side& y) { return x.west_m() < y.west_m(); });
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    std::size_t kept = 0;
    for (const std::size_t k : open) {
      if (sides[k].east_m() < sides[i].west_m()) continue;
      if (cross(sides[k], sides[i])) return std::pair(sides[k], sides[i]);
      open[kept++] = k;
    }
    open.resize(kept);
    open.push_back(i);
  }
  return std::nullopt;
}

bool inside(const Ring& ring, EnuPoint p) noexcept {
  bool in = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    if ((ring[i].north_m > p.north_m) == (ring[j].north_m > p.north_m)) continue;
    const double share = (p.north_m - ring[i].north_m) / (ring[j].north_m - ring[i].north_m);
    if (p.east_m < ring[i].east_m + share * (ring[j].east_m - ring[i].east_m)) in = !in;
  }
  return in;
}

/// The middle of the extremes, the short way round the date line.
LatLon middle_of(const std::vector<LatLon>& ring) {
  double south = ring.front().lat;
  double north = south;
  double west = 0.0;
  double east = 0.0;
  for (const LatLon& p : ring) {
    south = std::min(south, p.lat);
    north = std::max(north, p.lat);
    const double lon = std::remainder(p.lon - ring.front().lon, 360.0);
    west = std::min(west, lon);
    east = std::max(east, lon);
  }
  const double lon = ring.front().lon + (west + east) / 2.0;
  return {(south + north) / 2.0, std::remainder(lon, 360.0)};
}

/// Points, numbers, reach.
void check_points(const std::vector<std::vector<LatLon>>& rings, Problems& problems) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    count += rings[r].size();
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      if (!base::is_valid(rings[r][i])) problems.add(place_of(r, i), "is not a position on earth");
    }
  }
  if (rings.empty() || rings.front().empty()) problems.add("/polygon", "is empty");
  if (count > kMaxFieldPoints) {
    problems.add("/polygon", "has " + std::to_string(count) + " points, at most " +
                                 std::to_string(kMaxFieldPoints) + " are possible");
  }
}

/// Without what repeats the point before; with the numbers that the points came with.
struct Laid {
  Ring ring;
  std::vector<std::size_t> numbers;
};

Laid lay(const std::vector<LatLon>& points, const base::TangentPlane& plane) {
  constexpr double kSamePoint_m = 1e-3;
  Laid out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const EnuPoint p = plane.to_local(points[i]);
    if (!out.ring.empty() && base::distance_m(out.ring.back(), p) < kSamePoint_m) continue;
    out.ring.push_back(p);
    out.numbers.push_back(i);
  }
  while (out.ring.size() > 1 &&
         base::distance_m(out.ring.front(), out.ring.back()) < kSamePoint_m) {
    out.ring.pop_back();
    out.numbers.pop_back();
  }
  return out;
}

void check_sides(const std::vector<Laid>& laid, Problems& problems) {
  std::vector<Side> sides;
  for (std::size_t r = 0; r < laid.size(); ++r) {
    const Ring& ring = laid[r].ring;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t j = (i + 1) % ring.size();
      sides.push_back({ring[i], ring[j], r, laid[r].numbers[i], laid[r].numbers[j]});
    }
  }
  if (const auto found = first_crossing(std::move(sides))) {
    const auto& [x, y] = *found;
    problems.add(place_of(x.ring, x.point), "begins an edge that crosses or touches the one from " +
                                                place_of(y.ring, y.point));
  }
}

void check_holes(const std::vector<Laid>& laid, Problems& problems) {
  for (std::size_t r = 1; r < laid.size(); ++r) {
    const EnuPoint p = laid[r].ring.front();
    if (!inside(laid.front().ring, p)) {
      problems.add(place_of(r), "is a hole outside of the field");
      continue;
    }
    for (std::size_t other = 1; other < laid.size(); ++other) {
      if (other == r || !inside(laid[other].ring, p)) continue;
      problems.add(place_of(r), "is a hole within the hole " + place_of(other));
      break;
    }
  }
}

}  // namespace

Result<Field> field_of(const std::vector<std::vector<LatLon>>& rings) {
  Problems problems;
  check_points(rings, problems);
  if (!problems.none()) return refuse(problems);
  const LatLon middle = middle_of(rings.front());
  const base::TangentPlane plane(middle);
  std::vector<Laid> laid;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      if (base::distance_bearing(middle, rings[r][i]).distance_m > base::LocalFrame::kReach_m) {
        problems.add(place_of(r, i), "lies more than 10 km from the middle of the field");
      }
    }
    laid.push_back(lay(rings[r], plane));
    if (laid.back().ring.size() < 3) {
      problems.add(place_of(r), "has " + std::to_string(laid.back().ring.size()) +
                                    " different points, at least 3 are needed");
    }
  }
  if (!problems.none()) return refuse(problems);
  check_sides(laid, problems);
  constexpr double kLeast_m2 = 1e-4;
  for (std::size_t r = 0; r < laid.size() && problems.none(); ++r) {
    if (std::abs(square_m2(laid[r].ring)) < kLeast_m2) problems.add(place_of(r), "has no area");
  }
  if (problems.none()) check_holes(laid, problems);
  if (!problems.none()) return refuse(problems);
  Field field{plane, {}};
  for (std::size_t r = 0; r < laid.size(); ++r) {
    Ring& ring = laid[r].ring;
    if ((square_m2(ring) > 0.0) != (r == 0)) std::reverse(ring.begin(), ring.end());
    field.area.push_back(std::move(ring));
  }
  return field;
}

}  // namespace roverd::mission::survey
