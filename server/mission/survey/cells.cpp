#include "mission/survey/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mission/survey/strips.hpp"

namespace roverd::mission::survey {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Tracks and which of them follow on which.
class Joiner {
 public:
  std::size_t add(const Track& track) {
    nodes_.push_back({track});
    return nodes_.size() - 1;
  }

  /// `upper` lies on the other side of a common border.
  void join(std::size_t lower, std::size_t upper) {
    link(nodes_[lower].above, nodes_[lower].forks_above, upper);
    link(nodes_[upper].below, nodes_[upper].forks_below, lower);
  }

  std::vector<Cell> cells() const {
    std::vector<Cell> out;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (follows(nodes_[i].below, i)) continue;  // not the first of its cell
      Cell& cell = out.emplace_back();
      for (std::size_t k = i; k != kNone;
           k = follows(k, nodes_[k].above) ? nodes_[k].above : kNone) {
        cell.push_back(nodes_[k].track);
      }
    }
    return out;
  }

 private:
  struct Node {
    Track track;
    std::size_t above = kNone;
    std::size_t below = kNone;
    bool forks_above = false;
    bool forks_below = false;
  };

  static void link(std::size_t& place, bool& forks, std::size_t other) {
    forks = forks || (place != kNone && place != other);
    place = other;
  }
  /// Is each the other's only neighbour on that side?
  bool follows(std::size_t lower, std::size_t upper) const {
    return lower != kNone && upper != kNone && !nodes_[lower].forks_above &&
           !nodes_[upper].forks_below && nodes_[lower].above == upper;
  }

  std::vector<Node> nodes_;
};

double height_m(const Box& box) noexcept {
  return box.high.north_m - box.low.north_m;
}

/// The four ways to begin a cell.
struct Entry {
  std::size_t cell = kNone;
  bool last_first = false;
  bool backwards = false;  ///< the first track from its end to its beginning
};

EnuPoint entry_point(const Cell& cell, const Entry& e) noexcept {
  const Track& track = e.last_first ? cell.back() : cell.front();
  return e.backwards ? track.end() : track.begin();
}

}  // namespace

std::vector<Cell> covering_cells(const Area& area, double spacing_m) {
  if (area.empty()) return {};
  const Box box = box_of(area);
  const auto count =
      static_cast<std::size_t>(std::max(1.0, std::ceil(height_m(box) / spacing_m - 1e-9)));
  const double low_m =
      box.low.north_m - (static_cast<double>(count) * spacing_m - height_m(box)) / 2.0;
  const Strips strips = cut(area, low_m, spacing_m, count, kMostCrossings);
  if (strips.strips.empty()) return {};
  // A corner that reaches this little into a strip is covered well enough by the track beside it.
  const double sliver_m = 0.02 * spacing_m;
  Joiner joiner;
  std::vector<std::size_t> below_line;  // by interval of the line under the strip: its track
  for (std::size_t s = 0; s < count; ++s) {
    const double across_m = low_m + (static_cast<double>(s) + 0.5) * spacing_m;
    std::vector<std::size_t> above_line(strips.lines[s + 1].size(), kNone);
    for (const Component& c : strips.strips[s]) {
      const bool hangs = c.below.empty() != c.above.empty();
      if (hangs && c.high_m - c.low_m < sliver_m) continue;
      const std::size_t node = joiner.add({c.from_m, c.to_m, across_m});
      for (const std::size_t i : c.below) {
        if (below_line[i] != kNone) joiner.join(below_line[i], node);
      }
      for (const std::size_t i : c.above) above_line[i] = node;
    }
    below_line = std::move(above_line);
  }
  return joiner.cells();
}

std::vector<Cell> inner_cells(const Area& area, double spacing_m) {
  if (area.empty()) return {};
  // Lines a hair inside of the extremes: one on an edge would be in and out by rounding.
  const double hair_m = std::min(1e-3, spacing_m / 1000.0);
  const Box box = box_of(area);
  const double height = std::max(height_m(box) - 2.0 * hair_m, hair_m);
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(height / spacing_m - 1e-9)));
  const double step_m = height / static_cast<double>(count);
  const double first_m = box.low.north_m + hair_m;
  // One strip more at each end, so that every line has a strip on both sides.
  const Strips strips = cut(area, first_m - step_m, step_m, count + 2, kMostCrossings);
  if (strips.strips.empty()) return {};
  Joiner joiner;
  std::vector<std::vector<std::size_t>> nodes(strips.lines.size());
  for (std::size_t line = 0; line < strips.lines.size(); ++line) {
    const double across_m = first_m + (static_cast<double>(line) - 1.0) * step_m;
    for (const Interval& i : strips.lines[line]) {
      nodes[line].push_back(joiner.add({i.from_m, i.to_m, across_m}));
    }
  }
  for (std::size_t s = 0; s < strips.strips.size(); ++s) {
    for (const Component& c : strips.strips[s]) {
      for (const std::size_t low : c.below) {
        for (const std::size_t high : c.above) joiner.join(nodes[s][low], nodes[s + 1][high]);
      }
    }
  }
  return joiner.cells();
}

std::vector<std::size_t> track_order(std::size_t count, int skip) {
  std::vector<std::size_t> out;
  out.reserve(count);
  if (skip <= 0) {
    for (std::size_t i = 0; i < count; ++i) out.push_back(i);
    return out;
  }
  for (std::size_t first = 0; first < count;) {
    // The last block is smaller, and so are its turns.
    const std::size_t k = std::min(static_cast<std::size_t>(skip) + 2, (count - first + 2) / 2);
    for (std::size_t j = 0; j + 1 < k; ++j) {
      out.push_back(first + j);
      if (first + j + k < count) out.push_back(first + j + k);
    }
    out.push_back(first + k - 1);
    first += 2 * k - 1;
  }
  return out;
}

std::vector<Drive> drives_from(EnuPoint start, const std::vector<Cell>& cells, int skip) {
  // Looking at this many of those that are left bounds the time; they lie in order of strips.
  constexpr std::size_t kLook = 2000;
  std::vector<std::size_t> left(cells.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Drive> out;
  EnuPoint at = start;
  while (!left.empty()) {
    Entry best;
    std::size_t place = 0;
    double best_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < std::min(left.size(), kLook); ++k) {
      for (const bool last_first : {false, true}) {
        for (const bool backwards : {false, true}) {
          const Entry e{left[k], last_first, backwards};
          const double far_m = base::distance_m(at, entry_point(cells[left[k]], e));
          if (far_m >= best_m) continue;
          best_m = far_m;
          best = e;
          place = k;
        }
      }
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
    const Cell& cell = cells[best.cell];
    bool backwards = best.backwards;
    for (const std::size_t i : track_order(cell.size(), skip)) {
      const Track& track = cell[best.last_first ? cell.size() - 1 - i : i];
      out.push_back(backwards ? Drive{track.end(), track.begin()}
                              : Drive{track.begin(), track.end()});
      backwards = !backwards;
    }
    at = out.back().end;
  }
  return out;
}

}  // namespace roverd::mission::survey
