// What a way around costs, and how good it is: 20 x 20 m at 5 cm, one core.
//
//   around_bench                                   # the curve over corridors and things
//   around_bench --benchmark_filter=worlds         # p50, p99, solved, length of 1,000 worlds;
//                                                  # cars judged in a third of them: minutes

#include <algorithm>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "unit/around/cars.hpp"
#include "unit/around/worlds.hpp"

namespace roverd::nav::around {
namespace {

/// Of this thread: others share the machine.
double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double part(std::vector<double>& v, double p) {
  if (v.empty()) return 0.0;
  std::sort(v.begin(), v.end());
  return v[std::min(v.size() - 1, static_cast<std::size_t>(p * static_cast<double>(v.size())))];
}

Question question(double half_m, bool car) {
  if (car) return tests::car_along_x(half_m);
  Question q = tests::along_x(half_m);
  q.rejoin_within_m = 8.0;
  return q;
}

/// Corridor (whole width) and things.
void grows(benchmark::State& state) {
  const double half = 0.5 * static_cast<double>(state.range(0));
  const bool car = state.range(2) != 0;
  Planner planner;
  Answer a;
  std::vector<tests::Scene> scenes(20);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (state.range(1) <= 100) {
      tests::strew(scenes[i], 100 + i, static_cast<int>(state.range(1)), half);
    } else {
      // Single cells all over, one wall on the route: more than fit beside each other.
      tests::strew(scenes[i], 100 + i, 1, half);
      std::mt19937_64 random(i);
      std::uniform_int_distribution<std::int32_t> cell(-200, 199);
      for (std::int64_t k = 0; k < state.range(1); ++k) {
        const std::int32_t x = cell(random);
        const std::int32_t y = cell(random);
        if (std::abs(y) > 30 && (x % 40 + 40) % 40 < 20)
          scenes[i].set(x, y, sense::Known::Occupied);
      }
    }
  }
  const Question q = question(half, car);
  std::vector<double> ms;
  std::size_t ways = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    const double t = cpu_ms();
    if (!planner.plan(scenes[i++ % scenes.size()].patch, q, a)) state.SkipWithError("refused");
    ms.push_back(cpu_ms() - t);
    if (a.found != Found::None) ++ways;
  }
  state.counters["ways"] = static_cast<double>(ways) / static_cast<double>(ms.size());
  state.counters["p99_ms"] = part(ms, 0.99);
}

/// 1,000 worlds as the long test's, other seeds.
void worlds(benchmark::State& state) {
  const bool car = state.range(0) != 0;
  Planner planner;
  Answer a;
  for (auto _ : state) {
    tests::Reference reference(question(5.0, false).body, 0.3);
    tests::CarReference cars(question(5.0, true).body, 4.0, 0.3);
    std::vector<double> ms;
    std::vector<double> ratios;
    double solvable = 0.0;
    double solved = 0.0;
    for (std::uint64_t seed = 10'001; seed <= 11'000; ++seed) {
      constexpr std::array<double, 5> kHalves{1.5, 2.0, 3.0, 5.0, 10.0};
      constexpr std::array<int, 5> kThings{1, 3, 8, 16, 30};
      tests::Scene s;
      const double half = kHalves[seed % 5] + (car ? 1.0 : 0.0);
      tests::strew(s, seed, kThings[(seed / 5) % 5], half);
      const Question q = question(half, car);
      const double t = cpu_ms();
      if (!planner.plan(s.patch, q, a)) state.SkipWithError("refused");
      ms.push_back(cpu_ms() - t);
      if (a.found == Found::Clear) continue;
      // The reference takes half a second for a car.
      if (car && seed % 3 != 0) continue;
      const double shortest = car ? cars.shortest_m(s, half) : reference.shortest_m(s, half);
      if (!std::isfinite(shortest)) continue;
      solvable += 1.0;
      // A car comes to the window's end, if it does not join the route before.
      const bool passes = a.found == Found::Way || (car && a.found == Found::Part);
      if (!passes) continue;
      solved += 1.0;
      double rest = car ? tests::CarReference::kGoal_m : tests::kGoal_m;
      rest -= a.found == Found::Way ? a.rejoin_m - q.here_m : rest;
      ratios.push_back((a.length_m + (car ? std::max(0.0, rest) : rest)) / shortest);
    }
    state.counters["p50_ms"] = part(ms, 0.5);
    state.counters["p99_ms"] = part(ms, 0.99);
    state.counters["max_ms"] = part(ms, 1.0);
    state.counters["solvable"] = solvable;
    state.counters["solved"] = solved;
    state.counters["length_p50"] = part(ratios, 0.5);
    state.counters["length_max"] = part(ratios, 1.0);
  }
}

BENCHMARK(grows)
    ->ArgNames({"corridor", "things", "car"})
    ->ArgsProduct({{2, 5, 10, 30}, {1, 10, 100, 1000, 10'000}, {0}})
    ->ArgsProduct({{10}, {1, 10, 100}, {1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(worlds)->ArgName("car")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace roverd::nav::around
