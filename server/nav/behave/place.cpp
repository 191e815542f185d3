// Where a mission stands, as a value that outlives the program.

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/behave/executor.hpp"

namespace roverd::nav {

std::optional<base::MissionPlace> Executor::place() const {
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
  if (doing_ == Doing::Wait) p.wait_s = wait_s_;
  const RouteStep* step = step_now();
  const bool counts = step != nullptr && !step->yaw_rad;
  if (counts && step->kind == StepKind::Turn) {
    p.left = doing_ == Doing::Turn ? turner_.left_rad() : left_;
  }
  if (counts && step->kind == StepKind::Move && doing_ == Doing::Connector) {
    const double driven_m = tracker_.path() == &connector_ ? tracker_.s_m() : 0.0;
    const double left_m = std::max(0.01, connector_.length_m() - driven_m);
    p.left = connector_end_.reverse ? -left_m : left_m;
  }
  p.jumps_left = jumps_left_;
  while (!p.jumps_left.empty() && p.jumps_left.back() < 0) p.jumps_left.pop_back();
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
                    p.jumps_left.size() <= route->forth.steps.size();
  if (!fits) return none();
  load(std::move(route));
  course_ = p.back ? &route_->back : &route_->forth;
  begin_at(static_cast<std::size_t>(p.step));
  jumps_left_.assign(route_->forth.steps.size(), -1);
  std::copy(p.jumps_left.begin(), p.jumps_left.end(), jumps_left_.begin());
  if (p.standing >= 0) standing_ = static_cast<std::size_t>(p.standing);
  left_ = p.left;
  drove_ = true;
  skipped_ = 0;
  fled_.clear();
  const RouteStep* step = step_now();
  if (p.s_m >= 0.0 && step != nullptr && step->kind == StepKind::Go &&
      !course_->path.legs.empty()) {
    doing_ = Doing::Path;
    s_m_ = std::min(p.s_m, course_->path.length_m());
    leg_ = std::min(course_->path.leg_from(s_m_), course_->path.legs.size() - 1);
  } else if (p.wait_s > 0.0 && step != nullptr) {
    doing_ = Doing::Wait;
    wait_s_ = p.wait_s;
  }
  state_ = base::ExecutionState::Paused;
  reason_ = std::move(reason);
  return {};
}

}  // namespace roverd::nav
