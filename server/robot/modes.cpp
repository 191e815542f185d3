// Entering and leaving the modes: what each asks for, and what it begins with.

#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::ExecutionState;
using base::Severity;

constexpr double kLongGap_m = 5.0;   // a piece of the way that was not seen
constexpr double kSameHome_m = 1.0;  // crumbs that begin so near to home end there
constexpr double kHeadingKnown_rad = 0.35;

std::string metres(double m) {
  return std::to_string(std::lround(m)) + " m";
}

}  // namespace

bool Robot::Impl::by_itself() const noexcept {
  switch (mode) {
    case Mode::Auto:
    case Mode::Guided:
    case Mode::Rtl:
    case Mode::SmartRtl:
    case Mode::Follow:
    case Mode::Dock:
      return true;
    case Mode::Manual:
    case Mode::Hold:
    case Mode::Steering:
    case Mode::Acro:
    case Mode::Simple:
      break;
  }
  return false;
}

base::Result<void> Robot::Impl::handle(const SetMode& c) {
  switch (c.mode) {
    case Mode::Hold:
      executor.pause("mode HOLD");
      set_mode(Mode::Hold, "by the operator");
      return {};
    case Mode::Manual:
      if (estop) return base::fail(Code::Conflict, "the emergency stop is latched");
      executor.pause("mode MANUAL");
      set_mode(Mode::Manual, "by the operator");
      return {};
    case Mode::Acro:
    case Mode::Steering:
    case Mode::Simple:
      return enter_sticks(c.mode);
    case Mode::Auto: {
      if (mode == Mode::Auto) return {};
      const ExecutionState s = executor.state();
      if (s == ExecutionState::Paused || s == ExecutionState::Blocked) return resume();
      if (auto ok = may_drive_mission(); !ok) return ok;
      return base::fail(Code::Conflict, "the mission is " + std::string(base::to_string(s)) +
                                            ": there is none to go on with; start it");
    }
    case Mode::Guided:
      return enter_guided();
    case Mode::Rtl:
      return enter_return();
    case Mode::SmartRtl:
      return enter_retrace();
    case Mode::Follow:
      return enter_follow();
    case Mode::Dock:
      return enter_dock(c);
  }
  return base::fail(Code::Invalid, "there is no such mode");
}

void Robot::Impl::set_mode(Mode to, const std::string& why) {
  if (mode == to) return;
  const bool busy = activity.state == base::ActivityState::Driving ||
                    activity.state == base::ActivityState::Turning ||
                    activity.state == base::ActivityState::Waiting;
  if (busy) {
    activity.state = base::ActivityState::Failed;
    activity.reason = "ended by mode " + std::string(base::to_string(to)) + ": " + why;
  }
  guided.reset();
  dock.reset();
  homeward.reset();
  follower.reset();
  mode = to;
  manual.release();
  changeover.skip();
  event(Severity::Info, "mode", "mode " + std::string(base::to_string(to)) + ": " + why);
}

/// To a mode that drives by itself: the mission waits, and the robot stands before it begins.
void Robot::Impl::take_over(Mode to, const std::string& why) {
  executor.pause("mode " + std::string(base::to_string(to)));
  if (mode == to) return;
  set_mode(to, why);
  changeover.begin();
}

void Robot::Impl::begin_activity(std::string_view kind) {
  const std::uint64_t id = activity.id + 1;
  activity = {};
  activity.id = id;
  activity.kind = kind;
  activity.state = base::ActivityState::Driving;
}

base::Result<void> Robot::Impl::may_drive_by_itself() const {
  if (estop) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (!armed) return base::fail(Code::Conflict, "the robot is not armed");
  if (!pose) return base::fail(Code::Conflict, "the position is not known");
  if (radio_drives(world, config.safety, now)) {
    return base::fail(Code::Conflict, "the radio drives: put its switch SWB up first");
  }
  // What would hold it at the next tick refuses it now.
  Facts as_if = facts();
  as_if.autonomous = true;
  const Assessment then = assess(as_if, config.safety, now);
  if (then.response >= Response::Hold) return base::fail(Code::Conflict, then.cause);
  if (!fence) return {};
  if (!estimator.frame() || fence->frame_id != estimator.frame()->id()) {
    return base::fail(Code::Conflict,
                      "the fence is not laid out in the robot's map yet: try again");
  }
  if (!(fence->limits.clearance_m(pose->at) > 0.0)) {
    return base::fail(Code::Conflict,
                      "the robot stands outside of the fence: drive it back by hand");
  }
  return {};
}

