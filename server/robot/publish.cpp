// The snapshot: everything the robot says of itself at one tick.

#include <algorithm>

#include "robot/impl.hpp"

namespace roverd::robot {

/// For those who ask where SMART_RTL would lead: a second old at most.
void Robot::Impl::publish_driven_way() {
  if (!estimator.frame()) return;
  std::uint64_t told = driven_told;
  auto news = driven.news(told, estimator.frame()->id());
  if (news && shared_way.publish(std::move(news))) driven_told = told;
}

/// What drives by itself stands before something: why, where people look for it.
void Robot::Impl::tell_wait(base::Snapshot& s) const {
  const std::string why = (guard.blocked() ? "blocked: " : "waits: ") + guard.why();
  if (s.mode == Mode::Auto) {
    if (s.mission.state == base::ExecutionState::Running) s.mission.reason = why;
    return;
  }
  if (s.activity.state != base::ActivityState::Driving &&
      s.activity.state != base::ActivityState::Turning) {
    return;
  }
  s.activity.state = base::ActivityState::Waiting;
  s.activity.reason = why;
}

bool Robot::Impl::publish() {
  auto s = std::make_shared<base::Snapshot>();
  s->now = clock.now();
  s->wall = clock.wall();
  s->tick = clock.health().ticks;
  s->mode = machine.mode();
  s->armed = arm.armed();
  s->armed_by_hand = arm.by_hand();
  s->estop = arm.latched();
  s->control = driver;
  s->speed_reason = speed_reason;
  s->pose = pose;
  s->frame = estimator.frame();
  s->home = home.at();
  s->gnss = world.gnss;
  s->gnss_velocity = world.gnss_velocity;
  s->place = world.place;
  s->attitude = attitude();
  if (!s->attitude) s->attitude = world.attitude;
  s->satellites = world.satellites;
  s->base = world.base;
  s->motion = world.motion;
  s->steering = world.steering;
  s->battery = world.battery;
  s->motors = world.motors;
  s->lights = world.lights;
  s->bumper = world.bumper;
  s->radio = world.radio;
  s->radio_meaning = radio_meaning();
  s->drivers = world.drivers;
  s->mission = missions.progress(pose, estimator.frame(), driver == base::Driver::Radio);
  s->mission.laid_by_old = missions && missions->way != config->way;
  s->activity = self_driving.activity();
  if (machine.by_itself() && !guard.why().empty()) tell_wait(*s);
  if (const auto may = may_drive_by_itself(true); !may) s->autonomy_refusal = may.error().detail;
  if (fence.get() != nullptr) {
    s->fence = fence.state(pose, estimator.frame(), missions.get().get(), way_margin_m());
  }
  s->command = sent;
  s->detour = detour_way();
  if (guard.obstacle().action != base::GuardAction::None) {
    s->obstacle = guard.obstacle();
    // Of the mission that stands there; any other drive has asked nobody for a way around.
    if (around_hopeless && machine.mode() == base::Mode::Auto && missions.executor.running() &&
        guard.stops()) {
      s->obstacle->no_way = around_none;
    }
  }
  s->row = row_state();
  s->tags = tag_states();
  s->known_places = known_places.states();
  if (guard.sees()) {
    const nav::sense::Pose2& at = guard.odometry().pose;
    s->odometry = {at.x_m, at.y_m, at.yaw_rad};
  }
  if (const auto& around = guard.around(); around && guard.sees()) {
    s->sensors = around->sensors;
    s->sensors_stale = guard.too_old(clock.now());
  }
  s->teleop = teleop();
  s->safety = std::move(assessment.conditions);
  s->checks = checks;
  s->ready_to_arm = std::none_of(checks.begin(), checks.end(), [](const base::Check& c) {
    return !c.ok && c.severity == base::Severity::Error;
  });
  s->estimator = health;
  s->learned = handling.learned();
  s->learned.kept = calibrated.measured();
  s->calibration = self_driving.calibration().tell();
  s->antennas_heard = world.antennas.has_value();
  s->loop = clock.health();
  bool all = loaded.deliver();
  all = shared_fence.deliver() && all;
  if (clock.health().ticks % 50 == 0) {  // once a second; who missed it gets the next
    nav::Learned known = estimator.learned();
    handling.tell(known);
    calibrated.tell(known, clock.now());
    learned.publish(std::make_shared<const nav::Learned>(known));
    publish_driven_way();
  }
  if (config_unpublished) {
    config_unpublished = !shared_config.publish(config.whole());
    all = all && !config_unpublished;
  }
  return snapshot.publish(std::move(s)) && all;
}

}  // namespace roverd::robot
