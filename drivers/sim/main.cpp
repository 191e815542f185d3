// roverd-sim: the plant in real time, between a drive link (CAN, UDP, TCP or serial), a GNSS port
// and the side channel of tests.
// One thread, one io_context.

#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <sys/prctl.h>
#include <unistd.h>

#include "base/time.hpp"
#include "bunker/codec.hpp"
#include "bunker/v1.hpp"
#include "link/cansock.hpp"
#include "link/socketcan.hpp"
#include "link/tcp.hpp"
#include "link/udp.hpp"
#include "sim/bunker.hpp"
#include "sim/cart.hpp"
#include "sim/control_server.hpp"
#include "sim/eyes.hpp"
#include "sim/options.hpp"
#include "sim/pace.hpp"
#include "sim/port.hpp"
#include "sim/pty.hpp"
#include "sim/surroundings.hpp"

namespace roverd::sim {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
namespace id = bunker::id;

constexpr auto kReopen = std::chrono::milliseconds(500);

std::unique_ptr<link::FrameLink> make_bus(asio::io_context& io, const Options& options) {
  if (!options.can.empty()) return std::make_unique<link::SocketCanLink>(io, options.can);
  return std::make_unique<link::CanSocketServer>(io, options.cansock);
}

Start starting_now(Start start, base::Time now) {
  start.time = now;
  start.wall = base::wall_now();
  return start;
}

/// A vehicle with its drive link. Names what roverd calls the driver of each link:
/// "ackermann=udp:127.0.0.1:40123".
class Side {
 public:
  virtual ~Side() = default;
  virtual Vehicle& vehicle() = 0;
  /// @param catch_up called before anything that comes in.
  virtual base::Result<void> open(std::function<void()> catch_up) = 0;
  virtual void close() noexcept = 0;
  virtual std::string links() const = 0;
  /// Once a step.
  virtual void tick() {}
};

class CanSide final : public Side {
 public:
  CanSide(asio::io_context& io, const Options& o, const Start& start)
      : bunker_(o.config.params, o.seed, start), bus_(make_bus(io, o)), reopen_(io) {}

  Vehicle& vehicle() override { return bunker_; }
  base::Result<void> open(std::function<void()> catch_up) override {
    bunker_.on_frame = [this](const CanFrame& f, Time) { bus_->send(f); };
    bus_->on_frame = [this, catch_up = std::move(catch_up)](const CanFrame& f, Time) {
      catch_up();
      bunker_.receive(f);
    };
    bus_->on_closed = [this](const std::string&) { reopen(); };
    bus_->attend({id::kMotionCommand, id::kLightCommand, id::kControlMode, id::kClearErrors,
                  id::kVersionRequest, id::kVersionText, bunker::v1::id::kCommand,
                  bunker::v1::id::kLightCommand});
    return bus_->open();
  }
  void close() noexcept override {
    reopen_.cancel();
    bus_->close();
  }
  std::string links() const override { return "can=" + bus_->describe(); }

 private:
  /// The interface went down or away: the robot goes on, and speaks again when it is back.
  void reopen() {
    bus_->close();
    reopen_.expires_after(kReopen);
    reopen_.async_wait([this](error_code ec) {
      if (!ec && !bus_->open()) reopen();
    });
  }

  Bunker bunker_;
  std::unique_ptr<link::FrameLink> bus_;
  asio::steady_timer reopen_;
};

class CartSide final : public Side {
 public:
  CartSide(asio::io_context& io, const Options& o, const Start& start)
      : cart_(o.config.params, o.seed, start), drive_(io, o.drive), bumper_(io, o.bumper) {
    const DeviceParams& device = o.config.params.device;
    name_ = device.wire.substr(0, device.wire.find('_'));
    has_bumper_ = device.bumper;
  }

  Vehicle& vehicle() override { return cart_; }
  base::Result<void> open(std::function<void()> catch_up) override {
    cart_.on_drive = [this](Bytes b, Time) { drive_.write(b); };
    cart_.on_bumper = [this](Bytes b, Time) { bumper_.write(b); };
    drive_.on_bytes = [this, catch_up = std::move(catch_up)](Bytes b) {
      catch_up();
      cart_.receive(b);
    };
    if (auto done = drive_.open(); !done || !has_bumper_) return done;
    return bumper_.open();
  }
  void close() noexcept override {
    drive_.close();
    bumper_.close();
  }
  std::string links() const override {
    const std::string drive = name_ + "=" + drive_.address();
    return has_bumper_ ? drive + " bumper=" + bumper_.address() : drive;
  }
  void tick() override { drive_.cut(cart_.faults().bus_off); }