/// The straight way there, against the fence.
base::Result<void> Robot::Impl::inside(base::EnuPoint to) const {
  if (!fence) return {};
  if (may_drive(fence->limits, pose->at, to, config.fence.margin_m + kFenceAllowance_m)) return {};
  return base::fail(Code::Conflict, "the way there leaves the fence");
}

base::Result<void> Robot::Impl::mission_inside(const nav::StartAt& at) const {
  if (!fence) return {};
  std::string objection;
  if (mission->fence_id == fence->id) {
    objection = mission->fence_objection;
  } else if (fence->mission_id == mission->id) {
    objection = fence->objection;
  } else {  // both came at the same moment
    objection = route_objection(mission->route, fence->limits, home_point(),
                                config.fence.margin_m + kFenceAllowance_m);
  }
  if (!objection.empty()) return base::fail(Code::Conflict, objection);
  const std::size_t step = nav::first_step(mission->route, at, pose->at);
  const auto target = nav::first_target(mission->route, step, home_point());
  if (target && !inside(*target)) {
    return base::fail(Code::Conflict, "the way to the first point leaves the fence");
  }
  return {};
}

base::Result<void> Robot::Impl::handle(const SetFence& c) {
  fence = c.fence;
  fence_unpublished = true;
  fence_told = false;
  event(Severity::Info, "fence_set",
        fence ? "fence \"" + fence->fence->name + "\" holds" : std::string("no fence holds"));
  return {};
}

// ---- GUIDED ----

base::Result<void> Robot::Impl::enter_guided() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::Guided) return {};
  take_over(Mode::Guided, "by the operator");
  begin_activity("goto");
  activity.state = base::ActivityState::Waiting;
  activity.reason = "no goal yet";
  return {};
}

base::Result<base::EnuPoint> Robot::Impl::place_of(const GoTo& c) const {
  base::EnuPoint p;
  if (c.at) {
    if (!base::is_valid(*c.at)) {
      return base::fail(Code::Invalid, "the goal is not a position on earth",
                        {{"/lat", "or /lon out of range"}});
    }
    if (!within_reach(*c.at)) {
      return base::fail(Code::Invalid, "the goal lies more than 10 km from the robot's map",
                        {{"/lat", "or /lon lies more than 10 km from the robot's map"}});
    }
    p = estimator.frame()->to_local(*c.at);
  } else if (c.local) {
    p = *c.local;
    const double far_m = std::hypot(p.east_m, p.north_m);
    if (!(far_m <= base::LocalFrame::kReach_m)) {
      return base::fail(Code::Invalid, "the goal lies more than 10 km from the robot's map",
                        {{"/east_m", "or /north_m lies more than 10 km from the robot's map"}});
    }
  }
  return p;
}

base::Result<void> Robot::Impl::guide(const nav::GuidedGoal& goal, std::string_view kind) {
  if (const std::string no = guided.refusal(goal); !no.empty()) {
    return base::fail(Code::Conflict, no);
  }
  take_over(Mode::Guided, "by the operator");
  guided.go(goal, vehicle());
  begin_activity(kind);
  return {};
}

base::Result<void> Robot::Impl::handle(const GoTo& c) {
  const bool finite =
      std::isfinite(c.yaw_rad.value_or(0.0)) && std::isfinite(c.speed_mps.value_or(0.0)) &&
      (!c.local || (std::isfinite(c.local->east_m) && std::isfinite(c.local->north_m)));
  if (!finite) return base::fail(Code::Invalid, "a goal has finite numbers only");
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  nav::GuidedGoal goal;
  goal.yaw_rad = c.yaw_rad;
  goal.speed_mps = c.speed_mps;
  goal.reverse = c.reverse;
  if (!c.at && !c.local) {
    if (!c.yaw_rad || !c.speed_mps) {
      return base::fail(Code::Invalid, "a goal is a position, or a heading and a speed");
    }
    goal.kind = nav::GuidedGoal::Kind::Steer;
    return guide(goal, "heading");
  }
  const auto place = place_of(c);
  if (!place) return tl::unexpected(place.error());
  if (auto ok = inside(*place); !ok) return ok;
  goal.at = *place;
  return guide(goal, "goto");
}

