// A recorded minute of a Bunker with receiver and inertial unit through drivers and estimator.

#include <filesystem>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "replay/run.hpp"
#include "unit/replay/recorder.hpp"

namespace {

using namespace roverd;

/// times_real_time: recorded seconds a second.
void BM_Replay(benchmark::State& state) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("roverd-replay-bench." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const tests::Drive drive = tests::record_drive(60.0);
  const ReplayPlan plan{{tests::write_file(folder / "bus.log", drive.bus),
                         tests::write_file(folder / "gnss.raw", drive.receiver),
                         tests::write_file(folder / "mti.raw", drive.unit)},
                        0.1};
  double played_s = 0.0;
  for (auto _ : state) {
    std::size_t text = 0;
    const auto report =
        run_replay(plan, {}, [&](const ReplayPose& p) { text += csv_line(p).size(); });
    if (!report) state.SkipWithError(report.error().detail.c_str());
    if (report) played_s += report->duration_s;
    benchmark::DoNotOptimize(text);
  }
  std::filesystem::remove_all(folder);
  state.counters["times_real_time"] = benchmark::Counter(played_s, benchmark::Counter::kIsRate);
}
BENCHMARK(BM_Replay)->Unit(benchmark::kMillisecond);

}  // namespace
