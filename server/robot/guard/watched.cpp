// The guard in the robot: what it is told each tick, and what follows from its word.

#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::SensorHealth;

constexpr base::Duration kBlindFor = std::chrono::milliseconds(250);

/// Which sensor does not see, of those that the profile demands.
std::string blind_words(const Guard& guard, base::Time now) {
  const Surroundings* around = guard.around().get();
  if (around == nullptr) return "the sensors have not been heard yet";
  for (const base::SensorState& s : *around->sensors) {
    if (!s.required) continue;
    if (s.health == SensorHealth::Silent) return "the sensor " + s.name + " is silent";
    if (s.health == SensorHealth::Blind) {
      return "the sensor " + s.name + " does not see: " + s.reason;
    }
  }
  if (guard.too_old(now)) return "the picture of the surroundings is too old";
  return {};
}

}  // namespace

void Robot::Impl::look_around() {
  take_known_places();
  if (!guard.sees() && !recognises && !reads_tags) return;
  surroundings_batch.clear();
  if (surroundings.try_take(surroundings_batch) && !surroundings_batch.empty()) {
    for (auto& one : surroundings_batch) one = guard.take(std::move(one));
  }
  // Large: whoever made them frees them, unless he is busy.
  for (auto& one : surroundings_batch) {
    if (one) (void)surroundings_done.try_offer(one);
  }
  surroundings_batch.clear();
  ask_for_row();
  base::BodyTwist moved = world.motion ? world.motion->twist : base::BodyTwist{};
  if (pose && pose->speed_mps) moved.linear_mps = *pose->speed_mps;
  if (pose && pose->yaw_rate_radps) moved.angular_radps = *pose->yaw_rate_radps;
  double left_mps = 0.0;
  if (pose && pose->over_ground) {
    moved.linear_mps = pose->over_ground->ahead_mps;
    left_mps = pose->over_ground->left_mps;
  }
  nav::sense::Odometry state = guard.move(moved, clock.now(), attitude(), left_mps);
  (void)odometry.try_offer(state);  // one that is missed is a gap of 20 ms
  known_places.moved(state);
  read_the_tags(state);
  see_known_poles();
  for (const KnownPlaces::News& news : known_places.news()) {
    event(news.bad ? base::Severity::Warning : base::Severity::Info, "known_place", news.words);
  }
  guard.brake_by(braking_here_mps2(config->fence.decel_mps2));
  std::string words = guard.demands() ? blind_words(guard, clock.now()) : std::string();
  if (words.empty()) blind_since.reset();
  if (!words.empty() && !blind_since) blind_since = clock.now();
  // One piece that is of no use is no blindness; silence was waited for already.
  const bool silent = words.ends_with("is silent") || guard.too_old(clock.now());
  const bool long_enough = blind_since && clock.now() - *blind_since >= kBlindFor;
  blind = silent || long_enough ? std::move(words) : std::string();
}

/// Told once, and again where there was no room, or other parameters hold.
void Robot::Impl::ask_for_row() {
  const auto wanted = missions.executor.row_wanted();
  const bool same =
      wanted ? row_asked.order && row_asked.id == wanted->id && row_asked.params == config->rows
             : !row_asked.order;
  if (same) return;
  RowQuestion asked;
  if (wanted) asked = {wanted->id, wanted->order, config->rows};
  RowQuestion offered = asked;
  if (row_questions.try_offer(offered)) row_asked = asked;
}

std::optional<nav::RowSight> Robot::Impl::row_sight() const {
  if (!guard.sees()) return std::nullopt;
  nav::RowSight sight;
  sight.body = guard.odometry().pose;
  const auto& around = guard.around();
  // By the executor's word: of a row that it has just begun, nobody has been asked yet.
  const auto wanted = missions.executor.row_wanted();
  const bool seen = around && around->row && wanted && around->row->id == wanted->id;
  if (seen) {
    sight.view = &around->row->view;
    sight.age_s = base::seconds(clock.now() - sight.view->stamp);
  }
  return sight;
}

