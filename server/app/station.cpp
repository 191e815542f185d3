#include "app/station.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include "api/api.hpp"
#include "app/control_loop.hpp"
#include "app/devices.hpp"
#include "app/version.hpp"
#include "base/angle.hpp"
#include "base/log.hpp"
#include "base/params.hpp"
#include "config/learned.hpp"
#include "net/assets.hpp"
#include "net/doorbell.hpp"
#include "net/hub.hpp"
#include "net/page.hpp"
#include "net/server.hpp"
#include "net/workers.hpp"
#include "robot/robot.hpp"
#include "store/store.hpp"
#include "store/tiles.hpp"
#include "supervise/supervisor.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

constexpr base::Duration kGoodbye = std::chrono::milliseconds(500);
constexpr base::Duration kKeepLearned = std::chrono::minutes(1);

/// The simulated robot is not the real one: they differ in the link that moves them.
std::string learner(const Settings& s) {
  const auto scheme = [](const DriverWiring& w) { return w.link.substr(0, w.link.find(':')); };
  for (const DriverWiring* w :
       {&s.bunker.wiring, &s.ackermann.wiring, &s.ratio.wiring, &s.twist.wiring}) {
    if (w->enabled) return s.vehicle.name + " " + scheme(*w);
  }
  return s.vehicle.name;
}

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
  if (!s.robot.vehicle.steered()) profile.item_types.push_back("turn");
  profile.limits = limits_of(s);
  profile.limits.item_types = profile.item_types;
  profile.limits.actions = robot::kActions;
  return profile;
}

/// net's hub behind the callables that api knows.
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

}  // namespace

struct Station::Impl {
  explicit Impl(const Settings& settings) : robot(settings.robot) {}

  asio::io_context web{net::kWebConcurrency};
  robot::Robot robot;
  net::Files page{net::page_entries()};
  store::TileFolder tiles;
  std::unique_ptr<Supervisor> supervisor;
  std::unique_ptr<store::Store> store;
  std::unique_ptr<services::Services> services;
  std::unique_ptr<api::Api> api;
  std::unique_ptr<net::Server> server;
  std::unique_ptr<net::Doorbell> bell;
  std::unique_ptr<ControlLoop> loop;
  asio::signal_set signals{web, SIGINT, SIGTERM};
  asio::steady_timer learned_timer{web};
  std::filesystem::path learned_file;  ///< empty: a recording is played, nothing is kept
  std::string learned_by;
  net::Workers workers{web};  ///< for what would keep the web waiting; ends first
  std::string address;

  Result<void> open(const Settings& settings, const Options& options);
  Result<void> open_tiles(const Settings& settings);
  Result<void> open_store(const Settings& settings, const Options& options);
  Result<void> open_server(const Settings& settings, const Options& options);
  void make_api(const Settings& settings);
  api::DriverDoor driver_door();
  void start();
  void start_services();
  void recall(const Settings& settings, const Options& options);
  void tell_left_out(const Settings& settings);
  void keep_learned();
  void keep_learned_soon();
  void halt() noexcept;
  void stop();
};

Result<void> Station::Impl::open(const Settings& settings, const Options& options) {
  auto plans = plan_devices(settings, options);
  if (!plans) return tl::unexpected(plans.error());
  auto made = Supervisor::make(std::move(*plans),
                               [this](const base::Measurement& m) { robot.measurements().put(m); });
  if (!made) return tl::unexpected(made.error());
  supervisor = std::move(*made);
  if (auto done = open_tiles(settings); !done) return done;
  if (auto done = open_store(settings, options); !done) return done;
  services = std::make_unique<services::Services>(robot, *store, settings.vehicle.name);
  make_api(settings);
  if (auto done = open_server(settings, options); !done) return done;
  recall(settings, options);
  tell_left_out(settings);
  start();
  return {};
}

Result<void> Station::Impl::open_tiles(const Settings& settings) {
  for (const auto& set : settings.tiles) {  // one by one first, to name the line of the wrong one
    if (auto done = store::TileFolder().open({set}); !done) {
      return base::fail(done.error().code,
                        settings.where("tiles." + set.first) + ": " + done.error().detail);
    }
  }
  return tiles.open(settings.tiles);
}

