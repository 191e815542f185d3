// roverd-stop PATH PORT COUNT http|stream|key: stops a robot that is driven by hand COUNT times,
// and prints how long it took from the first byte of the request to the first frame with a zero
// command on the bus, as one JSON object: stops, p50_ms, p99_ms, max_ms. A stop over HTTP comes
// through a new connection each time, as from a script. With `key` somebody else stops it: asked by
// a line "press", he answers with the moment at which he did, in milliseconds since 1970.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
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
#include "link/cansock.hpp"

namespace {

using namespace roverd;
using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr std::uint32_t kMotion = 0x111;

/// The measuring side's own lateness is none of the robot's: before others, where that is allowed.
void before_others() {
  sched_param priority{};
  priority.sched_priority = 10;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}

/// What the robot says to its base.
class Bus {
 public:
  explicit Bus(const std::string& path) : link_(io_, path) {
    link_.on_frame = [this](const base::CanFrame& f, base::Time t) {
      if (f.id != kMotion || f.extended || f.len < 4) return;
      const bool zero = std::all_of(f.data.begin(), f.data.begin() + 4,
                                    [](std::uint8_t byte) { return byte == 0; });
      if (!zero) moving_ = t.time_since_epoch().count();
      // The first since it was asked for: whoever waits for a key looks only later.
      base::Duration::rep none = 0;
      if (zero) zero_.compare_exchange_strong(none, t.time_since_epoch().count());
    };
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

 private:
  boost::asio::io_context io_{1};
  link::CanSocketLink link_;
  std::atomic<base::Duration::rep> zero_{0};
  std::atomic<base::Duration::rep> moving_{0};
  std::thread thread_;
};

class Stopper {
 public:
  Stopper(const std::string& path, std::uint16_t port) : bus_(path), port_(port), stream_(port) {
    // As a browser does: a small message does not wait until the one before was acknowledged.
    const int at_once = 1;
    ::setsockopt(stream_.handle(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    if (stream_.upgrade("/api/v1/stream") != 101) throw std::runtime_error("no stream");
  }

  /// @return from the key's press, as its page saw it, to the zero on the bus
  base::Duration wait_for_key() {
    get_ready();
    drive();
    // Not in the moment in which the page draws that the robot was armed and drives off: that is
    // when nobody presses yet. Anywhere in its ordinary work, whatever that is just then.
    const auto ready = base::steady_now() + std::chrono::milliseconds(300 + seen_(random_));
    while (base::steady_now() < ready) {
      keep_driving();
      std::this_thread::sleep_for(20ms);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(anywhere_(random_)));
    bus_.look_for_zero();
    const base::Time asked = base::steady_now();
    std::puts("press");
    std::fflush(stdout);
    double pressed_ms = 0.0;
    if (!(std::cin >> pressed_ms)) throw std::runtime_error("nobody presses");
    while (bus_.zero() < asked) {
      if (base::steady_now() - asked > 10s) throw std::runtime_error("no zero within 10 s");
      std::this_thread::sleep_for(200us);
    }
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    const base::Duration ago = base::steady_now() - bus_.zero();
    return std::chrono::duration_cast<base::Duration>(since_epoch) - ago -
           base::from_seconds(pressed_ms / 1e3);
  }

  /// @return from the request's first byte to the zero on the bus
  base::Duration stop_once(bool by_stream) {
    get_ready();
    const base::Time from = drive();
    std::this_thread::sleep_for(std::chrono::microseconds(anywhere_(random_)));
    bus_.look_for_zero();
    const base::Time asked = base::steady_now();
    std::optional<test::Client> http;
    if (by_stream) {
      say({{"estop", true}});
    } else {
      http.emplace(port_);
      http->send("POST /api/v1/vehicle/estop HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
    while (bus_.zero() < asked) {
      if (base::steady_now() - asked > 10s) throw std::runtime_error("no zero within 10 s");
      std::this_thread::sleep_for(200us);
    }
    const base::Duration took = bus_.zero() - asked;
    if (from > asked) throw std::runtime_error("it did not drive");
    if (http && http->answer().value_or(test::Answer{}).status != 200) {
      throw std::runtime_error("the stop was refused");
    }
    return took;
  }

 private:
  void get_ready() {
    const Json soon = {{"valid_for_s", 5}};
    const auto end = base::steady_now() + 60s;
    Json mode = soon;
    mode["mode"] = "MANUAL";
    while (call("POST", "/vehicle/estop/reset", soon) != 200 ||
           call("POST", "/vehicle/arm", soon) != 200 || call("PUT", "/vehicle/mode", mode) != 200) {
      if (base::steady_now() > end) throw std::runtime_error("not ready within 60 s: " + said_);
      std::this_thread::sleep_for(50ms);
    }
  }

  /// By hand, until the base is told to move. @return when
  base::Time drive() {
    const base::Time begin = base::steady_now();
    // A stick acts only after it was seen let go.
    for (int i = 0; bus_.moving() < begin; ++i) {
      if (base::steady_now() - begin > 60s) throw std::runtime_error("it does not drive");
      if (i % 10 == 0) {
        say({{"drive", {{"speed_mps", 0}, {"yaw_rate_dps", 0}, {"deadman", false}}}});
        std::this_thread::sleep_for(40ms);
      }
      keep_driving();
      std::this_thread::sleep_for(20ms);
    }
    return bus_.moving();
  }

  void keep_driving() {
    say({{"drive",
          {{"speed_mps", 0.3}, {"yaw_rate_dps", 0}, {"deadman", true}, {"valid_for_s", 5}}}});
  }

  void say(const Json& message) { stream_.send_frame(1, message.dump()); }

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

  Bus bus_;
  std::uint16_t port_;
  test::Client stream_;
  std::string said_;
  std::mt19937 random_{1};
  std::uniform_int_distribution<int> anywhere_{0, 20'000};
  std::uniform_int_distribution<int> seen_{0, 500};
};

double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  const std::string way = argc == 5 ? argv[4] : "";
  if (way != "http" && way != "stream" && way != "key") {
    std::fputs("usage: roverd-stop PATH PORT COUNT http|stream|key\n", stderr);
    return 2;
  }
  try {
    before_others();
    Stopper stopper(argv[1], static_cast<std::uint16_t>(std::atoi(argv[2])));
    std::vector<double> took_ms;
    for (int i = 0; i < std::atoi(argv[3]); ++i) {
      const base::Duration took =
          way == "key" ? stopper.wait_for_key() : stopper.stop_once(way == "stream");
      took_ms.push_back(1e3 * base::seconds(took));
    }
    std::sort(took_ms.begin(), took_ms.end());
    std::printf("{\"stops\":%zu,\"p50_ms\":%.3f,\"p99_ms\":%.3f,\"max_ms\":%.3f}\n", took_ms.size(),
                at_share(took_ms, 0.5), at_share(took_ms, 0.99), took_ms.back());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roverd-stop: %s\n", error.what());
    return 1;
  }
  return 0;
}