 private:
  Cart cart_;
  Port drive_;
  Port bumper_;
  std::string name_;
  bool has_bumper_ = false;
};

std::unique_ptr<Side> make_side(asio::io_context& io, const Options& o, base::Time began) {
  const Start start = starting_now(o.config.start, began);
  if (o.config.params.device.wire == "can") return std::make_unique<CanSide>(io, o, start);
  return std::make_unique<CartSide>(io, o, start);
}

/// A sensor with its socket: an lms or depth camera listens on TCP, a vlp16 and a vision program
/// send to a port of this computer, a range sensor has a pseudo-terminal.
class EyeSide {
 public:
  EyeSide(asio::io_context& io, const world::SensorParams& p, std::uint64_t seed)
      : eye_(p, seed, 0.0) {
    if (p.kind != "vlp16" && p.kind != "vision") {
      const std::string usual = p.kind == "range" ? "pty" : "tcp:0";
      port_ = std::make_unique<Port>(io, read_port(p.port.empty() ? usual : p.port).value());
      return;
    }
    const std::uint16_t usual = p.kind == "vlp16" ? 2368 : 5005;
    const PortSpec spec = read_port(p.port.empty() ? "udp:0" : p.port).value();
    const std::uint16_t port = spec.port == 0 ? usual : spec.port;
    datagrams_ = std::make_unique<link::UdpLink>(io, 0, link::UdpLink::Peer{"127.0.0.1", port});
    to_ = "udp:127.0.0.1:" + std::to_string(port);
  }

  base::Result<void> open(std::function<void()> catch_up) {
    if (datagrams_) return datagrams_->open();
    port_->on_bytes = [this, catch_up = std::move(catch_up)](Bytes bytes) {
      catch_up();
      const auto answer = eye_.receive(bytes);
      if (!answer.empty()) port_->write(answer);
    };
    return port_->open();
  }
  void close() noexcept {
    if (port_) port_->close();
    if (datagrams_) datagrams_->close();
  }
  /// " front=tcp:127.0.0.1:40123"
  std::string link() const {
    return " " + eye_.params().name + "=" + (port_ ? port_->address() : to_);
  }
  void tick(const Surroundings& around, const world::SensorFaults& faults) {
    eye_.advance(around, faults, [this](Bytes bytes) {
      if (port_) port_->write(bytes);
      if (datagrams_) datagrams_->write(bytes);
    });
    if (port_) port_->cut(eye_.cut());
  }

 private:
  Eye eye_;
  std::unique_ptr<Port> port_;
  std::unique_ptr<link::UdpLink> datagrams_;
  std::string to_;
};

class Simulation {
 public:
  Simulation(asio::io_context& io, const Options& options)
      : began_(base::steady_now()),
        pace_(began_),
        side_(make_side(io, options, began_)),
        vehicle_(side_->vehicle()),
        imu_(io, options.imu),
        has_imu_(options.config.params.imu.fitted),
        tick_(io),
        control_(io, options.control_port,
                 {.truth = [this] { return truth(); },
                  .carry_out = [this](std::string_view line) { return carry_out(line); }}) {
    if (options.world || !options.config.sensors.empty()) {
      around_ = std::make_unique<Surroundings>(options.world.value_or(world::World{}),
                                               options.config.params.body, began_);
      around_->attend(vehicle_);
      for (const world::SensorParams& sensor : options.config.sensors) {
        eyes_.push_back(std::make_unique<EyeSide>(io, sensor, options.seed));
      }
    }
    if (options.gnss_port) {
      auto server = std::make_unique<link::TcpServer>(io, "127.0.0.1", *options.gnss_port);
      tcp_ = server.get();
      gnss_ = std::move(server);
    } else {
      gnss_ = std::make_unique<Pty>(io, options.gnss_pty);
    }
  }

