// From facts to a command: judge what is wrong, let the one with the right to drive drive.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Driver;
using base::ExecutionState;
using base::Mode;
using base::Severity;

/// What tracks may have counted in vain until they are caught at it.
constexpr double kSpun_m = 5.0;
/// The base tells its state every 0.1 to 0.2 s: until then its last word is of the time before.
constexpr base::Duration kSettled = std::chrono::milliseconds(500);

}  // namespace

Facts Robot::Impl::facts() const {
  return {.world = world,
          .pose = pose,
          .last_position = estimator.last_position(),
          .armed = armed,
          .estop = estop,
          .autonomous = mode == Mode::Auto ? executor.running() : by_itself(),
          .base_waited_since = base_waited_since,
          .base_left = base_left,
          .commands_lost = follow.lost(),
          .not_following = follow.failing(),
          .sigma_bad_since = sigma_bad_since,
          .spins = spin.for_longer_than(config->safety.spin_s, now),
          .estimate = health};
}

void Robot::Impl::judge() {
  const SafetyParams& p = config->safety;
  const bool radio = radio_drives(world, p, now);
  const bool waits = armed && !radio && !base_listens(world);
  if (!waits) base_waited_since.reset();
  if (waits && !base_waited_since) base_waited_since = now;
  const bool bad = pose && pose->horizontal_sigma_m > p.sigma_hold_m;
  if (!bad) sigma_bad_since.reset();
  if (bad && !sigma_bad_since) sigma_bad_since = now;
  watch_base();
  spin.step(world.motion, world.gnss_velocity, now);
  // Once each time, whoever drives: the way counted meanwhile misleads all of them.
  const bool spins = spin.for_longer_than(p.spin_s, now);
  if (spins && !spun) estimator.doubt_position(kSpun_m);
  spun = spins;

  assessment = assess(facts(), p, now);
  if (assessment.base_estop) latch_estop("the button at the base");
  if (const auto hit = std::exchange(world.bumper_hit, std::nullopt)) {
    latch_estop("the bumper" + (hit->empty() ? "" : " (" + *hit + ")"));
  }
  if (assessment.response >= Response::Hold && mode != Mode::Hold) {
    const bool was_auto = mode == Mode::Auto;
    hold(assessment.cause);
    event(Severity::Warning, was_auto ? "mission_paused" : "stopped", assessment.cause);
  }
  checks = arming_checks(facts(), p, config->arming, mission != nullptr, now);
}

/// The part of a command that this vehicle can do at all.
base::BodyTwist Robot::Impl::possible(const base::BodyTwist& told) const noexcept {
  const double v = config->vehicle.max_speed_mps;
  const double w = config->vehicle.steered() ? 0.0 : config->speed.max_yaw_rate_radps;
  return {std::clamp(told.linear_mps, -v, v), std::clamp(told.angular_radps, -w, w)};
}

/// Whether our commands reach the base, by what it shows of them.
void Robot::Impl::watch_base() {
  const SafetyParams& p = config->safety;
  const bool in_charge = armed && sent.enabled && !radio_drives(world, p, now);
  if (!in_charge) in_charge_since.reset();
  if (in_charge && !in_charge_since) in_charge_since = now;

  // Just armed, or just given back by the radio, the last status may still tell of the time before.
  const bool settled = in_charge_since && now - *in_charge_since > kSettled;
  const bool listens = base_listens(world);
  const bool normal = world.base && world.base->vehicle_state == base::VehicleState::Normal;
  base_left = settled && base_listened && !listens && normal;
  if (base_left) {
    base_gone = true;
    event(Severity::Warning, "base_left_control",
          "the base left our control by itself: it was switched off and on, or heard no command");
  }
  if (base_gone && listens) event(Severity::Info, "base_back", "the base takes commands again");
  if (listens || !armed) base_gone = false;
  if (settled && listens && !base_listened) follow.heard();
  base_listened = listens;

  const bool was_lost = follow.lost();
  std::optional<base::BodyTwist> does;
  const bool told = world.motion && !world.motion->assumed &&
                    base::seconds(now - world.motion->stamp) <= p.base_timeout_s;
  if (told) does = world.motion->twist;
  follow.step(in_charge ? possible(sent.twist) : base::BodyTwist{}, does, now, p.follow_timeout_s);
  if (!was_lost && follow.lost()) {
    event(Severity::Warning, "base_not_following",
          "the base does not do what it is told: commands seem not to reach it");
  } else if (was_lost && !follow.lost()) {
    event(Severity::Info, "base_follows", "the base does what it is told again");
  }
}

void Robot::Impl::hold(const std::string& why) {
  executor.pause(why);
  set_mode(Mode::Hold, why);
}

base::DriveCommand Robot::Impl::decide() {
  driver = Driver::None;
  speed_reason = "standing";
  const bool radio = radio_drives(world, config->safety, now);
  if (radio != radio_had_control) {
    radio_had_control = radio;
    event(Severity::Info, radio ? "radio_takeover" : "radio_released",
          radio ? "the radio took control" : "the radio gave control back");
    if (radio) hold_for_a_word();
  }
  if (radio || !base_listens(world)) {
    if (executor.running() && !executor.interrupted()) executor.interrupt();
    interrupt_modes();
    manual.release();
  }
  if (radio && !estop) driver = Driver::Radio;
  if (estop || !armed || radio) return {};
  if (base_lost(world, config->safety, now)) return {};
  if (!base_listens(world)) return {{}, true};
  return keep_inside(choose());
}

