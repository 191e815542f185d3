// What each command does, and when it is refused. Answers tell what the robot did.

#include <cmath>
#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Mode;
using base::Severity;

/// Somebody wants the robot to stand. To let go of the stick says less: another way of driving may
/// have been chosen before.
bool halts(const Command& c) noexcept {
  return is_stop(c) && !std::holds_alternative<Drive>(c) && !std::holds_alternative<Throttle>(c);
}

/// A person sends the robot off by itself.
bool begins(const Command& c) noexcept {
  return std::holds_alternative<StartMission>(c) || std::holds_alternative<ResumeMission>(c) ||
         std::holds_alternative<ResumeActivity>(c) || std::holds_alternative<ResumeAt>(c) ||
         std::holds_alternative<SetMode>(c) || std::holds_alternative<GoTo>(c) ||
         std::holds_alternative<MoveBy>(c) || std::holds_alternative<Calibrate>(c);
}

bool carries_much(const Command& c) noexcept {
  return std::holds_alternative<LoadMission>(c) || std::holds_alternative<ReviseMission>(c) ||
         std::holds_alternative<ResumeAt>(c) || std::holds_alternative<LayAnew>(c) ||
         std::holds_alternative<SetFence>(c);
}

/// What is left of a command when it was carried out.
struct Left {
  Command command;
  std::shared_ptr<const void> old;
};

}  // namespace

bool is_stop(const Command& c) noexcept {
  if (const auto* mode = std::get_if<SetMode>(&c)) return mode->mode == Mode::Hold;
  if (const auto* drive = std::get_if<Drive>(&c)) return !drive->deadman;
  if (const auto* hand = std::get_if<Throttle>(&c)) return !hand->held;
  return std::holds_alternative<Estop>(c) || std::holds_alternative<Disarm>(c) ||
         std::holds_alternative<PauseMission>(c) || std::holds_alternative<StopMission>(c);
}

bool neutral(const base::BodyTwist& twist) noexcept {
  return Manual::neutral(twist);
}

/// To free ten thousand items takes longer than a tick may: whoever takes the answer does it.
void Robot::Impl::retire(std::shared_ptr<const void> old) {
  if (old) retired = std::move(old);
}

void Robot::Impl::take_commands() {
  command_batch.clear();
  if (outbox.full()) return;
  commands.try_take(command_batch);
  for (PendingCommand& pending : command_batch) {
    base::Result<void> result = carry_out(pending);
    std::shared_ptr<const void> left;
    if (carries_much(pending.command)) {
      left = std::make_shared<const Left>(
          Left{std::move(pending.command), std::exchange(retired, nullptr)});
    }
    outbox.reply(std::move(pending.reply), std::move(result), std::move(left));
  }
  command_batch.clear();
}

base::Result<void> Robot::Impl::carry_out(const PendingCommand& pending) {
  if (halts(pending.command)) {
    last_stop.take(clock.now());
    blind_pause = false;  // somebody wants it to stand
  }
  if (!is_stop(pending.command)) {
    if (clock.now() > pending.validity.not_after) {
      return base::fail(Code::Late, "the command arrived too late and was not carried out");
    }
    if (auto ok = last_stop.permits(pending.validity.seen); !ok) return ok;
  }
  const bool stood = !machine.by_itself();
  auto done = std::visit([this](const auto& c) { return handle(c); }, pending.command);
  if (done && stood && begins(pending.command)) auto_hand.begin();
  return done;
}

base::Result<void> Robot::Impl::handle(const Arm& c) {
  if (arm.armed()) return {};
  if (auto refusal = arming_refusal(checks, c.by_hand)) {
    event(Severity::Warning, "arm_refused", refusal->detail);
    return tl::unexpected(std::move(*refusal));
  }
  const bool by_hand_only = arming_refusal(checks).has_value();
  if (!arm.arm(by_hand_only)) return base::fail(Code::Conflict, "the emergency stop is latched");
  base_watch.ask_anew();
  by_hand.lock("the robot was armed", clock.now());
  reset_latch.armed();
  handling.armed();
  change_mode(ModeCause::Armed, "armed");
  const HomeAtArm rule = home_at_arm_from(config->robot.home_at_arm).value_or(HomeAtArm::Keep);
  if (pose && home.arm(pose->global, rule)) begin_way_anew();
  event(Severity::Info, "armed",
        by_hand_only ? "armed to be driven by hand: the checks of the position do not hold"
                     : "armed");
  return {};
}

