#pragma once
// A judge of coverage that shares nothing with the planner: a field as a fine raster, distances by
// the exact distance transform (Felzenszwalb and Huttenlocher 2012), the path painted onto it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace roverd::mission {

struct Spot {
  double x_m = 0.0;
  double y_m = 0.0;
};
using Outline = std::vector<Spot>;

class FieldRaster {
 public:
  /// @param outlines the field, then its holes
  FieldRaster(const std::vector<Outline>& outlines, double cell_m)
      : outlines_(outlines), cell_m_(cell_m) {
    double east = -1e9;
    double north = -1e9;
    for (const Spot& p : outlines.front()) {
      west_ = std::min(west_, p.x_m);
      south_ = std::min(south_, p.y_m);
      east = std::max(east, p.x_m);
      north = std::max(north, p.y_m);
    }
    west_ -= 2.0 * cell_m;
    south_ -= 2.0 * cell_m;
    columns_ = static_cast<std::size_t>((east - west_) / cell_m) + 3;
    rows_ = static_cast<std::size_t>((north - south_) / cell_m) + 3;
    field_.assign(columns_ * rows_, false);
    for (std::size_t row = 0; row < rows_; ++row) {
      const double y = south_ + (static_cast<double>(row) + 0.5) * cell_m;
      std::vector<double> hits;
      for (const Outline& o : outlines) {
        for (std::size_t i = 0, j = o.size() - 1; i < o.size(); j = i++) {
          if ((o[i].y_m > y) == (o[j].y_m > y)) continue;
          hits.push_back(o[i].x_m + (y - o[i].y_m) / (o[j].y_m - o[i].y_m) * (o[j].x_m - o[i].x_m));
        }
      }
      std::sort(hits.begin(), hits.end());
      for (std::size_t column = 0; column < columns_; ++column) {
        const double x = west_ + (static_cast<double>(column) + 0.5) * cell_m;
        const auto passed = std::lower_bound(hits.begin(), hits.end(), x) - hits.begin();
        field_[row * columns_ + column] = passed % 2 == 1;
      }
    }
  }

  /// Share of what a disc of this radius reaches whose middle stays `border_m` inside of the field,
  /// that is nearer than the radius to the path.
  double covered_share(const std::vector<Spot>& path, double radius_m, double border_m) const {
    std::vector<bool> outside(field_.size());
    for (std::size_t i = 0; i < field_.size(); ++i) outside[i] = !field_[i];
    const auto from_outside = squares(outside);
    std::vector<bool> drivable(field_.size());
    const double border = border_m / cell_m_ + 0.5;
    for (std::size_t i = 0; i < field_.size(); ++i)
      drivable[i] = from_outside[i] >= border * border;
    const auto from_drivable = squares(drivable);
    const auto driven = painted(path, radius_m);
    const double radius = radius_m / cell_m_;
    double due = 0.0;
    double done = 0.0;
    for (std::size_t i = 0; i < field_.size(); ++i) {
      if (!field_[i] || from_drivable[i] > radius * radius) continue;
      due += 1.0;
      if (driven[i]) done += 1.0;
    }
    return due > 0.0 ? done / due : 0.0;
  }

