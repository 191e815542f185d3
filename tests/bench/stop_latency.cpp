// roverd-stop PATH PORT COUNT http|stream|key: stops a robot that is driven by hand COUNT times,
// and prints how long it took from the first byte of the request to the first frame with a zero
// command on the bus, as one JSON object: stops, p50_ms, p99_ms, max_ms. A stop over HTTP comes
// through a new connection each time, as from a script. With `key` somebody else stops it: asked by
// a line "press", he answers with the moment at which he did, in milliseconds since 1970.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hand.hpp"

namespace {

using namespace roverd;
using namespace std::chrono_literals;
using bench::at_share;

class Stopper {
 public:
  Stopper(const std::string& path, std::uint16_t port) : hand_(path, port, 0.3), port_(port) {}

  /// @return from the key's press, as its page saw it, to the zero on the bus
  base::Duration wait_for_key() {
    hand_.get_ready();
    hand_.drive();
    // Not in the moment in which the page draws that the robot was armed and drives off: that is
    // when nobody presses yet. Anywhere in its ordinary work, whatever that is just then.
    const auto ready = base::steady_now() + std::chrono::milliseconds(300 + seen_(random_));
    while (base::steady_now() < ready) {
      hand_.keep_driving();
      std::this_thread::sleep_for(20ms);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(anywhere_(random_)));
    hand_.bus.look_for_zero();
    const base::Time asked = base::steady_now();
    std::puts("press");
    std::fflush(stdout);
    double pressed_ms = 0.0;
    if (!(std::cin >> pressed_ms)) throw std::runtime_error("nobody presses");
    while (hand_.bus.zero() < asked) {
      if (base::steady_now() - asked > 10s) throw std::runtime_error("no zero within 10 s");
      std::this_thread::sleep_for(200us);
    }
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    const base::Duration ago = base::steady_now() - hand_.bus.zero();
    return std::chrono::duration_cast<base::Duration>(since_epoch) - ago -
           base::from_seconds(pressed_ms / 1e3);
  }

  /// @return from the request's first byte to the zero on the bus
  base::Duration stop_once(bool by_stream) {
    hand_.get_ready();
    const base::Time from = hand_.drive();
    std::this_thread::sleep_for(std::chrono::microseconds(anywhere_(random_)));
    hand_.bus.look_for_zero();
    const base::Time asked = base::steady_now();
    std::optional<test::Client> http;
    if (by_stream) {
      hand_.say({{"estop", true}});
    } else {
      http.emplace(port_);
      http->send("POST /api/v1/vehicle/estop HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
    while (hand_.bus.zero() < asked) {
      if (base::steady_now() - asked > 10s) throw std::runtime_error("no zero within 10 s");
      std::this_thread::sleep_for(200us);
    }
    const base::Duration took = hand_.bus.zero() - asked;
    if (from > asked) throw std::runtime_error("it did not drive");
    if (http && http->answer().value_or(test::Answer{}).status != 200) {
      throw std::runtime_error("the stop was refused");
    }
    return took;
  }

 private:
  bench::Hand hand_;
  std::uint16_t port_;
  std::mt19937 random_{1};
  std::uniform_int_distribution<int> anywhere_{0, 20'000};
  std::uniform_int_distribution<int> seen_{0, 500};
};

}  // namespace

int main(int argc, char** argv) {
  const std::string way = argc == 5 ? argv[4] : "";
  if (way != "http" && way != "stream" && way != "key") {
    std::fputs("usage: roverd-stop PATH PORT COUNT http|stream|key\n", stderr);
    return 2;
  }
  try {
    bench::before_others();
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
