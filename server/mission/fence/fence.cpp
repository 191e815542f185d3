#include "mission/fence/fence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "mission/fence/plane_lines.hpp"

namespace roverd::mission {

using base::EnuPoint;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Areas all of whose corners are farther from the origin are left out of the map.
constexpr double kFarAway_m = 30'000.0;
/// How far beside a side its two faces are looked at.
constexpr double kFace_m = 1e-4;

bool is_finite(EnuPoint p) noexcept {
  return std::isfinite(p.east_m) && std::isfinite(p.north_m);
}

/// Inside the circle for an inclusion, around it for an exclusion.
std::vector<EnuPoint> corners_of(EnuPoint center, double radius_m, AreaKind kind) {
  constexpr double kMost_m = 0.01;
  constexpr double kFewest = 24.0;
  constexpr double kMany = 2400.0;  // 10 km within 1 cm needs 2222
  const double each_rad = std::acos(std::max(0.0, 1.0 - kMost_m / radius_m));
  const auto count =
      static_cast<std::size_t>(std::clamp(std::ceil(base::kPi / each_rad), kFewest, kMany));
  const double half_rad = base::kPi / static_cast<double>(count);
  const double r_m = kind == AreaKind::Inclusion ? radius_m : radius_m / std::cos(half_rad);
  std::vector<EnuPoint> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * half_rad * static_cast<double>(i);
    out.push_back(center + EnuPoint{r_m * std::cos(angle_rad), r_m * std::sin(angle_rad)});
  }
  return out;
}

std::vector<EnuPoint> corners_of(const FenceArea& area, const base::LocalFrame& frame) {
  if (const auto* circle = std::get_if<FenceCircle>(&area.shape)) {
    // Behind the horizon a plane says nothing of where a place is.
    if (base::distance_bearing(frame.origin(), circle->center).distance_m >
        kFarAway_m + kMaxFenceRadius_m) {
      return {};
    }
    return corners_of(frame.to_local(circle->center), circle->radius_m, area.kind);
  }
  std::vector<EnuPoint> out;
  double nearest_m = kInfinity;
  for (const base::LatLon corner : std::get<FencePolygon>(area.shape).points) {
    nearest_m = std::min(nearest_m, base::distance_bearing(frame.origin(), corner).distance_m);
    out.push_back(frame.to_local(corner));
  }
  // A polygon is at most 20 km wide, so that its sides stay 10 km away, too.
  if (nearest_m > kFarAway_m) out.clear();
  return out;
}

}  // namespace

void CompiledFence::Box::take_in(EnuPoint p) noexcept {
  west_m = std::min(west_m, p.east_m);
  east_m = std::max(east_m, p.east_m);
  south_m = std::min(south_m, p.north_m);
  north_m = std::max(north_m, p.north_m);
}

bool CompiledFence::Box::meets(const Box& other, double margin_m) const noexcept {
  return west_m <= other.east_m + margin_m && other.west_m <= east_m + margin_m &&
         south_m <= other.north_m + margin_m && other.south_m <= north_m + margin_m;
}

double CompiledFence::Box::distance_m(EnuPoint p) const noexcept {
  const double east = std::max({west_m - p.east_m, 0.0, p.east_m - east_m});
  const double north = std::max({south_m - p.north_m, 0.0, p.north_m - north_m});
  return std::hypot(east, north);
}

void CompiledFence::Lines::close() {
  constexpr std::size_t kRun = 16;
  for (std::size_t first = 0; first < segments.size(); first += kRun) {
    Run run{{}, first, std::min(first + kRun, segments.size())};
    for (std::size_t i = run.first; i < run.end; ++i) {
      run.box.take_in(segments[i].a);
      run.box.take_in(segments[i].b);
    }
    box.take_in({run.box.west_m, run.box.south_m});
    box.take_in({run.box.east_m, run.box.north_m});
    runs.push_back(run);
  }
}

bool CompiledFence::Lines::encloses(EnuPoint p) const noexcept {
  if (!(box.distance_m(p) <= 0.0)) return false;
  // A ray to the east crosses the ring an odd number of times. A corner belongs to the side above
  // it, so that no crossing counts twice.
  bool inside = false;
  for (const Run& run : runs) {
    if (p.north_m < run.box.south_m || p.north_m > run.box.north_m || p.east_m > run.box.east_m) {
      continue;
    }
    for (std::size_t i = run.first; i < run.end; ++i) {
      const auto& [a, b] = segments[i];
      if ((a.north_m > p.north_m) == (b.north_m > p.north_m)) continue;
      const double at_m =
          a.east_m + (p.north_m - a.north_m) * (b.east_m - a.east_m) / (b.north_m - a.north_m);
      if (p.east_m < at_m) inside = !inside;
    }
  }
  return inside;
}

double CompiledFence::Lines::distance_m(EnuPoint p) const noexcept {
  double least_m = kInfinity;
  for (const Run& run : runs) {
    if (run.box.distance_m(p) >= least_m) continue;
    for (std::size_t i = run.first; i < run.end; ++i) {
      least_m = std::min(least_m, distance_to_side_m(p, segments[i].a, segments[i].b));
    }
  }
  return least_m;
}

