// The executor at work: which way begins, what counts as reached, what counts as stuck.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"
#include "nav/behave/text.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

constexpr double kSeeks = 3.0;     // times as long without progress, until the heading is known
constexpr double kThere_m = 0.05;  // nearer than this there is nothing to drive
constexpr double kThereVaguely_m = 0.3;
constexpr double kVague_m = 0.1;  // of the position's sigma

/// A robot that does not know its place to the decimetre, or cannot move aside, is not sent round
/// for one; nor for 15 cm while it does not know which way it points.
double there_m(const Vehicle& vehicle, const PathParams& params) {
  if (params.vehicle.steered()) return 0.5;
  if (vehicle.sigma_m > kVague_m) return std::clamp(vehicle.sigma_m, kThereVaguely_m, 0.5);
  const bool turned = vehicle.yaw_sigma_rad > base::rad_from_deg(params.speed.heading_sigma_deg);
  return turned ? 3.0 * kThere_m : kThere_m;
}

}  // namespace

TrackOutput Executor::step(const Vehicle& vehicle, double limit_mps, std::optional<EnuPoint> home,
                           double dt_s) {
  if (!running() || interrupted_) return {};
  home_ = home;
  if (doing_ == Doing::Nothing) enter(vehicle, home);
  if (!running()) return {};
  if (stays_) wait_s_ = std::max(0.0, wait_s_ - dt_s);
  if (doing_ == Doing::Stay) step_stay(vehicle);
  if (!running() || doing_ == Doing::Stay || doing_ == Doing::Nothing) return {};
  if (doing_ == Doing::Wait) {
    wait_s_ -= dt_s;
    if (wait_s_ > 0.0) return {};
    wait_s_ = 0.0;
    if (step_now()->kind == StepKind::Wait && !step_now()->silent) {
      notices_.push_back({Notice::Kind::ItemReached, step_now()->item, {}});
    }
    ++at_;
    enter(vehicle, home);
    if (!running()) return {};
  }
  const Vehicle moves = carried(vehicle).value_or(vehicle);
  if (doing_ == Doing::Turn) return step_turn(moves, dt_s);
  if (doing_ == Doing::Row) return step_row(vehicle, limit_mps, dt_s);
  if (doing_ == Doing::Wall) return step_wall(vehicle, limit_mps, dt_s);
  if (doing_ == Doing::Landmarks) return step_landmarks(vehicle, limit_mps, dt_s);
  if (doing_ == Doing::Dock) return step_dock(vehicle, limit_mps, dt_s);
  if (doing_ == Doing::Wait || cut_goal(vehicle, dt_s)) return {};
  const TrackOutput out = tracker_.step(moves, limit_mps, dt_s);
  if (doing_ == Doing::Path) pass_nodes(vehicle);
  if (doing_ == Doing::Arc) arc_yaw_rad_ = vehicle.yaw_rad;
  if (tracker_.phase() == TrackPhase::Done) {
    leg_done(moves);
    if (running() && doing_ == Doing::Nothing) enter(vehicle, home);
  }
  watch(moves, dt_s);
  return out;
}

/// Begins steps until one of them takes time.
void Executor::enter(const Vehicle& vehicle, std::optional<EnuPoint> home) {
  // Jumps and places already reached take no time; a circle of them must not hang the loop.
  std::size_t idle = 0;
  const std::size_t most = 2 * course_->steps.size() + 4;
  while (running()) {
    doing_ = Doing::Nothing;
    if (++idle > most) {
      stop("the mission goes round in a circle without driving");
      return;
    }
    const RouteStep* step = step_now();
    const bool busy = step == nullptr ? at_end(vehicle, home) : enter_step(*step, vehicle, home);
    if (busy) return;
  }
}

