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

/// The velocity tells of the drift as well: only odometry, gyro and what turns can contradict.
void runs_away_velocity_too(benchmark::State& state) {
  const double least_mps = 0.001 * static_cast<double>(state.range(0));
  const double most_mps = 0.001 * static_cast<double>(state.range(1));
  for (auto _ : state) {
    std::vector<double> astray_m, found_s;
    double accused = 0.0;
    double held = 0.0;
    double arrived = 0.0;
    double dishonest_m = 0.0;
    double dishonest = 0.0;
    for (std::uint64_t i = 0; i < kDrives; ++i) {
      DriftLie lie = drift_lie(i, least_mps, most_mps);
      lie.velocity_too = true;
      DriftDrive drive(7000 + i, i, lie);
      const DriftSeen seen = drive.run();
      astray_m.push_back(seen.astray_m);
      if (seen.found_s >= 0.0) found_s.push_back(seen.found_s - lie.hidden_s());
      accused += drive.accusations > 0 ? 1.0 : 0.0;
      held += seen.held ? 1.0 : 0.0;
      arrived += seen.arrived ? 1.0 : 0.0;
      dishonest_m = std::max(dishonest_m, seen.dishonest_m);
      dishonest += seen.dishonest_m > 0.0 ? 1.0 : 0.0;
    }
    state.counters["astray_median_m"] = quantile(astray_m, 0.5);
    state.counters["astray_worst_m"] = largest(astray_m);
    state.counters["astray_over_half_m"] = static_cast<double>(
        std::count_if(astray_m.begin(), astray_m.end(), [](double m) { return m > 0.5; }));
    state.counters["accused"] = accused;
    state.counters["found"] = static_cast<double>(found_s.size());
    state.counters["found_median_s"] = found_s.empty() ? 0.0 : quantile(found_s, 0.5);
    state.counters["found_worst_s"] = found_s.empty() ? 0.0 : largest(found_s);
    state.counters["found_after_3_s"] = static_cast<double>(
        std::count_if(found_s.begin(), found_s.end(), [](double s) { return s > 3.0; }));
    state.counters["held"] = held;
    state.counters["arrived"] = arrived;
    state.counters["dishonest"] = dishonest;
    state.counters["dishonest_worst_m"] = dishonest_m;
  }
}
BENCHMARK(runs_away_velocity_too)
    ->ArgNames({"least_mmps", "most_mmps"})
    ->Args({30, 100})
    ->Args({100, 300})
    ->Args({300, 800})
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
