// A whole bus of 1 Mbit/s (about 8,000 frames a second), paced as a bus would, through the local
// CAN socket into the driver: on a thread of its own as in the program, its measurements taken 50
// times a second. Counters: lost frames, the device thread's share of a core, and how long a frame
// takes from its sending to the inbox of the control loop.

#include <algorithm>
#include <atomic>
#include <ctime>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <unistd.h>

#include "base/inbox.hpp"
#include "bunker/driver.hpp"
#include "link/cansock.hpp"

namespace {

using namespace roverd;
namespace asio = boost::asio;

constexpr int kFramesPerMs = 8;
constexpr auto kRun = std::chrono::seconds(5);
constexpr std::size_t kInbox = 4096;

double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// The mix of a base's frames; every fourth one carries its number, which a measurement tells.
class Traffic {
 public:
  base::CanFrame next() {
    using namespace bunker;
    const auto n = number_++;
    switch (n % 8) {
      case 0:
        return encode(MotionState{{.linear_mps = 0.731, .angular_radps = -0.052}});
      case 1:
        return encode(RadioFrame{.switches_raw = 0xAA, .count = static_cast<std::uint8_t>(n / 8)});
      case 2:
      case 6:
        return encode(ActuatorFast{1, 1234, 5.7, static_cast<std::int32_t>(n)});
      case 3:
        return encode(
            Odometer{static_cast<std::int32_t>(n / 64), static_cast<std::int32_t>(n / 64)});
      case 4:
        return encode(ActuatorSlow{2, 49.1, 38, 41, 0x40});
      case 5:
        return encode(SystemState{0, 1, 48.7, 0, static_cast<std::uint8_t>(n / 8)});
      default:
        return encode(Battery{80, 99, 54.0, -12.3, 31.5});
    }
  }
  std::size_t sent() const { return number_; }

 private:
  std::size_t number_ = 0;
};

/// The driver on its thread, as Supervisor has it.
class Side {
 public:
  Side(const std::string& path, std::vector<std::atomic<base::Time::rep>>& sent_at)
      : sent_at_(sent_at),
        driver_(
            "bunker", {},
            [this, path]() -> base::Result<std::unique_ptr<link::FrameLink>> {
              return std::make_unique<link::CanSocketLink>(io_, path);
            },
            [this](const base::Measurement& m) { put(m); }) {
    late_ns.reserve(sent_at.size());
    thread_ = std::thread([this] {
      driver_.start(base::steady_now());
      tick();
      const double before_s = thread_cpu_s();
      io_.run();
      cpu_s = thread_cpu_s() - before_s;
      received = driver_.status(base::steady_now()).received;
      driver_.stop(base::steady_now());
    });
  }
  void stop() {
    io_.stop();
    thread_.join();
  }

  base::Inbox<base::Measurement> inbox{kInbox};
  std::vector<base::Time::rep> late_ns;
  double cpu_s = 0.0;
  std::uint64_t received = 0;

 private:
  void put(const base::Measurement& m) {
    const auto* motor = std::get_if<base::MotorState>(&m);
    inbox.put(m);
    if (motor == nullptr || motor->motor != 1 || !motor->encoder_pulses) return;
    const auto n = static_cast<std::size_t>(*motor->encoder_pulses);
    if (n >= sent_at_.size() || late_ns.size() == late_ns.capacity()) return;
    late_ns.push_back(base::steady_now().time_since_epoch().count() - sent_at_[n].load());
  }
  void tick() {
    timer_.expires_after(std::chrono::milliseconds(10));
    timer_.async_wait([this](const boost::system::error_code& ec) {
      if (ec) return;
      driver_.tick(base::steady_now());
      tick();
    });
  }

  std::vector<std::atomic<base::Time::rep>>& sent_at_;
  asio::io_context io_{1};
  asio::steady_timer timer_{io_};
  bunker::Driver driver_;
  std::thread thread_;
};

double percentile_ms(std::vector<base::Time::rep>& all, double share) {
  if (all.empty()) return 1e9;
  const auto at =
      all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  return static_cast<double>(*at) * 1e-6;
}

void BM_FullBus(benchmark::State& state) {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("roverd-bench-" + std::to_string(::getpid()) + ".can"))
                               .string();
  constexpr auto kMs = std::chrono::milliseconds(kRun).count();
  for (auto _ : state) {
    asio::io_context io(1);
    link::CanSocketServer bus(io, path);
    if (!bus.open()) return state.SkipWithError("the CAN socket does not open");
    std::vector<std::atomic<base::Time::rep>> sent_at(static_cast<std::size_t>(kMs * kFramesPerMs));
    Side side(path, sent_at);
    while (bus.clients() == 0) io.run_one();

    Traffic traffic;
    std::vector<base::Measurement> batch;
    auto due = std::chrono::steady_clock::now();
    for (long ms = 0; ms < kMs; ++ms) {
      due += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);
      for (int i = 0; i < kFramesPerMs; ++i) {
        const std::size_t n = traffic.sent();
        const base::CanFrame frame = traffic.next();
        sent_at[n].store(base::steady_now().time_since_epoch().count());
        bus.send(frame);
      }
      if (ms % 20 != 0) continue;
      batch.clear();
      side.inbox.try_take(batch);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    side.stop();
    const auto lost = static_cast<double>(traffic.sent()) - static_cast<double>(side.received);
    state.counters["lost"] = lost;
    state.counters["cpu_pct"] = 100.0 * side.cpu_s / base::seconds(kRun);
    state.counters["p99_ms"] = percentile_ms(side.late_ns, 0.99);
    state.counters["p50_ms"] = percentile_ms(side.late_ns, 0.5);
    state.counters["frames_per_s"] = static_cast<double>(traffic.sent()) / base::seconds(kRun);
  }
}
BENCHMARK(BM_FullBus)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
