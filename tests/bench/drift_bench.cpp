// Fixed solutions that run away, a hundred of each speed (tests/loop/drifts.hpp): how far the robot
// is led astray, and how long after the lie has left what an honest fix errs by it is found; and a
// hundred honest drives on ground that slides.

#include <benchmark/benchmark.h>

#include "drifts.hpp"
#include "figures.hpp"

namespace roverd::loop {
namespace {

constexpr std::uint64_t kDrives = 100;

void runs_away(benchmark::State& state) {
  const double least_mps = 0.001 * static_cast<double>(state.range(0));
  const double most_mps = 0.001 * static_cast<double>(state.range(1));
  for (auto _ : state) {
    std::vector<double> astray_m, found_s;
    for (std::uint64_t i = 0; i < kDrives; ++i) {
      const DriftLie lie = drift_lie(i, least_mps, most_mps);
      const DriftSeen seen = DriftDrive(1000 + i, i, lie).run();
      astray_m.push_back(seen.astray_m);
      if (seen.found_s >= 0.0) found_s.push_back(seen.found_s - lie.hidden_s());
    }
    const auto over = [](const std::vector<double>& all, double limit) {
      return static_cast<double>(
          std::count_if(all.begin(), all.end(), [&](double v) { return v > limit; }));
    };
    state.counters["astray_worst_m"] = largest(astray_m);
    state.counters["astray_over_half_m"] = over(astray_m, 0.5);
    state.counters["found"] = static_cast<double>(found_s.size());
    state.counters["found_median_s"] = quantile(found_s, 0.5);
    state.counters["found_worst_s"] = largest(found_s);
    state.counters["found_after_3_s"] = over(found_s, 3.0);
  }
}
BENCHMARK(runs_away)
    ->ArgNames({"least_mmps", "most_mmps"})
    ->Args({30, 50})
    ->Args({50, 70})
    ->Args({70, 100})
    ->Args({100, 800})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

void honest(benchmark::State& state) {
  for (auto _ : state) {
    double accused = 0.0;
    double arrived = 0.0;
    for (std::uint64_t i = 0; i < kDrives; ++i) {
      DriftDrive drive(5000 + i, i, {});
      arrived += drive.run().arrived ? 1.0 : 0.0;
      accused += drive.accusations > 0 ? 1.0 : 0.0;
    }
    state.counters["accused"] = accused;
    state.counters["arrived"] = arrived;
  }
}
BENCHMARK(honest)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace roverd::loop