  base::Result<void> open() {
    vehicle_.on_gnss = [this](Bytes bytes, Time) { gnss_->write(bytes); };
    if (auto done = side_->open([this] { catch_up(); }); !done) return done;
    if (auto done = gnss_->open(); !done) return done;
    if (auto done = open_imu(); !done) return done;
    for (const auto& eye : eyes_) {
      if (auto done = eye->open([this] { catch_up(); }); !done) return done;
    }
    if (auto done = control_.open(); !done) return done;
    due_ = std::chrono::steady_clock::now();
    schedule();
    return {};
  }

  /// The words before gnss are names of roverd's drivers, "can" stands for the Bunker's.
  std::string ready_line() const {
    const std::string gnss =
        tcp_ != nullptr ? "tcp:127.0.0.1:" + std::to_string(tcp_->port()) : gnss_->describe();
    return "ready " + side_->links() + " gnss=" + gnss +
           (has_imu_ ? " mti=" + imu_.address() : "") + links_of_eyes() +
           " control=127.0.0.1:" + std::to_string(control_.port());
  }

  void close() noexcept {
    tick_.cancel();
    control_.close();
    gnss_->close();
    imu_.close();
    for (const auto& eye : eyes_) eye->close();
    side_->close();
  }

 private:
  std::string links_of_eyes() const {
    std::string out;
    for (const auto& eye : eyes_) out += eye->link();
    return out;
  }

  base::Result<void> open_imu() {
    if (!has_imu_) return {};
    vehicle_.on_imu = [this](Bytes bytes, Time) { imu_.write(bytes); };
    imu_.on_bytes = [this](Bytes bytes) {
      catch_up();
      vehicle_.receive_imu(bytes);
    };
    return imu_.open();
  }

  void catch_up() { vehicle_.advance_to(pace_.advance(base::steady_now())); }

  /// Absolute times, so that lateness does not add up; times already past are left out, for
  /// catch_up does their steps.
  void schedule() {
    const auto now = std::chrono::steady_clock::now();
    due_ += Vehicle::kStep;
    if (due_ < now) due_ = now;
    tick_.expires_at(due_);
    tick_.async_wait([this](error_code ec) {
      if (ec) return;
      catch_up();
      side_->tick();
      for (const auto& eye : eyes_) eye->tick(*around_, vehicle_.faults().see);
      schedule();
    });
  }

  std::string truth() {
    catch_up();
    return truth_line(vehicle_.truth(), began_, around_.get());
  }

  ControlAnswer carry_out(std::string_view line) {
    catch_up();
    return sim::carry_out(line, vehicle_, began_, around_.get());
  }

  const Time began_;
  Pace pace_;
  std::unique_ptr<Side> side_;
  Vehicle& vehicle_;  ///< of side_
  std::unique_ptr<Surroundings> around_;
  std::vector<std::unique_ptr<EyeSide>> eyes_;
  std::unique_ptr<link::ByteLink> gnss_;
  link::TcpServer* tcp_ = nullptr;  ///< gnss_, when it is one
  Port imu_;
  bool has_imu_;
  asio::steady_timer tick_;
  std::chrono::steady_clock::time_point due_;
  ControlServer control_;
};

int run(const Options& options) {
  asio::io_context io(1);
  asio::signal_set signals(io, SIGINT, SIGTERM);
  if (options.die_with_parent) {
    const pid_t parent = ::getppid();
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) return 0;  // it ended just before
  }
  Simulation simulation(io, options);
  if (auto done = simulation.open(); !done) {
    std::fprintf(stderr, "roverd-sim: %s\n", done.error().detail.c_str());
    return 1;
  }
  signals.async_wait([&](error_code, int) { io.stop(); });
  std::printf("%s\n", simulation.ready_line().c_str());
  std::fflush(stdout);
  io.run();
  simulation.close();
  return 0;
}

}  // namespace
}  // namespace roverd::sim

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  const auto parsed = roverd::sim::parse_options(argc, argv);
  if (!parsed.options) {
    std::fprintf(parsed.exit_code == 0 ? stdout : stderr, "%s\n", parsed.text.c_str());
    return parsed.exit_code;
  }
  try {
    return roverd::sim::run(*parsed.options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roverd-sim: %s\n", error.what());
    return 1;
  }
}
