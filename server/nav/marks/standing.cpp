#include "nav/marks/standing.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kFollows_s = 2.0;
constexpr double kUnseen_s = 2.0;  ///< it may have been carried away and back
constexpr double kAstray_m = 0.1;
constexpr double kOfWay = 0.05;
constexpr double kOfTurn = 0.05;
/// From one leg to the other one, and to a stick that somebody carries.
constexpr double kBeside_m = 0.8;
constexpr double kSameStir_m = 0.2;

/// What is left after so long of what fades within kFollows_s.
double left_of_it(double dt_s) noexcept {
  return std::exp(-std::max(0.0, dt_s) / kFollows_s);
}

}  // namespace

bool Standing::holds(Vec2 at, double by_m, base::Time now) const noexcept {
  return base::seconds(now - seen_) > kUnseen_s || length(at - at_) <= by_m;
}

bool Standing::see(Vec2 at, double by_m, int most, base::Time now) noexcept {
  const double dt_s = base::seconds(now - seen_);
  if (dt_s > kUnseen_s) {
    seen_ = since_ = now;
    at_ = at;
    astray_ = 0;
    return false;
  }
  seen_ = now;
  if (holds(at, by_m, now)) {
    at_ = at_ + (1.0 - left_of_it(dt_s)) * (at - at_);
    astray_ = 0;
    return false;
  }
  if (++astray_ < most) return false;
  at_ = at;
  since_ = now;
  astray_ = 0;
  return true;
}

void Slack::move(const Pose2& pose, base::Time now) noexcept {
  const double dt_s = base::seconds(now - at_);
  // Where it was before is not known, or it is long ago.
  if (dt_s > kUnseen_s) pose_ = pose;
  way_m_ = left_of_it(dt_s) * way_m_ + length(Vec2{pose.x_m - pose_.x_m, pose.y_m - pose_.y_m});
  turn_rad_ = left_of_it(dt_s) * turn_rad_ + std::abs(base::wrap_rad(pose.yaw_rad - pose_.yaw_rad));
  pose_ = pose;
  at_ = now;
}

double Slack::at_m(double range_m) const noexcept {
  return kAstray_m + kOfWay * way_m_ + kOfTurn * turn_rad_ * range_m;
}

void Stirs::tell(Vec2 at, double radius_m, base::Time now) {
  std::erase_if(stirs_, [&](const Stir& s) {
    return base::seconds(now - s.seen) > kLong_s || length(s.at - at) < kSameStir_m;
  });
  if (stirs_.size() == kMost) stirs_.erase(std::ranges::min_element(stirs_, {}, &Stir::seen));
  stirs_.push_back({at, radius_m, now});
}

bool Stirs::beside(Vec2 at, base::Time now) const noexcept {
  return std::ranges::any_of(stirs_, [&](const Stir& s) {
    return base::seconds(now - s.seen) <= kLong_s && length(s.at - at) <= s.radius_m + kBeside_m;
  });
}

}  // namespace roverd::nav::marks
