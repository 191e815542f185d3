#include "nav/behave/executor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::Code;
using base::ExecutionState;

constexpr double kSame_m = 1e-3;

std::string metres(double m) {
  return std::to_string(std::lround(m)) + " m";
}

}  // namespace

std::size_t first_step(const Route& route, const StartAt& start,
                       std::optional<EnuPoint> here) noexcept {
  const Course& course = route.forth;
  if (start.from == StartAt::From::First) return 0;
  if (start.from == StartAt::From::Item) {
    const auto found = std::find_if(course.steps.begin(), course.steps.end(),
                                    [&](const RouteStep& s) { return s.item >= start.item; });
    const bool exists = start.item >= 1 && start.item <= route.items;
    return exists ? static_cast<std::size_t>(found - course.steps.begin()) : course.steps.size();
  }
  std::size_t best = 0;
  double best_m = 1e300;
  for (std::size_t i = 0; here && i < course.steps.size(); ++i) {
    if (course.steps[i].kind != StepKind::Go) continue;
    const double far_m = base::distance_m(*here, course.nodes[course.steps[i].node].at);
    if (far_m > best_m - kSame_m) continue;  // of a circle's turns the first
    best_m = far_m;
    best = i;
  }
  return best;
}

std::optional<EnuPoint> first_target(const Route& route, std::size_t step,
                                     std::optional<EnuPoint> home) noexcept {
  const Course& course = route.forth;
  for (std::size_t i = step; i < course.steps.size(); ++i) {
    if (course.steps[i].kind == StepKind::Go) return course.nodes[course.steps[i].node].at;
    if (course.steps[i].kind == StepKind::Home) return home;
    if (course.steps[i].by_sight()) return std::nullopt;  // it leads who knows where
  }
  return std::nullopt;
}

Executor::Executor(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
                   base::Setting<ModeParams> modes, base::Setting<RowDriveParams> rows,
                   MarkSettings marks)
    : path_params_(path),
      params_(std::move(behave)),
      modes_(std::move(modes)),
      tracker_(path),
      row_(path, std::move(rows)),
      wall_(marks.wall_path.value_or(path), marks.landmark_path.value_or(path), marks),
      landmarks_(marks.landmark_path.value_or(path), marks),
      dock_(path, params_, marks.tag_dock) {
  notices_.reserve(16);
}

void Executor::load(std::shared_ptr<const Route> route) {
  ++way_id_;
  route_ = std::move(route);
  course_ = route_ ? &route_->forth : nullptr;
  state_ = route_ ? ExecutionState::Loaded : ExecutionState::Idle;
  reason_.clear();
  interrupt();
  interrupted_ = false;
  doing_ = Doing::Nothing;
  at_ = 0;
  standing_.reset();
  rejoin_.reset();
  stays_.reset();
}

void Executor::lay_anew(std::shared_ptr<const Route> route) {
  const ExecutionState state = state_;
  std::string reason = std::move(reason_);
  load(std::move(route));
  state_ = state;
  reason_ = std::move(reason);
}

void Executor::begin_at(std::size_t step) {
  ++way_id_;
  tracker_.reset();
  rotation_.reset();
  row_.reset();
  wall_.reset();
  landmarks_.reset();
  dock_.reset();
  doing_ = Doing::Nothing;
  left_ = looked_s_ = 0.0;
  arc_yaw_rad_.reset();
  at_ = step;
  standing_.reset();
  rejoin_.reset();
  stays_.reset();
  wait_s_ = lost_s_ = stuck_s_ = going_round_m_ = 0.0;
  returning_ = rolled_on_ = joins_ = backed_up_ = false;
}

base::Result<void> Executor::start(const StartAt& at, EnuPoint here, std::optional<EnuPoint> home) {
  if (!route_) return base::fail(Code::Conflict, "no mission is loaded");
  if (running()) return base::fail(Code::Conflict, "the mission already runs");
  const std::size_t step = first_step(*route_, at, here);
  if (step >= route_->forth.steps.size()) {
    return base::fail(Code::Conflict, "item " + std::to_string(at.item) +
                                          " has nothing to drive to; the mission has " +
                                          std::to_string(route_->items) + " items");
  }
  const auto target = first_target(*route_, step, home);
  const double far_m = target ? base::distance_m(here, *target) : 0.0;
  if (far_m > params_->start_within_m) {
    return base::fail(Code::Conflict, "the first point is " + metres(far_m) + " away; at most " +
                                          metres(params_->start_within_m) + " are allowed");
  }
  course_ = &route_->forth;
  begin_at(step);
  joins_ = at.from != StartAt::From::Item;
  jumps_left_.assign(route_->jumps, -1);
  drove_ = false;
  interrupted_ = false;
  skipped_ = 0;
  laps_ = 0;
  fled_.clear();
  state_ = ExecutionState::Running;
  reason_.clear();
  return {};
}

