// How fast a Bunker's frames become values. A bus of 1 Mbit/s carries at most about 8,000 a second.

#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include <benchmark/benchmark.h>

#include "bunker/codec.hpp"
#include "bunker/driver.hpp"
#include "bunker/plausible.hpp"
#include "bunker/v1.hpp"
#include "link/memory.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};
}  // namespace

// Not inlined: GCC would see free() end what operator new began, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace {

using namespace roverd;

/// What a base says in 200 ms, in the mix of its periods; some of it broken.
std::vector<base::CanFrame> bus() {
  using namespace bunker;
  std::vector<base::CanFrame> out;
  for (int i = 0; i < 10; ++i) {
    out.push_back(encode(MotionState{{.linear_mps = 0.731, .angular_radps = -0.052}}));
    out.push_back(encode(Odometer{12345 + i, -12345 - i}));
    out.push_back(encode(RadioFrame{.switches_raw = 0xAA, .count = static_cast<std::uint8_t>(i)}));
    for (const std::uint8_t motor : {std::uint8_t{1}, std::uint8_t{2}}) {
      out.push_back(encode(ActuatorFast{motor, 1234, 5.7, i}));
      out.push_back(encode(ActuatorSlow{motor, 49.1, 38, 41, 0x40}));
    }
    out.push_back(encode(LightState{}));
  }
  out.push_back(encode(SystemState{0, 1, 48.7, 6, 17}));
  out.push_back(encode(Battery{80, 99, 54.0, -12.3, 31.5}));
  out.push_back(encode(BatteryAlarms{}));
  out.push_back(v1::encode(v1::SystemState{0, 1, 24.5, 0, 3}));
  out.back().data[7] ^= 1U;
  out.push_back(out.front());
  out.back().len = 7;
  return out;
}

void BM_DecodeFrames(benchmark::State& state) {
  const auto frames = bus();
  const std::uint64_t before = allocations.load();
  for (auto _ : state) {
    for (const base::CanFrame& f : frames) {
      if (bunker::v1::is_known(f.id)) {
        auto decoded = bunker::v1::decode(f);
        benchmark::DoNotOptimize(decoded);
        auto bad = bunker::impossible(decoded.message, 4.0);
        benchmark::DoNotOptimize(bad);
      } else {
        auto decoded = bunker::decode(f);
        benchmark::DoNotOptimize(decoded);
        auto bad = bunker::impossible(decoded.message, 4.0);
        benchmark::DoNotOptimize(bad);
      }
    }
  }
  state.counters["allocations"] = static_cast<double>(allocations.load() - before);
  state.SetItemsProcessed(static_cast<std::int64_t>(frames.size()) * state.iterations());
}
BENCHMARK(BM_DecodeFrames);

/// The same frames through the whole driver, gate and measurements included.
void BM_DriverHearsFrames(benchmark::State& state) {
  const auto frames = bus();
  auto wire = link::memory_frame_pair(frames.size());
  auto* ours = wire.a.get();
  if (!wire.b->open()) return state.SkipWithError("the memory link does not open");
  bunker::Driver driver(
      "bunker", {},
      [&]() -> base::Result<std::unique_ptr<link::FrameLink>> { return std::move(wire.a); },
      [](const base::Measurement& m) { benchmark::DoNotOptimize(&m); });
  base::Time now{};
  driver.start(now);
  for (auto _ : state) {
    for (const base::CanFrame& f : frames) wire.b->send(f);
    now += std::chrono::milliseconds(200);
    ours->deliver(now);
    driver.tick(now);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(frames.size()) * state.iterations());
}
BENCHMARK(BM_DriverHearsFrames);

}  // namespace
