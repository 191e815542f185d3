// One tick of each kind of mode.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "robot/impl.hpp"
#include "robot/safety/certainty.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::Driver;
using base::ExecutionState;
using base::Severity;

constexpr double kLookForMap_s = 0.2;
constexpr double kOutOfMap_s = 2.0;

}  // namespace

nav::Vehicle Robot::Impl::vehicle() const {
  const nav::Belief& b = estimator.belief();
  const auto lean = attitude();
  return {pose->at,
          pose->yaw_rad,
          pose->yaw_sigma_rad,
          pose->speed_mps.value_or(0.0),
          pose->yaw_rate_radps.value_or(0.0),
          b.x(nav::kScale),
          b.x(nav::kYawScale),
          b.x(nav::kPull),
          pose->horizontal_sigma_m,
          lean ? lean->roll_rad : 0.0,
          lean ? lean->pitch_rad : 0.0,
          estimator.crab(),
          estimator.slide()};
}

/// What a hand on the speed leaves of it: its share of what the way sets here, and where nothing is
/// set, of the most.
double Robot::Impl::hand_mps() const noexcept {
  const double most = std::min(config->speed.max_mps, config->vehicle.max_speed_mps);
  const double share = auto_hand.share();
  if (share >= 1.0 || !machine.by_itself()) return most;
  const auto set = machine.mode() == Mode::Auto ? missions.executor.set_mps() : std::nullopt;
  return share * std::min(most, set.value_or(most));
}

/// A limit from outside has one word for the way; whose it is, is known here.
std::string_view Robot::Impl::reason_under_hand(std::string_view reason) const noexcept {
  const bool slows = reason == nav::to_string(nav::SpeedReason::Slow);
  return slows && hand_mps() < free_limit_mps() ? std::string_view("hand") : reason;
}

/// It wants the robot to stand, and as slow as it can be driven along a way it is already.
bool Robot::Impl::hand_holds() const noexcept {
  return auto_hand.stands() && std::abs(sent.twist.linear_mps) <= 1.05 * config->speed.min_mps;
}

void Robot::Impl::watch_hand() {
  if (auto_hand.step(clock.now(), config->manual.auto_timeout_s) && machine.by_itself()) {
    event(Severity::Warning, "hand_lost", auto_hand.why());
  }
}

/// The last word of the hand on the speed, also where something else than a way is driven. A limit
/// that came suddenly brakes; it is gentler than what follows a way does by itself.
base::DriveCommand Robot::Impl::under_hand(base::DriveCommand command) {
  if (!auto_hand.used()) return command;
  if (!auto_hand.held()) assessment.conditions.push_back({"auto_hand", auto_hand.why()});
  if (auto_hand.share() >= 1.0) return command;
  if (auto_hand.stands() && command.twist.linear_mps == 0.0) command.twist.angular_radps = 0.0;
  const double floor_mps = auto_hand.stands() ? 0.0 : config->speed.min_mps;
  const double braked_mps =
      std::abs(sent.twist.linear_mps) - 0.5 * config->speed.hold_decel_mps2 * clock.dt_s();
  const double most = std::max({hand_mps(), floor_mps, braked_mps});
  const double wanted = std::abs(command.twist.linear_mps);
  if (wanted <= most) return command;
  speed_reason = "hand";
  command.twist.linear_mps *= most / wanted;
  command.twist.angular_radps *= most / wanted;
  return command;
}

/// What is allowed now, whatever a path was laid for.
double Robot::Impl::limit_mps() const noexcept {
  return std::min(free_limit_mps(), hand_mps());
}

double Robot::Impl::free_limit_mps() const noexcept {
  double most = std::min(config->speed.max_mps, config->vehicle.max_speed_mps);
  most = std::min(most, std::max(guard.limit_mps(), 0.5 * config->speed.min_mps));
  if (assessment.slow) return std::min(most, config->speed.creep_mps);
  if (!pose || by_sight()) return most;
  return certain_mps(pose->horizontal_sigma_m, corridor_m(), most, config->speed.creep_mps,
                     config->safety);
}

base::DriveCommand Robot::Impl::drive_by_hand() {
  ByHand::Step step;
  if (machine.mode() == Mode::Manual) {
    step = by_hand.plain(clock.now(), clock.dt_s());
  } else if (pose) {
    const nav::Vehicle v = vehicle();
    step = by_hand.helped(&v, limit_mps(), clock.now(), clock.dt_s());
  } else {
    step = by_hand.helped(nullptr, limit_mps(), clock.now(), clock.dt_s());
  }
  if (step.held) driver = Driver::Teleop;
  if (!step.reason.empty()) speed_reason = std::string(step.reason);
  if (const double share = by_hand.share_of_speed(clock.now()); share < 1.0) {
    speed_reason = "link_delay";
    const auto late_ms = std::lround(1000.0 * by_hand.delay_s(clock.now()).value_or(0.0));
    assessment.conditions.push_back(
        {"link_delay", "whoever drives is up to " + std::to_string(late_ms) +
                           " ms behind: no more than " +
                           std::to_string(std::lround(100.0 * share)) + " % of the speed"});
  }
  if (!step.stale && by_hand.in_vain(clock.now())) {
    assessment.conditions.push_back({"release_stick", by_hand.why()});
  }
  if (step.stale) {
    assessment.conditions.push_back(
        {"teleop_stale", "the commands by hand stopped coming: let go once to drive on"});
  }
  return {step.twist, true};
}

