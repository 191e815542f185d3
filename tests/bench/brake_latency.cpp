// roverd-brake PATH PORT COUNT LISTEN SCANNER: stands between a robot and its (simulated) SICK
// scanner, passes on what the scanner says, and lets a wall appear in it COUNT times before a robot
// that is driven by hand. Prints how long it took from the last byte of the first scan with the
// wall (handed to the system) to the first frame on the bus that commands less speed, as one JSON
// object: brakes, p50_ms, p99_ms, max_ms.
//
// LISTEN is the port at which the robot finds its scanner, SCANNER the one at which that is, both
// of this computer. The wall is 1.2 m wide and 0.4 m before the scanner, wherever that drives: so
// near that 0.5 m/s is too fast, and so wide that one scan is enough (sense.persist.at_once voxels
// of 5 cm: it fills 24). A simulated scanner may turn in step with the robot's own ticks, a real
// one does not: each time all scans are later by another part of a period, and say so.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <unistd.h>

#include "base/angle.hpp"
#include "hand.hpp"
#include "sick/cola.hpp"
#include "sick/scan.hpp"

namespace {

using namespace roverd;
using namespace std::chrono_literals;
using bench::at_share;

constexpr double kSpeed_mps = 0.5;
constexpr double kWall_m = 0.4;  // before the scanner
constexpr double kWallHalf_m = 0.6;
constexpr int kPeriod_us = 20'000;
constexpr int kLess_mmps = 5;  // less than before by this: it brakes

/// A connected socket, or one that listens.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int handle) : handle_(handle) {
    if (handle_ < 0) throw std::runtime_error("no socket");
    const int at_once = 1;
    ::setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  }
  ~Socket() {
    if (handle_ >= 0) ::close(handle_);
  }
  Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  int handle() const { return handle_; }
  bool send(base::Bytes bytes) const {
    while (!bytes.empty()) {
      const auto sent = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
  }

 private:
  int handle_ = -1;
};

sockaddr_in local(std::uint16_t port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return at;
}

