// Entering a mode: what those that drive by themselves all ask for, and the modes by hand. What the
// others ask for stands in goals.cpp and returns.cpp, what a change entails in machine.hpp.

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Severity;

constexpr double kHeadingKnown_rad = 0.35;

}  // namespace

base::Result<void> Robot::Impl::handle(const SetMode& c) {
  switch (c.mode) {
    case Mode::Hold:
      change_mode(ModeCause::Chosen, asker, Mode::Hold);
      return {};
    case Mode::Manual:
      if (arm.latched()) return base::fail(Code::Conflict, "the emergency stop is latched");
      change_mode(ModeCause::Chosen, asker, Mode::Manual);
      return {};
    case Mode::Acro:
    case Mode::Steering:
    case Mode::Simple:
      return enter_sticks(c.mode);
    case Mode::Auto: {
      if (machine.mode() == Mode::Auto) return {};
      if (missions.waits()) return resume();
      if (auto ok = may_drive_mission(); !ok) return ok;
      return base::fail(Code::Conflict, "the mission is " +
                                            std::string(to_string(missions.executor.state())) +
                                            ": there is none to go on with; start it");
    }
    case Mode::Guided:
      return enter_guided();
    case Mode::Rtl:
    case Mode::SmartRtl:
      return enter_home(c.mode);
    case Mode::Follow:
      return enter_follow();
    case Mode::Dock:
      return enter_dock(c);
    case Mode::Loiter:
      return enter_loiter(c);
    case Mode::Circle:
      return enter_circle(c);
  }
  return base::fail(Code::Invalid, "there is no such mode");
}

bool Robot::Impl::change_mode(ModeCause cause, const std::string& why, Mode chosen) {
  const auto change = machine.take(cause, chosen);
  if (!change) return false;
  const std::string name(base::to_string(change->to));
  if (change->pauses_mission) {
    missions.executor.pause(cause == ModeCause::Chosen ? "mode " + name : why);
  }
  self_driving.leave(change->to, why, change->stands_first);
  by_hand.lock("the mode changed", clock.now());
  event(Severity::Info, "mode", "mode " + name + ": " + why);
  return true;
}

base::Result<void> Robot::Impl::may_drive_by_itself(bool homeward, bool sight) const {
  if (arm.latched()) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (!arm.armed()) return base::fail(Code::Conflict, "the robot is not armed");
  if (arm.by_hand()) {
    if (auto refusal = arming_refusal(checks)) {
      return base::fail(Code::Conflict,
                        "it was armed to be driven by hand only, " + refusal->detail);
    }
  }
  if (!pose) return base::fail(Code::Conflict, "the position is not known");
  if (radio_drives(world, config->safety, clock.now())) {
    return base::fail(Code::Conflict, "the radio drives: put its switch SWB up first");
  }
  // What would hold it or lead it home at the next tick refuses it now.
  Facts as_if = facts();
  as_if.autonomous = true;
  as_if.homeward = homeward;
  as_if.by_sight = sight;
  const Assessment then = assess(as_if, config->safety, clock.now());
  if (then.response >= Response::Return) return base::fail(Code::Conflict, then.cause);
  return fence.may_begin(pose->at, estimator.frame());
}

/// The word that something interrupted waited for; nothing else to do where nothing waits.
base::Result<void> Robot::Impl::go_on() {
  if (!self_driving.held().waits()) return {};
  self_driving.go_on();
  event(Severity::Info, "activity_resumed",
        "the " + std::string(self_driving.activity().kind) + " goes on, " + asker);
  return {};
}

base::Result<void> Robot::Impl::enter_sticks(Mode to) {
  if (arm.latched()) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (machine.mode() == to) return {};
  if (!pose || pose->yaw_sigma_rad > kHeadingKnown_rad) {
    return base::fail(Code::Conflict, "the heading is not known well enough: drive some metres");
  }
  if (!pose->yaw_rate_radps) {
    return base::fail(Code::Conflict, "the turn rate is not measured");
  }
  change_mode(ModeCause::Chosen, asker, to);
  by_hand.begin(to, vehicle());
  return {};
}

}  // namespace roverd::robot
