// The guard in the robot: what it is told each tick, and what follows from its word.

#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::SensorHealth;

/// Which sensor does not see, of those that the profile demands.
std::string blind_words(const Surroundings* around, base::Time now) {
  constexpr double kSilent_s = 0.3;
  if (around == nullptr) return "the sensors have not been heard yet";
  if (base::seconds(now - around->patch.stamp) > Guard::kTooOld_s) {
    return "the picture of the surroundings is too old";
  }
  for (const base::SensorState& s : around->sensors) {
    if (!s.required) continue;
    const bool silent = !s.seen || base::seconds(now - *s.seen) > kSilent_s;
    if (silent) return "the sensor " + s.name + " is silent";
    if (s.health == SensorHealth::Silent || s.health == SensorHealth::Blind) {
      return "the sensor " + s.name + " does not see: " + s.reason;
    }
  }
  return {};
}

}  // namespace

void Robot::Impl::look_around() {
  if (!guard.sees()) return;
  surroundings_batch.clear();
  if (surroundings.try_take(surroundings_batch) && !surroundings_batch.empty()) {
    guard.take(std::move(surroundings_batch.back()));
  }
  surroundings_batch.clear();
  base::BodyTwist moved = world.motion ? world.motion->twist : base::BodyTwist{};
  if (pose && pose->speed_mps) moved.linear_mps = *pose->speed_mps;
  if (pose && pose->yaw_rate_radps) moved.angular_radps = *pose->yaw_rate_radps;
  nav::sense::Odometry state = guard.move(moved, clock.now());
  (void)odometry.try_offer(state);  // one that is missed is a gap of 20 ms
  blind = blind_words(guard.around().get(), clock.now());
}

/// What is in the way is not driven against, whoever drives.
base::DriveCommand Robot::Impl::keep_off(base::DriveCommand command) {
  if (!guard.sees()) return command;
  command.twist = guard.judge(command.twist, machine.by_itself(), clock.now());
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
  return command;
}

/// A drive by itself stands before something until the way has been clear for a while.
bool Robot::Impl::waits_for_way() {
  if (!guard.sees() || !guard.stops()) return false;
  if (guard.may_go_on(clock.now())) return false;
  driver = base::Driver::Autonomy;
  speed_reason = "obstacle";
  return true;
}

}  // namespace roverd::robot
