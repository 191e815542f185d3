// What each command does, and when it is refused. Answers tell what the robot did.

#include <cmath>
#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::ExecutionState;
using base::Mode;
using base::Severity;

/// Stops are never too late: they are carried out whenever they arrive.
bool is_stop(const Command& c) noexcept {
  if (const auto* mode = std::get_if<SetMode>(&c)) return mode->mode == Mode::Hold;
  if (const auto* drive = std::get_if<Drive>(&c)) return !drive->deadman;
  return std::holds_alternative<Estop>(c) || std::holds_alternative<Disarm>(c) ||
         std::holds_alternative<PauseMission>(c) || std::holds_alternative<StopMission>(c);
}

bool carries_much(const Command& c) noexcept {
  return std::holds_alternative<LoadMission>(c) || std::holds_alternative<ReviseMission>(c) ||
         std::holds_alternative<ResumeAt>(c) || std::holds_alternative<SetFence>(c);
}

}  // namespace

/// To free ten thousand items takes longer than a tick may: whoever takes the answer does it.
void Robot::Impl::retire(std::shared_ptr<const void> old) {
  if (old) retired = std::move(old);
}

void Robot::Impl::take_commands() {
  command_batch.clear();
  if (outbox.full()) return;
  commands.try_take(command_batch);
  for (PendingCommand& pending : command_batch) {
    base::Result<void> result =
        base::fail(Code::Late, "the command arrived too late and was not carried out");
    if (now <= pending.not_after || is_stop(pending.command)) {
      result = std::visit([this](const auto& c) { return handle(c); }, pending.command);
    }
    if (carries_much(pending.command)) {
      pending.reply = [reply = std::move(pending.reply), old = std::exchange(retired, nullptr),
                       command = std::move(pending.command)](base::Result<void> r) {
        if (reply) reply(std::move(r));
      };
    }
    outbox.reply(std::move(pending.reply), std::move(result));
  }
  command_batch.clear();
}

base::Result<void> Robot::Impl::handle(const Arm&) {
  if (armed) return {};
  std::vector<base::FieldError> failing;
  for (const base::Check& c : checks) {
    if (!c.ok && c.severity == Severity::Error) failing.push_back({"/checks/" + c.id, c.detail});
  }
  if (!failing.empty() || checks.empty()) {
    std::string detail = "not armed: ";
    detail += failing.empty() ? "the checks have not run yet" : failing.front().detail;
    if (failing.size() > 1) {
      detail += " (and " + std::to_string(failing.size() - 1) + " more)";
    }
    event(Severity::Warning, "arm_refused", detail);
    return base::fail(Code::Conflict, std::move(detail), std::move(failing));
  }
  armed = true;
  base_waited_since.reset();
  manual.release();
  if (by_itself()) set_mode(Mode::Hold, "armed");
  const HomeAtArm rule = home_at_arm_from(config->robot.home_at_arm).value_or(HomeAtArm::Keep);
  if (pose && home.arm(pose->global, rule)) drop_crumbs();
  event(Severity::Info, "armed", "armed");
  return {};
}

base::Result<void> Robot::Impl::handle(const Disarm&) {
  disarm(asker);
  return {};
}

void Robot::Impl::disarm(const std::string& why) {
  executor.pause("disarmed");
  manual.release();
  if (by_itself()) set_mode(Mode::Hold, "disarmed");
  if (!armed) return;
  armed = false;
  base_waited_since.reset();
  event(Severity::Info, "disarmed", "disarmed " + why);
}

base::Result<void> Robot::Impl::handle(const Estop& c) {
  latch_estop(c.who);
  return {};
}

void Robot::Impl::latch_estop(const std::string& who) {
  if (estop) return;
  estop = true;
  executor.pause("emergency stop");
  manual.release();
  if (armed) event(Severity::Warning, "disarmed", "disarmed by the emergency stop");
  armed = false;
  base_waited_since.reset();
  set_mode(Mode::Hold, "emergency stop");
  event(Severity::Error, "estop", "emergency stop" + (who.empty() ? "" : " by " + who));
}

