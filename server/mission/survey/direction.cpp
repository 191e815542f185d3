#include "mission/survey/direction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/angle.hpp"
#include "mission/survey/cells.hpp"

namespace roverd::mission::survey {
namespace {

/// Of a line, [0, 180).
double compass_of_line(EnuPoint a, EnuPoint b) noexcept {
  const double heading =
      base::heading_from_yaw(std::atan2(b.north_m - a.north_m, b.east_m - a.east_m));
  return std::fmod(heading, 180.0);
}

std::vector<double> candidates(const Area& area) {
  constexpr double kBin_deg = 3.0;
  constexpr std::size_t kBins = 60;
  constexpr std::size_t kEdges = 12;
  struct Bin {
    double length_m = 0.0;  ///< of all edges
    double longest_m = 0.0;
    double heading_deg = 0.0;  ///< of the longest one
  };
  std::array<Bin, kBins> bins{};
  for (const Ring& ring : area) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const double length_m = base::distance_m(ring[j], ring[i]);
      const double heading = compass_of_line(ring[j], ring[i]);
      Bin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(heading / kBin_deg))];
      bin.length_m += length_m;
      if (length_m <= bin.longest_m) continue;
      bin.longest_m = length_m;
      bin.heading_deg = heading;
    }
  }
  std::sort(bins.begin(), bins.end(),
            [](const Bin& a, const Bin& b) { return a.length_m > b.length_m; });
  std::vector<double> out;
  for (std::size_t i = 0; i < kEdges && bins[i].length_m > 0.0; ++i) {
    out.push_back(bins[i].heading_deg);
  }
  for (double heading = 0.0; heading < 180.0; heading += 15.0) out.push_back(heading);
  return out;
}

double cost_of(const Area& area, double spacing_m) {
  constexpr double kStrips = 200.0;  // enough to compare by
  constexpr double kTurn_m = 5.0;
  const Box box = box_of(area);
  const double coarse_m = std::max(spacing_m, (box.high.north_m - box.low.north_m) / kStrips);
  double cost = 0.0;
  for (const Cell& cell : covering_cells(area, coarse_m)) {
    for (const Track& track : cell) cost += track.to_m - track.from_m + kTurn_m + 3.0 * spacing_m;
    cost += (2.0 * kTurn_m + 5.0 * spacing_m) * spacing_m / coarse_m;
  }
  return cost * coarse_m / spacing_m;
}

}  // namespace

Rotation::Rotation(double yaw_rad) noexcept : c_(std::cos(yaw_rad)), s_(std::sin(yaw_rad)) {}

Area Rotation::forth(const Area& area) const {
  Area out = area;
  for (Ring& ring : out) {
    for (EnuPoint& p : ring) p = forth(p);
  }
  return out;
}

double best_direction_deg(const Area& area, double spacing_m) {
  Area plain;
  for (const Ring& ring : area) plain.push_back(simplified(ring, spacing_m / 4.0));
  double best = 0.0;
  double best_cost = -1.0;
  for (const double heading : candidates(plain)) {
    const double cost = cost_of(Rotation(base::yaw_from_heading(heading)).forth(plain), spacing_m);
    // Later ones must be clearly better: an edge's direction is worth keeping.
    constexpr double kClearly = 0.995;
    if (best_cost >= 0.0 && cost >= kClearly * best_cost) continue;
    best = heading;
    best_cost = cost;
  }
  return best;
}

}  // namespace roverd::mission::survey