  /// Least distance of any point of the path from the outlines; below 0 outside of the field.
  double clearance_m(const std::vector<Spot>& path) const {
    double least = 1e9;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double way = std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
      const int pieces = std::max(1, static_cast<int>(way / (2.0 * cell_m_)));
      for (int k = 0; k <= pieces; ++k) {
        const double share = static_cast<double>(k) / pieces;
        const Spot p{path[i - 1].x_m + share * (path[i].x_m - path[i - 1].x_m),
                     path[i - 1].y_m + share * (path[i].y_m - path[i - 1].y_m)};
        const double far = from_outlines_m(p);
        least = std::min(least, within(p) ? far : -far);
      }
    }
    return least;
  }

 private:
  static double from_edge_m(Spot p, Spot a, Spot b) {
    const double x = b.x_m - a.x_m;
    const double y = b.y_m - a.y_m;
    const double t = std::clamp(
        ((p.x_m - a.x_m) * x + (p.y_m - a.y_m) * y) / std::max(1e-12, x * x + y * y), 0.0, 1.0);
    return std::hypot(p.x_m - a.x_m - t * x, p.y_m - a.y_m - t * y);
  }

  double from_outlines_m(Spot p) const {
    double best = 1e9;
    for (const Outline& o : outlines_) {
      for (std::size_t i = 0, j = o.size() - 1; i < o.size(); j = i++) {
        best = std::min(best, from_edge_m(p, o[j], o[i]));
      }
    }
    return best;
  }

  bool within(Spot p) const {
    bool in = false;
    for (const Outline& o : outlines_) {
      for (std::size_t i = 0, j = o.size() - 1; i < o.size(); j = i++) {
        if ((o[i].y_m > p.y_m) == (o[j].y_m > p.y_m)) continue;
        const double x =
            o[i].x_m + (p.y_m - o[i].y_m) / (o[j].y_m - o[i].y_m) * (o[j].x_m - o[i].x_m);
        if (p.x_m < x) in = !in;
      }
    }
    return in;
  }

  std::vector<bool> painted(const std::vector<Spot>& path, double radius_m) const {
    std::vector<bool> out(field_.size(), false);
    const auto index = [this](double along_m, std::size_t count) {
      return static_cast<std::size_t>(
          std::clamp(along_m / cell_m_, 0.0, static_cast<double>(count - 1)));
    };
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Spot a = path[i - 1];
      const Spot b = path[i];
      const std::size_t top = index(std::max(a.y_m, b.y_m) + radius_m - south_, rows_);
      const std::size_t right = index(std::max(a.x_m, b.x_m) + radius_m - west_, columns_);
      for (std::size_t row = index(std::min(a.y_m, b.y_m) - radius_m - south_, rows_); row <= top;
           ++row) {
        for (std::size_t column = index(std::min(a.x_m, b.x_m) - radius_m - west_, columns_);
             column <= right; ++column) {
          const std::size_t at = row * columns_ + column;
          if (out[at]) continue;
          const Spot p{west_ + (static_cast<double>(column) + 0.5) * cell_m_,
                       south_ + (static_cast<double>(row) + 0.5) * cell_m_};
          out[at] = from_edge_m(p, a, b) <= radius_m;
        }
      }
    }
    return out;
  }

  /// Squared distance in cells of each cell from the nearest that is set.
  std::vector<double> squares(const std::vector<bool>& set) const {
    constexpr double kFar = 1e12;
    std::vector<double> out(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) out[i] = set[i] ? 0.0 : kFar;
    for (std::size_t row = 0; row < rows_; ++row) transform(out, row * columns_, 1, columns_);
    for (std::size_t column = 0; column < columns_; ++column) {
      transform(out, column, columns_, rows_);
    }
    return out;
  }

  static void transform(std::vector<double>& f, std::size_t first, std::size_t step,
                        std::size_t count) {
    std::vector<double> g(count);
    std::vector<std::size_t> v(count);
    std::vector<double> z(count + 1);
    for (std::size_t i = 0; i < count; ++i) g[i] = f[first + i * step];
    std::size_t k = 0;
    v[0] = 0;
    z[0] = -1e18;
    z[1] = 1e18;
    for (std::size_t q = 1; q < count; ++q) {
      const auto meet = [&](std::size_t p) {
        const double a = static_cast<double>(q);
        const double b = static_cast<double>(p);
        return ((g[q] + a * a) - (g[p] + b * b)) / (2.0 * a - 2.0 * b);
      };
      double s = meet(v[k]);
      while (s <= z[k]) s = meet(v[--k]);
      v[++k] = q;
      z[k] = s;
      z[k + 1] = 1e18;
    }
    k = 0;
    for (std::size_t q = 0; q < count; ++q) {
      while (z[k + 1] < static_cast<double>(q)) ++k;
      const double d = static_cast<double>(q) - static_cast<double>(v[k]);
      f[first + q * step] = d * d + g[v[k]];
    }
  }

  const std::vector<Outline> outlines_;
  const double cell_m_;
  double west_ = 1e9;
  double south_ = 1e9;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<bool> field_;
};

}  // namespace roverd::mission
