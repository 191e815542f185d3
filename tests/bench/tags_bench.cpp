// Tags in a picture of 640x480: how long the finder takes, near and far, by what it shrinks the
// picture to look for borders. One core.

#include <benchmark/benchmark.h>

#include "unit/tags/picture.hpp"

namespace {

using namespace roverd::nav::tags;

void BM_Find640x480(benchmark::State& state) {
  Shot shot;
  shot.width = 640;
  shot.height = 480;
  shot.lens = {600.0, 600.0, 320.0, 240.0};
  const double range_m = 0.1 * static_cast<double>(state.range(0));
  const Truth truth{Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                    {0.0, 0.0, range_m}};
  const auto bytes = picture(Cells(5), truth, shot);
  TagParams params;
  params.decimate = static_cast<double>(state.range(1));
  Finder finder;
  std::size_t found = 0;
  for (auto _ : state) {
    const auto tags = finder.find(image_of(bytes, shot), shot.lens, params);
    found += tags ? tags->size() : 0;
  }
  state.counters["found"] = static_cast<double>(found) /
                            static_cast<double>(std::max<std::int64_t>(1, state.iterations()));
}
BENCHMARK(BM_Find640x480)
    ->ArgNames({"range_dm", "decimate"})
    ->Args({5, 1})
    ->Args({20, 1})
    ->Args({40, 1})
    ->Args({20, 2})
    ->Unit(benchmark::kMillisecond);

}  // namespace