CompiledFence::CompiledFence(const Fence& fence, const base::LocalFrame& frame) {
  for (const FenceArea& area : fence.areas) {
    has_inclusion_ = has_inclusion_ || area.kind == AreaKind::Inclusion;
    const auto corners = corners_of(area, frame);
    if (corners.empty()) continue;
    Area& made = areas_.emplace_back();
    made.kind = area.kind;
    made.ring.segments.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      made.ring.segments.push_back({corners[i], corners[(i + 1) % corners.size()]});
    }
    made.ring.close();
  }
  find_limits();
}

void CompiledFence::find_limits() {
  for (std::size_t i = 0; i < areas_.size(); ++i) {
    for (const Segment& side : areas_[i].ring.segments) add_pieces(i, side);
  }
  limits_.close();
}

/// Cuts a side where other areas' sides meet it, and keeps the pieces with allowed ground on one
/// face alone.
void CompiledFence::add_pieces(std::size_t area, const Segment& side) {
  const double length_m = base::distance_m(side.a, side.b);
  if (length_m < kSame_m) return;
  std::vector<double> shares{0.0, 1.0};
  cuts_of(area, side, shares);
  std::sort(shares.begin(), shares.end());
  const EnuPoint way = side.b - side.a;
  const EnuPoint face{-way.north_m / length_m * kFace_m, way.east_m / length_m * kFace_m};
  for (std::size_t i = 1; i < shares.size(); ++i) {
    if ((shares[i] - shares[i - 1]) * length_m < kSame_m) continue;
    const EnuPoint middle = along(side.a, side.b, (shares[i - 1] + shares[i]) / 2.0);
    if (contains(middle + face) == contains(middle - face)) continue;
    limits_.segments.push_back(
        {along(side.a, side.b, shares[i - 1]), along(side.a, side.b, shares[i])});
  }
}

void CompiledFence::cuts_of(std::size_t area, const Segment& side,
                            std::vector<double>& shares) const {
  Box box;
  box.take_in(side.a);
  box.take_in(side.b);
  const EnuPoint way = side.b - side.a;
  for (std::size_t i = 0; i < areas_.size(); ++i) {
    if (i == area || !areas_[i].ring.box.meets(box, kSame_m)) continue;
    const Lines& ring = areas_[i].ring;
    for (const Lines::Run& run : ring.runs) {
      if (!run.box.meets(box, kSame_m)) continue;
      for (std::size_t k = run.first; k < run.end; ++k) {
        const auto& [c, d] = ring.segments[k];
        if (const auto share = meeting(side.a, side.b, c, d)) shares.push_back(*share);
        for (const EnuPoint end : {c, d}) {  // where they lie on one line
          if (distance_to_side_m(end, side.a, side.b) > kSame_m) continue;
          shares.push_back(std::clamp(dot(end - side.a, way) / dot(way, way), 0.0, 1.0));
        }
      }
    }
  }
}

bool CompiledFence::contains(EnuPoint p) const noexcept {
  if (!is_finite(p)) return false;
  bool included = !has_inclusion_;
  for (const Area& area : areas_) {
    if (area.kind == AreaKind::Inclusion && included) continue;
    if (!area.ring.encloses(p)) continue;
    if (area.kind == AreaKind::Exclusion) return false;
    included = true;
  }
  return included;
}

double CompiledFence::clearance_m(EnuPoint p) const noexcept {
  if (!is_finite(p)) return -kInfinity;
  const double far_m = limits_.distance_m(p);
  return contains(p) ? far_m : -far_m;
}

double CompiledFence::clearance_m(EnuPoint a, EnuPoint b) const noexcept {
  const double ends_m = std::min(clearance_m(a), clearance_m(b));
  if (!(ends_m > 0.0)) return ends_m;
  if (crosses(a, b)) return 0.0;
  // Nothing is met on the way: the nearest points are at one's end or the other's.
  double least_m = ends_m;
  Box box;
  box.take_in(a);
  box.take_in(b);
  for (const Lines::Run& run : limits_.runs) {
    if (!run.box.meets(box, least_m)) continue;
    for (std::size_t i = run.first; i < run.end; ++i) {
      least_m = std::min(least_m, distance_to_side_m(limits_.segments[i].a, a, b));
      least_m = std::min(least_m, distance_to_side_m(limits_.segments[i].b, a, b));
    }
  }
  return least_m;
}

std::optional<double> CompiledFence::first_crossing_m(EnuPoint a, EnuPoint b) const noexcept {
  if (!is_finite(a) || !is_finite(b)) return 0.0;
  Box box;
  box.take_in(a);
  box.take_in(b);
  std::optional<double> first;
  for (const Lines::Run& run : limits_.runs) {
    if (!run.box.meets(box, kSame_m)) continue;
    for (std::size_t i = run.first; i < run.end; ++i) {
      const auto share = meeting(a, b, limits_.segments[i].a, limits_.segments[i].b);
      if (share) first = std::min(first.value_or(*share), *share);
    }
  }
  if (first) *first *= base::distance_m(a, b);
  return first;
}

}  // namespace roverd::mission