base::Result<void> Robot::Impl::handle(const Disarm&) {
  disarm(asker);
  return {};
}

void Robot::Impl::disarm(const std::string& why) {
  by_hand.lock("the robot was disarmed", clock.now());
  change_mode(ModeCause::Disarmed, "disarmed");
  if (!arm.disarm()) return;
  base_watch.ask_anew();
  event(Severity::Info, "disarmed", "disarmed " + why);
}

base::Result<void> Robot::Impl::handle(const Estop& c) {
  if (unnamed_stop) tell_stop(c.who);
  latch_estop(c.who);
  return {};
}

void Robot::Impl::latch_estop(const std::string& who) {
  if (latch_silently()) tell_stop(who);
}

/// @return false: it was latched already
bool Robot::Impl::latch_silently() {
  const ArmSwitch::Latch latch = arm.latch();
  if (!latch.newly) return false;
  by_hand.lock("the emergency stop was pressed", clock.now());
  base_watch.ask_anew();
  if (latch.disarmed) event(Severity::Warning, "disarmed", "disarmed by the emergency stop");
  change_mode(ModeCause::Estop, "emergency stop");
  return true;
}

void Robot::Impl::tell_stop(const std::string& who) {
  event(Severity::Error, "estop", "emergency stop" + (who.empty() ? "" : " by " + who));
  unnamed_stop.reset();
}

base::Result<void> Robot::Impl::handle(const ResetEstop&) {
  if (!arm.latched()) return {};
  if (const std::string still = release_refusal(world); !still.empty()) {
    return base::fail(Code::Conflict, still);
  }
  if (unnamed_stop) tell_stop("the operator");
  arm.release();
  estop_asked.store(false);
  change_mode(ModeCause::EstopReset, "emergency stop released");
  event(Severity::Info, "estop_reset", "emergency stop released; disarmed");
  return {};
}

/// A mission that counts from a map does so rightly. @param from empty: from anywhere
base::Result<void> Robot::Impl::in_its_map(const CompiledMission& mission,
                                           const std::optional<base::MissionPlace>& from) const {
  const auto& map = mission.copy.plan.frame;
  if (!map) return {};
  const nav::RouteStep* step = nullptr;
  if (from) {
    const auto& steps = (from->back ? mission.route.back : mission.route.forth).steps;
    const auto i = static_cast<std::size_t>(from->step);
    if (i < steps.size()) step = &steps[i];
  }
  return counts_from(*map, map_now(), leads_into_map(mission.copy.plan, step));
}

MapNow Robot::Impl::map_now() const {
  return {world.place, estimator.frame(), estimator.health().map_offset, clock.now()};
}

base::Result<void> Robot::Impl::may_drive_mission(
    const std::optional<base::MissionPlace>& from) const {
  if (arm.latched()) return base::fail(Code::Conflict, "the emergency stop is latched");
  if (!missions) return base::fail(Code::Conflict, "no mission is loaded");
  if (auto ok = in_its_map(*missions.get(), from); !ok) return ok;
  return may_drive_by_itself(false, from && by_sight_from(missions->route, *from));
}

/// Whether by_sight() will hold once that is driven.
bool Robot::Impl::by_sight_from(const nav::Route& route,
                                const base::MissionPlace& from) const noexcept {
  return fence.get() == nullptr && !route.corridor_m &&
         nav::asks_no_place(from.back ? route.back : route.forth,
                            static_cast<std::size_t>(from.step));
}

base::Result<void> Robot::Impl::start(const nav::StartAt& at) {
  base::MissionPlace from_step;
  if (missions && pose) {
    from_step.step = static_cast<int>(nav::first_step(missions->route, at, pose->at));
  }
  if (auto ok = may_drive_mission(from_step); !ok) return ok;
  const nav::PathParams path = config->path();
  const FenceKeep::Start from{.stand = stand_of(*pose),
                              .home = home_point(),
                              .margin_m = way_margin_m(),
                              .path = path,
                              .behave = config->behave};
  if (auto ok = fence.may_start(*missions.get(), at, from); !ok) return ok;
  if (auto ok = missions.executor.start(at, pose->at, from.home); !ok) return ok;
  straight.reset();
  change_mode(ModeCause::MissionDrives, "mission started");
  event(Severity::Info, "mission_started", missions.name() + " started");
  return {};
}

