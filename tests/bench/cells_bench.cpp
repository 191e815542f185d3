// One lidar scan laid on another, from 1 m and 10 degrees beside; one thread.
//   A VLP-16 gives ten turns a second: 100 ms for all that is made of one. Needs the recordings.

#include <fstream>

#include <benchmark/benchmark.h>

#include "nav/cells/align.hpp"
#include "nav/cells/pcd.hpp"
#include "ply.hpp"
#include "real_data.hpp"

namespace {

using namespace roverd;
using namespace roverd::nav::cells;

Cloud scan(const char* name) {
  return tests::ply_points(tests::real_data_path("sensors/clouds") / name, 4);
}

Relief relief(const Cloud& cloud) {
  CellMap map;
  map.add(cloud);
  return Relief(map);
}

/// From raw points: what is done once for a map, and for every scan.
void BM_CellsPrepare(benchmark::State& state) {
  const Cloud cloud = scan("pair-source.ply");
  if (cloud.empty()) state.SkipWithError("no recording");
  for (auto _ : state) benchmark::DoNotOptimize(relief(cloud).surfels().data());
}
BENCHMARK(BM_CellsPrepare)->Unit(benchmark::kMillisecond);

/// With the source's preparation: from its points to the verdict.
void BM_CellsAlign(benchmark::State& state) {
  const Relief target = relief(scan("pair-target.ply"));
  const Cloud cloud = scan("pair-source.ply");
  if (cloud.empty()) state.SkipWithError("no recording");
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.linear() = Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  start.translation() = Eigen::Vector3d(1.5, 0.1, 0.0);
  int good = 0;
  for (auto _ : state) {
    good += align(relief(cloud), target, start).verdict == Verdict::Good ? 1 : 0;
  }
  state.counters["good"] = good / double(std::max<std::int64_t>(state.iterations(), 1));
}
BENCHMARK(BM_CellsAlign)->Unit(benchmark::kMillisecond);

/// 182,292 points of 307,200, binary_compressed.
void BM_PcdRead(benchmark::State& state) {
  const auto file =
      tests::read_file(tests::real_data_path("sensors/clouds/table-organised-640x480.pcd"));
  if (file.empty()) state.SkipWithError("no recording");
  for (auto _ : state) benchmark::DoNotOptimize(read_pcd_cloud(file));
}
BENCHMARK(BM_PcdRead)->Unit(benchmark::kMillisecond);

}  // namespace
