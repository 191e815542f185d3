#include "nav/track/ease.hpp"

#include <cmath>

namespace roverd::nav {
namespace {

constexpr int kSimpson = 16;  // even

}  // namespace

EasedBend::EasedBend(EnuPoint begin, double yaw_rad, const std::array<Arc, 2>& arcs,
                     double window_m)
    : arcs_(arcs), window_m_(window_m) {
  joints_[0] = joints_[1] = joints_[2] = {begin, yaw_rad};
  joints_[1] = raw(arcs_[0].length_m);
  joints_[2] = raw(arcs_[0].length_m + arcs_[1].length_m);
}

/// Where the arcs are at s, lines before and behind them.
EasedBend::Pose EasedBend::raw(double s_m) const noexcept {
  const double first_m = arcs_[0].length_m;
  const bool second = s_m > first_m;
  const bool behind = s_m > first_m + arcs_[1].length_m;
  const Pose& from = joints_[behind ? 2 : second ? 1 : 0];
  const double along_m = s_m - (behind ? first_m + arcs_[1].length_m : second ? first_m : 0.0);
  const double k = behind || s_m < 0.0 ? 0.0 : arcs_[second ? 1 : 0].curvature_1pm;
  const double half = 0.5 * k * along_m;
  const double chord_m = std::abs(half) < 1e-9 ? along_m : along_m * std::sin(half) / half;
  return {{from.at.east_m + chord_m * std::cos(from.yaw_rad + half),
           from.at.north_m + chord_m * std::sin(from.yaw_rad + half)},
          from.yaw_rad + 2.0 * half};
}

EasedBend::Place EasedBend::place(double s_m) const noexcept {
  const double from_m = s_m - window_m_;
  EnuPoint sum{};
  for (int i = 0; i <= kSimpson; ++i) {
    const double weight = i == 0 || i == kSimpson ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const EnuPoint q = raw(from_m + window_m_ * i / kSimpson).at;
    sum = {sum.east_m + weight * q.east_m, sum.north_m + weight * q.north_m};
  }
  const Pose a = raw(from_m);
  const Pose b = raw(s_m);
  const double dx = (b.at.east_m - a.at.east_m) / window_m_;
  const double dy = (b.at.north_m - a.at.north_m) / window_m_;
  const double ddx = (std::cos(b.yaw_rad) - std::cos(a.yaw_rad)) / window_m_;
  const double ddy = (std::sin(b.yaw_rad) - std::sin(a.yaw_rad)) / window_m_;
  const double speed = std::hypot(dx, dy);
  constexpr double kThird = 1.0 / (3.0 * kSimpson);
  return {{sum.east_m * kThird, sum.north_m * kThird},
          (dx * ddy - dy * ddx) / (speed * speed * speed)};
}

}  // namespace roverd::nav
