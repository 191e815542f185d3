#include "config/lookout.hpp"

#include <algorithm>
#include <utility>

#include "base/angle.hpp"
#include "robot/guard/guard.hpp"
#include "robot/guard/outline.hpp"

namespace roverd {
namespace {

constexpr double kMissed = 2.5;
constexpr double kSky = 0.95;

}  // namespace

base::Result<robot::Lookout> lookout_of(const Settings& s, base::Time now) {
  using namespace nav::sense;
  const Footprint body = robot::footprint_of(s.robot.vehicle, s.robot.tool, s.sense.outline);
  std::vector<SensorSetup> setups;
  std::vector<std::string> kinds;
  for (const auto& [name, sensor] : s.sensors) {
    if (!sensor.said.enabled || !sensor.said.ranging()) continue;
    SensorSetup one;
    one.name = name;
    one.mount = sensor.said.mount();
    one.planar = sensor.said.planar();
    one.thin = sensor.said.thin();
    one.needed = sensor.said.required;
    one.persist = s.sense.persist;
    one.health = s.sense.health;
    one.health.rate_hz = sensor.said.rate_hz;
    // A slow one is not silent between two pieces.
    one.health.silent_s = std::max(one.health.silent_s, kMissed / sensor.said.rate_hz);
    // Half of what a lidar looks at is the sky, from where nothing comes back.
    if (sensor.said.kind == "velodyne") {
      one.health.max_unknown_part = std::max(kSky, one.health.max_unknown_part);
    }
    setups.push_back(std::move(one));
    kinds.push_back(sensor.said.kind);
  }
  ChainParams params{s.sense.reduce, s.sense.ground, s.sense.grid};
  params.pulled = robot::pulled_of(s.robot.tool, s.sense.outline);
  auto chain = Chain::of(params, std::move(setups), body, now);
  if (!chain) return tl::unexpected(chain.error());
  robot::Lookout lookout(std::move(*chain), std::move(kinds), s.robot.protect.reach_m,
                         s.robot.rays);
  lookout.follow(s.robot.protect, s.robot.rays);
  std::vector<robot::Camera> cameras;
  for (const auto& [name, sensor] : s.sensors) {
    if (!sensor.said.enabled || sensor.said.ranging()) continue;
    cameras.push_back({name, sensor.said.mount(), base::rad_from_deg(sensor.vision.half_view_deg)});
  }
  lookout.watch_by(std::move(cameras));
  return lookout;
}

}  // namespace roverd