/// Who may drive in this mode, and what he wants.
base::DriveCommand Robot::Impl::choose() {
  switch (mode) {
    case Mode::Hold:
      return {{}, true};
    case Mode::Manual:
      return drive_by_hand();
    case Mode::Acro:
    case Mode::Steering:
    case Mode::Simple:
      return drive_by_sticks();
    case Mode::Auto:
      return drive_mission();
    case Mode::Guided:
    case Mode::Rtl:
    case Mode::SmartRtl:
    case Mode::Follow:
    case Mode::Dock:
      return drive_by_itself();
  }
  return {{}, true};
}

base::DriveCommand Robot::Impl::drive_by_hand() {
  const base::BodyTwist twist = manual.step(now, dt_s);
  switch (manual.phase()) {
    case Manual::Phase::Free:
      break;
    case Manual::Phase::Held:
      driver = Driver::Teleop;
      speed_reason = "manual";
      break;
    case Manual::Phase::Stale:
      speed_reason = "teleop_stale";
      assessment.conditions.push_back(
          {"teleop_stale", "the commands by hand stopped coming: let go once to drive on"});
      break;
  }
  return {twist, true};
}

base::DriveCommand Robot::Impl::drive_mission() {
  if (!executor.running() || !pose) return {{}, true};
  driver = Driver::Autonomy;
  if (!pose->heading_known) return seek_heading();
  executor.go_on(pose->at);
  const nav::TrackOutput out = executor.step(vehicle(), limit_mps(), home_point(), dt_s);
  speed_reason = std::string(nav::to_string(out.reason));
  tell_notices();
  if (!executor.running()) {
    driver = Driver::None;
    return {{}, true};
  }
  return {straight_first(out.command), true};
}

void Robot::Impl::tell_notices() {
  for (nav::Notice& n : executor.notices()) {
    switch (n.kind) {
      case nav::Notice::Kind::ItemReached:
        event(Severity::Info, "item_reached", "item " + std::to_string(n.item) + " reached");
        break;
      case nav::Notice::Kind::ItemMissed:
        event(Severity::Warning, "item_missed", "item " + std::to_string(n.item) + " " + n.detail);
        break;
      case nav::Notice::Kind::Action:
        act(n);
        break;
      case nav::Notice::Kind::Finished:
        event(Severity::Info, "mission_finished",
              "mission \"" + mission->copy.plan.name + "\" finished");
        break;
      case nav::Notice::Kind::Lap:
        event(Severity::Info, "mission_lap", "the mission begins again");
        break;
      case nav::Notice::Kind::Blocked:
        event(Severity::Error, "blocked", std::move(n.detail));
        break;
      case nav::Notice::Kind::Lost:
        event(Severity::Error, "cross_track_lost", std::move(n.detail));
        break;
    }
  }
  executor.notices().clear();
  if (mode == Mode::Auto && !executor.running()) {
    const bool finished = executor.state() == ExecutionState::Finished;
    if (executor.state() == ExecutionState::Aborted) {
      event(Severity::Error, "mission_aborted", executor.reason());
    }
    set_mode(Mode::Hold, finished ? "mission finished" : executor.reason());
  }
}

/// Every action is told, so that a script may do it; what the robot knows of, it does itself.
void Robot::Impl::act(const nav::Notice& n) {
  event(Severity::Info, "action", "item " + std::to_string(n.item) + ": " + n.detail);
  if (n.detail == "set_home" && pose) {
    choose_home(pose->global);
    drop_crumbs();
  }
}

std::optional<base::EnuPoint> Robot::Impl::home_point() const {
  const auto& at = home.at();
  if (!at || !estimator.frame() || !within_reach(*at)) return std::nullopt;
  return estimator.frame()->to_local(*at);
}

bool Robot::Impl::within_reach(base::LatLon at) const {
  const double far_m = base::distance_bearing(estimator.frame()->origin(), at).distance_m;
  return far_m <= base::LocalFrame::kReach_m;
}

/// Changes that an operator wants to find later.
void Robot::Impl::watch_changes() {
  const base::FixType fix = world.gnss ? world.gnss->fix : base::FixType::None;
  if (fix != fix_seen) {
    fix_seen = fix;
    fix_seen_since = now;
  }
  if (fix_seen != fix_told && now - fix_seen_since >= std::chrono::seconds(1)) {
    const bool worse = fix_seen < fix_told;
    fix_told = fix_seen;
    event(worse ? Severity::Warning : Severity::Info, "gnss_fix",
          "GNSS fix is " + std::string(base::to_string(fix_seen)));
  }
}

/// The first fix may lie out of reach of the frame that a mission brought: a new frame began then.
void Robot::Impl::watch_frame() {
  if (pose) home.assume(pose->global);
  if (!mission || !estimator.frame() || estimator.frame()->id() == mission->frame.id()) return;
  executor.load(nullptr);
  event(Severity::Warning, "mission_unloaded",
        "the mission lies more than 10 km away from the robot and was unloaded");
  mission.reset();
  mission_unpublished = true;
}

}  // namespace roverd::robot
