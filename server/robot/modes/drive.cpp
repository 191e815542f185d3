// One tick of the modes other than AUTO and MANUAL.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::Driver;
using base::Severity;

}  // namespace

nav::Vehicle Robot::Impl::vehicle() const {
  const nav::Belief& b = estimator.belief();
  return {pose->at,
          pose->yaw_rad,
          pose->yaw_sigma_rad,
          pose->speed_mps.value_or(0.0),
          pose->yaw_rate_radps.value_or(0.0),
          b.x(nav::kScale),
          b.x(nav::kYawScale),
          b.x(nav::kPull),
          pose->horizontal_sigma_m};
}

/// What is allowed now, whatever a path was laid for.
double Robot::Impl::limit_mps() const noexcept {
  const double most = std::min(config->speed.max_mps, config->vehicle.max_speed_mps);
  return assessment.response >= Response::Slow ? std::min(most, config->speed.creep_mps) : most;
}

void Robot::Impl::interrupt_modes() {
  guided.interrupt();
  dock.interrupt();
  homeward.interrupt();
}

/// The radio took over: what is under way and is no mission does not go on by itself.
void Robot::Impl::hold_for_a_word() {
  const bool no_goal = mode == Mode::Guided && activity.state == ActivityState::Waiting;
  const bool under_way = activity.state == ActivityState::Driving ||
                         activity.state == ActivityState::Turning ||
                         activity.state == ActivityState::Waiting;
  if (mode == Mode::Auto || !by_itself() || !under_way || no_goal) return;
  held.take(activity.kind);
  activity.state = ActivityState::Held;
  activity.reason = held.why();
  event(Severity::Warning, "activity_held", held.why());
}

base::DriveCommand Robot::Impl::drive_by_sticks() {
  const base::BodyTwist stick = manual.step(now, dt_s);
  if (manual.phase() == Manual::Phase::Stale) {
    speed_reason = "teleop_stale";
    assessment.conditions.push_back(
        {"teleop_stale", "the commands by hand stopped coming: let go once to drive on"});
  }
  if (manual.phase() == Manual::Phase::Held) driver = Driver::Teleop;
  if (!pose) return {{}, true};
  const base::BodyTwist full{config->manual.max_mps, config->manual.max_yaw_rate_radps};
  const nav::TrackOutput out = sticks.step(stick, full, vehicle(), limit_mps(), dt_s);
  if (driver == Driver::Teleop) speed_reason = std::string(nav::to_string(out.reason));
  return {out.command, true};
}

nav::TrackOutput Robot::Impl::step_mode(const nav::Vehicle& v, double limit) {
  switch (mode) {
    case Mode::Guided:
      return guided.step(v, limit, dt_s);
    case Mode::Rtl:
    case Mode::SmartRtl:
      return homeward.step(v, limit, dt_s);
    case Mode::Follow:
      return follower.step(v, limit, now, dt_s);
    case Mode::Dock:
      return dock.step(v, limit, dt_s);
    case Mode::Auto:
    case Mode::Manual:
    case Mode::Hold:
    case Mode::Steering:
    case Mode::Acro:
    case Mode::Simple:
      break;
  }
  return {};
}

base::DriveCommand Robot::Impl::drive_by_itself() {
  if (!pose) return {{}, true};
  if (held.waits()) {
    speed_reason = "held";
    return {{}, true};
  }
  const nav::Vehicle v = vehicle();
  if (changeover.ends(v.speed_mps, v.yaw_rate_radps, dt_s)) interrupt_modes();
  if (changeover.waits()) {
    speed_reason = "stopping";
    return {{}, true};
  }
  const nav::TrackOutput out = step_mode(v, limit_mps());
  speed_reason = std::string(nav::to_string(out.reason));
  watch_mode();
  const bool drives = by_itself() && (activity.state == ActivityState::Driving ||
                                      activity.state == ActivityState::Turning);
  if (drives) driver = Driver::Autonomy;
  if (!by_itself()) return {{}, true};
  return {out.command, true};
}

void Robot::Impl::end_mode(ActivityState state, const char* kind, const std::string& detail) {
  activity.state = state;
  activity.reason = state == ActivityState::Reached ? std::string() : detail;
  activity.distance_m.reset();
  activity.turn_rad.reset();
  event(state == ActivityState::Reached ? Severity::Info : Severity::Warning, kind, detail);
  if (mode != Mode::Guided) set_mode(Mode::Hold, detail);
}