bool Executor::enter_step(const RouteStep& step, const Vehicle& vehicle,
                          std::optional<EnuPoint> home) {
  const bool stays = step.kind == StepKind::Act || step.kind == StepKind::Wait;
  joins_ = joins_ && (stays || step.kind == StepKind::Go);
  stays_.reset();
  switch (step.kind) {
    case StepKind::Go:
      return enter_go(step, vehicle);
    case StepKind::Wait:
      wait_s_ = step.seconds;
      doing_ = Doing::Wait;
      return true;
    case StepKind::Stay:
      return enter_stay(step, vehicle);
    case StepKind::Move:
      return enter_move(step, vehicle);
    case StepKind::Row:
      return enter_row(step);
    case StepKind::Wall:
      return enter_wall(step);
    case StepKind::Landmarks:
      return enter_landmarks(step);
    case StepKind::Dock:
      return enter_dock(step);
    case StepKind::Face:
    case StepKind::Turn:
      return enter_turn(step, vehicle);
    case StepKind::Act:
      notices_.push_back(
          {Notice::Kind::Action, step.item,
           step.arguments.empty() ? step.action : step.action + " " + step.arguments});
      ++at_;
      return false;
    case StepKind::Home: {
      if (!home) {
        stop("there is no home to return to");
        return true;
      }
      standing_.reset();
      if (connect(*home, nullptr, vehicle)) return true;
      reached(step);
      return doing_ == Doing::Wait;
    }
    case StepKind::Jump: {
      int& left = jumps_left_[step.node];
      if (left < 0) left = step.times;
      if (step.times == 0 || left > 0) {
        if (step.times != 0) --left;
        at_ = step.target;
      } else {
        left = -1;  // counts anew when the mission comes here again
        ++at_;
      }
      return false;
    }
  }
  return false;
}

bool Executor::enter_go(const RouteStep& step, const Vehicle& vehicle) {
  if (std::exchange(joins_, false) && begin_here(step, vehicle)) return doing_ != Doing::Nothing;
  const Path& path = course_->path;
  const RouteNode& node = course_->nodes[step.node];
  const bool cuts = modes_->goal_cut_m > 0.0 && node.curvature_1pm == 0.0;
  const bool in_order = standing_ && *standing_ + 1 == step.node && !cuts;
  if (in_order) {
    const double from_m = path.vertex_m[*standing_];
    if (path.vertex_m[step.node] - from_m > 1e-6) {
      const double off_m = base::distance_m(vehicle.at, path.at(from_m));
      if (off_m <= beside_m(vehicle)) {
        doing_ = Doing::Path;
        drove_ = true;
        tracker_.begin(path, path.leg_from(from_m), from_m);
        return true;
      }
    } else {
      reached(step);
      return doing_ == Doing::Wait;
    }
  }
  if (modes_->goal_cut_m > 0.0) standing_.reset();
  looked_s_ = 0.0;
  if (connect(cut(node.at, vehicle.at), &node, vehicle)) return true;
  reached(step);
  return doing_ == Doing::Wait;
}

/// A straight way of its own. @return false when the robot is already there.
bool Executor::connect(EnuPoint to, const RouteNode* node, const Vehicle& vehicle) {
  Vertex end;
  end.at = to;
  end.speed_mps = node != nullptr ? node->speed_mps : route_->speed_mps;
  end.reverse = node != nullptr && node->reverse;
  return lay_connector(end, vehicle);
}

bool Executor::lay_connector(Vertex end, const Vehicle& vehicle, std::optional<double> least_m) {
  EnuPoint from = vehicle.at;
  if (standing_) {
    const EnuPoint nominal = course_->nodes[*standing_].at;
    if (base::distance_m(nominal, from) < path_params_->track.rejoin_m) from = nominal;
  }
  connector_end_ = end;
  const Vertex both[] = {{from, end.speed_mps, end.reverse, false, mission::Turn::Auto, 0.1}, end};
  connector_ = build_path(both, *path_params_);
  rejoin_.reset();
  const double shortest_m = least_m.value_or(there_m(vehicle, *path_params_));
  if (connector_.legs.empty() || connector_.length_m() < shortest_m) return false;
  doing_ = Doing::Connector;
  drove_ = true;
  tracker_.begin(connector_, 0, 0.0);
  return true;
}

bool Executor::at_end(const Vehicle& vehicle, std::optional<EnuPoint> home) {
  if (returning_) {
    if (fled_.empty()) {
      finish();
    } else {
      stop("returned home: " + fled_);
    }
    return true;
  }
  if (!fled_.empty()) {
    returning_ = true;
    standing_.reset();
    if (home && connect(*home, nullptr, vehicle)) return true;
    stop("did not return home: " + fled_);
    return true;
  }
  switch (route_->at_end) {
    case mission::AtEnd::Hold:
      finish();
      return true;
    case mission::AtEnd::Return: {
      returning_ = true;
      standing_.reset();
      if (home && connect(*home, nullptr, vehicle)) return true;
      finish();
      return true;
    }
    case mission::AtEnd::Repeat:
    case mission::AtEnd::BackAndForth: {
      if (!drove_) {
        finish();
        return true;
      }
      drove_ = false;
      ++laps_;
      if (route_->times > 0 && laps_ >= route_->times) {
        finish();
        return true;
      }
      notices_.push_back({Notice::Kind::Lap, 0, {}});
      if (route_->at_end == mission::AtEnd::BackAndForth) {
        turn_round();
      } else {
        at_ = 0;
      }
      return false;
    }
  }
  return false;
}

