// Whole recordings to maps, one thread. Needs the recordings.
//   times_real_time: the recording's duration over the processor's; error_percent: the worst pose's
//   distance from the reference over the length of the way.

#include <benchmark/benchmark.h>

#include "recorded_drive.hpp"

namespace {

using namespace roverd;

void map_it(benchmark::State& state, const char* name) {
  const auto path = tests::real_data_path(name);
  if (!std::filesystem::is_regular_file(path)) {
    state.SkipWithError("no recording");
    return;
  }
  const tests::RecordedDrive drive(path);
  tests::RecordedDrive::Error error;
  for (auto _ : state) {
    nav::mapping::Mapper mapper;
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      if (!mapper.add(drive.scans[i], drive.odometry[i])) state.SkipWithError("refused");
    }
    mapper.finish();
    error = drive.error_of(mapper.path());
    state.counters["loops"] = static_cast<double>(mapper.counts().loops);
  }
  state.counters["times_real_time"] =
      benchmark::Counter(drive.time_s, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["error_rms_m"] = error.rms_m;
  state.counters["error_percent"] = 100.0 * error.worst_m / drive.length_m;
}
BENCHMARK_CAPTURE(map_it, office, "sensors/carmen/intel-corrected.log.gz")
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(map_it, corridor, "sensors/carmen/freiburg-079-corrected.log.gz")
    ->Unit(benchmark::kSecond);

}  // namespace