std::optional<nav::MarkSight> Robot::Impl::mark_sight() const {
  if (!guard.sees() && !recognises && !reads_tags) return std::nullopt;
  nav::MarkSight sight;
  sight.now = clock.now();
  sight.body = guard.odometry().pose;
  const auto& around = guard.around();
  if (around) sight.view = around->beside.get();
  if (reads_tags) sight.tags = &tag_book;
  return sight;
}

/// For people.
std::optional<base::RowState> Robot::Impl::row_state() const {
  const nav::RowDrive* drive = missions.executor.row();
  const nav::RowToDrive* order = missions.executor.row_order();
  const auto sight = row_sight();
  if (drive == nullptr || order == nullptr || !sight) return std::nullopt;
  base::RowState out;
  out.item = missions.executor.progress(std::nullopt).current_item.value_or(0);
  out.side = nav::rows::to_string(order->order.sides);
  out.seeing = nav::rows::to_string(order->order.seeing);
  out.state = drive->waits()                                    ? "waiting"
              : drive->state() == nav::RowDrive::State::Seeking ? "seeking"
                                                                : "driving";
  out.driven_m = drive->driven_m();
  out.left_m = drive->left_m();
  if (sight->view == nullptr) return out;
  const nav::rows::RowView& view = *sight->view;
  const nav::rows::Along at = nav::rows::beside_line(view, sight->body);
  base::RowInSight& seen = out.seen.emplace();
  seen.offset_m = at.d_m;
  seen.angle_rad =
      base::wrap_rad(sight->body.yaw_rad - view.line.yaw_rad - view.curvature_1pm * at.s_m);
  seen.sigma_m = view.sigma_m(at.s_m + nav::RowDrive::kLook_m);
  seen.certainty = drive->certainty(seen.sigma_m);
  if (view.width_m > 0.0) {
    seen.width_m = view.width_m;
    seen.width_sigma_m = view.width_sigma_m;
  }
  if (view.to_end_m) seen.to_end_m = *view.to_end_m - at.s_m;
  seen.age_s = sight->age_s;
  return out;
}

/// What is in the way is not driven against, whoever drives.
base::DriveCommand Robot::Impl::keep_off(base::DriveCommand command) {
  if (!guard.sees()) return command;
  const bool waits = std::exchange(waits_before, false);
  const bool by_itself = machine.by_itself();
  if (std::exchange(guarded_mode, machine.mode()) != machine.mode()) guard.forget();
  spare_dock();
  if (!waits) command.twist = guarded(command.twist);
  const auto then = guard.decide(by_itself, clock.now());
  const base::Obstacle& o = guard.obstacle();
  if (o.action != base::GuardAction::None) {
    speed_reason = "obstacle";
    if (o.action == base::GuardAction::Stop) {
      assessment.conditions.push_back({"obstacle", o.reason});
    }
  }
  if (const auto stopped = guard.news()) {
    event(*stopped ? base::Severity::Warning : base::Severity::Info,
          *stopped ? "obstacle" : "obstacle_gone", *stopped ? o.reason : "the way is clear again");
  }
  if (then) be_blocked(*then);
  return command;
}

/// Who docks comes near to the dock.
void Robot::Impl::spare_dock() {
  if (const nav::tags::TagDock* at_tag = docks_at_tag(); at_tag != nullptr) {
    const auto& docked = at_tag->goal();
    if (!docked || !at_tag->on_line()) return guard.spare_dock(std::nullopt, false);
    return guard.spare_dock(nav::sense::inverse(guard.odometry().pose) * *docked, false);
  }
  const auto goal = machine.mode() == Mode::Dock ? self_driving.docks_at() : std::nullopt;
  if (!goal || !pose) return guard.spare_dock(std::nullopt, false);
  const base::EnuPoint to = goal->at - pose->at;
  const double c = std::cos(pose->yaw_rad);
  const double s = std::sin(pose->yaw_rad);
  guard.spare_dock(
      nav::sense::Pose2{c * to.east_m + s * to.north_m, -s * to.east_m + c * to.north_m,
                        base::angle_diff_rad(pose->yaw_rad, goal->yaw_rad)},
      goal->reverse);
}