base::Result<void> Robot::Impl::resume() {
  if (auto ok = may_drive_mission(missions.executor.place()); !ok) return ok;
  missions.executor.see_row(row_sight());
  if (auto ok = missions.executor.resume(pose->at); !ok) return ok;
  straight.reset();
  change_mode(ModeCause::MissionDrives, "mission resumed");
  event(Severity::Info, "mission_resumed", "mission resumed");
  return {};
}

base::Result<void> Robot::Impl::handle(const StartMission& c) {
  const auto& mission = missions.get();
  if (mission && (c.mission_id != mission->copy.id || c.revision != mission->copy.revision)) {
    return base::fail(Code::Conflict, "loaded is mission " + mission->copy.id + " revision " +
                                          std::to_string(mission->copy.revision) + ", not " +
                                          c.mission_id + " revision " + std::to_string(c.revision));
  }
  return start(start_at(c));
}

base::Result<void> Robot::Impl::handle(const PauseMission&) {
  // Said twice, over the stream and by a call: it is as was asked for.
  if (missions.executor.state() == base::ExecutionState::Paused) return {};
  if (!missions.executor.running()) {
    return base::fail(Code::Conflict, "no mission runs: it is " +
                                          std::string(to_string(missions.executor.state())));
  }
  hold(std::string("paused ") + asker);
  event(Severity::Info, "mission_paused", "mission paused");
  return {};
}

/// A mission that waits; with none, what the radio interrupted.
base::Result<void> Robot::Impl::handle(const ResumeMission&) {
  if (self_driving.held().waits() && !missions.waits()) return handle(ResumeActivity{});
  return resume();
}

base::Result<void> Robot::Impl::handle(const ResumeActivity&) {
  if (!self_driving.held().waits()) {
    return base::fail(Code::Conflict, "nothing was interrupted by the radio");
  }
  if (auto ok = may_drive_by_itself(leads_home(machine.mode())); !ok) return ok;
  return go_on();
}

base::Result<void> Robot::Impl::handle(const StopMission&) {
  if (!missions.in_hand()) {
    return base::fail(Code::Conflict, "there is nothing to stop: the mission is " +
                                          std::string(to_string(missions.executor.state())));
  }
  missions.executor.stop(std::string("stopped ") + asker);
  change_mode(ModeCause::MissionOver, "mission stopped");
  event(Severity::Info, "mission_aborted", std::string("mission stopped ") + asker);
  return {};
}

base::Result<void> Robot::Impl::handle(const SkipItem& c) {
  auto result = missions.executor.skip(c.item);
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
  if (!c.at) begin_way_anew();
  return {};
}

void Robot::Impl::choose_home(base::LatLon at) {
  home.choose(at);
  event(Severity::Info, "home", "home was set");
}

base::Result<void> Robot::Impl::handle(const Drive& c) {
  const bool finite = std::isfinite(c.twist.linear_mps) && std::isfinite(c.twist.angular_radps);
  if (!finite) return base::fail(Code::Invalid, "speed and turn rate must be finite");
  const bool by_network = machine.kind() == ModeKind::ByHand;
  if (c.deadman && !by_network) {
    return base::fail(Code::Conflict, "the sticks do nothing in mode " +
                                          std::string(base::to_string(machine.mode())));
  }
  if (c.deadman && !arm.armed()) return base::fail(Code::Conflict, "the robot is not armed");
  if (c.deadman && driver == base::Driver::Radio) {
    return base::fail(Code::Conflict, "the radio drives");
  }
  const Handle handle{c.twist, c.deadman,       c.source, c.said.value_or(clock.now()),
                      c.gone,  c.override_guard};
  if (by_network && !by_hand.drive(handle, clock.now())) {
    return base::fail(Code::Conflict, by_hand.why());
  }
  if (c.override_guard && by_hand.overrides_guard()) overrider = c.who;
  return {};
}

