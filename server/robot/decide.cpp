// From facts to a command: judge what is wrong, let the one with the right to drive drive.

#include <cmath>
#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Driver;
using base::Severity;

/// What tracks may have counted in vain until they are caught at it.
constexpr double kSpun_m = 5.0;
constexpr double kStands_mps = 0.05;

}  // namespace

/// Empty: nothing tells, or not any more.
std::optional<base::Attitude> Robot::Impl::attitude() const {
  return estimator.attitude(clock.now());
}

double Robot::Impl::braking_here_mps2(double level_mps2) const {
  const double braking_mps2 = handling.braking_mps2(level_mps2);
  const auto lean = attitude();
  if (!lean || !std::isfinite(lean->pitch_rad)) return braking_mps2;
  const double speed_mps = pose && pose->speed_mps ? *pose->speed_mps : 0.0;
  // Standing it may begin to either side.
  const double down_rad = speed_mps > kStands_mps    ? -lean->pitch_rad
                          : speed_mps < -kStands_mps ? lean->pitch_rad
                                                     : std::abs(lean->pitch_rad);
  return nav::slope_decel_mps2(braking_mps2, down_rad, config->slope);
}

double Robot::Impl::most_roll_deg() const noexcept {
  return base::deg_from_rad(nav::most_roll_rad(config->vehicle, config->slope));
}

std::optional<double> Robot::Impl::corridor_m() const noexcept {
  return machine.mode() == Mode::Auto ? missions.executor.corridor_m() : std::nullopt;
}

/// What is driven now needs no position: the item in hand asks for none, no fence is to be kept,
/// and no corridor.
bool Robot::Impl::by_sight() const noexcept {
  if (machine.mode() == Mode::Dock) {
    return fence.get() == nullptr && self_driving.docks_at_tag() != nullptr;
  }
  return machine.mode() == Mode::Auto && fence.get() == nullptr &&
         !missions.executor.corridor_m() && missions.executor.asks_no_place();
}

Facts Robot::Impl::facts() const {
  const auto home_at = pose ? home_point() : std::nullopt;
  return {.world = world,
          .pose = pose,
          .last_position = estimator.last_position(),
          .armed = arm.armed(),
          .estop = arm.latched(),
          .autonomous =
              machine.mode() == Mode::Auto ? missions.executor.running() : machine.by_itself(),
          .by_sight = by_sight(),
          .homeward = leads_home(machine.mode()),
          .base_waited_since = base_watch.waited_since(),
          .base_left = base_watch.left(),
          .commands_lost = base_watch.commands_lost(),
          .not_following = base_watch.disobeys_now(),
          .sigma_bad_since = position_watch.uncertain_since(),
          .corridor_m = corridor_m(),
          .corridor_bad_since = position_watch.too_wide_since(),
          .spins = position_watch.spins(),
          .attitude = attitude(),
          .leans_since = lean_watch.since(),
          .rolls_since = roll_watch.since(),
          .most_roll_deg = most_roll_deg(),
          .gyro_lost = estimate_watch.gyro_lost(),
          .falls = driver_falls.worst(clock.now()),
          .home_m = home_at ? std::optional(base::distance_m(pose->at, *home_at)) : std::nullopt,
          .use_pct_per_m = battery_use.pct_per_m(),
          .self_test = self_test,
          .estimate = health,
          .latched = reset_latch.why(),
          .moved_disarmed = reset_latch.disarmed_why(),
          .blind = blind,
          .looks = guard.sees(),
          .wander_unknown_s = estimator.wander_unknown_s()};
}

void Robot::Impl::judge() {
  const SafetyParams& p = config->safety;
  watch_base();
  auto lean = attitude();
  lean_watch.step(lean, p.tilt_stop_deg, clock.now());
  if (lean) lean->pitch_rad = 0.0;
  roll_watch.step(lean, most_roll_deg(), clock.now());
  battery_use.step(world.battery, world.motion ? world.motion->twist.linear_mps : 0.0,
                   clock.dt_s());
  if (position_watch.step(pose, world, p, corridor_m(), clock.now()))
    estimator.doubt_position(kSpun_m);
  assessment = assess(facts(), p, clock.now());
  if (assessment.base_estop) latch_estop("the button at the base");
  if (const auto hit = std::exchange(world.bumper_hit, std::nullopt)) {
    latch_estop("the bumper" + (hit->empty() ? "" : " (" + *hit + ")"));
  }
  if (assessment.response == Response::Return) go_back(assessment.cause);
  if (assessment.response >= Response::Hold && machine.mode() != Mode::Hold) {
    const bool was_auto = machine.mode() == Mode::Auto;
    hold(assessment.cause);
    event(Severity::Warning, was_auto ? "mission_paused" : "stopped", assessment.cause);
    blind_pause = was_auto && !blind.empty() && assessment.cause == blind;
    sees_since.reset();
  }
  watch_blind_pause();
  // In its CAN mode the base obeys whoever speaks; out of it, nobody.
  if (!assessment.disarms.empty() && arm.armed()) disarm("because " + assessment.disarms);
  // Armed, they are only shown: ten times a second will do.
  constexpr int kArmedEvery = 5;
  if (arm.armed() && ++ticks_unchecked < kArmedEvery) return;
  ticks_unchecked = 0;
  checks = arming_checks(facts(), p, config->arming, missions.get() != nullptr, clock.now());
}

