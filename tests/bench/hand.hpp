#pragma once
// What programs that measure a robot driven by hand have in common: they arm it, hold a stick over
// the stream, and hear on the bus what it commands its base.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <nlohmann/json.hpp>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>

#include "../api/client.hpp"
#include "base/time.hpp"
#include "link/cansock.hpp"

namespace roverd::bench {

/// The measuring side's own lateness is none of the robot's: before others, where that is allowed.
inline void before_others() {
  sched_param priority{};
  priority.sched_priority = 10;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}

/// @param sorted not empty
inline double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// What the robot says to its base.
class Bus {
 public:
  /// @param path of the local CAN socket. Throws std::runtime_error if nobody listens there.
  explicit Bus(const std::string& path) : link_(io_, path) {
    link_.on_frame = [this](const base::CanFrame& f, base::Time t) { hear(f, t); };
    if (const auto opened = link_.open(); !opened) {
      throw std::runtime_error(opened.error().detail);
    }
    thread_ = std::thread([this] {
      before_others();
      io_.run();
    });
  }
  ~Bus() {
    io_.stop();
    thread_.join();
  }
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  void look_for_zero() { zero_ = 0; }
  /// The first zero command since it was looked for; the clock's beginning: none yet
  base::Time zero() const { return base::Time(base::Duration(zero_)); }
  base::Time moving() const { return base::Time(base::Duration(moving_)); }

  int speed_mmps() const { return speed_mmps_; }
  void look_for_less(int mmps) {
    least_mmps_ = mmps;
    less_ = 0;
  }
  /// The first command of less speed than that; likewise
  base::Time less() const { return base::Time(base::Duration(less_)); }

 private:
  static constexpr std::uint32_t kMotion = 0x111;

  void hear(const base::CanFrame& f, base::Time t) {
    if (f.id != kMotion || f.extended || f.len < 4) return;
    const bool zero = std::all_of(f.data.begin(), f.data.begin() + 4,
                                  [](std::uint8_t byte) { return byte == 0; });
    const auto at = t.time_since_epoch().count();
    if (!zero) moving_ = at;
    // The first since it was asked for: whoever waits looks only later.
    base::Duration::rep none = 0;
    if (zero) zero_.compare_exchange_strong(none, at);
    const auto speed = static_cast<std::int16_t>((f.data[0] << 8) | f.data[1]);
    none = 0;
    if (speed < least_mmps_) less_.compare_exchange_strong(none, at);
    speed_mmps_ = speed;
  }

  boost::asio::io_context io_{1};
  link::CanSocketLink link_;
  std::atomic<base::Duration::rep> zero_{0};
  std::atomic<base::Duration::rep> moving_{0};
  std::atomic<base::Duration::rep> less_{0};
  std::atomic<int> least_mmps_{-100'000};
  std::atomic<int> speed_mmps_{0};
  std::thread thread_;
};

/// Somebody's hand on the stick: straight ahead at one speed.
class Hand {
 public:
  Hand(const std::string& path, std::uint16_t port, double speed_mps)
      : bus(path), port_(port), speed_mps_(speed_mps), stream_(port) {
    // As a browser does: a small message does not wait until the one before was acknowledged.
    const int at_once = 1;
    ::setsockopt(stream_.handle(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    if (stream_.upgrade("/api/v1/stream") != 101) throw std::runtime_error("no stream");
  }

  void get_ready() {
    const Json soon = {{"valid_for_s", 5}};
    const auto end = base::steady_now() + std::chrono::seconds(60);
    Json mode = soon;
    mode["mode"] = "MANUAL";
    while (call("POST", "/vehicle/estop/reset", soon) != 200 ||
           call("POST", "/vehicle/arm", soon) != 200 || call("PUT", "/vehicle/mode", mode) != 200) {
      if (base::steady_now() > end) throw std::runtime_error("not ready within 60 s: " + said_);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  /// Until the base is told to move. @return when
  base::Time drive() {
    const base::Time begin = base::steady_now();
    // A stick acts only after it was seen let go.
    for (int i = 0; bus.moving() < begin; ++i) {
      if (base::steady_now() - begin > std::chrono::seconds(60)) {
        throw std::runtime_error("it does not drive");
      }
      if (i % 10 == 0) {
        say({{"drive", {{"speed_mps", 0}, {"yaw_rate_dps", 0}, {"deadman", false}}}});
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
      }
      keep_driving();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return bus.moving();
  }

  void keep_driving() {
    say({{"drive",
          {{"speed_mps", speed_mps_},
           {"yaw_rate_dps", 0},
           {"deadman", true},
           {"valid_for_s", 5}}}});
  }

  void say(const nlohmann::json& message) { stream_.send_frame(1, message.dump()); }

  Bus bus;

 private:
  using Json = nlohmann::json;

  unsigned call(const std::string& method, const std::string& path, const Json& body) {
    const std::string text = body.dump();
    test::Client client(port_);
    client.send(method + " /api/v1" + path +
                " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n" +
                "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
    const auto answer = client.answer();
    if (answer && answer->status != 200) said_ = answer->body;
    return answer ? answer->status : 0;
  }

  std::uint16_t port_;
  double speed_mps_;
  test::Client stream_;
  std::string said_;
};

}  // namespace roverd::bench