/// A mission that a blind sensor paused: it sees again.
void Robot::Impl::watch_blind_pause() {
  if (!blind_pause) return;
  const bool waits = arm.armed() && machine.mode() == Mode::Hold &&
                     missions.executor.state() == base::ExecutionState::Paused;
  if (!waits) {
    blind_pause = false;
    return;
  }
  if (!blind.empty() || guard.too_old(clock.now())) sees_since.reset();
  if (!blind.empty() || guard.too_old(clock.now())) return;
  if (!sees_since) sees_since = clock.now();
  const BlockedParams& p = guard.when_blocked();
  if (base::seconds(clock.now() - *sees_since) < p.resume_after_s) return;
  blind_pause = false;
  const std::string again = "the sensors see again";
  if (!p.resume_blind) {
    return event(base::Severity::Info, "sees_again", again + "; the mission waits for a word");
  }
  if (const auto done = resume(); !done) {
    return event(base::Severity::Warning, "sees_again",
                 again + ", and the mission does not go on: " + done.error().detail);
  }
  event(base::Severity::Info, "sees_again", again + ": the mission goes on by itself");
}

/// A hand that holds it off is told so, and so is everybody else, until it does not any more.
base::BodyTwist Robot::Impl::guarded(const base::BodyTwist& wanted) {
  const bool by_hand_only = machine.kind() == ModeKind::ByHand;
  if (!by_hand_only || !by_hand.overrides_guard()) {
    keep_guard();
    return guard.judge(wanted, machine.by_itself(), clock.now());
  }
  const base::BodyTwist out = guard.overrule(wanted, clock.now());
  const base::Obstacle& o = guard.obstacle();
  if (o.action == base::GuardAction::Overridden && !std::exchange(overridden, true)) {
    event(base::Severity::Warning, "guard_overridden",
          "the guard is overridden" + (overrider.empty() ? "" : " by " + overrider) + ": " +
              o.reason);
  }
  return out;
}

/// Nobody holds it off any more.
void Robot::Impl::keep_guard() {
  if (!std::exchange(overridden, false)) return;
  event(base::Severity::Info, "guard_kept",
        "the guard holds again; it was overridden" + (overrider.empty() ? "" : " by " + overrider));
}

/// What was chosen for a drive by itself that something has stopped for too long.
void Robot::Impl::be_blocked(Then then) {
  const std::string why = guard.why();
  const bool homeward = leads_home(machine.mode());
  const auto told = [&](const char* follows) {
    event(base::Severity::Warning, "blocked", "blocked: " + why + "; " + follows);
  };
  switch (then) {
    case Then::Wait:
      return told("it waits until the way is clear");
    case Then::Around:
      // Ways are looked for around what stands before a mission, and before nothing else.
      return told(machine.mode() == Mode::Auto ? "a way around it is looked for"
                                               : "it waits until the way is clear");
    case Then::Return:
      if (homeward) return told("it is on its way home already: it waits until the way is clear");
      told("it returns home");
      return go_back("blocked: " + why);
    case Then::Abort:
      told(machine.mode() == Mode::Auto ? "the mission ends" : "it gives up");
      return give_up("blocked: " + why);
  }
}

/// What drives by itself ends here, for good.
void Robot::Impl::give_up(const std::string& why) {
  driver = base::Driver::None;
  if (machine.mode() != Mode::Auto) {
    hold(why);
    return event(base::Severity::Warning, "stopped", why);
  }
  missions.executor.stop(why);
  event(base::Severity::Error, "mission_aborted", why);
  change_mode(ModeCause::MissionOver, why);
}

/// A drive by itself stands before something until the way has been clear for a while.
bool Robot::Impl::waits_for_way() {
  if (!guard.sees() || !guard.stops()) return false;
  if (guard.may_go_on(clock.now())) return false;
  waits_before = true;
  driver = base::Driver::Autonomy;
  speed_reason = "obstacle";
  return true;
}

}  // namespace roverd::robot