/// What tells how the vehicle answers.
nav::VehicleLearner::Seen Robot::Impl::seen() const {
  nav::VehicleLearner::Seen out;
  out.ours = arm.armed() && base_listens(world) && !arm.latched() &&
             !radio_drives(world, config->safety, clock.now());
  if (world.motion && !world.motion->assumed) {
    out.tracks = world.motion->twist;
    out.tracks_stamp = world.motion->stamp;
  }
  if (pose) out.yaw_rate_radps = pose->yaw_rate_radps;
  out.now = clock.now();
  return out;
}

/// Whether our commands reach the base, by what it shows of them.
void Robot::Impl::watch_base() {
  const bool radio = radio_drives(world, config->safety, clock.now());
  const BaseWatch::News news = base_watch.step(
      {world, config->safety, arm.armed(), radio, sent, possible(sent.twist, *config)},
      clock.now());
  if (news.left) {
    event(Severity::Warning, "base_left_control",
          "the base left our control by itself: it was switched off and on, or heard no command");
  }
  if (news.back) event(Severity::Info, "base_back", "the base takes commands again");
  if (news.disobeys) {
    event(Severity::Warning, "base_not_following",
          "the base does not do what it is told: commands seem not to reach it");
  }
  if (news.obeys) event(Severity::Info, "base_follows", "the base does what it is told again");
}

/// What changed about the estimate and the receiver that an operator wants to find later.
void Robot::Impl::watch_estimate() {
  estimator.ask_about_shifts(arm.armed());
  health = estimator.health();
  const base::FixType fix = world.gnss ? world.gnss->fix : base::FixType::None;
  for (const EstimateWatch::News& n : estimate_watch.step(health, fix, clock.now())) {
    event(n.level, n.kind, n.detail);
  }
  for (const EstimateWatch::News& n : votes_watch.step(health.votes)) {
    event(n.level, n.kind, n.detail);
  }
  if (reset_latch.step(health, arm.armed(), config->safety.reset_repeat_s, clock.now())) {
    if (const auto& reset = health.last_reset) {
      estimator.distrust(std::hypot(reset->jump.east_m, reset->jump.north_m),
                         std::abs(reset->jump_rad));
      pose = estimator.pose(clock.now());
    }
    event(Severity::Warning, "estimate_latched", reset_latch.why());
  }
  watch_place();
  if (estimate_watch.anchor_lost() && missions.executor.running()) {
    const std::string why = "the anchor was dropped: the fix class changed";
    hold(why);
    event(Severity::Warning, "mission_paused", why);
  }
}

/// Where in its map it is: that it is found, and that it is lost.
void Robot::Impl::watch_place() {
  using Phase = base::PlacePhase;
  if (!world.place) return;
  const base::PlaceState& place = *world.place;
  if (place.map != place_told_in) {  // in another map it is found, or lost, anew
    place_told = Phase::Off;
    place_told_in = place.map;
  }
  if (place.phase == place_told || place.phase == Phase::Off || place.phase == Phase::Searching) {
    return;
  }
  place_told = place.phase;
  if (place.phase == Phase::Known) {
    event(Severity::Info, "place_known", "the map " + place.map + " shows where the robot is");
  } else {
    event(Severity::Warning, "place_lost", place.map + ": " + place.reason);
  }
}

void Robot::Impl::hold(const std::string& why) {
  change_mode(ModeCause::Loss, why);
}

void Robot::Impl::watch_radio(bool drives) {
  if (std::exchange(radio_had_control, drives) == drives) return;
  event(Severity::Info, drives ? "radio_takeover" : "radio_released",
        drives ? "the radio took control" : "the radio gave control back");
  if (drives) last_stop.take(clock.now(), "the radio took control");
  if (drives) blind_pause = false;
  const bool interrupts = drives && machine.kind() == ModeKind::ByItself;
  if (interrupts && self_driving.hold(machine.mode())) {
    event(Severity::Warning, "activity_held", self_driving.held().why());
  }
}

