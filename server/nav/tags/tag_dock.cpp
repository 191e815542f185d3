#include "nav/tags/tag_dock.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.hpp"

namespace roverd::nav::tags {
namespace {

constexpr int kMostTries = 3;
constexpr double kBehind_m = 1.0;
constexpr double kLineTimeout_s = 60.0;
constexpr double kOnLine_m = 0.06;
constexpr double kOnLine_rad = 0.09;
constexpr int kMostGates = 6;
constexpr int kMostTurns = 3;

EnuPoint at(const sense::Pose2& p) noexcept {
  return {p.x_m, p.y_m};
}

}  // namespace

/// Short settling, and a stop within millimetres: at the speed of docking both are calm.
PathParams TagDock::careful(PathParams p) {
  p.track.settle_min_m = std::min(p.track.settle_min_m, 0.25);
  p.track.arrive_m = std::min(p.track.arrive_m, 0.01);
  p.speed.min_mps = std::min(p.speed.min_mps, 0.05);
  p.pivot.done_deg = std::min(p.pivot.done_deg, 0.3);
  return p;
}

TagDock::TagDock(base::Setting<PathParams> path, base::Setting<BehaveParams> behave)
    : path_(base::Setting<PathParams>(careful(*path))),
      trip_(path_, std::move(behave)),
      tracker_(path_) {}

void TagDock::begin(base::Time now) {
  trip_.reset();
  tracker_.reset();
  line_.reset();
  tag_.reset();
  goal_.reset();
  seen_at_ = now;
  news_ = false;
  tries_ = 0;
  gates_ = 0;
  reason_.clear();
  state_ = State::Search;
}

void TagDock::see(const TagTrack& track) {
  const auto pose = track.pose();
  if (!pose) return;
  tag_ = pose;
  seen_at_ = track.seen_at();
  news_ = true;
}

void TagDock::fail(std::string why) {
  reason_ = std::move(why);
  state_ = State::Failed;
}

/// Along the line, to the pose; negative: beyond it.
double TagDock::left_m(const Vehicle& v) const noexcept {
  const EnuPoint to = at(*goal_) - v.at;
  return to.east_m * std::cos(goal_->yaw_rad) + to.north_m * std::sin(goal_->yaw_rad);
}

void TagDock::to_gate(const Vehicle& v, const TagDockParams& params) {
  Trip::Order order;
  Vertex gate;
  gate.at = at(*goal_ * sense::Pose2{-params.gate_m, 0.0, 0.0});
  gate.speed_mps = params.way_mps;
  order.way.push_back(gate);
  order.face_yaw_rad = goal_->yaw_rad;
  order.within_m = 0.3;
  state_ = State::ToGate;
  trip_.begin(std::move(order), v, false);
}

void TagDock::back(const Vehicle& v, const TagDockParams& params) {
  Trip::Order order;
  Vertex gate;
  gate.at = at(*goal_ * sense::Pose2{-params.gate_m, 0.0, 0.0});
  gate.speed_mps = params.dock_mps;
  gate.reverse = true;
  order.way.push_back(gate);
  order.face_yaw_rad = goal_->yaw_rad;
  state_ = State::Back;
  trip_.begin(std::move(order), v, false);
}

/// @param first from a stand; else the way that is driven is replaced by the newer one.
void TagDock::lay_line(const Vehicle& v, const TagDockParams& params, bool first) {
  const double here_m = left_m(v);
  Vertex begin;
  begin.at = at(*goal_ * sense::Pose2{-(std::max(here_m, 0.0) + kBehind_m), 0.0, 0.0});
  begin.speed_mps = params.dock_mps;
  Vertex end = begin;
  end.at = at(*goal_);
  const std::vector<Vertex> both{begin, end};
  auto path = std::make_shared<const Path>(build_path(both, *path_));
  if (path->legs.empty()) return;
  if (first) {
    tracker_.reset();
    tracker_.begin(*path, 0, kBehind_m);
    on_line_s_ = 0.0;
    looked_s_ = 0.0;
    turns_ = 0;
  } else {
    tracker_.move_to(*path, 0, kBehind_m);
  }
  line_ = std::move(path);
  state_ = State::Line;
}

void TagDock::judge(const Vehicle& v, const TagDockParams& params) {
  // By the tag where it is still seen, else by the odometry since: both stand in the goal.
  const double off_m = base::distance_m(v.at, at(*goal_));
  const double off_deg =
      std::abs(base::deg_from_rad(base::angle_diff_rad(v.yaw_rad, goal_->yaw_rad)));
  if (off_m <= params.within_m && off_deg <= params.within_deg) {
    state_ = State::Docked;
    return;
  }
  if (++tries_ >= kMostTries) {
    fail("stands " + std::to_string(std::lround(off_m * 1000.0)) + " mm and " +
         std::to_string(std::lround(off_deg * 10.0)) + " tenths of a degree off");
    return;
  }
  back(v, params);
}

TrackOutput TagDock::on_line(const Vehicle& v, const TagDockParams& params, double dt_s) {
  on_line_s_ += dt_s;
  if (on_line_s_ > kLineTimeout_s) {
    fail("the line took too long");
    return {};
  }
  if (news_ && left_m(v) > params.straight_m && tracker_.phase() == TrackPhase::Track) {
    lay_line(v, params, false);
  }
  const TrackOutput out = tracker_.step(v, params.dock_mps, dt_s);
  if (tracker_.phase() != TrackPhase::Done) return out;
  // It stands where the tag is seen best: a last look, and a small turn where that helps.
  looked_s_ += dt_s;
  if (looked_s_ < params.look_s) return out;
  const double off_deg = base::deg_from_rad(base::angle_diff_rad(v.yaw_rad, goal_->yaw_rad));
  if (std::abs(off_deg) > 0.4 * params.within_deg && turns_ < kMostTurns) {
    ++turns_;
    looked_s_ = 0.0;
    tracker_.begin_turn(goal_->yaw_rad);
    return out;
  }
  judge(v, params);
  return out;
}

TrackOutput TagDock::step(const Vehicle& v, const TagDockParams& params, base::Time now,
                          double dt_s) {
  if (state_ == State::Docked || state_ == State::Failed) return {};
  if (tag_) goal_ = *tag_ * sense::Pose2{-params.stand_off_m, 0.0, 0.0};
  const bool near = state_ == State::Line && goal_ && left_m(v) <= params.straight_m;
  const bool turning = state_ == State::ToGate || state_ == State::Back;  // it may look away
  if (!near && !turning && base::seconds(now - seen_at_) > params.lost_s) {
    fail("the tag is not seen");
    return {};
  }
  if (state_ == State::Search) {
    if (goal_) to_gate(v, params);
    return {};
  }
  TrackOutput out;
  if (turning) {
    out = trip_.step(v, 10.0, dt_s);
    if (trip_.state() == Trip::State::Failed) fail(trip_.reason());
    if (trip_.state() == Trip::State::There) {
      state_ = State::Look;
      looked_s_ = 0.0;
      seen_at_ = std::max(seen_at_, now);  // from here on it must be seen
    }
  } else if (state_ == State::Look) {
    looked_s_ += dt_s;
    if (looked_s_ < params.look_s) return {};
    // From here the tag is seen better than from afar: its line may lie elsewhere by now.
    const sense::Pose2 off =
        sense::inverse(*goal_) * sense::Pose2{v.at.east_m, v.at.north_m, v.yaw_rad};
    const bool on = std::abs(off.y_m) < kOnLine_m && std::abs(off.yaw_rad) < kOnLine_rad;
    if (on || ++gates_ > kMostGates) {
      lay_line(v, params, true);
    } else {
      to_gate(v, params);
    }
  } else {
    out = on_line(v, params, dt_s);
  }
  news_ = false;
  return out;
}

std::string_view to_string(TagDock::State s) noexcept {
  switch (s) {
    case TagDock::State::Search:
      return "search";
    case TagDock::State::ToGate:
      return "to_gate";
    case TagDock::State::Look:
      return "look";
    case TagDock::State::Line:
      return "line";
    case TagDock::State::Back:
      return "back";
    case TagDock::State::Docked:
      return "docked";
    case TagDock::State::Failed:
      return "failed";
  }
  return "";
}

}  // namespace roverd::nav::tags