/// What the machine of this mode came to.
void Robot::Impl::watch_mode() {
  const bool over =
      activity.state == ActivityState::Reached || activity.state == ActivityState::Failed;
  switch (mode) {
    case Mode::Guided:
      if (over) return;
      if (guided.state() == nav::Guided::State::Reached) {
        return end_mode(ActivityState::Reached, "goal_reached",
                        "the goal of this " + std::string(activity.kind) + " is reached");
      }
      if (guided.state() == nav::Guided::State::Failed) {
        return end_mode(ActivityState::Failed, "goal_failed", guided.reason());
      }
      break;
    case Mode::Rtl:
    case Mode::SmartRtl:
      if (homeward.state() == nav::Homeward::State::Home) {
        return end_mode(ActivityState::Reached, "home_reached", "home is reached");
      }
      if (homeward.state() == nav::Homeward::State::Failed) {
        return end_mode(ActivityState::Failed, "return_failed",
                        "the way home: " + homeward.reason());
      }
      break;
    case Mode::Follow:
      if (follower.state() == nav::Follow::State::Lost) {
        return end_mode(ActivityState::Failed, "target_lost", follower.reason());
      }
      break;
    case Mode::Dock:
      if (dock.state() == nav::Dock::State::Docked) {
        return end_mode(ActivityState::Reached, "docked", "docked");
      }
      if (dock.state() == nav::Dock::State::Failed) {
        return end_mode(ActivityState::Failed, "dock_failed", "not docked: " + dock.reason());
      }
      break;
    case Mode::Auto:
    case Mode::Manual:
    case Mode::Hold:
    case Mode::Steering:
    case Mode::Acro:
    case Mode::Simple:
      return;
  }
  tell_activity();
}

/// Where the mode stands, in the words of the snapshot.
void Robot::Impl::tell_activity() {
  base::Activity& a = activity;
  const auto global = [this](base::EnuPoint p) { return estimator.frame()->to_global(p); };
  a.state = ActivityState::Driving;
  a.reason.clear();
  a.turn_rad.reset();
  a.distance_m.reset();
  if (mode == Mode::Guided) {
    const nav::Guided::State s = guided.state();
    if (s == nav::Guided::State::Waiting) a.state = ActivityState::Waiting;
    a.reason = s == nav::Guided::State::Waiting && guided.reason().empty() ? "no goal yet"
                                                                           : guided.reason();
    if (guided.place()) a.goal = global(*guided.place());
    if (s != nav::Guided::State::Waiting) a.goal_yaw_rad = guided.goal().yaw_rad;
    a.distance_m = guided.distance_left_m(pose->at);
    a.turn_rad = guided.trip().turn_left_rad();
  } else if (mode == Mode::Rtl || mode == Mode::SmartRtl) {
    a.distance_m = homeward.trip().distance_left_m();
  } else if (mode == Mode::Dock) {
    a.goal = global(dock.goal().at);
    a.goal_yaw_rad = dock.goal().yaw_rad;
    a.distance_m = dock.distance_left_m();
    a.reason = dock.reason();
  } else if (mode == Mode::Follow && follower.target()) {
    a.target = global(follower.target()->at);
    a.target_age_s = base::seconds(now - follower.target()->stamp);
    a.distance_m = follower.distance_m(pose->at);
    const bool waits = follower.state() == nav::Follow::State::Braking;
    if (waits) a.state = ActivityState::Waiting;
    a.reason = waits ? "the target is silent" : "";
  }
  if (a.turn_rad) a.state = ActivityState::Turning;
}

void Robot::Impl::lay_crumbs() {
  // From the first arming on; a robot that is carried lays none, and what it misses is a gap.
  const bool wheels_turn = world.motion && world.motion->twist != base::BodyTwist{};
  if (!pose || !(armed || (crumbs.size() > 0 && wheels_turn))) return;
  const std::uint64_t resets = estimator.health().resets;
  const bool jumped = resets != crumbs_resets;
  crumbs_resets = resets;
  crumbs.take(pose->at, pose->horizontal_sigma_m, jumped,
              [this](base::EnuPoint a, base::EnuPoint b) {
                return !fence || !fence->limits.crosses(a, b);
              });
}

}  // namespace roverd::robot