Result<void> Station::Impl::open_store(const Settings& settings, const Options& options) {
  store::Options how;
  how.keep_deleted = std::chrono::hours(24) * settings.missions.keep_deleted_days;
  how.keep_runs = settings.runs.keep;
  auto opened = store::Store::open(
      std::filesystem::path(options.data) / "roverd.db",
      [this](std::function<void()> answer) { asio::post(web, std::move(answer)); }, std::move(how));
  if (!opened) return tl::unexpected(opened.error());
  store = std::move(*opened);
  return {};
}

/// What the web asks of drivers, and their answers back on the web thread.
api::DriverDoor Station::Impl::driver_door() {
  const auto on_web = [this](api::DriverDoor::Done done) {
    return [this, done = std::move(done)](Result<void> result) {
      asio::post(web, [done, result = std::move(result)] { done(result); });
    };
  };
  api::DriverDoor door;
  door.restart = [this](const std::string& name) { return supervisor->restart(name); };
  if (supervisor->has_lights()) {
    door.set_lights = [this, on_web](const base::LightState& lights, base::Time not_after,
                                     api::DriverDoor::Done done) {
      supervisor->set_lights(lights, not_after, on_web(std::move(done)));
    };
  }
  if (supervisor->clears_errors()) {
    door.clear_errors = [this, on_web](int motor, base::Time not_after,
                                       api::DriverDoor::Done done) {
      supervisor->clear_errors(motor, not_after, on_web(std::move(done)));
    };
  }
  return door;
}

void Station::Impl::make_api(const Settings& settings) {
  api::Deps deps{.robot = robot,
                 .store = *store,
                 .services = *services,
                 .version = kVersion,
                 .profile = profile_of(settings, *supervisor)};
  deps.tiles = {tiles.sets(), [this](const std::string& set, int zoom, int x, int y) {
                  return tiles.read(set, zoom, x, y);
                }};
  deps.drivers = driver_door();
  deps.page = [this](const net::Request& request) { return page.answer(request); };
  deps.figures = [this] {
    const net::Stats stats = server->stats();
    return api::NetFigures{.accepted = stats.accepted,
                           .refused = stats.refused,
                           .timed_out = stats.timed_out,
                           .requests = stats.requests,
                           .delivered = server->hub().delivered(),
                           .dropped = server->hub().dropped(),
                           .connections = stats.connections,
                           .clients = stats.clients};
  };
  deps.aside = [this](api::Aside a) {
    const net::Lane lane = a.large ? net::Lane::Large : net::Lane::Small;
    if (!a.must) return workers.run(lane, std::move(a.work), std::move(a.then));
    workers.must_run(lane, std::move(a.work), std::move(a.then));
    return true;
  };
  deps.later = [this](std::function<void()> call) { asio::post(web, std::move(call)); };
  api = std::make_unique<api::Api>(std::move(deps));
}

Result<void> Station::Impl::open_server(const Settings& settings, const Options& options) {
  const std::string& bind = settings.server.bind;
  if (auto allowed = api::check_bind_address(bind); !allowed) return allowed;
  const int port = options.port.value_or(settings.server.port);
  auto listening = net::Server::listen(web, bind, static_cast<std::uint16_t>(port), net::Limits{},
                                       handlers_of(*api));
  if (!listening) return tl::unexpected(listening.error());
  server = std::move(*listening);
  api->attach(stream_of(server->hub()));
  const bool v6 = bind.find(':') != std::string::npos;
  address = "http://" + (v6 ? "[" + bind + "]" : bind) + ":" + std::to_string(server->port());
  return {};
}

/// Nobody reads a log: what holds in place of a kept value is told where the robot's events are.
void Station::Impl::tell_left_out(const Settings& settings) {
  for (const std::string& why : settings.left_out) {
    robot.tell({base::wall_now(), base::Severity::Warning, "parameter_left_out",
                "a kept value is not taken any more, the one before it holds: " + why});
  }
}