base::Result<void> Robot::Impl::handle(const ResetEstop&) {
  if (!estop) return {};
  if (world.base && world.base->vehicle_state == base::VehicleState::Estop) {
    return base::fail(Code::Conflict,
                      "the emergency stop at the base is still pressed: release it first");
  }
  if (world.bumper && world.bumper->pressed) {
    return base::fail(Code::Conflict, "the bumper is still pressed: free it first");
  }
  estop = false;
  estop_asked.store(false);
  set_mode(Mode::Hold, "emergency stop released");
  event(Severity::Info, "estop_reset", "emergency stop released; disarmed");
  return {};
}

base::Result<void> Robot::Impl::may_drive_mission() const {
  if (estop) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (!mission) return base::fail(Code::Conflict, "no mission is loaded");
  return may_drive_by_itself();
}

base::Result<void> Robot::Impl::start(const nav::StartAt& at) {
  if (auto ok = may_drive_mission(); !ok) return ok;
  if (auto ok = mission_inside(at); !ok) return ok;
  if (auto ok = executor.start(at, pose->at, home_point()); !ok) return ok;
  straight.reset();
  set_mode(Mode::Auto, "mission started");
  event(Severity::Info, "mission_started",
        "mission \"" + mission->copy.plan.name + "\" revision " +
            std::to_string(mission->copy.revision) + " started");
  return {};
}

base::Result<void> Robot::Impl::resume() {
  if (auto ok = may_drive_mission(); !ok) return ok;
  if (auto ok = executor.resume(pose->at); !ok) return ok;
  straight.reset();
  set_mode(Mode::Auto, "mission resumed");
  event(Severity::Info, "mission_resumed", "mission resumed");
  return {};
}

base::Result<void> Robot::Impl::handle(const StartMission& c) {
  if (mission && (c.mission_id != mission->copy.id || c.revision != mission->copy.revision)) {
    return base::fail(Code::Conflict, "loaded is mission " + mission->copy.id + " revision " +
                                          std::to_string(mission->copy.revision) + ", not " +
                                          c.mission_id + " revision " + std::to_string(c.revision));
  }
  return start(start_at(c));
}

base::Result<void> Robot::Impl::handle(const PauseMission&) {
  if (!executor.running()) {
    return base::fail(Code::Conflict,
                      "no mission runs: it is " + std::string(base::to_string(executor.state())));
  }
  hold(std::string("paused ") + asker);
  event(Severity::Info, "mission_paused", "mission paused");
  return {};
}

/// A mission that waits; with none, what the radio interrupted.
base::Result<void> Robot::Impl::handle(const ResumeMission&) {
  const ExecutionState s = executor.state();
  const bool waits = s == ExecutionState::Paused || s == ExecutionState::Blocked;
  if (held.waits() && !waits) return handle(ResumeActivity{});
  return resume();
}

base::Result<void> Robot::Impl::handle(const ResumeActivity&) {
  if (!held.waits()) return base::fail(Code::Conflict, "nothing was interrupted by the radio");
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  held.go_on();
  event(Severity::Info, "activity_resumed",
        "the " + std::string(activity.kind) + " goes on, " + asker);
  return {};
}

base::Result<void> Robot::Impl::handle(const StopMission&) {
  const ExecutionState s = executor.state();
  if (s != ExecutionState::Running && s != ExecutionState::Paused && s != ExecutionState::Blocked) {
    return base::fail(Code::Conflict,
                      "there is nothing to stop: the mission is " + std::string(to_string(s)));
  }
  executor.stop(std::string("stopped ") + asker);
  if (mode == Mode::Auto) set_mode(Mode::Hold, "mission stopped");
  event(Severity::Info, "mission_aborted", std::string("mission stopped ") + asker);
  return {};
}

base::Result<void> Robot::Impl::handle(const SkipItem& c) {
  auto result = executor.skip(c.item);
  if (result) event(Severity::Info, "skip", "skipped to another item");
  return result;
}

base::Result<void> Robot::Impl::handle(const SetHome& c) {
  if (c.at && !base::is_valid(*c.at)) {
    return base::fail(Code::Invalid, "home is not a position on earth",
                      {{"/lat", "or /lon out of range"}});
  }
  if (!c.at && !pose) return base::fail(Code::Conflict, "the position is not known");
  if (c.at && estimator.frame() && !within_reach(*c.at)) {
    return base::fail(Code::Invalid, "home lies more than 10 km from the robot's map",
                      {{"/lat", "or /lon lies more than 10 km from the robot's map"}});
  }
  choose_home(c.at ? *c.at : pose->global);
  if (!c.at) drop_crumbs();
  return {};
}

