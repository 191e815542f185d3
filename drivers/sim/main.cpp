// roverd-sim: the plant in real time, between a CAN bus, a GNSS port and the side channel of tests.
// One thread, one io_context.

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <sys/prctl.h>
#include <unistd.h>

#include "base/time.hpp"
#include "link/cansock.hpp"
#include "link/socketcan.hpp"
#include "link/tcp.hpp"
#include "sim/bunker.hpp"
#include "sim/control_server.hpp"
#include "sim/options.hpp"
#include "sim/pace.hpp"
#include "sim/pty.hpp"

namespace roverd::sim {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

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

class Simulation {
 public:
  Simulation(asio::io_context& io, const Options& options)
      : began_(base::steady_now()),
        pace_(began_),
        bunker_(options.config.params, options.seed, starting_now(options.config.start, began_)),
        bus_(make_bus(io, options)),
        tick_(io),
        reopen_(io),
        control_(io, options.control_port,
                 {.truth = [this] { return truth(); },
                  .carry_out = [this](std::string_view line) { return carry_out(line); }}) {
    if (options.gnss_port) {
      auto server = std::make_unique<link::TcpServer>(io, "127.0.0.1", *options.gnss_port);
      tcp_ = server.get();
      gnss_ = std::move(server);
    } else {
      gnss_ = std::make_unique<Pty>(io, options.gnss_pty);
    }
  }

  base::Result<void> open() {
    bunker_.on_frame = [this](const CanFrame& f, Time) { bus_->send(f); };
    bunker_.on_gnss = [this](Bytes bytes, Time) { gnss_->write(bytes); };
    bus_->on_frame = [this](const CanFrame& f, Time) {
      catch_up();
      bunker_.receive(f);
    };
    bus_->on_closed = [this](const std::string&) { reopen(); };
    if (auto done = bus_->open(); !done) return done;
    if (auto done = gnss_->open(); !done) return done;
    if (auto done = control_.open(); !done) return done;
    due_ = std::chrono::steady_clock::now();
    schedule();
    return {};
  }

  std::string ready_line() const {
    const std::string gnss =
        tcp_ != nullptr ? "tcp:127.0.0.1:" + std::to_string(tcp_->port()) : gnss_->describe();
    return "ready can=" + bus_->describe() + " gnss=" + gnss +
           " control=127.0.0.1:" + std::to_string(control_.port());
  }

  void close() noexcept {
    tick_.cancel();
    reopen_.cancel();
    control_.close();
    gnss_->close();
    bus_->close();
  }

 private:
  void catch_up() { bunker_.advance_to(pace_.advance(base::steady_now())); }

  /// Absolute times, so that lateness does not add up; times already past are left out, for
  /// catch_up does their steps.
  void schedule() {
    const auto now = std::chrono::steady_clock::now();
    due_ += Bunker::kStep;
    if (due_ < now) due_ = now;
    tick_.expires_at(due_);
    tick_.async_wait([this](error_code ec) {
      if (ec) return;
      catch_up();
      schedule();
    });
  }

  /// The interface went down or away: the robot goes on, and speaks again when it is back.
  void reopen() {
    bus_->close();
    reopen_.expires_after(kReopen);
    reopen_.async_wait([this](error_code ec) {
      if (!ec && !bus_->open()) reopen();
    });
  }

  std::string truth() {
    catch_up();
    return truth_line(bunker_.truth(), began_);
  }

  ControlAnswer carry_out(std::string_view line) {
    catch_up();
    return sim::carry_out(line, bunker_, began_);
  }

  const Time began_;
  Pace pace_;
  Bunker bunker_;
  std::unique_ptr<link::FrameLink> bus_;
  std::unique_ptr<link::ByteLink> gnss_;
  link::TcpServer* tcp_ = nullptr;  ///< gnss_, when it is one
  asio::steady_timer tick_;
  asio::steady_timer reopen_;
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
