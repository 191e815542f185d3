#include "nav/around/trace.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav::around {

namespace {

constexpr double kApart_m = 0.08;
constexpr double kApart_rad = base::kPi / 45.0;
constexpr double kOff_m = 0.05;
constexpr double kOff_rad = base::kPi / 18.0;
constexpr double kTurns_rad = base::kPi / 18.0;

bool over_unseen(const sense::Patch& patch, const Question& q, const Field& field,
                 const Pose2& pose) {
  const Pose2 bo = sense::inverse(pose);
  const double reach = q.body.reach_m() + patch.cell_m;
  const Vec2 at{pose.x_m, pose.y_m};
  if (!field.any_unseen(at - Vec2{reach, reach}, at + Vec2{reach, reach})) return false;
  const auto cell = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v / patch.cell_m));
  };
  for (std::int32_t y = cell(pose.y_m - reach); y <= cell(pose.y_m + reach); ++y) {
    for (std::int32_t x = cell(pose.x_m - reach); x <= cell(pose.x_m + reach); ++x) {
      if (patch.at(x, y).known != sense::Known::Unknown) continue;
      const Vec2 m{(x + 0.5) * patch.cell_m, (y + 0.5) * patch.cell_m};
      if (!field.unseen(m.x, m.y)) continue;  // beside the start
      const Pose2 in = bo * Pose2{m.x, m.y, 0.0};
      if (q.body.distance_m({in.x_m, in.y_m}) <= 0.0) return true;
    }
  }
  return false;
}

}  // namespace

void Trace::lay(const Pose2& start, std::span<const Piece> pieces, std::vector<Place>& path) {
  path.clear();
  path.push_back({start, false, false, 0.0});
  Pose2 at = start;
  for (const Piece& p : pieces) {
    const double turn = p.pivot() ? p.turn_rad : p.length_m * p.curvature_1pm;
    const double most = std::max(std::abs(p.length_m) / kApart_m, std::abs(turn) / kApart_rad);
    const int n = std::max(1, static_cast<int>(std::ceil(most)));
    for (int i = 1; i <= n; ++i) {
      path.push_back({p.after(at, static_cast<double>(i) / n), p.length_m < 0.0, p.pivot(),
                      p.pivot() ? 0.0 : p.curvature_1pm});
    }
    at = path.back().pose;
  }
  if (!path.empty() && path.size() > 1) path.front().reverse = path[1].reverse;
}

std::size_t Trace::seen(const sense::Patch& patch, const Question& q, const Field& field,
                        std::span<const Place> path, bool ahead_too) {
  std::size_t n = 0;
  while (n < path.size() &&
         ((!ahead_too && !path[n].reverse) || !over_unseen(patch, q, field, path[n].pose))) {
    ++n;
  }
  return n;
}

double Trace::length_m(std::span<const Place> path) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    sum += std::hypot(path[i].pose.x_m - path[i - 1].pose.x_m,
                      path[i].pose.y_m - path[i - 1].pose.y_m);
  }
  return sum;
}

bool Trace::turns(std::span<const Place> path) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (!path[i].pivot) continue;
    sum += std::abs(base::angle_diff_rad(path[i - 1].pose.yaw_rad, path[i].pose.yaw_rad));
  }
  return sum > kTurns_rad;
}

void Trace::tell(const Lane& lane, Answer& a) {
  bool left = false;
  double beside = 0.0;
  double farthest = 0.0;
  for (const Place& p : a.path) {
    const Beside b = lane.beside({p.pose.x_m, p.pose.y_m});
    const double off = base::angle_diff_rad(lane.pose(b.along_m).yaw_rad, p.pose.yaw_rad);
    if (!left && (b.distance_m > kOff_m || std::abs(off) > kOff_rad)) {
      left = true;
      a.leave_m = b.along_m;
    }
    if (b.along_m >= a.blocked_from_m && b.along_m <= a.blocked_to_m) beside += b.left_m;
    if (std::abs(b.left_m) > std::abs(farthest)) farthest = b.left_m;
  }
  if (!left) a.leave_m = lane.beside({a.path.back().pose.x_m, a.path.back().pose.y_m}).along_m;
  const double side = beside != 0.0 ? beside : farthest;
  if (std::abs(farthest) > kOff_m) a.side = side > 0.0 ? Side::Left : Side::Right;
}

}  // namespace roverd::nav::around