/// What the scanner says, with a wall in it when there is to be one.
class Scanner {
 public:
  /// @param listen on this port for the robot. @param port of the scanner, on this computer
  Scanner(std::uint16_t listen, std::uint16_t port) : port_(port) {
    listening_ = Socket(::socket(AF_INET, SOCK_STREAM, 0));
    const int again = 1;
    ::setsockopt(listening_.handle(), SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    const sockaddr_in at = local(listen);
    if (::bind(listening_.handle(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
        ::listen(listening_.handle(), 1) != 0) {
      throw std::runtime_error("nobody can listen on port " + std::to_string(listen));
    }
    thread_ = std::thread([this] {
      bench::before_others();
      while (!ending_) serve();
    });
  }
  ~Scanner() {
    ending_ = true;
    thread_.join();
  }
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;

  /// From now on its scans are later by that, as those of one that was switched on later.
  void turn_later(std::chrono::microseconds by) {
    later_us_ = static_cast<std::uint32_t>(by.count());
  }
  void show_wall() {
    shown_ = 0;
    wall_ = true;
  }
  void hide_wall() { wall_ = false; }
  /// The first scan with it was handed over; the clock's beginning: not yet
  base::Time shown() const { return base::Time(base::Duration(shown_)); }
  std::uint64_t scans() const { return scans_; }

 private:
  static bool readable(int handle, int patience_ms) {
    pollfd one{handle, POLLIN, 0};
    return ::poll(&one, 1, patience_ms) > 0;
  }

  void serve() {
    if (!readable(listening_.handle(), 100)) return;
    const Socket robot(::accept(listening_.handle(), nullptr, nullptr));
    const Socket scanner(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in at = local(port_);
    if (::connect(scanner.handle(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) return;
    sick::Framer framer;
    waiting_.clear();
    while (!ending_) {
      pollfd both[2] = {{robot.handle(), POLLIN, 0}, {scanner.handle(), POLLIN, 0}};
      timespec patience = patience_of(base::steady_now());
      if (::ppoll(both, 2, &patience, nullptr) < 0) return;
      if (both[0].revents != 0 && !pass(robot, [&](base::Bytes b) { return scanner.send(b); })) {
        return;
      }
      const auto keep = [&](const sick::Telegram& t) {
        const auto later = std::chrono::microseconds(later_us_);
        waiting_.push_back({base::steady_now() + later, t.dialect, {t.body.begin(), t.body.end()}});
      };
      if (both[1].revents != 0 && !pass(scanner, [&](base::Bytes b) {
            framer.feed(b, keep);
            return true;
          })) {
        return;
      }
      for (; !waiting_.empty() && waiting_.front().due <= base::steady_now();
           waiting_.pop_front()) {
        if (!say(robot, waiting_.front())) return;
      }
    }
  }

  /// Until the next one is due.
  timespec patience_of(base::Time now) const {
    const base::Duration most = 100ms;
    const base::Duration left =
        waiting_.empty() ? most : std::clamp(waiting_.front().due - now, base::Duration{}, most);
    return {0, std::chrono::duration_cast<std::chrono::nanoseconds>(left).count()};
  }

  template <class To>
  static bool pass(const Socket& from, To&& to) {
    std::uint8_t piece[16'384];
    const auto got = ::recv(from.handle(), piece, sizeof piece, 0);
    return got > 0 && to(base::Bytes(piece, static_cast<std::size_t>(got)));
  }

  struct Waiting {
    base::Time due;
    sick::Dialect dialect;
    std::vector<std::uint8_t> body;
  };

  bool say(const Socket& robot, const Waiting& one) {
    auto scan = sick::decode_scan({one.dialect, one.body});
    if (!scan) return robot.send(sick::frame(one.dialect, one.body));
    ++scans_;
    const bool wall = wall_;
    if (wall) build_wall(*scan);
    scan->start_us += later_us_;
    scan->sent_us += later_us_;
    const auto bytes = sick::encode(*scan, one.dialect);
    // Before it goes: what the system takes to take it over counts, too.
    const base::Time now = base::steady_now();
    const bool gone = robot.send(bytes);
    base::Duration::rep none = 0;
    if (wall) shown_.compare_exchange_strong(none, now.time_since_epoch().count());
    return gone;
  }

  static void build_wall(sick::Scan& scan) {
    for (sick::Channel& c : scan.channels) {
      if (c.name != "DIST1") continue;
      for (std::size_t i = 0; i < c.values.size(); ++i) {
        const double deg = 1e-4 * (c.start_e4deg + static_cast<double>(i) * c.step_e4deg) - 90.0;
        const double rad = base::rad_from_deg(deg);
        if (std::abs(deg) > 80.0 || std::abs(kWall_m * std::tan(rad)) > kWallHalf_m) continue;
        const double raw = 1e3 * kWall_m / std::cos(rad) / static_cast<double>(c.scale);
        c.values[i] = static_cast<std::uint16_t>(std::lround(raw));
      }
    }
  }

  std::uint16_t port_;
  Socket listening_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> wall_{false};
  std::atomic<base::Duration::rep> shown_{0};
  std::atomic<std::uint64_t> scans_{0};
  std::atomic<std::uint32_t> later_us_{0};
  std::deque<Waiting> waiting_;
  std::thread thread_;
};

class Driver {
 public:
  Driver(const std::string& path, std::uint16_t port, Scanner& scanner)
      : hand_(path, port, kSpeed_mps), scanner_(scanner) {
    const auto end = base::steady_now() + 30s;
    while (scanner_.scans() < 50) {
      if (base::steady_now() > end) throw std::runtime_error("the robot hears no scan");
      std::this_thread::sleep_for(50ms);
    }
    hand_.get_ready();
    hand_.drive();
  }

  /// @return from the scan's last byte to the command of less speed
  base::Duration brake() {
    scanner_.turn_later(std::chrono::microseconds(anywhere_(random_)));
    const int before_mmps = cruise();
    hand_.bus.look_for_less(before_mmps - kLess_mmps);
    scanner_.show_wall();
    const base::Time asked = base::steady_now();
    const auto none = base::Time{};
    while (hand_.bus.less() == none) {
      if (base::steady_now() - asked > 2s) throw std::runtime_error("it does not brake");
      hold(2ms);
    }
    const base::Time less = hand_.bus.less();
    if (scanner_.shown() == none || less < scanner_.shown()) {
      throw std::runtime_error("it braked before there was a wall");
    }
    const base::Duration took = less - scanner_.shown();
    hold(200ms);
    scanner_.hide_wall();
    return took;
  }

 private:
  /// Until it has driven at one speed for a while. @return that, mm/s
  int cruise() {
    const auto end = base::steady_now() + 30s;
    int steady = 0;
    int last_mmps = 0;
    while (steady < 10) {
      if (base::steady_now() > end) throw std::runtime_error("it does not drive on");
      hold(20ms);
      const int now_mmps = hand_.bus.speed_mmps();
      const bool same = now_mmps == last_mmps && now_mmps > 900.0 * kSpeed_mps;
      steady = same ? steady + 1 : 0;
      last_mmps = now_mmps;
    }
    return last_mmps;
  }

  /// The stick, 50 times a second.
  void hold(base::Duration time) {
    const auto end = base::steady_now() + time;
    while (base::steady_now() < end) {
      if (base::steady_now() - told_ >= 20ms) {
        hand_.keep_driving();
        told_ = base::steady_now();
      }
      std::this_thread::sleep_for(1ms);
    }
  }

  bench::Hand hand_;
  Scanner& scanner_;
  base::Time told_{};
  std::mt19937 random_{1};
  std::uniform_int_distribution<int> anywhere_{0, kPeriod_us};
};

std::uint16_t number(const std::string& text) {
  return static_cast<std::uint16_t>(std::atoi(text.c_str()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: roverd-brake PATH PORT COUNT LISTEN SCANNER\n", stderr);
    return 2;
  }
  try {
    bench::before_others();
    Scanner scanner(number(argv[4]), number(argv[5]));
    Driver driver(argv[1], number(argv[2]), scanner);
    std::vector<double> took_ms;
    for (int i = 0; i < std::atoi(argv[3]); ++i) {
      took_ms.push_back(1e3 * base::seconds(driver.brake()));
    }
    std::sort(took_ms.begin(), took_ms.end());
    std::printf("{\"brakes\":%zu,\"p50_ms\":%.3f,\"p99_ms\":%.3f,\"max_ms\":%.3f}\n",
                took_ms.size(), at_share(took_ms, 0.5), at_share(took_ms, 0.99), took_ms.back());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roverd-brake: %s\n", error.what());
    return 1;
  }
  return 0;
}