/// The other direction begins where the robot stands: at its first waypoint, already reached.
void Executor::turn_round() {
  course_ = course_ == &route_->forth ? &route_->back : &route_->forth;
  at_ = 0;
  standing_.reset();
  while (at_ < course_->steps.size() && course_->steps[at_].kind == StepKind::Wait) ++at_;
  if (at_ < course_->steps.size() && course_->steps[at_].kind == StepKind::Go) {
    standing_ = course_->steps[at_].node;
    ++at_;
    while (at_ < course_->steps.size() && course_->steps[at_].kind == StepKind::Wait) ++at_;
  }
}

/// Waypoints inside a leg count when the robot is level with them, or within their radius.
void Executor::pass_nodes(const Vehicle& vehicle) {
  const Path& path = course_->path;
  const double end_m = path.legs[tracker_.leg()].end_m;
  for (;;) {
    const RouteStep* step = step_now();
    if (step == nullptr || step->kind != StepKind::Go) return;
    const double at_m = path.vertex_m[step->node];
    if (at_m > end_m - 1e-6) return;  // the leg's end is a stop and counts when it stands there
    const RouteNode& node = course_->nodes[step->node];
    const bool level = tracker_.s_m() >= at_m;
    const bool within = node.radius_m > 0.0 && at_m - tracker_.s_m() <= node.radius_m &&
                        base::distance_m(vehicle.at, node.at) <= node.radius_m;
    if (!level && !within) return;
    // What the corner leaves out is meant; what the robot drove beside it is not.
    const double off_m = base::distance_m(vehicle.at, node.at);
    const double meant_m = std::max(node.radius_m, base::distance_m(path.at(at_m), node.at));
    if (off_m >
        std::max(meant_m + params_->missed_m, arrival_radius_m(&node, vehicle.sigma_m, *params_))) {
      notices_.push_back({Notice::Kind::ItemMissed, step->item, "missed by " + tenths_text(off_m)});
      pass(*step);
    } else {
      reached(*step);
    }
  }
}

void Executor::leg_done(const Vehicle& vehicle) {
  if (stays_) {
    doing_ = Doing::Stay;
    return;
  }
  if (!rejoin_ && missed(vehicle)) return;
  if (rejoin_) {
    rejoin_.reset();
    doing_ = Doing::Path;
    tracker_.begin(course_->path, leg_, s_m_);
    return;
  }
  const bool on_path = doing_ == Doing::Path;
  const RouteStep* step = step_now();
  if (on_path && leads_on(step)) return;
  doing_ = Doing::Nothing;
  if (step == nullptr) return;  // on the way home: at_end decides
  reached(*step);
  // A robot that did not stop at a vertex of its own still goes on with its path.
  if (on_path && doing_ == Doing::Nothing) leg_ = 0;
}

/// With a tool a leg may end between two places: the vehicle goes round until the tool is where
/// its way goes on.
bool Executor::leads_on(const RouteStep* step) {
  const Path& path = course_->path;
  const std::size_t leg = tracker_.leg();
  if (step == nullptr || step->kind != StepKind::Go || leg + 1 >= path.legs.size()) return false;
  if (path.vertex_m[step->node] <= path.legs[leg].end_m + 1e-6) return false;
  tracker_.begin(path, leg + 1, path.legs[leg].end_m);
  return true;
}

/// The tracker stops where it is level with the place; a vehicle that cannot turn on the spot may
/// stand beside it then. That is not claimed as reached.
bool Executor::missed(const Vehicle& vehicle) {
  const Path& path = *tracker_.path();
  if (tracker_.leg() >= path.legs.size()) return false;  // it stood there already
  const double off_m = base::distance_m(vehicle.at, path.points[path.legs[tracker_.leg()].last].at);
  const RouteStep* step = step_now();
  const bool goes = step != nullptr && step->kind == StepKind::Go;
  const double allowed_m =
      arrival_radius_m(goes ? &course_->nodes[step->node] : nullptr, vehicle.sigma_m, *params_);
  if (off_m <= allowed_m) return false;
  if (passed_by(step, off_m)) return true;
  if (back_up(vehicle, off_m)) {
    notices_.push_back({Notice::Kind::Overshot, step != nullptr ? step->item : 0,
                        "overshot by " + tenths_text(off_m)});
    return true;
  }
  const std::string what = step == nullptr || step->kind == StepKind::Home
                               ? "home"
                               : "item " + std::to_string(step->item);
  block(what + " missed by " + tenths_text(off_m) + "; at most " + tenths_text(allowed_m) +
        " count");
  return true;
}