base::Result<void> Robot::Impl::handle(const Throttle& c) {
  if (!std::isfinite(c.share) || c.share < 0.0 || c.share > 1.0) {
    return base::fail(Code::Invalid, "the share of the speed must be from 0 to 1");
  }
  if (auto_hand.say({c.share, c.held, c.source, c.gone}, clock.now())) return {};
  return base::fail(Code::Conflict, auto_hand.why_not());
}

base::TeleopState Robot::Impl::teleop() const {
  base::TeleopState s;
  if (auto_hand.used()) s.auto_share = auto_hand.share();
  if (machine.kind() != ModeKind::ByHand) {
    s.reason = "the mode is " + std::string(base::to_string(machine.mode()));
    return s;
  }
  if (!arm.armed() || driver == base::Driver::Radio) {
    s.reason = arm.armed() ? "the radio drives" : "the robot is not armed";
    return s;
  }
  s.released = by_hand.released();
  s.delay_s = by_hand.delay_s(clock.now());
  switch (by_hand.phase()) {
    case Manual::Phase::Locked:
      s.phase = base::TeleopPhase::Release;
      s.reason = by_hand.why();
      break;
    case Manual::Phase::Ready:
      s.phase = base::TeleopPhase::Ready;
      break;
    case Manual::Phase::Held:
      s.phase = base::TeleopPhase::Held;
      break;
  }
  return s;
}

base::Result<void> Robot::Impl::handle(const LoadMission& c) {
  if (!c.mission) return base::fail(Code::Invalid, "there is no mission to load");
  if (missions.executor.running()) {
    return base::fail(Code::Conflict, "a mission runs: pause or stop it first");
  }
  if (!estimator.frame()) estimator.use_frame(c.mission->frame);
  if (estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: load once more");
  }
  adopt(c.mission);
  return {};
}

void Robot::Impl::adopt(std::shared_ptr<const CompiledMission> mission) {
  retire(missions.load(std::move(mission)));
  loaded.set(missions.get());
  change_mode(ModeCause::MissionOver, "another mission was loaded");
  if (missions->copy.plan.home) home.choose(missions->copy.plan.home->at);
  event(Severity::Info, "mission_loaded", missions.name() + " loaded");
}

base::Result<void> Robot::Impl::handle(const LayAnew& c) {
  if (!c.mission) return base::fail(Code::Invalid, "there is no mission to lay out");
  if (auto ok = missions.may_lay_anew(*c.mission); !ok) return ok;
  retire(missions.lay_anew(c.mission));
  loaded.set(missions.get());
  event(Severity::Info, "mission_laid_anew",
        missions.name() + " was laid out anew, by the parameters as they are now");
  return {};
}

base::Result<void> Robot::Impl::handle(const ResumeAt& c) {
  if (!c.mission) return base::fail(Code::Invalid, "there is no mission to go on with");
  const bool other = missions && missions->copy.id != c.mission->copy.id;
  if (other || missions.executor.place()) {
    return base::fail(Code::Conflict, "mission \"" + missions->copy.plan.name +
                                          "\" is loaded: resume or start that one");
  }
  const bool sight = by_sight_from(c.mission->route, c.place);
  if (auto ok = may_drive_by_itself(false, sight); !ok) return ok;
  if (!estimator.frame() || estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: try once more");
  }
  if (auto ok = missions.may_restore(c, config, pose->at); !ok) return ok;
  if (auto ok = in_its_map(*c.mission, c.place); !ok) return ok;
  adopt(c.mission);
  missions.restore(rolled_on(c.mission->route, c.place, *pose));
  return resume();
}

base::Result<void> Robot::Impl::handle(const ReviseMission& c) {
  if (auto ok = missions.may_revise(c); !ok) return ok;
  if (c.mission && !estimator.frame()) estimator.use_frame(c.mission->frame);
  if (c.mission && estimator.frame()->id() != c.mission->frame.id()) {
    return base::fail(Code::Conflict, "the robot's map began meanwhile: try once more");
  }
  const bool was_loaded = missions.get() != nullptr;
  retire(missions.revise(c));
  loaded.set(missions.get());
  if (!was_loaded && missions && missions->copy.plan.home) {
    home.choose(missions->copy.plan.home->at);
  }
  if (!missions) change_mode(ModeCause::MissionOver, "nothing is left of the mission");
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
