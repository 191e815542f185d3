#pragma once
// Ways through an area that do not leave it. Pure; many questions to one area are quick.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

/// Edges sorted into square cells, so that only those near a line or a point are looked at.
class EdgeGrid {
 public:
  struct Edge {
    EnuPoint a;
    EnuPoint b;
  };

  EdgeGrid() = default;
  /// @param least_m no cell is smaller
  explicit EdgeGrid(std::vector<Edge> edges, double least_m = 0.0);

  const std::vector<Edge>& edges() const noexcept { return edges_; }

  /// Calls look(edge) for those in the cells that the line passes, some more than once, until it
  /// returns true. @return whether it did
  template <class F>
  bool along(EnuPoint a, EnuPoint b, F look) const {
    return visit(a, b, [&](std::size_t cell) {
      for (std::uint32_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
        if (look(edges_[held_[k]])) return true;
      }
      return false;
    });
  }
  /// The same for the cells within `radius_m` of a point.
  template <class F>
  bool around(EnuPoint p, double radius_m, F look) const {
    if (edges_.empty()) return false;
    const Cell low = cell_of({p.east_m - radius_m, p.north_m - radius_m});
    const Cell high = cell_of({p.east_m + radius_m, p.north_m + radius_m});
    for (std::size_t row = low.row; row <= high.row; ++row) {
      for (std::size_t cell = row * columns_ + low.column; cell <= row * columns_ + high.column;
           ++cell) {
        for (std::uint32_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
          if (look(edges_[held_[k]])) return true;
        }
      }
    }
    return false;
  }

 private:
  struct Cell {
    std::size_t column = 0;
    std::size_t row = 0;
  };
  Cell cell_of(EnuPoint p) const noexcept;
  template <class F>
  bool visit(EnuPoint a, EnuPoint b, F f) const;

  std::vector<Edge> edges_;
  EnuPoint low_;
  double size_m_ = 1.0;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::uint32_t> begin_;  ///< of each cell in held_
  std::vector<std::uint32_t> held_;
};

template <class F>
bool EdgeGrid::visit(EnuPoint a, EnuPoint b, F f) const {
  if (columns_ == 0) return false;
  if (a.east_m > b.east_m) std::swap(a, b);
  const std::size_t first = cell_of(a).column;
  const std::size_t last = cell_of(b).column;
  for (std::size_t column = first; column <= last; ++column) {
    // The piece of the line over this column, and a little more against rounding.
    const double run = b.east_m - a.east_m;
    const auto north_at = [&](double east_m) {
      const double share = run > 0.0 ? (east_m - a.east_m) / run : 0.0;
      return a.north_m + (share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share) * (b.north_m - a.north_m);
    };
    const double west = low_.east_m + size_m_ * static_cast<double>(column);
    double low = column == first ? a.north_m : north_at(west);
    double high = column == last ? b.north_m : north_at(west + size_m_);
    if (low > high) std::swap(low, high);
    constexpr double kGrace_m = 1e-6;
    const std::size_t from = cell_of({west, low - kGrace_m}).row;
    const std::size_t to = cell_of({west, high + kGrace_m}).row;
    for (std::size_t row = from; row <= to; ++row) {
      if (f(row * columns_ + column)) return true;
    }
  }
  return false;
}

std::vector<EdgeGrid::Edge> edges_of(const Area& area);

/// Squared distance of a point from an edge.
double square_from_edge(EnuPoint p, const EdgeGrid::Edge& edge) noexcept;

/// Where one may drive.
class Ways {
 public:
  /// @param part what the ends of all ways lie in. Ways may leave it by `slack_m`, > 0.
  Ways(const Part& part, double slack_m, double sagitta_m);

  /// Does the straight line stay inside?
  bool clear(EnuPoint a, EnuPoint b) const;
  /// Straight, or with corners where the border is in the way: along it, pulled tight. Not always
  /// the shortest. @return with both ends
  std::vector<EnuPoint> way(EnuPoint a, EnuPoint b) const;
  /// How far one gets from `a` towards `b`, 0 … 1.
  double share_clear(EnuPoint a, EnuPoint b) const;

 private:
  struct Hit {
    double along = 0.0;  ///< of the straight line, 0 … 1
    std::size_t ring = 0;
    std::size_t edge = 0;  ///< from point `edge` to the next
    EnuPoint at;
  };
  std::vector<Hit> hits(EnuPoint a, EnuPoint b) const;
  void follow(const Hit& from, const Hit& to, std::vector<EnuPoint>& out) const;
  std::vector<EnuPoint> pulled(const std::vector<EnuPoint>& points) const;

  EdgeGrid walls_;  ///< a little outside of the rings that are followed
  std::vector<Ring> rings_;
  std::vector<std::vector<double>> run_m_;  ///< of each ring, the way from its first point
};

}  // namespace roverd::mission::survey