void Executor::pause(std::string reason) {
  if (!running()) return;
  interrupt();
  interrupted_ = false;
  state_ = ExecutionState::Paused;
  reason_ = std::move(reason);
}

void Executor::stop(std::string reason) {
  interrupt();
  interrupted_ = false;
  state_ = ExecutionState::Aborted;
  reason_ = std::move(reason);
}

void Executor::interrupt() noexcept {
  wait();
  row_left_ = true;
}

void Executor::wait() noexcept {
  if (doing_ == Doing::Path) {
    leg_ = tracker_.leg();
    s_m_ = tracker_.s_m();
  }
  if (doing_ == Doing::Arc) arc_rad_ = arc_left_rad();
  tracker_.reset();
  row_.interrupt();
  wall_.interrupt();
  landmarks_.interrupt();
  dock_.interrupt();
  lost_s_ = stuck_s_ = 0.0;
  interrupted_ = true;
}

std::optional<EnuPoint> Executor::place_to_go_on() const noexcept {
  switch (doing_) {
    case Doing::Path:
      return course_->path.at(s_m_);
    case Doing::Connector:
      return connector_.points.back().at;
    case Doing::Nothing:
    case Doing::Wait:
    case Doing::Arc:
    case Doing::Turn:
    case Doing::Stay:
    case Doing::Row:
    case Doing::Wall:
    case Doing::Landmarks:
    case Doing::Dock:
      return std::nullopt;
  }
  return std::nullopt;
}

bool Executor::waits_for_word() const noexcept {
  const RouteStep* step = step_now();
  return running() && !interrupted_ && stays_ && step != nullptr && step->endless;
}

base::Result<void> Executor::may_resume(EnuPoint here) const {
  if (waits_for_word()) return {};
  if (state_ != ExecutionState::Paused && state_ != ExecutionState::Blocked) {
    return base::fail(Code::Conflict, "the mission is " + std::string(base::to_string(state_)));
  }
  const auto place = place_to_go_on();
  const double far_m = place && doing_ == Doing::Path ? base::distance_m(here, *place) : 0.0;
  if (far_m > params_->start_within_m) {
    return base::fail(Code::Conflict, "the place to go on with is " + metres(far_m) +
                                          " away; at most " + metres(params_->start_within_m) +
                                          " are allowed");
  }
  return {};
}

base::Result<void> Executor::resume(EnuPoint here) {
  if (auto ok = may_resume(here); !ok) return ok;
  if (waits_for_word()) {
    doing_ = Doing::Nothing;
    tracker_.reset();
    reached(*step_now());
    return {};
  }
  state_ = ExecutionState::Running;
  reason_.clear();
  interrupted_ = true;
  catch_up(here);
  go_on(here);
  return {};
}

void Executor::go_on(EnuPoint here) {
  if (!interrupted_) return;
  interrupted_ = false;
  if (doing_ == Doing::Turn) {
    left_ = rotation_.left_rad();
    doing_ = Doing::Nothing;  // the rest of it is begun anew
  }
  if (doing_ == Doing::Arc) {  // likewise
    left_ = arc_rad_;
    doing_ = Doing::Nothing;
  }
  const bool left = std::exchange(row_left_, false);
  if (doing_ == Doing::Row && left) ++rows_begun_;
  const auto place = place_to_go_on();
  if (!place) return;
  const double far_m = base::distance_m(here, *place);
  if (doing_ == Doing::Path && far_m > params_->start_within_m) {
    pause("moved " + metres(far_m) + " away from the mission");
    return;
  }
  Vehicle vehicle;
  vehicle.at = here;
  if (const auto by_odometry = carried(vehicle)) vehicle = *by_odometry;
  if (doing_ == Doing::Path && far_m <= path_params_->track.rejoin_m) {
    tracker_.begin(course_->path, leg_, s_m_);
    return;
  }
  standing_.reset();
  if (doing_ == Doing::Connector) {  // the same end, driven the same way
    const auto rejoin = rejoin_;
    if (!lay_connector(connector_end_, vehicle)) tracker_.begin(connector_, 0, 0.0);
    rejoin_ = rejoin;
    return;
  }
  const RouteStep* step = step_now();
  const RouteNode* node =
      step != nullptr && step->kind == StepKind::Go ? &course_->nodes[step->node] : nullptr;
  const EnuPoint to = *place;
  if (!connect(to, node, vehicle)) {
    // Already there: the connector is as good as driven.
    tracker_.begin(connector_, 0, 0.0);
  }
  rejoin_ = to;
}

