// The snapshot: everything the robot says of itself at one tick.

#include <algorithm>

#include "robot/impl.hpp"

namespace roverd::robot {

base::MissionProgress Robot::Impl::progress() const {
  base::MissionProgress p;
  if (!mission) return p;
  p.mission_id = mission->copy.id;
  p.revision = mission->copy.revision;
  p.name = mission->copy.plan.name;
  p.state = executor.state();
  p.reason = executor.reason();
  if (executor.running() && driver == base::Driver::Radio) {
    p.reason = "the radio drives; the mission goes on when it gives control back";
  }
  p.items = static_cast<int>(mission->copy.plan.items.size());
  const nav::Progress at = executor.progress(pose ? std::optional(pose->at) : std::nullopt);
  p.current_item = at.current_item;
  p.cross_track_m = at.cross_track_m;
  p.distance_left_m = at.distance_left_m;
  p.eta_s = at.eta_s;
  p.place = executor.place();
  if (pose && at.target && estimator.frame()) {
    const auto to = base::distance_bearing(pose->global, estimator.frame()->to_global(*at.target));
    p.distance_to_item_m = to.distance_m;
    p.bearing_to_item_deg = to.bearing_deg;
  }
  return p;
}

/// For those who ask where SMART_RTL would lead: a second old at most.
void Robot::Impl::publish_driven_way() {
  if (crumbs.changes() == crumbs_published) return;
  if (driven_way.publish(std::make_shared<const DrivenWay>(driven()))) {
    crumbs_published = crumbs.changes();
  }
}

bool Robot::Impl::publish() {
  auto s = std::make_shared<base::Snapshot>();
  s->now = now;
  s->wall = wall;
  s->tick = loop.ticks;
  s->mode = mode;
  s->armed = armed;
  s->estop = estop;
  s->control = driver;
  s->speed_reason = speed_reason;
  s->pose = pose;
  s->frame = estimator.frame();
  s->home = home.at();
  s->gnss = world.gnss;
  s->gnss_velocity = world.gnss_velocity;
  s->attitude = estimator.attitude(now);
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
  s->mission = progress();
  s->activity = activity;
  if (const auto may = may_drive_by_itself(); !may) s->autonomy_refusal = may.error().detail;
  if (fence) s->fence = fence_state();
  s->command = sent;
  s->safety = std::move(assessment.conditions);
  s->checks = checks;
  s->ready_to_arm = std::none_of(checks.begin(), checks.end(), [](const base::Check& c) {
    return !c.ok && c.severity == base::Severity::Error;
  });
  s->estimator = health;
  s->loop = loop;
  bool all = true;
  if (mission_unpublished) {
    mission_unpublished = !loaded.publish(mission);
    all = !mission_unpublished;
  }
  if (loop.ticks % 50 == 0) {  // once a second; who missed it gets the next
    learned.publish(std::make_shared<const nav::Learned>(estimator.learned()));
    publish_driven_way();
  }
  if (config_unpublished) {
    config_unpublished = !shared_config.publish(config.whole());
    all = all && !config_unpublished;
  }
  if (fence_unpublished) {
    fence_unpublished = !shared_fence.publish(fence);
    all = all && !fence_unpublished;
  }
  return snapshot.publish(std::move(s)) && all;
}

}  // namespace roverd::robot
