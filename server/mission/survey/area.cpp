#include "mission/survey/area.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <polyclipping/clipper.hpp>

namespace roverd::mission::survey {
namespace {

constexpr double kPerMetre = 1e4;

ClipperLib::Paths paths_of(const Area& area) {
  ClipperLib::Paths out;
  out.reserve(area.size());
  for (const Ring& ring : area) {
    ClipperLib::Path path;
    path.reserve(ring.size());
    for (const EnuPoint& p : ring) {
      path.emplace_back(std::llround(p.east_m * kPerMetre), std::llround(p.north_m * kPerMetre));
    }
    out.push_back(std::move(path));
  }
  return out;
}

Ring ring_of(const ClipperLib::Path& path) {
  Ring out;
  out.reserve(path.size());
  for (const auto& p : path) {
    out.push_back({static_cast<double>(p.X) / kPerMetre, static_cast<double>(p.Y) / kPerMetre});
  }
  return out;
}

Area area_of(const ClipperLib::Paths& paths) {
  Area out;
  out.reserve(paths.size());
  for (const auto& path : paths) {
    if (path.size() >= 3) out.push_back(ring_of(path));
  }
  return out;
}

void take_parts(const ClipperLib::PolyNode& node, std::vector<Part>& out) {
  for (const ClipperLib::PolyNode* outer : node.Childs) {
    Part part;
    part.outer = ring_of(outer->Contour);
    for (const ClipperLib::PolyNode* hole : outer->Childs) {
      part.holes.push_back(ring_of(hole->Contour));
      take_parts(*hole, out);
    }
    if (part.outer.size() >= 3) out.push_back(std::move(part));
  }
}

double from_line_m(EnuPoint p, EnuPoint a, EnuPoint b) noexcept {
  const EnuPoint ab = b - a;
  const EnuPoint ap = p - a;
  const double square = ab.east_m * ab.east_m + ab.north_m * ab.north_m;
  const double along =
      square > 0.0
          ? std::clamp((ap.east_m * ab.east_m + ap.north_m * ab.north_m) / square, 0.0, 1.0)
          : 0.0;
  return std::hypot(ap.east_m - along * ab.east_m, ap.north_m - along * ab.north_m);
}

}  // namespace

Area Part::area() const {
  Area out{outer};
  out.insert(out.end(), holes.begin(), holes.end());
  return out;
}

Area offset(const Area& area, double by_m, double sagitta_m) {
  if (area.empty()) return {};
  constexpr double kMiterLimit = 2.0;
  ClipperLib::ClipperOffset work(kMiterLimit, std::max(1.0, sagitta_m * kPerMetre));
  work.AddPaths(paths_of(area), ClipperLib::jtRound, ClipperLib::etClosedPolygon);
  ClipperLib::Paths out;
  work.Execute(out, by_m * kPerMetre);
  return area_of(out);
}

Area without(const Area& area, const Area& other) {
  ClipperLib::Clipper work;
  work.AddPaths(paths_of(area), ClipperLib::ptSubject, true);
  work.AddPaths(paths_of(other), ClipperLib::ptClip, true);
  ClipperLib::Paths out;
  work.Execute(ClipperLib::ctDifference, out, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return area_of(out);
}

std::vector<Part> parts_of(const Area& area) {
  ClipperLib::Clipper work;
  work.AddPaths(paths_of(area), ClipperLib::ptSubject, true);
  ClipperLib::PolyTree tree;
  work.Execute(ClipperLib::ctUnion, tree, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  std::vector<Part> out;
  take_parts(tree, out);
  std::stable_sort(out.begin(), out.end(), [](const Part& a, const Part& b) {
    return square_m2(a.area()) > square_m2(b.area());
  });
  return out;
}

double square_m2(const Ring& ring) noexcept {
  double twice = 0.0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    twice += ring[j].east_m * ring[i].north_m - ring[i].east_m * ring[j].north_m;
  }
  return twice / 2.0;
}

double square_m2(const Area& area) noexcept {
  double sum = 0.0;
  for (const Ring& ring : area) sum += square_m2(ring);
  return sum;
}

// Greedy, with a window: each kept point looks ahead as far as the line to there passes near
// enough to all between. Bounded by window times length, whatever the shape.
Ring simplified(const Ring& ring, double tolerance_m) {
  constexpr std::size_t kWindow = 64;
  if (ring.size() < 4) return ring;
  Ring out{ring.front()};
  std::size_t from = 0;
  while (from + 1 < ring.size()) {
    std::size_t to = from + 1;
    for (std::size_t far = from + 2; far <= std::min(from + kWindow, ring.size()); ++far) {
      const EnuPoint end = ring[far % ring.size()];
      bool near = true;
      for (std::size_t k = from + 1; k < far && near; ++k) {
        near = from_line_m(ring[k], ring[from], end) <= tolerance_m;
      }
      if (!near) break;
      to = far;
    }
    if (to < ring.size()) out.push_back(ring[to]);
    from = to;
  }
  return out.size() >= 3 ? out : ring;
}

Box box_of(const Area& area) noexcept {
  Box box{area.front().front(), area.front().front()};
  for (const Ring& ring : area) {
    for (const EnuPoint& p : ring) {
      box.low = {std::min(box.low.east_m, p.east_m), std::min(box.low.north_m, p.north_m)};
      box.high = {std::max(box.high.east_m, p.east_m), std::max(box.high.north_m, p.north_m)};
    }
  }
  return box;
}

}  // namespace roverd::mission::survey
