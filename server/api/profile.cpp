#include "api/profile.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::api {

void take_parameters(Profile& profile, const robot::Config& config) {
  const nav::VehicleParams& v = config.vehicle;
  mission::VehicleLimits& limits = profile.limits;
  limits.max_speed_mps = std::min(v.max_speed_mps, config.speed.max_mps);
  limits.default_speed_mps = std::min(config.speed.default_mps, limits.max_speed_mps);
  limits.width_m = v.width_m;
  limits.wall_m = config.wall.distance_m;
  limits.yaw_rate_radps = config.speed.max_yaw_rate_radps;
  if (v.steered()) {
    limits.turn_radius_m = v.wheelbase_m / std::tan(base::rad_from_deg(v.max_steering_deg));
    // From full lock to one side to straight and in again takes twice the time of one.
    limits.steer_in_m =
        2.0 * limits.default_speed_mps * v.max_steering_deg / v.max_steering_rate_dps;
    limits.settle_m = config.track.lookahead_max_m;
  }
  profile.turning = {config.narrowest_turn_m(), config.tool.pulled()};
  profile.kinematics = v.kinematics;
  profile.length_m = v.length_m;
  profile.width_m = v.width_m;
  profile.max_speed_mps = limits.max_speed_mps;
  profile.max_yaw_rate_radps = config.speed.max_yaw_rate_radps;
  profile.max_acceleration_mps2 = config.speed.accel_mps2;
  if (profile.guard) {
    const nav::sense::ProtectParams& p = config.protect;
    limits.creeps_back = p.creep_back_mps > 0.0;
    limits.creeps_turning = p.creep_turn_radps > 0.0;
    // Rays that stand in for the guard's own rule leave no room of a known width.
    const bool own = !(config.rays.enabled && config.rays.instead);
    limits.room_m = own ? 0.5 * v.width_m + beside_m(p, profile.guard->cell_m) : 0.0;
    profile.guard = {profile.guard->back_m, profile.guard->cell_m, p.side_m, p.gap_m, p.delay_s,
                     p.decel_mps2,          p.turn_decel_radps2};
    if (const nav::sense::RaysParams& r = config.rays; r.enabled) {
      profile.guard->rays = {r.instead, r.stop_m, r.slow_m, base::rad_from_deg(r.stop_fan_deg),
                             r.stop_rays};
    }
  }
  profile.pivot_angle_rad = base::rad_from_deg(config.pivot.angle_deg);
  for (const base::ParamInfo& key : base::describe(config.radio)) {
    if (const auto* word = std::get_if<std::string>(&key.value)) profile.radio[key.name] = *word;
  }
}

}  // namespace roverd::api
