#include "nav/around/ahead.hpp"

namespace roverd::nav::around {

namespace {

constexpr double kLook_m = 0.05;
constexpr double kTargets_m = 0.2;  // between places where it may be joined
constexpr double kFree_m = 0.3;     // a gap on the route that is shorter is none
constexpr double kRoomOn_m = 0.4;   // free behind the place where it is joined
constexpr double kOn_m = 0.15;      // so far beside it the robot is on it
constexpr double kOn_rad = base::kPi / 12.0;
constexpr double kCorner_rad = base::kPi / 6.0;  // within 0.2 m: nobody joins there
// Driving on the route counts a little less than beside it: it is joined early.
constexpr float kOnRoute = 0.93F;

}  // namespace

void Ahead::find_blocked(const Question& q, const Lane& lane, const Body& body) {
  double free_since = -1.0;
  bool blocked = false;
  for (double s = q.here_m; s <= end_m_; s += kLook_m) {
    const bool fits = body.clears(lane.pose(s));
    if (!blocked) {
      if (fits) continue;
      blocked = true;
      from_m_ = s;
      free_since = -1.0;
    } else if (!fits) {
      free_since = -1.0;
    } else if (free_since < 0.0) {
      free_since = s;
    } else if (s - free_since >= kFree_m) {
      to_m_ = free_since;
      return;
    }
  }
  if (!blocked) {
    from_m_ = to_m_ = q.here_m;
    return;
  }
  to_m_ = free_since >= 0.0 ? free_since : end_m_;
}

void Ahead::look(const Question& q, const Lane& lane, const Field& field, const Body& body) {
  clear_ = lost_ = false;
  targets_.clear();
  end_m_ = q.here_m;
  const double reach = q.body.reach_m();
  while (end_m_ + kLook_m <= lane.end_m()) {
    const Vec2 p = lane.at(end_m_ + kLook_m);
    if (!field.inside(p.x, p.y, reach)) break;
    end_m_ += kLook_m;
  }
  ends_ = end_m_ + kLook_m > lane.end_m();
  if (ends_) end_m_ = lane.end_m();
  find_blocked(q, lane, body);
  if (from_m_ == to_m_ && from_m_ == q.here_m) {
    const Pose2 on = lane.pose(q.here_m);
    clear_ = std::hypot(q.pose.x_m - on.x_m, q.pose.y_m - on.y_m) < kOn_m &&
             std::abs(base::angle_diff_rad(on.yaw_rad, q.pose.yaw_rad)) < kOn_rad;
    if (clear_) return;
  }
  const double last = std::min(end_m_, to_m_ + q.rejoin_within_m);
  const auto take = [&](double s, double room_on_m) {
    const Pose2 at = lane.pose(s);
    const double turn =
        base::angle_diff_rad(lane.pose(s - 0.2).yaw_rad, lane.pose(s + 0.2).yaw_rad);
    if (std::abs(turn) > kCorner_rad || !body.fits(at)) return;
    for (double on = s; on <= std::min(end_m_, s + room_on_m); on += kLook_m) {
      if (!body.clears(lane.pose(on))) return;
    }
    targets_.push_back({at, s, kOnRoute * static_cast<float>(last - s)});
  };
  for (double s = to_m_; s <= last - kTargets_m; s += kTargets_m) take(s, kRoomOn_m);
  take(last, kRoomOn_m);
  lost_ = targets_.empty() && ends_ && q.at_end && to_m_ >= end_m_;
}

}  // namespace roverd::nav::around
