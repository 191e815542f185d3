// A scan of an LMS1xx from its bytes to what was seen. At 50 Hz, 2 % of a core is 400 us a scan.

#include <benchmark/benchmark.h>

#include "sick/scan.hpp"
#include "sick/sight.hpp"

namespace {

using namespace roverd;

sick::Scan lms(std::size_t beams) {
  sick::Scan s;
  s.scan_frequency_chz = beams > 600 ? 2500 : 5000;
  const auto step = static_cast<std::uint16_t>(beams > 600 ? 2500 : 5000);
  sick::Channel distance{"DIST1", 16, 1.0F, 0.0F, -450'000, step, {}};
  sick::Channel remission{"RSSI1", 16, 1.0F, 0.0F, -450'000, step, {}};
  for (std::size_t i = 0; i < beams; ++i) {
    distance.values.push_back(static_cast<std::uint16_t>(500 + i * 7919 % 19'000));
    remission.values.push_back(static_cast<std::uint16_t>(i * 31 % 1000));
  }
  s.channels = {distance, remission};
  return s;
}

void scan_to_sight(benchmark::State& state) {
  const auto dialect = state.range(0) == 0 ? sick::Dialect::A : sick::Dialect::B;
  const auto bytes = encode(lms(static_cast<std::size_t>(state.range(1))), dialect);
  sick::Framer framer;
  std::size_t points = 0;
  for (auto _ : state) {
    framer.feed(bytes, [&](const sick::Telegram& t) {
      const auto scan = sick::decode_scan(t);
      points += sick::to_sight(*scan, {})->points.size();
    });
  }
  benchmark::DoNotOptimize(points);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(scan_to_sight)->ArgNames({"binary", "beams"})->ArgsProduct({{0, 1}, {541, 1081}});

}  // namespace
