#include "mission/survey/cover.hpp"

#include <algorithm>
#include <cmath>

#include "mission/survey/ways.hpp"

namespace roverd::mission::survey {
namespace {

/// Edges by bands across north, to count how many a ray to the east passes.
class Inside {
 public:
  explicit Inside(const Area& area) : box_(box_of(area)) {
    const auto edges = edges_of(area);
    bands_.resize(std::clamp<std::size_t>(edges.size(), 1, 4096));
    for (const auto& e : edges) {
      const std::size_t from = band_of(std::min(e.a.north_m, e.b.north_m));
      const std::size_t to = band_of(std::max(e.a.north_m, e.b.north_m));
      for (std::size_t k = from; k <= to; ++k) bands_[k].push_back(e);
    }
  }

  const Box& box() const noexcept { return box_; }

  bool operator()(EnuPoint p) const noexcept {
    bool in = false;
    for (const auto& e : bands_[band_of(p.north_m)]) {
      if ((e.a.north_m > p.north_m) == (e.b.north_m > p.north_m)) continue;
      const double share = (p.north_m - e.a.north_m) / (e.b.north_m - e.a.north_m);
      if (p.east_m < e.a.east_m + share * (e.b.east_m - e.a.east_m)) in = !in;
    }
    return in;
  }

 private:
  std::size_t band_of(double north_m) const noexcept {
    const double height = std::max(box_.high.north_m - box_.low.north_m, 1e-9);
    const double k = (north_m - box_.low.north_m) / height * static_cast<double>(bands_.size());
    return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(bands_.size()) - 1.0));
  }

  Box box_;
  std::vector<std::vector<EdgeGrid::Edge>> bands_;
};

bool near(const EdgeGrid& grid, EnuPoint p, double reach_m) {
  return grid.around(p, reach_m, [&](const EdgeGrid::Edge& e) {
    return square_from_edge(p, e) <= reach_m * reach_m;
  });
}

}  // namespace

Cover cover_of(const Area& field, const Area& drivable, const std::vector<EnuPoint>& path,
               double reach_m) {
  const Inside in_field(field);
  const Inside in_drivable(drivable);
  const EdgeGrid rim(edges_of(drivable), reach_m);
  std::vector<EdgeGrid::Edge> way{{path.front(), path.front()}};
  for (std::size_t i = 1; i < path.size(); ++i) way.push_back({path[i - 1], path[i]});
  const EdgeGrid driven(std::move(way), reach_m);

  constexpr int kWanted = 100'000;
  constexpr int kMost = 1'000'000;
  constexpr double kStepEast = 0.7548776662466927;   // 1/g, g³ = g + 1
  constexpr double kStepNorth = 0.5698402909980532;  // 1/g²
  const Box& box = in_field.box();
  const EnuPoint span = box.high - box.low;
  int inside = 0;
  int covered = 0;
  int reachable = 0;
  for (int i = 0; i < kMost && inside < kWanted; ++i) {
    const double k = static_cast<double>(i) + 0.5;
    const EnuPoint p{box.low.east_m + span.east_m * std::fmod(k * kStepEast, 1.0),
                     box.low.north_m + span.north_m * std::fmod(k * kStepNorth, 1.0)};
    if (!in_field(p)) continue;
    ++inside;
    const bool is_covered = near(driven, p, reach_m);
    covered += is_covered ? 1 : 0;
    reachable += is_covered || in_drivable(p) || near(rim, p, reach_m) ? 1 : 0;
  }
  if (inside == 0) return {};
  return {static_cast<double>(covered) / inside, static_cast<double>(reachable) / inside};
}

}  // namespace roverd::mission::survey
