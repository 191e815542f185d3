// Operations on a mission of 100,000 items (limit: 50 ms each), what changed between two of them,
// and files of 100,000 points read (limit: 1 s each).

#include <cmath>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "mission/compare.hpp"
#include "mission/formats.hpp"
#include "mission/operations.hpp"

namespace {

using namespace roverd::mission;

constexpr int kItems = 100'000;

/// A wavy way of one point each 5 cm, 5 km long.
const Plan& long_way() {
  static const Plan plan = [] {
    Plan made;
    made.name = "long way";
    for (int i = 0; i < kItems; ++i) {
      Waypoint waypoint;
      waypoint.at = {58.378 + 4.5e-7 * i, 26.729 + 2e-5 * std::sin(i * 0.01)};
      if (i % 1000 == 0) waypoint.hold_s = 1.0;
      made.items.emplace_back(waypoint);
    }
    return made;
  }();
  return plan;
}

void Operate(benchmark::State& state, const Operation& operation) {
  for (auto _ : state) {
    state.PauseTiming();
    Plan plan = long_way();
    state.ResumeTiming();
    auto done = perform(std::move(plan), operation);
    if (!done) throw std::runtime_error(done.error().detail);
    benchmark::DoNotOptimize(done->plan.items.size());
    state.PauseTiming();
    done = {};
    state.ResumeTiming();
  }
}
BENCHMARK_CAPTURE(Operate, AddWaypoint, AddWaypoint{Waypoint{}, 1})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, RemoveItems, RemoveItems{Numbers{2, 9}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Reverse, Reverse{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Offset, Offset{{3.0, 4.0}, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, ScaleRotate, ScaleRotate{1.1, 30.0, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Mirror, Mirror{30.0, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Simplify, Simplify{0.1, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Densify, Densify{0.04, {}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Operate, Renumber, Renumber{{1, 10}, 500})->Unit(benchmark::kMillisecond);

void Compare(benchmark::State& state) {
  Plan now = long_way();
  std::get<Waypoint>(now.items[kItems / 2]).at.lat += 1e-6;
  for (auto _ : state) benchmark::DoNotOptimize(compare(long_way(), now).changed);
}
BENCHMARK(Compare)->Unit(benchmark::kMillisecond);

void Import(benchmark::State& state, Format format) {
  const std::string text = export_file(long_way(), format).content;
  for (auto _ : state) {
    benchmark::DoNotOptimize(import_file(text, std::nullopt, "x").value().plan.items.size());
  }
}
BENCHMARK_CAPTURE(Import, Plan, Format::Plan)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Waypoints, Format::Waypoints)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Gpx, Format::Gpx)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Kml, Format::Kml)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, GeoJson, Format::GeoJson)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Csv, Format::Csv)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Import, Follower, Format::Follower)->Unit(benchmark::kMillisecond);

}  // namespace
