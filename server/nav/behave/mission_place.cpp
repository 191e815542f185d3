// Where a mission stands, as a value that outlives the program.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"

namespace roverd::nav {
namespace {

// What a robot may drive between its place being kept and standing without a program.
constexpr double kRolls_m = 2.0;
constexpr double kRolls_s = 3.0;
constexpr double kLook_m = 0.05;
constexpr double kOtherWay_m = 0.3;
constexpr double kCarried_m = 3.0;  // farther beside the way nobody rolls
constexpr double kBefore_m = 0.03;
const double kTurned_rad = base::rad_from_deg(120.0);  // nobody rolls round that

double direction_at(const Path& path, double s_m) {
  const Leg& leg = path.legs[std::min(path.leg_from(s_m), path.legs.size() - 1)];
  const auto next =
      std::upper_bound(path.points.begin(), path.points.end(), s_m,
                       [](double s, const PathPoint& point) { return s < point.s_m; });
  const auto near = static_cast<std::size_t>(next - path.points.begin());
  return path.yaw_rad(leg, s_m, near > 0 ? near - 1 : 0);
}

}  // namespace

std::optional<base::MissionPlace> Executor::place(std::optional<double> yaw_rad) const {
  if (!in_hand() || course_ == nullptr) return std::nullopt;
  base::MissionPlace p;
  p.back = course_ == &route_->back;
  p.step = static_cast<int>(at_);
  p.standing = standing_ ? static_cast<int>(*standing_) : -1;
  if (doing_ == Doing::Path) {
    p.s_m = tracker_.path() == &course_->path ? tracker_.s_m() : s_m_;
  } else if (rejoin_) {
    p.s_m = s_m_;
  }
  if (doing_ == Doing::Wait || stays_) p.wait_s = wait_s_;
  const RouteStep* step = step_now();
  const bool counts = step != nullptr && !step->yaw_rad;
  constexpr double kDone_rad = 1e-3;  // all of it, and it backs up to its end
  if (counts && step->kind == StepKind::Turn) {
    p.left = doing_ == Doing::Turn        ? rotation_.left_rad()
             : doing_ == Doing::Arc       ? arc_left_rad(yaw_rad)
             : doing_ == Doing::Connector ? kDone_rad
                                          : left_;
  }
  if (counts && step->kind == StepKind::Row) {
    p.left = doing_ == Doing::Row ? row_.driven_m() : left_;
  }
  if (counts && step->kind == StepKind::Wall) {
    p.left = doing_ == Doing::Wall ? wall_.driven_m() : left_;
  }
  if (counts && step->kind == StepKind::Landmarks) {
    p.left = doing_ == Doing::Landmarks ? landmarks_.passed() : left_;
  }
  if (counts && step->kind == StepKind::Move && doing_ == Doing::Connector) {
    const double driven_m = tracker_.path() == &connector_ ? tracker_.s_m() : 0.0;
    const double left_m = std::max(0.01, connector_.length_m() - driven_m);
    p.left = connector_end_.reverse ? -left_m : left_m;
  }
  p.jumps_left = jumps_left_;
  while (!p.jumps_left.empty() && p.jumps_left.back() < 0) p.jumps_left.pop_back();
  p.laps = laps_;
  p.driving = running();
  return p;
}

base::Result<void> Executor::restore(std::shared_ptr<const Route> route,
                                     const base::MissionPlace& p, std::string reason) {
  const auto none = [] {
    return base::fail(base::Code::Conflict, "the mission has no such place to go on from");
  };
  if (!route || (p.back && route->back.steps.empty())) return none();
  const Course& course = p.back ? route->back : route->forth;
  const auto steps = static_cast<long>(course.steps.size());
  const auto nodes = static_cast<long>(course.nodes.size());
  const bool fits = p.step >= 0 && p.step <= steps && p.standing >= -1 && p.standing < nodes &&
                    std::isfinite(p.s_m) && p.s_m <= course.path.length_m() + 1.0 &&
                    std::isfinite(p.wait_s) && std::isfinite(p.left) &&
                    p.jumps_left.size() <= route->jumps && p.laps >= 0;
  if (!fits) return none();
  load(std::move(route));
  course_ = p.back ? &route_->back : &route_->forth;
  begin_at(static_cast<std::size_t>(p.step));
  jumps_left_.assign(route_->jumps, -1);
  std::copy(p.jumps_left.begin(), p.jumps_left.end(), jumps_left_.begin());
  if (p.standing >= 0) standing_ = static_cast<std::size_t>(p.standing);
  left_ = p.left;
  laps_ = p.laps;
  rolled_on_ = p.driving;
  drove_ = true;
  skipped_ = 0;
  fled_.clear();
  const RouteStep* step = step_now();
  if (p.s_m >= 0.0 && step != nullptr && step->kind == StepKind::Go &&
      !course_->path.legs.empty()) {
    doing_ = Doing::Path;
    s_m_ = std::min(p.s_m, course_->path.length_m());
    leg_ = std::min(course_->path.leg_from(s_m_), course_->path.legs.size() - 1);
  } else if (p.wait_s > 0.0 && step != nullptr && step->kind == StepKind::Stay) {
    wait_s_ = p.wait_s;  // where it stays is looked up anew
  } else if (p.wait_s > 0.0 && step != nullptr) {
    doing_ = Doing::Wait;
    wait_s_ = p.wait_s;
  }
  state_ = base::ExecutionState::Paused;
  reason_ = std::move(reason);
  return {};
}

/// As far as the way may have been driven on since the place was kept: to the next waypoint at
/// which something else than driving on happens.
double Executor::may_have_come_to_m() const noexcept {
  const double most_m = s_m_ + kRolls_m + kRolls_s * path_params_->speed.max_mps;
  for (std::size_t i = at_; i < course_->steps.size(); ++i) {
    const double at_m = course_->path.vertex_m[course_->steps[i].node];
    if (at_m >= most_m) return most_m;
    const bool on = i + 1 < course_->steps.size() && course_->steps[i + 1].kind == StepKind::Go &&
                    !(course_->steps[i].seconds > 0.0);
    if (!on) return at_m;
  }
  return most_m;
}

/// The place was kept up to a second before the program ended, and the robot rolled on: it goes on
/// from the nearest place ahead, and never turns round. From beside the way it comes back to it at
/// 45 degrees; from far away it was carried, and goes to the place itself.
void Executor::catch_up(EnuPoint here) {
  const bool rolled = std::exchange(rolled_on_, false) && doing_ == Doing::Path;
  if (!rolled) return;
  const Path& path = course_->path;
  const double end_m = may_have_come_to_m();
  double s_m = s_m_;
  double off_m = base::distance_m(here, path.at(s_m_));
  const double way_rad = direction_at(path, s_m_);
  for (double at_m = s_m_; at_m < end_m;) {
    at_m = std::min(end_m, at_m + kLook_m);
    const double far_m = base::distance_m(here, path.at(at_m));
    if (far_m > off_m + kOtherWay_m) break;  // a lane beside it may come nearer again
    if (std::abs(base::angle_diff_rad(way_rad, direction_at(path, at_m))) > kTurned_rad) break;
    if (far_m < off_m) {
      off_m = far_m;
      s_m = at_m;
    }
  }
  if (off_m > kCarried_m) return;
  const auto vertex_m = [&] { return path.vertex_m[course_->steps[at_].node]; };
  if (off_m <= path_params_->track.rejoin_m) {
    while (at_ + 1 < course_->steps.size() && vertex_m() <= s_m && vertex_m() < end_m) {
      reached(course_->steps[at_]);  // it drove past there before it stood
    }
  } else {
    s_m = std::min(s_m, vertex_m()) + off_m;
  }
  if (s_m >= vertex_m() - kBefore_m) {
    s_m = std::max(s_m_, vertex_m() - kBefore_m);
    // Past a place to stop at, farther than it may be missed: back to it.
    if (base::distance_m(here, path.at(vertex_m())) > params_->missed_m) doing_ = Doing::Nothing;
  }
  s_m_ = s_m;
  leg_ = std::min(path.leg_from(s_m_), path.legs.size() - 1);
}

}  // namespace roverd::nav