/// Counts a step as done; holds if it says so.
void Executor::reached(const RouteStep& step) {
  if (!step.silent) notices_.push_back({Notice::Kind::ItemReached, step.item, {}});
  skipped_ = 0;
  pass(step);
}

void Executor::pass(const RouteStep& step) {
  backed_up_ = false;
  stays_.reset();
  if (step.kind == StepKind::Go) standing_ = step.node;
  if (step.kind == StepKind::Go && step.seconds > 0.0) {
    wait_s_ = step.seconds;
    doing_ = Doing::Wait;
    return;
  }
  ++at_;
}

void Executor::finish() {
  state_ = ExecutionState::Finished;
  reason_.clear();
  doing_ = Doing::Nothing;
  tracker_.reset();
  notices_.push_back({Notice::Kind::Finished, 0, {}});
}

void Executor::watch(const Vehicle& vehicle, double dt_s) {
  if (!running()) return;
  const TrackPhase phase = tracker_.phase();
  if (going_round_m_ > 0.0 && has_joined(vehicle)) going_round_m_ = 0.0;
  const double most_m = cross_track_limit_m(vehicle.sigma_m);
  lost_s_ = phase == TrackPhase::Track && std::abs(tracker_.cross_track_m()) > most_m
                ? lost_s_ + dt_s
                : 0.0;
  if (lost_s_ > params_->lost_s) {
    const std::string text =
        tenths_text(std::abs(tracker_.cross_track_m())) + " away from the path";
    pause(text);
    notices_.push_back({Notice::Kind::Lost, 0, text});
    return;
  }
  watch_stuck(vehicle, dt_s);
}

void Executor::watch_stuck(const Vehicle& vehicle, double dt_s) {
  const TrackPhase at = phase();
  const bool driving = at == TrackPhase::Track || at == TrackPhase::Pivot || at == TrackPhase::Turn;
  const bool moved = base::distance_m(vehicle.at, stuck_at_.at) > params_->stuck_m ||
                     std::abs(base::angle_diff_rad(stuck_at_.yaw_rad, vehicle.yaw_rad)) >
                         base::rad_from_deg(params_->stuck_deg);
  if (!driving || moved) {
    stuck_s_ = 0.0;
    stuck_at_ = vehicle;
  } else {
    // Who looks for his heading creeps, and believes to stand while he believes in the wrong one.
    const double known_rad = base::rad_from_deg(path_params_->speed.heading_sigma_deg);
    stuck_s_ += vehicle.yaw_sigma_rad > known_rad ? dt_s / kSeeks : dt_s;
  }
  std::string text;
  if (stuck_s_ > params_->stuck_s) {
    text = "no progress for " + std::to_string(std::lround(params_->stuck_s)) + " s";
  } else if (tracker_.too_steep()) {
    text = steep_text(vehicle, path_params_->slope);
  } else if (tracker_.turn_timed_out()) {
    text = "a turn on the spot does not come to its end";
  } else {
    return;
  }
  block(std::move(text));
}

/// The item in hand cannot be reached: what follows is the operator's choice. Not beside what
/// is driven along by sight: the turns and moves that follow a row, or a straight way home, would
/// lead through its plants.
void Executor::block(std::string why) {
  const RouteStep* step = step_now();
  const bool in_row = step != nullptr && step->by_sight();
  if (!in_row && params_->unreachable == "skip" && step != nullptr &&
      at_ + 1 < course_->steps.size() && skipped_ < course_->steps.size()) {
    const int item = step->item;
    std::size_t next = at_;
    while (next < course_->steps.size() && course_->steps[next].item == item) ++next;
    if (next < course_->steps.size()) {
      ++skipped_;
      notices_.push_back({Notice::Kind::ItemMissed, item, "left out: " + why});
      begin_at(next);
      return;
    }
  }
  if (!in_row && params_->unreachable == "return" && fled_.empty() && home_) {
    notices_.push_back({Notice::Kind::ItemMissed, step != nullptr ? step->item : 0,
                        "given up, going home: " + why});
    begin_at(course_->steps.size());
    fled_ = std::move(why);
    return;
  }
  pause(why);
  state_ = ExecutionState::Blocked;
  notices_.push_back({Notice::Kind::Blocked, 0, std::move(why)});
}

}  // namespace roverd::nav