void Robot::Impl::choose_home(base::LatLon at) {
  home.choose(at);
  event(Severity::Info, "home", "home was set");
}

base::Result<void> Robot::Impl::handle(const Drive& c) {
  const bool finite = std::isfinite(c.twist.linear_mps) && std::isfinite(c.twist.angular_radps);
  if (!finite) return base::fail(Code::Invalid, "speed and turn rate must be finite");
  const bool by_hand =
      mode == Mode::Manual || mode == Mode::Acro || mode == Mode::Steering || mode == Mode::Simple;
  if (by_hand) manual.drive(c.twist, c.deadman, now);
  return {};
}

base::Result<void> Robot::Impl::handle(const LoadMission& c) {
  if (!c.mission) return base::fail(Code::Invalid, "there is no mission to load");
  if (executor.running()) {
    return base::fail(Code::Conflict, "a mission runs: pause or stop it first");
  }
  if (!estimator.frame()) estimator.use_frame(c.mission->frame);
  if (estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: load once more");
  }
  adopt(c);
  return {};
}

void Robot::Impl::adopt(const LoadMission& c) {
  retire(std::exchange(mission, c.mission));
  mission_unpublished = true;
  executor.load(std::shared_ptr<const nav::Route>(mission, &mission->route));
  if (mode == Mode::Auto) set_mode(Mode::Hold, "another mission was loaded");
  if (mission->copy.plan.home) home.choose(mission->copy.plan.home->at);
  event(Severity::Info, "mission_loaded",
        "mission \"" + mission->copy.plan.name + "\" revision " +
            std::to_string(mission->copy.revision) + " loaded");
}

base::Result<void> Robot::Impl::handle(const ResumeAt& c) {
  if (!c.mission) return base::fail(Code::Invalid, "there is no mission to go on with");
  const bool other = mission && mission->copy.id != c.mission->copy.id;
  if (other || executor.place()) {
    return base::fail(Code::Conflict, "mission \"" + mission->copy.plan.name +
                                          "\" is loaded: resume or start that one");
  }
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (!estimator.frame() || estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: try once more");
  }
  nav::Executor trial(config.path, config.behave, config.modes);
  const std::shared_ptr<const nav::Route> route(c.mission, &c.mission->route);
  if (auto ok = trial.restore(route, c.place, "left by a restart"); !ok) return ok;
  if (auto ok = trial.may_resume(pose->at); !ok) return ok;
  adopt({c.mission});
  (void)executor.restore(route, c.place, "left by a restart");
  return resume();
}

base::Result<void> Robot::Impl::handle(const ReviseMission& c) {
  const bool same = mission
                        ? mission->copy.id == c.from_id && mission->copy.revision == c.from_revision
                        : c.from_id.empty();
  if (!same) return base::fail(Code::Conflict, "another mission was loaded meanwhile");
  if (c.mission && !estimator.frame()) estimator.use_frame(c.mission->frame);
  if (c.mission && estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: try once more");
  }
  const bool was_loaded = mission != nullptr;
  retire(std::exchange(mission, c.mission));  // the old route is left below
  mission_unpublished = true;
  if (!was_loaded && mission && mission->copy.plan.home) {
    home.choose(mission->copy.plan.home->at);
  }
  if (!mission) {
    if (executor.running()) executor.stop("nothing is left of the mission");
    executor.load(nullptr);
    if (mode == Mode::Auto) set_mode(Mode::Hold, "nothing is left of the mission");
  } else {
    auto route = std::shared_ptr<const nav::Route>(mission, &mission->route);
    if (!was_loaded) {
      executor.load(std::move(route));
    } else if (c.kind == EditKind::RemoveItem) {
      executor.drop(std::move(route), c.item);
    } else {
      executor.extend(std::move(route));
    }
  }
  const std::string item = "item " + std::to_string(c.item);
  switch (c.kind) {
    case EditKind::AddWaypoint:
      event(Severity::Info, "mission_item_added", item + " added where the robot was");
      break;
    case EditKind::RemoveItem:
      event(Severity::Info, "mission_item_removed", item + " removed");
      break;
    case EditKind::Clear:
      event(Severity::Info, "mission_cleared", "the mission was cleared");
      break;
  }
  return {};
}

}  // namespace roverd::robot
