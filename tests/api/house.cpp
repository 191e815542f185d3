#include "house.hpp"

#include <algorithm>
#include <cctype>
#include <future>
#include <stdexcept>

#include <boost/asio/post.hpp>
#include <unistd.h>

#include "base/angle.hpp"
#include "net/hub.hpp"
#include "schema.hpp"
#include "supervise/urgency.hpp"

namespace roverd::test {

namespace {

using namespace std::chrono_literals;

constexpr auto kOnBefore = 5200ms;

api::Profile profile() {
  api::Profile p;
  p.name = "bunker";
  p.title = "AgileX Bunker";
  p.kinematics = "skid_steer";
  p.length_m = 1.023;
  p.width_m = 0.778;
  p.max_speed_mps = 1.5;
  p.modes = {base::Mode::Manual, base::Mode::Hold, base::Mode::Auto};
  p.drivers = {"bunker", "gnss"};
  p.item_types = {"waypoint"};
  p.limits.max_speed_mps = p.max_speed_mps;
  p.limits.item_types = {"waypoint", "wait", "speed", "return_home", "jump", "action"};
  p.limits.actions = robot::kActions;
  p.limits.drive_power_w = 360.0;
  p.limits.battery_wh = 2880.0;
  p.lights = p.clears_errors = true;
  return p;
}

/// A receiver that has been good for a moment is good enough for these tests.
robot::Config quick_to_trust(const Before& before) {
  robot::Config config;
  config.arming.healthy_s = 0.2;
  if (before.config) before.config(config);
  return config;
}

api::Stream stream_of(net::Hub& hub) {
  return {[&hub](std::string topic, api::Stream::Render render) {
            hub.add_sampled_topic(std::move(topic), std::move(render));
          },
          [&hub](std::string topic) { hub.add_event_topic(std::move(topic)); },
          [&hub](api::ClientId id, const auto& rates) { hub.subscribe(id, rates); },
          [&hub](std::string_view topic, const api::Stream::Render& render) {
            hub.publish(topic, render);
          },
          [&hub](api::ClientId id, std::string_view text) { hub.send(id, text); },
          [&hub](api::ClientId id, std::uint16_t code, std::string_view reason) {
            hub.close(id, code, reason);
          }};
}

}  // namespace

House::House(net::Limits limits, Vehicle vehicle, const Before& before)
    : robot_(quick_to_trust(before)) {
  std::string name = (std::filesystem::temp_directory_path() / "roverd-api-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;
  if (before.data) before.data(folder_ / "roverd.db");
  if (before.sees) robot_.guard_by({}, before.demands);
  auto opened = store::Store::open(folder_ / "roverd.db", [this](std::function<void()> answer) {
    boost::asio::post(io_, std::move(answer));
  });
  if (!opened) throw std::runtime_error(opened.error().detail);
  store_ = std::move(*opened);
  services_ = std::make_unique<services::Services>(robot_, *store_, "bunker");
  api::Deps deps{.robot = robot_,
                 .store = *store_,
                 .services = *services_,
                 .version = "test",
                 .profile = profile()};
  deps.drivers = door(vehicle);
  deps.drill = drill_door();
  deps.maps = map_door(before);
  deps.page = [](const net::Request& request) -> std::optional<net::Response> {
    if (request.target() != "/docs.html") return std::nullopt;
    net::Response file{boost::beast::http::status::ok, 11};
    file.body() = "the page's file /docs.html";
    file.prepare_payload();
    return file;
  };
  tiles_ = std::move(*store::TileShelf::open(folder_ / "tiles", {}, 0));
  deps.tiles = {tiles_.get(), {{"aerial", "https://tiles.example.org/{z}/{x}/{y}", "Board", 20}}};
  deps.cameras.cameras = {{"front", "ip", [this] { return picture_.get(); }}};
  deps.aside = [this](api::Aside a) {
    using Size = api::Aside::Size;
    const net::Lane lane = a.size == Size::Small   ? net::Lane::Small
                           : a.size == Size::Large ? net::Lane::Large
                                                   : net::Lane::Slow;
    if (!a.must) return workers_.run(lane, std::move(a.work), std::move(a.then));
    workers_.must_run(lane, std::move(a.work), std::move(a.then));
    return true;
  };
  deps.later = [this](std::function<void()> call) { boost::asio::post(io_, std::move(call)); };
  if (before.sees) deps.outlook = [this] { return seen_.get(); };
  if (before.access) deps.people = &people_;
  deps.control_grace = before.control_grace;
  deps.tell_code = [this](const std::string& code) {
    std::lock_guard lock(mutex_);
    code_ = code;
  };
  api_ = std::make_unique<api::Api>(std::move(deps));
  serve(limits);
  bell_ = std::make_unique<net::Doorbell>(io_, [this] { api_->drain(); });
  robot_.wake = [this] { bell_->ring(); };
  robot_.send = [this](const base::DriveCommand& command, base::Time) {
    std::lock_guard lock(mutex_);
    sent_ = command;
  };
  start_services();
  web_ = std::thread([this] { io_.run(); });
  control_ = std::thread([this] { play(); });
  was_on_.get_future().wait();  // until then the robot's time is not the test's
  while (!before.hasty && !services_->view()->recalled) std::this_thread::yield();
}

api::DrillDoor House::drill_door() {
  api::DrillDoor out;
  out.equip = [](Json& order) { order["sim"] = "plant"; };
  out.start = [this](std::string order, auto line, auto end) -> base::Result<void> {
    std::lock_guard lock(mutex_);
    drill_order_ = std::move(order);
    drill_line_ = std::move(line);
    drill_end_ = std::move(end);
    return {};
  };
  out.stop = [this] { ++drills_stopped; };
  return out;
}

api::MapDoor House::map_door(const Before& before) {
  auto opened = maps::Shelf::open(maps_folder(), before.map);
  if (!opened) throw std::runtime_error(opened.error().detail);
  shelf_ = std::move(*opened);
  api::MapDoor out;
  out.shelf = shelf_.get();
  if (!before.sees) return out;
  out.looks = [this] { return map_looks.load(); };
  out.prepare = [this](std::int64_t id, bool same_place) -> base::Result<api::MapDoor::Take> {
    if (const auto map = shelf_->read(id); !map) return tl::unexpected(map.error());
    return [this, id, same_place] {
      map_taken = id;
      map_same_place = same_place;
    };
  };
  out.drop = [this] { map_taken = -1; };
  out.start_making = [this]() -> base::Result<void> {
    if (making.exchange(true)) return base::fail(base::Code::Conflict, "one is being made");
    return {};
  };
  out.finish_making = [this](const api::MapDoor::Keep& keep) -> base::Result<maps::About> {
    if (!making) return base::fail(base::Code::Conflict, "none is being made");
    auto kept = keep(
        {*nav::chart::OccupancyMap::make({3, 2, 0.05, {}}), maps::Anchor{kStart, 12.0, 0.1, 0.5}});
    if (kept) making = false;
    return kept;
  };
  out.drop_making = [this]() -> base::Result<void> {
    making = false;
    return {};
  };
  out.making = [this] {
    return making ? std::optional(maps::Making{12, 3, 3.44, ""}) : std::nullopt;
  };
  out.placed = [this] {
    const std::int64_t id = map_taken;
    return id < 0 ? std::nullopt : std::optional(maps::Anchor{kStart, 90.0, 0.4, 2.0});
  };
  return out;
}

std::string House::drill_order() {
  std::lock_guard lock(mutex_);
  return drill_order_;
}

void House::drill_says(const std::string& line) {
  boost::asio::post(io_, [this, line] { drill_line_(line); });
}

void House::drill_ends(const std::string& problem) {
  boost::asio::post(io_, [this, problem] { drill_end_(problem); });
}

api::DriverDoor House::door(Vehicle vehicle) {
  api::DriverDoor out;
  out.restart = [this](const std::string& name) -> base::Result<void> {
    if (name != "gnss") return base::fail(base::Code::NotFound, "no driver");
    ++restarts;
    return {};
  };
  if (vehicle == Vehicle::Bare) return out;
  const auto answer = [this](api::DriverDoor::Done done) {
    if (driver_answers) boost::asio::post(io_, [done] { done({}); });
  };
  out.set_lights = [this, answer](const base::LightState& lights, base::Time,
                                  api::DriverDoor::Done done) {
    light_mode = lights.front_mode;
    base::LightState seen = lights;
    seen.stamp = base::steady_now();
    robot_.measurements().put(seen);
    answer(std::move(done));
  };
  out.clear_errors = [this, answer](int motor, base::Time, api::DriverDoor::Done done) {
    errors_cleared = motor;
    answer(std::move(done));
  };
  return out;
}

void House::serve(net::Limits limits) {
  net::Handlers h;
  h.on_request = [this](net::Request request, base::Time begun, net::Respond respond) {
    api_->on_request(std::move(request), begun, std::move(respond));
  };
  h.urgency = [](const net::Request& header) {
    return api::Api::is_estop(header)  ? net::Urgency::AtHeader
           : api::Api::is_stop(header) ? net::Urgency::Whole
                                       : net::Urgency::None;
  };
  h.body_limit = [this](const net::Request& header) { return api_->body_limit(header); };
  h.discard = [this](std::string large) { api_->discard(std::move(large)); };
  h.on_upgrade = [this](const net::Request& request) { return api_->on_upgrade(request); };
  h.on_client = [this](net::ClientId id, const net::Request& upgrade) {
    api_->on_client(id, upgrade);
  };
  h.on_text = [this](net::ClientId id, base::Time begun, std::string_view text) {
    api_->on_text(id, begun, text);
  };
  h.urgent_text = api::Api::is_estop_text;
  h.on_gone = [this](net::ClientId id) { api_->on_gone(id); };
  h.on_refused = api::Api::on_refused;
  h.on_second = [this] { api_->on_second(); };
  auto made = net::Server::listen(io_, "127.0.0.1", 0, limits, std::move(h));
  if (!made) throw std::runtime_error(made.error().detail);
  server_ = std::move(*made);
  api_->attach(stream_of(server_->hub()));
}

void House::start_services() {
  const auto on_web = [this](auto work) { boost::asio::post(io_, std::move(work)); };
  services_->start({.tell =
                        [this, on_web](base::Event event) {
                          on_web([this, event = std::move(event)] { api_->on_event(event); });
                        },
                    .mission_changed =
                        [this, on_web](const std::string& id, std::int64_t revision) {
                          on_web([this, id, revision] { api_->on_mission_change(id, revision); });
                        },
                    .answer = on_web});
}

House::~House() {
  stop_ = true;
  control_.join();
  services_->stop();
  boost::asio::post(io_, [this] {
    server_.reset();
    io_.stop();
  });
  web_.join();
  services_.reset();
  workers_.stop();
  store_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string House::code() {
  std::lock_guard lock(mutex_);
  return code_;
}

std::shared_ptr<void> House::hold(net::Lane lane) {
  auto until = std::make_shared<std::promise<void>>();
  const std::shared_future<void> let_go = until->get_future().share();
  const unsigned threads = lane == net::Lane::Large ? net::Workers::large_at_once() : 1;
  for (unsigned i = 0; i < threads; ++i) {
    workers_.must_run(lane, [let_go] { let_go.wait(); }, {});
  }
  while (workers_.waiting(lane) > 0) std::this_thread::yield();  // until the lane is at them
  return {nullptr, [until](void*) { until->set_value(); }};
}

std::size_t House::large_waiting() const {
  return workers_.waiting(net::Lane::Large);
}

base::DriveCommand House::sent() {
  std::lock_guard lock(mutex_);
  return sent_;
}

void House::play() {
  // Devices and loop run on computers and threads that nobody delays; where that is refused, a busy
  // machine may still make them late.
  (void)make_urgent(Urgency::Control);
  // It was on for some seconds when a test begins: the receiver was watched, what asks for it is
  // content.
  int count = 0;
  const base::Time begun = base::steady_now();
  const base::WallTime begun_wall = base::wall_now();
  for (auto ago = kOnBefore; ago > 0ms && healthy && ticking && !stop_; ago -= 20ms, ++count) {
    tell(begun - ago, count);
    robot_.tick(begun - ago, begun_wall - ago);
  }
  was_on_.set_value();
  auto next = std::chrono::steady_clock::now();
  for (; !stop_; ++count) {
    const base::Time now = base::steady_now();
    if (healthy) tell(now, count);
    if (ticking) robot_.tick(now, base::wall_now());
    next = std::max(next + 20ms, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

void House::tell(base::Time now, int count) {
  auto& in = robot_.measurements();
  base::BaseStatus status;
  status.stamp = now;
  status.vehicle_state = base::VehicleState::Normal;
  status.control_mode = base::ControlMode::Can;
  status.battery_v = 49.5;
  in.put(status);
  in.put(base::BaseMotion{now, sent().twist});  // the tracks do as told, in the air
  // Tracks, position and velocity tell of the same way, but for a jump.
  const double at_m = moved_m;
  const double step_m = at_m - tracks_m_ < kJump_m ? at_m - tracks_m_ : 0.0;
  tracks_m_ = at_m;
  in.put(base::WheelTravel{now, step_m, step_m});
  base::RadioState radio;
  radio.stamp = now;
  radio.swb = swb;
  radio.swa = swa;
  radio.swc = swc;
  radio.swd = swd;
  radio.vra = vra;
  radio.count = static_cast<std::uint8_t>(count);
  in.put(radio);
  if (count > 0 && now - told_slow_ < 200ms) return;
  const double since_s = count > 0 ? std::chrono::duration<double>(now - told_slow_).count() : 0.2;
  told_slow_ = now;
  in.put(base::BatteryState{now, 80.0, 49.5, {}, {}});
  base::GnssFix fix;
  fix.stamp = now;
  fix.fix = base::FixType::RtkFixed;
  fix.position = base::destination(kStart, 0.0, at_m);
  fix.alt_msl_m = 60.0;
  fix.satellites = 18;
  fix.hdop = 0.7;
  fix.sigma_east_m = 0.02;
  fix.sigma_north_m = 0.02;
  in.put(fix);
  const double way_m = at_m - fix_m_ < kJump_m ? at_m - fix_m_ : 0.0;
  fix_m_ = at_m;
  in.put(base::GnssVelocity{now, 0.0, way_m / since_s, {}});
  in.put(base::Heading{now, base::yaw_from_heading(0.0), base::HeadingSource::DualAntenna});
  base::DriverStatus driver;
  driver.stamp = now;
  driver.name = "gnss";
  driver.phase = phase;
  driver.received = static_cast<std::uint64_t>(count);
  driver.last_received = now;
  driver.link = "serial:/dev/ttyACM0:115200";
  driver.link_open = true;
  if (driver.phase == base::DriverPhase::Failed) {
    driver.reason = driver.last_error = "failed while ticking: a value that cannot be";
    driver.last_error_at = now;
  }
  base::DriverDetail detail;
  detail.counts["wrong checksum"] = 3;
  detail.rates_hz["GGA"] = 5.0;
  detail.facts["protocol"] = "NMEA";
  driver.detail = std::make_shared<const base::DriverDetail>(std::move(detail));
  in.put(std::move(driver));
}

const Json& HouseTest::document() {
  static const Json kDocument = Json::parse(api::openapi_text());
  return kDocument;
}

HouseTest::Reply HouseTest::raw(const std::string& request) {
  Client client(house.port());
  client.send(request);
  const auto answer = client.answer(request.starts_with("HEAD"));
  EXPECT_TRUE(answer) << request.substr(0, 200);
  if (!answer) return {};
  Reply out{answer->status, nullptr, *answer};
  if (out.raw.header("content-type").find("json") != std::string::npos && !out.raw.body.empty()) {
    out.body = Json::parse(out.raw.body);
  }
  return out;
}

HouseTest::Reply HouseTest::call(const std::string& method, const std::string& path,
                                 const std::string& body, const std::string& more) {
  std::string request = method + " /api/v1" + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more;
  if (!body.empty()) {
    request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    if (more.find("Content-Type") == std::string::npos) {
      request += "Content-Type: application/json\r\n";
    }
  }
  Reply reply = raw(request + "\r\n" + body);
  // The kernel tells in ticks of up to 10 ms when a connection came: what comes that soon after a
  // stop may be refused as if it had been clicked before (docs/api.md).
  if (path.ends_with("/pause") || path.ends_with("/stop") || path.ends_with("/disarm")) {
    std::this_thread::sleep_for(20ms);
  }
  const std::string known = documented_path(document(), path);
  std::string lower = method;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (known.empty() || !document()["paths"][known].contains(lower)) return reply;
  const Json* schema = answer_schema(document(), known, lower, reply.status);
  if (schema != nullptr && !reply.body.is_null()) {
    EXPECT_EQ(schema_fault(document(), *schema, reply.body), "") << method << ' ' << path;
  }
  return reply;
}

void HouseTest::until(const std::function<bool()>& claim, const char* what) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!claim()) {
    if (std::chrono::steady_clock::now() > end) FAIL() << "not within 20 s: " << what;
    std::this_thread::sleep_for(5ms);
  }
}

void HouseTest::until_ready() {
  until(
      [this] {
        const auto s = house.snapshot();
        return s && s->ready_to_arm && s->pose;
      },
      "the checks are fine");
}

Json two_waypoints(const std::string& name) {
  return {{"name", name},
          {"items",
           {{{"type", "waypoint"}, {"lat", kStart.lat + 0.0001}, {"lon", kStart.lon}},
            {{"type", "waypoint"}, {"lat", kStart.lat + 0.0001}, {"lon", kStart.lon + 0.0002}}}}};
}

std::string HouseTest::make_mission(const std::string& name) {
  const Reply made = call("POST", "/missions", two_waypoints(name));
  EXPECT_EQ(made.status, 201u);
  return made.body.value("id", "");
}

}  // namespace roverd::test