base::Result<void> Robot::Impl::handle(const MoveBy& c) {
  for (const auto& value : {c.forward_m, c.turn_rad, c.yaw_rad, c.speed_mps}) {
    if (value && !std::isfinite(*value)) {
      return base::fail(Code::Invalid, "a move has finite numbers only");
    }
  }
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  nav::GuidedGoal goal;
  if (c.forward_m) {
    goal.kind = nav::GuidedGoal::Kind::Move;
    goal.forward_m = *c.forward_m;
    goal.speed_mps = c.speed_mps;
    const base::EnuPoint to{pose->at.east_m + *c.forward_m * std::cos(pose->yaw_rad),
                            pose->at.north_m + *c.forward_m * std::sin(pose->yaw_rad)};
    if (auto ok = inside(to); !ok) return ok;
    return guide(goal, "move");
  }
  goal.kind = nav::GuidedGoal::Kind::Turn;
  goal.turn_rad = c.turn_rad;
  goal.yaw_rad = c.yaw_rad;
  if (c.turn_rad && c.yaw_rad) goal.yaw_rad.reset();
  return guide(goal, "turn");
}

// ---- RTL, SMART_RTL ----

/// The nearest of home and the rally points that can be reached straight, inside the fence.
std::optional<base::EnuPoint> Robot::Impl::refuge() const {
  std::optional<base::EnuPoint> best;
  const auto offer = [&](base::EnuPoint p) {
    if (best && base::distance_m(pose->at, p) >= base::distance_m(pose->at, *best)) return;
    if (inside(p)) best = p;
  };
  if (const auto h = home_point()) offer(*h);
  if (fence) {
    for (const base::EnuPoint& r : fence->rally) offer(r);
  }
  return best;
}

base::Result<void> Robot::Impl::enter_return() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::Rtl) return {};
  if (!home_point() && !(fence && !fence->rally.empty())) {
    return base::fail(Code::Conflict, "there is no home to return to");
  }
  const auto to = refuge();
  if (!to) {
    return base::fail(Code::Conflict,
                      "neither home nor a rally point can be reached straight inside the fence");
  }
  take_over(Mode::Rtl, "by the operator");
  homeward.begin(std::span(&*to, 1), vehicle());
  begin_activity("return");
  activity.goal = estimator.frame()->to_global(*to);
  return {};
}

base::Result<void> Robot::Impl::enter_retrace() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::SmartRtl) return {};
  if (crumbs.size() == 0) {
    return base::fail(Code::Conflict,
                      "the way from home is not known: it is kept from arming on, "
                      "where the position is certain enough");
  }
  if (const double gap_m = crumbs.longest_gap_m(); gap_m > kLongGap_m) {
    return base::fail(Code::Conflict, "the driven way is not known over " + metres(gap_m));
  }
  std::vector<base::EnuPoint> way = crumbs.way_back();
  const auto h = home_point();
  if (h && base::distance_m(way.back(), *h) <= kSameHome_m) way.back() = *h;
  base::EnuPoint from = pose->at;
  for (const base::EnuPoint& p : way) {
    if (fence && fence->limits.crosses(from, p)) {
      return base::fail(Code::Conflict, "the driven way leaves the fence");
    }
    from = p;
  }
  take_over(Mode::SmartRtl, "by the operator");
  homeward.begin(way, vehicle());
  begin_activity("retrace");
  activity.goal = estimator.frame()->to_global(way.back());
  return {};
}

void Robot::Impl::drop_crumbs() {
  crumbs.clear();
  crumbs.use(config.modes.crumb_m);
}

// ---- FOLLOW ----