void Station::Impl::start() {
  bell = std::make_unique<net::Doorbell>(web, [this] { api->drain(); });
  robot.wake = [this] { bell->ring(); };
  robot.send = [this](const base::DriveCommand& command, base::Time now) {
    supervisor->send(command, now);
  };
  robot.alert = [this] {
    if (loop) loop->alert();
  };
  signals.async_wait([this](const boost::system::error_code& ec, int) {
    if (!ec) stop();
  });
  supervisor->start();
  start_services();
  keep_learned_soon();
  loop = std::make_unique<ControlLoop>(
      [this](base::Time now, base::WallTime wall, base::Duration lateness) {
        robot.tick(now, wall, lateness);
      },
      [this](base::Time now) { robot.heed_stop(now); });
  base::log(base::Level::Info, "main", "serving", {{"address", address}, {"version", kVersion}});
}

void Station::Impl::start_services() {
  const auto on_web = [this](auto work) { asio::post(web, std::move(work)); };
  services->start({.tell =
                       [this, on_web](base::Event event) {
                         on_web([this, event = std::move(event)] { api->on_event(event); });
                       },
                   .mission_changed =
                       [this, on_web](const std::string& id, std::int64_t revision) {
                         on_web([this, id, revision] { api->on_mission_change(id, revision); });
                       },
                   .answer = on_web});
}

void Station::Impl::recall(const Settings& settings, const Options& options) {
  if (!options.replays.empty()) return;
  learned_file = std::filesystem::path(options.data) / "learned.json";
  learned_by = learner(settings);
  const nav::Learned known = read_learned(learned_file, learned_by, base::wall_now());
  robot.recall(known);
  if (!known.odometry_scale && !known.gyro_bias_radps) return;
  const auto text = [](const std::optional<nav::LearnedValue>& v) {
    return v ? std::to_string(v->value) : std::string("not known");
  };
  base::log(base::Level::Info, "main", "learned before",
            {{"odometry_scale", text(known.odometry_scale)},
             {"gyro_bias_radps", text(known.gyro_bias_radps)}});
}

/// A disk may pause: on a worker's thread, or, at the end, after all others.
void Station::Impl::keep_learned() {
  const auto learned = robot.learned();
  if (learned_file.empty() || !learned) return;
  if (!learned->odometry_scale && !learned->gyro_bias_radps) return;
  const auto kept = write_learned(learned_file, *learned, learned_by, base::wall_now());
  if (!kept) {
    base::log(base::Level::Warning, "main", "what was learned is not kept",
              {{"reason", kept.error().detail}});
  }
}

void Station::Impl::keep_learned_soon() {
  learned_timer.expires_after(kKeepLearned);
  learned_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    workers.must_run(net::Lane::Small, [this] { keep_learned(); }, {});
    keep_learned_soon();
  });
}

/// The robot first: no command after this, and the base is told to stand.
void Station::Impl::halt() noexcept {
  loop.reset();
  if (supervisor) supervisor->stop();
}

void Station::Impl::stop() {
  base::log(base::Level::Info, "main", "stopping");
  halt();
  server->stop(kGoodbye, [this] {
    bell->silence();
    web.stop();
  });
}

Station::Station(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Station::~Station() {
  impl_->halt();
  impl_->workers.stop();
  impl_->keep_learned();
  if (impl_->services)
    impl_->services->stop();  // what is on its way to the web is dropped with the io_context
  impl_->server.reset();
  impl_->services.reset();
  impl_->store.reset();  // its last answers are posted, and dropped with the io_context
}

Result<std::unique_ptr<Station>> Station::open(const Settings& settings, const Options& options) {
  std::unique_ptr<Station> station(new Station(std::make_unique<Impl>(settings)));
  if (auto done = station->impl_->open(settings, options); !done) {
    return tl::unexpected(done.error());
  }
  return station;
}

std::string Station::address() const {
  return impl_->address;
}

void Station::run() {
  impl_->web.run();
}

}  // namespace roverd
