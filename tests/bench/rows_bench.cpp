// A robot between rows: 1 km in ten blocks, straight and with bends of 15 m, 30 % gaps up to 2 m,
// leaves ±15 cm, weeds, slip. Counters are what counts here, not the time:
//
//   rms_m, worst_m    off the middle        end_m    farthest stop from a true end
//   done              blocks of ten that were driven to their end, none invented
//   touched           plants                nees     (error/sigma)² of what it says of itself

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "unit/rows/field.hpp"

namespace {

using namespace roverd::nav;
using namespace roverd::nav::rows::tests;

BlockParams block_of(std::uint64_t seed) {
  BlockParams p;
  p.seed = seed;
  switch (seed % 4) {
    case 1:
      p.bends = {{100.0, 0.0}};
      break;
    case 2:
      p.bends = {{30.0, 0.0}, {20.0, 1.0 / 15.0}, {50.0, 0.0}};
      break;
    case 3:
      p.bends = {{20.0, 0.0}, {30.0, -1.0 / 25.0}, {20.0, 1.0 / 15.0}, {30.0, 0.0}};
      break;
    default:
      p.bends = {{100.0, 1.0 / 80.0}};
      break;
  }
  return p;
}

void BM_RowKilometre(benchmark::State& state, rows::Seeing seeing) {
  double square = 0.0;
  double driven_m = 0.0;
  double worst_m = 0.0;
  double end_m = 0.0;
  double nees = 0.0;
  int done = 0;
  std::size_t touched = 0;
  for (auto _ : state) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Block block(block_of(seed));
      DriveSetup setup;
      setup.seed = seed;
      setup.order.seeing = seeing;
      setup.crab = seed % 2 == 0 ? 0.02 : -0.02;
      const DriveTold t = drive_row(block, setup);
      const double off_m = std::abs(t.stopped_m - block.end_m());
      square += t.rms_m * t.rms_m * t.driven_m;
      driven_m += t.driven_m;
      worst_m = std::max(worst_m, t.worst_m);
      end_m = std::max(end_m, off_m);
      if (t.done && off_m <= 0.5) ++done;
      touched += t.touched;
      nees += 0.1 * t.nees;
    }
  }
  state.counters["rms_m"] = std::sqrt(square / driven_m);
  state.counters["driven_m"] = driven_m;
  state.counters["worst_m"] = worst_m;
  state.counters["end_m"] = end_m;
  state.counters["done"] = done;
  state.counters["touched"] = static_cast<double>(touched);
  state.counters["nees"] = nees;
}
BENCHMARK_CAPTURE(BM_RowKilometre, line, rows::Seeing::Line)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(BM_RowKilometre, rays, rows::Seeing::Rays)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
