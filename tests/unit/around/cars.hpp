#pragma once
// The shortest way of a car through random ground, by a planner of another kind: every place of
// 15 cm and 5 degrees that arcs and straights of 30 cm come to, ahead and backwards, in the order
// of the way driven until there. What it finds can be driven; there may be a little shorter ones.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "nav/sense/grid.hpp"
#include "scene.hpp"

namespace roverd::nav::around::tests {

/// 4 m of radius, the origin on its rear axle.
inline Question car_along_x(double half_m = 5.0) {
  Question q = along_x(half_m);
  q.rejoin_within_m = 8.0;
  q.route.front() = {-8.0, 0.0};
  q.here_m = 8.0;
  q.kinematics = {4.0, false, true};
  q.body = sense::Footprint::box(2.4, 1.2, 0.4);
  return q;
}

class CarReference {
 public:
  /// As far as the window of 20 m goes for such a body.
  static constexpr double kGoal_m = 7.4;

  CarReference(const Footprint& body, double radius_m, double margin_m)
      : radius_m_(radius_m), margin_m_(static_cast<float>(margin_m)) {
    const auto corners = body.corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 e = corners[(i + 1) % corners.size()] - corners[i];
      const int n = static_cast<int>(std::hypot(e.x, e.y) / 0.1) + 1;
      for (int k = 0; k < n; ++k) outline_.push_back(corners[i] + (double(k) / n) * e);
    }
  }

  /// @return metres from the origin, ahead and backwards, to where the body's origin comes to
  /// kGoal_m along x, within 60 degrees of it; infinity: there is no way
  double shortest_m(const Scene& s, double half_m) {
    scene_ = &s.patch;
    half_m_ = half_m;
    sense::clearance(s.patch, false, 1.0F, clear_);
    way_.assign(kPlaces * kPlaces * kHeadings, kNone);
    if (!stands({})) return std::numeric_limits<double>::infinity();
    open_ = {};
    put({}, 0.0F);
    while (!open_.empty()) {
      const Entry top = open_.top();
      open_.pop();
      if (top.way > way_[top.place]) continue;
      const bool along = std::abs(top.pose.yaw_rad) < base::kPi / 3.0;
      if (top.pose.x_m >= kGoal_m && along) return static_cast<double>(top.way);
      for (const double bend : {0.0, 1.0, -1.0, 0.5, -0.5}) {
        for (const double way : {kStep_m, -kStep_m}) drive(top, bend / radius_m_, way);
      }
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double kStep_m = 0.3;
  static constexpr double kPlace_m = 0.15;
  static constexpr std::size_t kPlaces = 134;
  static constexpr std::size_t kHeadings = 72;
  static constexpr float kNone = 1e9F;

  struct Entry {
    float left = 0.0F;  ///< the way until there, and at least what is to go
    float way = 0.0F;
    std::size_t place = 0;
    Pose2 pose;
    bool operator>(const Entry& o) const { return left > o.left; }
  };

  void drive(const Entry& from, double bend_1pm, double way_m) {
    Pose2 at;
    for (const double part : {1.0 / 3.0, 2.0 / 3.0, 1.0}) {
      const double l = part * way_m;
      at = from.pose * sense::along(l, l * bend_1pm, 1.0);
      if (!stands(at)) return;
    }
    put(at, from.way + static_cast<float>(std::abs(way_m)));
  }

  bool stands(const Pose2& at) const {
    const double c = std::cos(at.yaw_rad);
    const double s = std::sin(at.yaw_rad);
    return std::all_of(outline_.begin(), outline_.end(), [&](Vec2 p) {
      const double x = at.x_m + c * p.x - s * p.y;
      const double y = at.y_m + s * p.x + c * p.y;
      if (std::abs(y) > half_m_) return false;
      const auto ix = static_cast<std::int32_t>(std::floor(x / scene_->cell_m)) - scene_->x0;
      const auto iy = static_cast<std::int32_t>(std::floor(y / scene_->cell_m)) - scene_->y0;
      if (ix < 0 || iy < 0 || ix >= scene_->side || iy >= scene_->side) return false;
      // From the middle of this cell to that of the taken one: half of each is taken off.
      const float free =
          clear_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(scene_->side) +
                 static_cast<std::size_t>(ix)];
      return free - static_cast<float>(scene_->cell_m) >= margin_m_;
    });
  }

  void put(const Pose2& at, float way) {
    const double px = (at.x_m + 10.0) / kPlace_m;
    const double py = (at.y_m + 10.0) / kPlace_m;
    if (px < 0.0 || py < 0.0 || px >= kPlaces || py >= kPlaces) return;
    const double turn = (at.yaw_rad + base::kPi) / (2.0 * base::kPi) * kHeadings;
    const std::size_t place =
        (static_cast<std::size_t>(py) * kPlaces + static_cast<std::size_t>(px)) * kHeadings +
        static_cast<std::size_t>(turn + 0.5) % kHeadings;
    if (way >= way_[place]) return;
    way_[place] = way;
    open_.push({way + static_cast<float>(std::max(0.0, kGoal_m - at.x_m)), way, place, at});
  }

  double radius_m_;
  float margin_m_;
  double half_m_ = 0.0;
  const Patch* scene_ = nullptr;
  std::vector<Vec2> outline_;
  std::vector<float> clear_;
  std::vector<float> way_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace roverd::nav::around::tests
