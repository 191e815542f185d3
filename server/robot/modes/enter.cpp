// Which mode: entering and leaving, what those that drive by themselves all ask for, and the modes
// by hand. What the others ask for stands in goals.cpp and returns.cpp.

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::ExecutionState;
using base::Severity;

constexpr double kHeadingKnown_rad = 0.35;

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
      set_mode(Mode::Hold, asker);
      return {};
    case Mode::Manual:
      if (estop) return base::fail(Code::Conflict, "the emergency stop is latched");
      executor.pause("mode MANUAL");
      set_mode(Mode::Manual, asker);
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
  const base::ActivityState did = activity.state;
  const bool over = did == base::ActivityState::None || did == base::ActivityState::Reached ||
                    did == base::ActivityState::Failed;
  if (!over) {
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
  held.go_on();
  event(Severity::Info, "mode", "mode " + std::string(base::to_string(to)) + ": " + why);
}

/// To a mode that drives by itself: the mission waits, and the robot stands before it begins.
void Robot::Impl::take_over(Mode to, const std::string& why) {
  executor.pause("mode " + std::string(base::to_string(to)));
  held.go_on();
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
  if (radio_drives(world, config->safety, now)) {
    return base::fail(Code::Conflict, "the radio drives: put its switch SWB up first");
  }
  // What would hold it at the next tick refuses it now.
  Facts as_if = facts();
  as_if.autonomous = true;
  const Assessment then = assess(as_if, config->safety, now);
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
  set_mode(to, asker);
  const nav::StickMode how = to == Mode::Acro       ? nav::StickMode::Acro
                             : to == Mode::Steering ? nav::StickMode::Steering
                                                    : nav::StickMode::Simple;
  sticks.begin(how, vehicle());
  return {};
}

}  // namespace roverd::robot
