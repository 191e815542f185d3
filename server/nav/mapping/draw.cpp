#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "nav/mapping/mapper.hpp"

namespace roverd::nav::mapping {

namespace {

constexpr double kMargin_m = 0.5;

struct Tally {
  std::uint16_t ended = 0;
  std::uint16_t passed = 0;
};

void count(std::uint16_t& n) {
  if (n < UINT16_MAX) ++n;
}

struct Ray {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool hit = false;
};

/// In M; cut at farthest_m, where nothing is said to stand.
Ray ray_of(const chart::Scan& scan, const chart::Beam& beam, const Pose2& pose, double farthest_m) {
  const Eigen::Rotation2Dd turn(pose.yaw_rad);
  const Eigen::Vector2d at(pose.x_m, pose.y_m);
  const Eigen::Vector2d eye(scan.eye_x_m, scan.eye_y_m);
  Eigen::Vector2d way = Eigen::Vector2d(beam.x_m, beam.y_m) - eye;
  const double length_m = way.norm();
  const bool far = length_m > farthest_m;
  if (far) way *= farthest_m / length_m;
  return {at + turn * eye, at + turn * (eye + way), beam.hit && !far};
}

class Canvas {
 public:
  Canvas(chart::OccupancyMap& map)
      : map_(map), tallies_(std::size_t(map.columns()) * std::size_t(map.rows())) {}

  void add(const Ray& ray) {
    const auto a = map_.cell_of(ray.from.x(), ray.from.y());
    const auto b = map_.cell_of(ray.to.x(), ray.to.y());
    if (!a || !b) return;
    const std::int32_t dx = b->column - a->column;
    const std::int32_t dy = b->row - a->row;
    const std::int32_t steps = std::max(std::abs(dx), std::abs(dy));
    for (std::int32_t i = 0; i < steps; ++i) {
      // The nearest cell on the line, in whole numbers.
      count(tally({a->column + rounded(dx, i, steps), a->row + rounded(dy, i, steps)}).passed);
    }
    if (ray.hit) count(tally(*b).ended);
  }
  void finish() {
    for (std::int32_t row = 0; row < map_.rows(); ++row) {
      for (std::int32_t column = 0; column < map_.columns(); ++column) {
        const Tally& t = tally({column, row});
        const int all = t.ended + t.passed;
        if (all == 0) continue;
        // A wall met at a slant is passed by the beams that end one cell further on.
        const int percent = std::min(100, 100 * 2 * t.ended / all);
        map_.set({column, row}, static_cast<chart::Cell>(percent));
      }
    }
  }

 private:
  static std::int32_t rounded(std::int32_t d, std::int32_t i, std::int32_t steps) {
    const std::int64_t twice = 2 * std::int64_t{d} * i;
    return static_cast<std::int32_t>((twice + (twice >= 0 ? steps : -steps)) / (2 * steps));
  }
  Tally& tally(chart::CellAt c) {
    if (!map_.holds(c)) return outside_;
    return tallies_[std::size_t(c.row) * std::size_t(map_.columns()) + std::size_t(c.column)];
  }
  chart::OccupancyMap& map_;
  std::vector<Tally> tallies_;
  Tally outside_;
};

}  // namespace

base::Result<chart::OccupancyMap> drawn(std::span<const chart::Scan* const> scans,
                                        std::span<const Pose2> poses, const DrawParams& how) {
  const bool watched = static_cast<bool>(how.give_up);
  Eigen::AlignedBox2d box;
  const auto each = [&](auto&& use) {
    for (std::size_t i = 0; i < std::min(scans.size(), poses.size()); ++i) {
      if (watched && how.give_up()) return;
      for (const chart::Beam& beam : scans[i]->beams) {
        use(ray_of(*scans[i], beam, poses[i], how.farthest_m));
      }
    }
  };
  each([&](const Ray& ray) {
    box.extend(ray.from);
    box.extend(ray.to);
  });
  const auto given_up = [] {
    return base::fail(base::Code::Unavailable, "the map was given up while it was drawn");
  };
  if (watched && how.give_up()) return given_up();
  if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite()) {
    return base::fail(base::Code::Invalid, "nothing was seen of which a map could be drawn");
  }
  const Eigen::Vector2d size =
      ((box.sizes() + Eigen::Vector2d::Constant(2.0 * kMargin_m)) / how.resolution_m)
          .array()
          .ceil();
  constexpr double kMostSide = 1e6;
  if (!(size.maxCoeff() < kMostSide)) {
    return base::fail(base::Code::TooLarge, "what was seen is larger than a map may be");
  }
  chart::MapShape shape;
  shape.columns = static_cast<std::int32_t>(size.x());
  shape.rows = static_cast<std::int32_t>(size.y());
  shape.resolution_m = how.resolution_m;
  shape.origin = {box.min().x() - kMargin_m, box.min().y() - kMargin_m, 0.0};
  auto map = chart::OccupancyMap::make(shape);
  if (!map) return map;
  Canvas canvas(*map);
  each([&](const Ray& ray) { canvas.add(ray); });
  if (watched && how.give_up()) return given_up();
  canvas.finish();
  return map;
}

}  // namespace roverd::nav::mapping
