#include "app/wiring.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angle.hpp"
#include "base/params.hpp"

namespace roverd {
namespace {

/// What missions are checked against.
mission::VehicleLimits limits_of(const Settings& s) {
  const nav::VehicleParams& v = s.robot.vehicle;
  mission::VehicleLimits limits;
  limits.max_speed_mps = std::min(v.max_speed_mps, s.robot.speed.max_mps);
  limits.default_speed_mps = std::min(s.robot.speed.default_mps, limits.max_speed_mps);
  limits.width_m = s.robot.vehicle.width_m;
  limits.max_climb_deg = s.vehicle.max_climb_deg;
  limits.yaw_rate_radps = s.robot.speed.max_yaw_rate_radps;
  if (v.steered()) {
    limits.turn_radius_m = v.wheelbase_m / std::tan(base::rad_from_deg(v.max_steering_deg));
    // From full lock to one side to straight and in again takes twice the time of one.
    limits.steer_in_m =
        2.0 * limits.default_speed_mps * v.max_steering_deg / v.max_steering_rate_dps;
    limits.settle_m = s.robot.track.lookahead_max_m;
  }
  const auto known = [](double value) { return value > 0.0 ? std::optional(value) : std::nullopt; };
  limits.drive_power_w = known(s.vehicle.drive_power_w);
  limits.idle_power_w = known(s.vehicle.idle_power_w);
  limits.battery_wh = known(s.vehicle.battery_wh);
  return limits;
}

}  // namespace

std::string drive_link(const Settings& s) {
  for (const DriverWiring* w :
       {&s.bunker.wiring, &s.ackermann.wiring, &s.ratio.wiring, &s.twist.wiring}) {
    if (w->enabled) return w->link;
  }
  return {};
}

std::string learner(const Settings& s) {
  const std::string link = drive_link(s);
  return link.empty() ? s.vehicle.name : s.vehicle.name + " " + link.substr(0, link.find(':'));
}

api::Profile profile_of(const Settings& s, const Supervisor& supervisor) {
  api::Profile profile;
  profile.name = s.vehicle.name;
  profile.title = s.vehicle.title;
  profile.kinematics = s.robot.vehicle.kinematics;
  profile.length_m = s.robot.vehicle.length_m;
  profile.width_m = s.robot.vehicle.width_m;
  profile.mass_kg = s.vehicle.mass_kg;
  profile.max_speed_mps = std::min(s.robot.vehicle.max_speed_mps, s.robot.speed.max_mps);
  profile.max_yaw_rate_radps = s.robot.speed.max_yaw_rate_radps;
  profile.max_acceleration_mps2 = s.robot.speed.accel_mps2;
  profile.pivot_angle_rad = base::rad_from_deg(s.robot.pivot.angle_deg);
  profile.modes = {base::Mode::Manual, base::Mode::Hold,  base::Mode::Auto,
                   base::Mode::Guided, base::Mode::Rtl,   base::Mode::SmartRtl,
                   base::Mode::Follow, base::Mode::Dock,  base::Mode::Steering,
                   base::Mode::Acro,   base::Mode::Simple};
  profile.drivers = supervisor.names();
  profile.lights = supervisor.has_lights();
  profile.clears_errors = supervisor.clears_errors();
  for (const base::ParamInfo& key : base::describe(s.robot.radio)) {
    if (const auto* word = std::get_if<std::string>(&key.value)) profile.radio[key.name] = *word;
  }
  profile.item_types = {"waypoint", "local",       "move", "wait",
                        "speed",    "return_home", "jump", "action"};
  if (!s.robot.vehicle.steered()) profile.item_types.emplace_back("turn");
  profile.limits = limits_of(s);
  profile.limits.item_types = profile.item_types;
  profile.limits.actions = robot::kActions;
  return profile;
}

api::Stream stream_of(net::Hub& hub) {
  return {
      .add_sampled_topic =
          [&hub](std::string topic, api::Stream::Render render) {
            hub.add_sampled_topic(std::move(topic), std::move(render));
          },
      .add_event_topic = [&hub](std::string topic) { hub.add_event_topic(std::move(topic)); },
      .subscribe = [&hub](net::ClientId client,
                          const auto& rates_hz) { hub.subscribe(client, rates_hz); },
      .publish = [&hub](std::string_view topic,
                        const api::Stream::Render& render) { hub.publish(topic, render); },
      .send = [&hub](net::ClientId client, std::string_view text) { hub.send(client, text); },
      .close = [&hub](net::ClientId client, std::uint16_t code,
                      std::string_view reason) { hub.close(client, code, reason); },
  };
}

net::Handlers handlers_of(api::Api& api) {
  return {
      .on_request =
          [&api](net::Request request, base::Time begun, net::Respond respond) {
            api.on_request(std::move(request), begun, std::move(respond));
          },
      .body_limit = [&api](const net::Request& header) { return api.body_limit(header); },
      .discard = [&api](std::string large) { api.discard(std::move(large)); },
      .on_upgrade = [&api](const net::Request& request) { return api.on_upgrade(request); },
      .on_client = [&api](net::ClientId client) { api.on_client(client); },
      .on_text = [&api](net::ClientId client, base::Time begun,
                        std::string_view text) { api.on_text(client, begun, text); },
      .on_gone = [&api](net::ClientId client) { api.on_gone(client); },
      .on_refused = api::Api::on_refused,
      .on_second = [&api] { api.on_second(); },
  };
}

}  // namespace roverd
