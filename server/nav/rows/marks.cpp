#include "nav/rows/marks.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav::rows {
namespace {

constexpr std::uint16_t kBelieved = 2;   // hits
constexpr std::uint16_t kMeanOver = 10;  // hits: older ones fade, as the odometry drifts
constexpr double kTidyEvery_m = 0.25;

std::uint64_t key_at(double x_m, double y_m) noexcept {
  const auto ix = static_cast<std::int32_t>(std::floor(x_m / Marks::kCell_m));
  const auto iy = static_cast<std::int32_t>(std::floor(y_m / Marks::kCell_m));
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(ix)) << 32) |
         static_cast<std::uint32_t>(iy);
}

}  // namespace

void Marks::clear() noexcept {
  cells_.clear();
  where_.clear();
  way_m_ = dropped_at_m_ = 0.0;
  begun_ = false;
}

void Marks::take(const RowScan& scan, double reach_m) {
  if (begun_) way_m_ += std::hypot(scan.pose.x_m - last_.x_m, scan.pose.y_m - last_.y_m);
  last_ = scan.pose;
  begun_ = true;
  const double c = std::cos(scan.pose.yaw_rad);
  const double s = std::sin(scan.pose.yaw_rad);
  for (const RowScan::Point& p : scan.points) {
    const auto px = double(p.x_m);
    const auto py = double(p.y_m);
    if (!(px * px + py * py <= reach_m * reach_m)) continue;
    const double x = scan.pose.x_m + c * px - s * py;
    const double y = scan.pose.y_m + s * px + c * py;
    const auto [found, fresh] =
        where_.try_emplace(key_at(x, y), static_cast<std::uint32_t>(cells_.size()));
    if (fresh) cells_.push_back({});
    Cell& cell = cells_[found->second];
    cell.hits = static_cast<std::uint16_t>(std::min<int>(cell.hits + 1, kMeanOver));
    cell.x_m += (x - cell.x_m) / double(cell.hits);
    cell.y_m += (y - cell.y_m) / double(cell.hits);
    cell.at_m = way_m_;
  }
  if (way_m_ - dropped_at_m_ > kTidyEvery_m || cells_.size() > kMost) {
    drop_far(scan.pose, reach_m);
  }
}

void Marks::drop_far(const sense::Pose2& body, double reach_m) {
  dropped_at_m_ = way_m_;
  std::erase_if(cells_, [&](const Cell& cell) {
    return std::hypot(cell.x_m - body.x_m, cell.y_m - body.y_m) > reach_m;
  });
  if (cells_.size() > kMost / 2) {  // so that the next ones have room
    const auto keep = static_cast<std::ptrdiff_t>(kMost / 2);
    cells_.erase(cells_.begin(), cells_.end() - keep);
  }
  where_.clear();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    where_[key_at(cells_[i].x_m, cells_[i].y_m)] = static_cast<std::uint32_t>(i);
  }
}

void Marks::read(std::vector<Mark>& out) const {
  out.clear();
  for (const Cell& cell : cells_) {
    if (cell.hits >= kBelieved) out.push_back({cell.x_m, cell.y_m, way_m_ - cell.at_m});
  }
}

}  // namespace roverd::nav::rows