base::DriveCommand Robot::Impl::drive_by_itself() {
  if (!pose) return {{}, true};
  if (self_driving.calibrates() && guard.obstacle().action != base::GuardAction::None) {
    // A figure that was slowed, or stood in between, measures nothing: it does not wait.
    self_driving.calibration().end(guard.obstacle().reason);
  } else if (self_driving.calibrates() && auto_hand.share() < 1.0) {
    self_driving.calibration().end(auto_hand.why());
  } else if (hand_holds()) {
    self_driving.interrupt();
    speed_reason = "hand";
    driver = Driver::Autonomy;
    return {{}, true};
  } else if (waits_for_way()) {
    self_driving.interrupt();
    return {{}, true};
  }
  const SelfDriving::Step step =
      self_driving.step({machine.mode(), vehicle(), *estimator.frame(), limit_mps(), clock.now(),
                         clock.dt_s(), tag_sight()});
  speed_reason = std::string(reason_under_hand(step.reason));
  if (step.drives) driver = Driver::Autonomy;
  if (!step.ending) return {step.twist, true};
  const SelfDriving::Ending& end = *step.ending;
  event(end.state == ActivityState::Reached ? Severity::Info : Severity::Warning, end.kind,
        end.detail);
  const bool left = change_mode(ModeCause::ActivityOver, end.detail);
  return {left ? base::BodyTwist{} : step.twist, true};
}

/// On the way to a point of its map: why that may lie elsewhere, after kOutOfMap_s. Asked seldom:
/// it costs a geodesic.
std::optional<std::string> Robot::Impl::out_of_map() {
  const nav::RouteStep* step = missions.executor.step_in_hand();
  const mission::Plan& plan = missions.get()->copy.plan;
  if (!plan.frame || step == nullptr || !leads_into_map(plan, step)) {
    out_of_map_since.reset();
    return std::nullopt;
  }
  if (base::seconds(clock.now() - looked_for_map) < kLookForMap_s) return std::nullopt;
  looked_for_map = clock.now();
  auto ok = counts_from(*plan.frame, map_now(), true);
  if (ok) out_of_map_since.reset();
  if (ok) return std::nullopt;
  if (!out_of_map_since) out_of_map_since = clock.now();
  if (base::seconds(clock.now() - *out_of_map_since) < kOutOfMap_s) return std::nullopt;
  out_of_map_since.reset();
  return std::move(ok.error().detail);
}

base::DriveCommand Robot::Impl::drive_mission() {
  if (!missions.executor.running() || !pose) return {{}, true};
  if (const auto why = out_of_map()) {
    hold(*why);
    event(Severity::Warning, "mission_paused", *why);
    driver = Driver::None;
    return {{}, true};
  }
  driver = Driver::Autonomy;
  if (hand_holds()) {
    missions.executor.wait();
    speed_reason = "hand";
    return {{}, true};
  }
  if (const auto twist = drive_around()) {
    tell_notices();
    return {*twist, true};
  }
  if (waits_for_way()) {
    missions.executor.wait();
    return {{}, true};
  }
  const bool moves = !missions.executor.stands(vehicle(), clock.dt_s());
  if (!pose->heading_known && !by_sight() && moves) return seek_heading();
  missions.executor.see_row(row_sight());
  missions.executor.go_on(pose->at);
  missions.executor.see_row(row_sight());  // going on, it may have asked for another row
  missions.executor.see_marks(mark_sight());
  const nav::TrackOutput out =
      missions.executor.step(vehicle(), limit_mps(), home_point(), clock.dt_s());
  speed_reason = std::string(reason_under_hand(nav::to_string(out.reason)));
  tell_notices();
  if (!missions.executor.running()) {
    driver = Driver::None;
    return {{}, true};
  }
  return {straight_first(out.command), true};
}

void Robot::Impl::tell_notices() {
  for (nav::Notice& n : missions.executor.notices()) {
    switch (n.kind) {
      case nav::Notice::Kind::ItemReached:
        event(Severity::Info, "item_reached", "item " + std::to_string(n.item) + " reached");
        break;
      case nav::Notice::Kind::ItemMissed:
        event(Severity::Warning, "item_missed", "item " + std::to_string(n.item) + " " + n.detail);
        break;
      case nav::Notice::Kind::Overshot:
        event(Severity::Warning, "overshot",
              "item " + std::to_string(n.item) + " " + n.detail + ": the robot backs up to it");
        break;
      case nav::Notice::Kind::Action:
        act(n);
        break;
      case nav::Notice::Kind::Finished:
        event(Severity::Info, "mission_finished",
              "mission \"" + missions->copy.plan.name + "\" finished");
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
  missions.executor.notices().clear();
  if (machine.mode() == Mode::Auto && !missions.executor.running()) {
    const bool finished = missions.executor.state() == ExecutionState::Finished;
    if (missions.executor.state() == ExecutionState::Aborted) {
      event(Severity::Error, "mission_aborted", missions.executor.reason());
    }
    change_mode(ModeCause::MissionOver, finished ? "mission finished" : missions.executor.reason());
  }
}

/// Only what was done is told as done.
void Robot::Impl::act(const nav::Notice& n) {
  const std::string item = "item " + std::to_string(n.item) + ": ";
  const std::string name = n.detail.substr(0, n.detail.find(' '));
  if (name != "set_home" || !pose) {
    const char* why = name != "set_home" ? "nothing here does it" : "the position is not known";
    event(Severity::Warning, "action_left_out", item + name + " was not done: " + why);
    return;
  }
  choose_home(pose->global);
  begin_way_anew();
  event(Severity::Info, "action", item + n.detail);
}

}  // namespace roverd::robot
