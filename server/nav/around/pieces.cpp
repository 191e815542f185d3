#include "nav/around/pieces.hpp"

#include <algorithm>
#include <limits>

namespace roverd::nav::around {

namespace {

double turn(double a) noexcept {
  const double full = 2.0 * base::kPi;
  const double r = std::fmod(a, full);
  const double t = r < 0.0 ? r + full : r;
  return full - t < 1e-9 ? 0.0 : t;  // a hair less than a full turn is none
}

/// In units of the radius, the first pose at the origin, d ahead of the line between the two.
struct Word {
  double t = 0.0;
  double p = 0.0;
  double q = 0.0;
  int first = 0;   ///< 1 left, −1 right
  int middle = 0;  ///< 0 straight
  int last = 0;
};

struct Best {
  Word word;
  double length = std::numeric_limits<double>::infinity();
  void take(const Word& w) noexcept {
    const double l = w.t + w.p + w.q;
    if (l < length) {
      length = l;
      word = w;
    }
  }
};

}  // namespace

Link dubins(const Pose2& from, const Pose2& to, double radius_m) noexcept {
  const double dx = (to.x_m - from.x_m) / radius_m;
  const double dy = (to.y_m - from.y_m) / radius_m;
  const double d = std::hypot(dx, dy);
  const double line = d > 1e-12 ? std::atan2(dy, dx) : 0.0;
  const double a = turn(from.yaw_rad - line);
  const double b = turn(to.yaw_rad - line);
  const double sa = std::sin(a);
  const double ca = std::cos(a);
  const double sb = std::sin(b);
  const double cb = std::cos(b);
  const double cab = std::cos(a - b);
  Best best;
  if (const double p2 = 2.0 + d * d - 2.0 * cab + 2.0 * d * (sa - sb); p2 >= 0.0) {
    const double m = std::atan2(cb - ca, d + sa - sb);
    best.take({turn(m - a), std::sqrt(p2), turn(b - m), 1, 0, 1});
  }
  if (const double p2 = 2.0 + d * d - 2.0 * cab + 2.0 * d * (sb - sa); p2 >= 0.0) {
    const double m = std::atan2(ca - cb, d - sa + sb);
    best.take({turn(a - m), std::sqrt(p2), turn(m - b), -1, 0, -1});
  }
  if (const double p2 = -2.0 + d * d + 2.0 * cab + 2.0 * d * (sa + sb); p2 >= 0.0) {
    const double p = std::sqrt(p2);
    const double m = std::atan2(-ca - cb, d + sa + sb) - std::atan2(-2.0, p);
    best.take({turn(m - a), p, turn(m - b), 1, 0, -1});
  }
  if (const double p2 = -2.0 + d * d + 2.0 * cab - 2.0 * d * (sa + sb); p2 >= 0.0) {
    const double p = std::sqrt(p2);
    const double m = std::atan2(ca + cb, d - sa - sb) - std::atan2(2.0, p);
    best.take({turn(a - m), p, turn(b - m), -1, 0, 1});
  }
  if (const double k = (6.0 - d * d + 2.0 * cab + 2.0 * d * (sa - sb)) / 8.0; std::abs(k) <= 1.0) {
    const double p = turn(2.0 * base::kPi - std::acos(k));
    const double t = turn(a - std::atan2(ca - cb, d - sa + sb) + 0.5 * p);
    best.take({t, p, turn(a - b - t + p), -1, 1, -1});
  }
  if (const double k = (6.0 - d * d + 2.0 * cab + 2.0 * d * (sb - sa)) / 8.0; std::abs(k) <= 1.0) {
    const double p = turn(2.0 * base::kPi - std::acos(k));
    const double t = turn(-a - std::atan2(ca - cb, d + sa - sb) + 0.5 * p);
    best.take({t, p, turn(b - a - t + p), 1, -1, 1});
  }
  const double bend = 1.0 / radius_m;
  Link link;
  link.add({best.word.first * bend, best.word.t * radius_m, 0.0});
  link.add({best.word.middle * bend, best.word.p * radius_m, 0.0});
  link.add({best.word.last * bend, best.word.q * radius_m, 0.0});
  return link;
}

Link straight_between_turns(const Pose2& from, const Pose2& to) noexcept {
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  const double d = std::hypot(dx, dy);
  const double line = d > 1e-6 ? std::atan2(dy, dx) : to.yaw_rad;
  Link link;
  link.add({0.0, 0.0, base::angle_diff_rad(from.yaw_rad, line)});
  link.add({0.0, d, 0.0});
  link.add({0.0, 0.0, base::angle_diff_rad(line, to.yaw_rad)});
  return link;
}

}  // namespace roverd::nav::around