base::Result<void> Executor::skip(int item) {
  if (!route_ || (state_ != ExecutionState::Running && state_ != ExecutionState::Paused &&
                  state_ != ExecutionState::Blocked)) {
    return base::fail(Code::Conflict, "no mission is running or paused");
  }
  if (item == 0 && waits_for_word()) return resume({});
  std::size_t to = at_ + 1;
  if (item != 0) {
    const auto found = std::find_if(course_->steps.begin(), course_->steps.end(),
                                    [&](const RouteStep& s) { return s.item == item; });
    to = static_cast<std::size_t>(found - course_->steps.begin());
  }
  if (to >= course_->steps.size()) {
    return base::fail(Code::Conflict, item == 0
                                          ? "there is no later item"
                                          : "item " + std::to_string(item) + " is none to go to");
  }
  begin_at(to);
  return {};
}

bool Executor::in_hand() const noexcept {
  return running() || state_ == ExecutionState::Paused || state_ == ExecutionState::Blocked;
}

void Executor::extend(std::shared_ptr<const Route> route) {
  if (!in_hand()) return load(std::move(route));
  const bool back = course_ == &route_->back;
  const Course& fresh = back ? route->back : route->forth;
  const Course& old = *course_;
  const bool at_end = at_ >= old.steps.size();  // on the way home, or done with the last item
  // Backwards, what was added comes first and shifts the rest.
  move_to(fresh, back ? fresh.steps.size() - old.steps.size() : 0,
          back ? fresh.nodes.size() - old.nodes.size() : 0);
  jumps_left_.resize(std::max(jumps_left_.size(), route->jumps), -1);
  route_ = std::move(route);
  course_ = &fresh;
  if (at_end && !back) begin_at(at_);
}

/// The place on the old course, on the new one: the same way before the same waypoint.
void Executor::move_to(const Course& fresh, std::size_t more_steps, std::size_t more_nodes) {
  ++way_id_;
  const Course& old = *course_;
  const bool tracking = tracker_.path() == &old.path;
  const RouteStep* step = step_now();
  if (doing_ == Doing::Path || rejoin_) {
    double s_m = tracking ? tracker_.s_m() : s_m_;
    if (step != nullptr && step->kind == StepKind::Go) {
      const double before_m = old.path.vertex_m[step->node] - s_m;
      s_m = fresh.path.vertex_m[step->node + more_nodes] - before_m;
    }
    s_m_ = std::clamp(s_m, 0.0, fresh.path.length_m());
    leg_ = fresh.path.leg_from(s_m_);
  }
  at_ += more_steps;
  if (standing_) *standing_ += more_nodes;
  if (tracking) tracker_.move_to(fresh.path, leg_, s_m_);
}

void Executor::drop(std::shared_ptr<const Route> route, int item) {
  if (!in_hand()) return load(std::move(route));
  const bool back = course_ == &route_->back;
  const Course& fresh = back ? route->back : route->forth;
  std::size_t next = at_;
  while (next < course_->steps.size() && course_->steps[next].item == item) ++next;
  std::size_t to = fresh.steps.size();
  if (next < course_->steps.size()) {
    const int number = course_->steps[next].item - (course_->steps[next].item > item ? 1 : 0);
    const auto found = std::find_if(fresh.steps.begin(), fresh.steps.end(),
                                    [&](const RouteStep& s) { return s.item == number; });
    to = static_cast<std::size_t>(found - fresh.steps.begin());
  }
  route_ = std::move(route);
  course_ = back ? &route_->back : &route_->forth;
  jumps_left_.assign(route_->jumps, -1);
  begin_at(to);
}

const RouteStep* Executor::step_now() const noexcept {
  return course_ != nullptr && at_ < course_->steps.size() ? &course_->steps[at_] : nullptr;
}

}  // namespace roverd::nav
