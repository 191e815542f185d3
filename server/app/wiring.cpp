#include "app/wiring.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "api/profile.hpp"
#include "base/angle.hpp"

namespace roverd {
namespace {

/// What missions are checked against, beside what the parameters say.
mission::VehicleLimits limits_of(const Settings& s) {
  mission::VehicleLimits limits;
  limits.max_climb_deg = s.vehicle.max_climb_deg;
  const auto known = [](double value) { return value > 0.0 ? std::optional(value) : std::nullopt; };
  limits.drive_power_w = known(s.vehicle.drive_power_w);
  limits.idle_power_w = known(s.vehicle.idle_power_w);
  limits.battery_wh = known(s.vehicle.battery_wh);
  return limits;
}

/// By where its sensors point: how wide each one sees is not told before it speaks. A lidar that
/// turns sees all around.
void look_out(mission::VehicleLimits& limits, const Settings& s) {
  constexpr double kSideways_deg = 60.0;
  constexpr double kBackwards_deg = 100.0;
  bool left = false;
  bool right = false;
  limits.sees_behind = limits.sees_around = false;
  for (const auto& [name, sensor] : s.sensors) {
    if (!sensor.said.enabled || !sensor.said.ranging()) continue;
    const double yaw_deg =
        base::deg_from_rad(base::wrap_rad(base::rad_from_deg(sensor.said.yaw_deg)));
    const bool turns = sensor.said.kind == "velodyne";
    limits.sees_behind = limits.sees_behind || turns || std::abs(yaw_deg) >= kBackwards_deg;
    left = left || turns || yaw_deg >= kSideways_deg;
    right = right || turns || yaw_deg <= -kSideways_deg;
  }
  limits.sees_around = limits.sees_behind || (left && right);
}

}  // namespace

std::string drive_link(const Settings& s) {
  for (const DriverWiring* w :
       {&s.bunker.wiring, &s.ackermann.wiring, &s.ratio.wiring, &s.twist.wiring}) {
    if (w->enabled) return w->link;
  }
  return {};
}

RecordingBounds bounds_of(const RecordingSettings& recording) {
  return {static_cast<std::uint64_t>(recording.total_mb) * 1'000'000,
          std::chrono::hours(24) * recording.keep_days};
}

std::string learner(const Settings& s) {
  const std::string link = drive_link(s);
  return link.empty() ? s.vehicle.name : s.vehicle.name + " " + link.substr(0, link.find(':'));
}

api::Profile profile_of(const Settings& s, const Supervisor& supervisor) {
  api::Profile profile;
  profile.name = s.vehicle.name;
  profile.title = s.vehicle.title;
  profile.mass_kg = s.vehicle.mass_kg;
  profile.modes = {base::Mode::Manual, base::Mode::Hold,   base::Mode::Auto,
                   base::Mode::Guided, base::Mode::Rtl,    base::Mode::SmartRtl,
                   base::Mode::Follow, base::Mode::Dock,   base::Mode::Steering,
                   base::Mode::Acro,   base::Mode::Simple, base::Mode::Loiter,
                   base::Mode::Circle};
  profile.drivers = supervisor.names();
  profile.lights = supervisor.has_lights();
  profile.clears_errors = supervisor.clears_errors();
  profile.item_types = {"waypoint",    "local", "move",   "turn",   "wait",  "speed",
                        "return_home", "jump",  "action", "loiter", "circle"};
  if (std::ranges::any_of(s.sensors, [](const auto& one) {
        return one.second.said.enabled && one.second.said.ranging();
      })) {
    profile.item_types.emplace_back("row");
    profile.item_types.emplace_back("map_point");
    const nav::VehicleParams& v = s.robot.vehicle;
    const double back_m = v.steered() ? 0.5 * (v.length_m - v.wheelbase_m) : 0.5 * v.length_m;
    profile.guard = {.back_m = back_m, .cell_m = s.sense.grid.cell_m};  // the rest: take_parameters
  }
  if (std::ranges::any_of(s.sensors, [](const auto& one) {
        return one.second.said.enabled && (one.second.said.planar() || !one.second.said.ranging());
      })) {
    profile.item_types.emplace_back("wall");
    profile.item_types.emplace_back("landmarks");
  }
  if (read_tags(s.cameras) && !s.robot.vehicle.steered()) profile.item_types.emplace_back("dock");
  profile.limits = limits_of(s);
  profile.limits.item_types = profile.item_types;
  if (profile.guard) look_out(profile.limits, s);
  profile.limits.actions = robot::kActions;
  api::take_parameters(profile, s.robot);
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

net::Handlers handlers_of(api::Api& api, const Front* front) {
  return {
      .on_request =
          [&api](net::Request request, base::Time begun, net::Respond respond) {
            api.on_request(std::move(request), begun, std::move(respond));
          },
      .body_limit = [&api](const net::Request& header) { return api.body_limit(header); },
      .urgency =
          [](const net::Request& header) {
            return api::Api::is_estop(header)  ? net::Urgency::AtHeader
                   : api::Api::is_stop(header) ? net::Urgency::Whole
                                               : net::Urgency::None;
          },
      .knows = [&api](const std::string& address) { return api.knows(address); },
      .discard = [&api](std::string large) { api.discard(std::move(large)); },
      .on_upgrade = [&api](const net::Request& request) { return api.on_upgrade(request); },
      .on_client = [&api](net::ClientId client,
                          const net::Request& upgrade) { api.on_client(client, upgrade); },
      .on_text = [&api](net::ClientId client, base::Time begun,
                        std::string_view text) { api.on_text(client, begun, text); },
      .urgent_text = api::Api::is_estop_text,
      .on_gone = [&api](net::ClientId client) { api.on_gone(client); },
      .on_plain = front == nullptr ? decltype(net::Handlers::on_plain)()
                                   : [front](const net::Request& r) { return front->on_plain(r); },
      .on_refused = api::Api::on_refused,
      .on_second = [&api] { api.on_second(); },
  };
}

}  // namespace roverd