base::Result<void> Robot::Impl::handle(const SetTarget& c) {
  if (!estimator.frame()) return base::fail(Code::Conflict, "the position is not known");
  GoTo where;
  where.at = c.at;
  where.local = c.local;
  if (!c.at && !c.local) return base::fail(Code::Invalid, "a target has a position");
  const auto place = place_of(where);
  if (!place) return tl::unexpected(place.error());
  const auto bad = [](double x) { return !std::isfinite(x); };
  const bool not_finite =
      bad(place->east_m) || bad(place->north_m) || bad(c.age_s) || bad(c.a_m) || bad(c.b_m) ||
      (c.velocity_mps && (bad(c.velocity_mps->east_m) || bad(c.velocity_mps->north_m)));
  if (not_finite) return base::fail(Code::Invalid, "a target has finite numbers only");
  nav::FollowTarget target{*place, c.velocity_mps, c.asked - base::from_seconds(c.age_s)};
  if (target.stamp > now + std::chrono::milliseconds(200)) {
    return base::fail(Code::Invalid, "the target's time lies in the future",
                      {{"/time", "lies in the future"}});
  }
  if (base::seconds(now - target.stamp) > config.modes.follow_hold_s) {
    return base::fail(Code::Late, "the target's time is too long ago");
  }
  nav::FollowOffset offset;
  if (c.offset == SetTarget::Offset::North) offset.frame = nav::FollowOffset::Frame::North;
  if (c.offset == SetTarget::Offset::Course) offset.frame = nav::FollowOffset::Frame::Course;
  offset.a_m = c.a_m;
  offset.b_m = c.b_m;
  if (const std::string no = follower.take(target, offset); !no.empty()) {
    return base::fail(Code::Conflict, "the target is not believed: " + no);
  }
  return {};
}

base::Result<void> Robot::Impl::enter_follow() {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (mode == Mode::Follow) return {};
  if (const std::string no = follower.refusal(pose->at, now); !no.empty()) {
    return base::fail(Code::Conflict, no);
  }
  take_over(Mode::Follow, "by the operator");
  begin_activity("follow");
  return {};
}

// ---- DOCK ----

base::Result<void> Robot::Impl::enter_dock(const SetMode& c) {
  const bool whole = c.goal && (c.goal->at || c.goal->local) && c.goal->yaw_rad;
  if (!whole) {
    return base::fail(Code::Invalid, "DOCK needs the pose to dock at",
                      {{"/heading_deg", "with lat and lon, or east_m and north_m, is missing"}});
  }
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  const auto place = place_of(*c.goal);
  if (!place) return tl::unexpected(place.error());
  if (!std::isfinite(place->east_m + place->north_m + *c.goal->yaw_rad)) {
    return base::fail(Code::Invalid, "a pose has finite numbers only");
  }
  if (auto ok = inside(*place); !ok) return ok;
  if (pose->horizontal_sigma_m > 2.0 * config.modes.dock_within_m) {
    return base::fail(Code::Conflict,
                      "the position is uncertain by " +
                          std::to_string(std::lround(pose->horizontal_sigma_m * 100.0)) +
                          " cm: too much to dock");
  }
  take_over(Mode::Dock, "by the operator");
  dock.begin({*place, *c.goal->yaw_rad, c.goal->reverse}, vehicle());
  begin_activity("dock");
  return {};
}

// ---- sticks ----

base::Result<void> Robot::Impl::enter_sticks(Mode to) {
  if (estop) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (mode == to) return {};
  if (!pose || pose->yaw_sigma_rad > kHeadingKnown_rad) {
    return base::fail(Code::Conflict, "the heading is not known well enough: drive some metres");
  }
  if (!pose->yaw_rate_radps) {
    return base::fail(Code::Conflict, "the turn rate is not measured");
  }
  executor.pause("mode " + std::string(base::to_string(to)));
  set_mode(to, "by the operator");
  const nav::StickMode how = to == Mode::Acro       ? nav::StickMode::Acro
                             : to == Mode::Steering ? nav::StickMode::Steering
                                                    : nav::StickMode::Simple;
  sticks.begin(how, vehicle());
  return {};
}

}  // namespace roverd::robot
