// What TLS adds to a delivered WebSocket message: CPU of the web thread with it, over that without.
//
//   hub ─ timer 20 Hz ─ 50 sessions ─▶ 50 sockets, plain or TLS 1.3 ─▶ one thread that only reads
//
// Both ways in one run, crossed, because the machine's pace changes.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>

#include "api/net_house.hpp"

namespace {

using namespace roverd;

constexpr int kClients = 50;
constexpr double kRate_hz = 20.0;
constexpr std::size_t kBytes = 1024;
constexpr auto kTime = std::chrono::seconds(4);

double used_s() {
  clockid_t clock{};
  timespec used{};
  ::pthread_getcpuclockid(::pthread_self(), &clock);
  ::clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

net::Handlers handlers(net::Hub*& hub) {
  net::Handlers h;
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  h.on_client = [&hub](net::ClientId client, const net::Request&) {
    hub->subscribe(client, {{"state", kRate_hz}});
  };
  h.on_text = [](net::ClientId, base::Time, std::string_view) {};
  h.on_gone = [](net::ClientId) {};
  return h;
}

/// Takes in whatever comes, unopened.
class Reader {
 public:
  explicit Reader(const std::vector<std::unique_ptr<test::Client>>& clients) {
    for (const auto& client : clients) ready_.push_back({client->handle(), POLLIN, 0});
    thread_ = std::thread([this] {
      std::array<char, 16 * 1024> bytes;
      while (!stop_) {
        ::poll(ready_.data(), ready_.size(), 50);
        for (const auto& one : ready_) {
          if (one.revents != 0) ::recv(one.fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
        }
      }
    });
  }
  ~Reader() {
    stop_ = true;
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  std::vector<pollfd> ready_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// CPU of the web thread for one delivered message, seconds.
double cost_s(bool tls) {
  tls ? ::setenv("ROVERD_TEST_TLS", "1.3", 1) : ::unsetenv("ROVERD_TEST_TLS");
  net::Hub* hub = nullptr;
  test::NetHouse house({}, handlers(hub), [&hub](net::Hub& made) {
    hub = &made;
    made.add_sampled_topic("state", [](std::uint64_t seq) {
      return std::optional<std::string>(std::string(kBytes, static_cast<char>('a' + seq % 26)));
    });
  });
  std::vector<std::unique_ptr<test::Client>> clients;
  for (int i = 0; i < kClients; ++i) {
    clients.push_back(std::make_unique<test::Client>(house.port()));
    if (clients.back()->upgrade("/stream") != 101) throw std::runtime_error("no WebSocket");
  }
  const Reader reader(clients);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto count = [hub] { return hub->delivered(); };
  const auto before = house.ask(count);
  const double begin_s = house.ask(used_s);
  std::this_thread::sleep_for(kTime);
  const double spent_s = house.ask(used_s) - begin_s;
  const auto messages = static_cast<double>(house.ask(count) - before);
  if (messages < 0.95 * kClients * kRate_hz * std::chrono::duration<double>(kTime).count()) {
    throw std::runtime_error("only " + std::to_string(messages) + " messages delivered");
  }
  return spent_s / messages;
}

void delivered(benchmark::State& state) {
  for (auto _ : state) {
    const double plain_s = cost_s(false);
    const double tls_s = cost_s(true);
    const double tls_again_s = cost_s(true);
    const double plain_again_s = cost_s(false);
    state.counters["us_plain"] = 1e6 * (plain_s + plain_again_s) / 2;
    state.counters["us_tls"] = 1e6 * (tls_s + tls_again_s) / 2;
    state.counters["ratio"] = (tls_s + tls_again_s) / (plain_s + plain_again_s);
  }
}
BENCHMARK(delivered)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