base::DriveCommand Robot::Impl::decide() {
  driver = Driver::None;
  speed_reason = "standing";
  watch_hand();
  const bool radio = radio_drives(world, config->safety, clock.now());
  watch_radio(radio);
  const bool listens = base_listens(world);
  if (radio || !listens) {
    nav::Executor& executor = missions.executor;
    if (executor.running() && !executor.interrupted()) executor.interrupt();
    self_driving.interrupt();
    by_hand.lock(radio ? "the radio drove" : "the base took no commands", clock.now());
  }
  if (radio && !arm.latched()) driver = Driver::Radio;
  const bool lost = base_lost(world, config->safety, clock.now());
  if (radio || !arm.armed() || !listens || lost) {
    guard.forget();
    keep_guard();
  }
  if (!arm.armed() || radio) return {};
  if (lost) return {};
  if (!listens) return {{}, true};
  guard.follow(false);
  return keep_off(keep_inside(choose()));
}

/// Who may drive in this mode, and what he wants.
base::DriveCommand Robot::Impl::choose() {
  switch (machine.kind()) {
    case ModeKind::Standing:
      return {{}, true};
    case ModeKind::ByHand:
      return drive_by_hand();
    case ModeKind::Mission:
      return under_hand(drive_mission());
    case ModeKind::ByItself:
      return under_hand(drive_by_itself());
  }
  return {{}, true};
}

/// What the body's origin keeps from the fence on a way that is asked for.
double Robot::Impl::way_margin_m() const {
  return config->way_margin_m();
}

/// The straight way there, against the fence.
base::Result<void> Robot::Impl::inside(base::EnuPoint to) const {
  return fence.inside(pose->at, to, way_margin_m());
}

/// The last word: what would not stop inside the fence does not leave.
base::DriveCommand Robot::Impl::keep_inside(base::DriveCommand command) {
  if (!pose) return command;
  const bool hands = !machine.by_itself();
  FenceParams kept = config->kept_fence();
  kept.decel_mps2 = braking_here_mps2(kept.decel_mps2);
  const FenceKeep::Verdict verdict =
      fence.judge(command.twist, *pose, estimator.frame(), hands, kept);
  if (!verdict.stops) return command;
  assessment.conditions.push_back({"fence", verdict.why});
  if (verdict.newly) event(Severity::Warning, "fence", verdict.why);
  speed_reason = "fence";
  if (!hands) {
    const bool mission_ran = machine.mode() == Mode::Auto;
    hold(verdict.why);
    if (mission_ran) event(Severity::Warning, "mission_paused", verdict.why);
    driver = Driver::None;
  }
  command.twist = {};
  return command;
}

base::Result<void> Robot::Impl::handle(const SetFence& c) {
  // A stick that is held against a fence must not drive on because the fence goes.
  if (fence.stops()) by_hand.lock("the fence changed", clock.now());
  retire(fence.set(c.fence));
  shared_fence.set(c.fence);
  event(Severity::Info, "fence_set",
        c.fence ? "fence \"" + c.fence->fence->name + "\" holds" : std::string("no fence holds"));
  return {};
}

std::optional<base::EnuPoint> Robot::Impl::home_point() const {
  const auto& at = home.at();
  if (!at || !estimator.frame() || !within_reach(*at)) return std::nullopt;
  return estimator.frame()->to_local(*at);
}

bool Robot::Impl::within_reach(base::LatLon at) const {
  const base::LatLon origin = estimator.frame()->origin();
  // Asked in each tick, and a geodesic is dear: what is near by the longest degrees there are, of
  // both, is near.
  constexpr double kLongestDegree_m = 111'700.0;
  const double degrees = std::abs(at.lat - origin.lat) + std::abs(at.lon - origin.lon);
  if (degrees * kLongestDegree_m <= base::LocalFrame::kReach_m) return true;
  return base::distance_bearing(origin, at).distance_m <= base::LocalFrame::kReach_m;
}

/// The first fix may lie out of reach of the frame that a mission brought: a new frame began then.
void Robot::Impl::watch_frame() {
  if (pose) home.assume(pose->global);
  if (!missions || !estimator.frame()) return;
  if (estimator.frame()->id() == missions->frame.id()) return;
  event(Severity::Warning, "mission_unloaded",
        "the mission lies more than 10 km away from the robot and was unloaded");
  (void)missions.unload();
  loaded.set(nullptr);
}

}  // namespace roverd::robot
