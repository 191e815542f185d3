// A second of a VLP-16, from datagrams to turns: how much of a core it takes is the time of one
// iteration in seconds.

#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "velodyne/revolutions.hpp"

namespace {

using namespace roverd;

/// As many packets as a second has, at 600 turns a minute, of a scene without edges.
std::vector<std::vector<std::uint8_t>> second_of(velodyne::ReturnMode mode) {
  const bool dual = mode == velodyne::ReturnMode::Dual;
  const unsigned packets = dual ? 1507 : 753;
  std::vector<std::vector<std::uint8_t>> out;
  unsigned firing = 0;
  for (unsigned i = 0; i < packets; ++i) {
    velodyne::Packet p;
    p.mode = mode;
    p.stamp_us = i * (dual ? 664U : 1327U);
    for (unsigned b = 0; b < velodyne::kBlocks; ++b) {
      p.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(firing * 40U % velodyne::kTurn_cdeg);
      if (!dual || b % 2 == 1) ++firing;
      for (unsigned c = 0; c < velodyne::kChannels; ++c) {
        const unsigned further = dual && b % 2 == 0 && c % 8 == 0 ? 500 : 0;
        const unsigned word = c % 5 == 0 ? 0 : 2000 + firing % 900 * 7 + further;
        p.blocks[b].channels[c] = {static_cast<std::uint16_t>(word), 30};
      }
    }
    const auto bytes = velodyne::encode(p);
    out.emplace_back(bytes.begin(), bytes.end());
  }
  return out;
}

void BM_Vlp16Second(benchmark::State& state) {
  const bool dual = state.range(0) != 0;
  const auto packets =
      second_of(dual ? velodyne::ReturnMode::Dual : velodyne::ReturnMode::Strongest);
  std::size_t points = 0;
  for (auto _ : state) {
    velodyne::Revolutions revolutions("bench", {}, [&](const velodyne::Turn& t) {
      points += t.sight->points.size();
      benchmark::DoNotOptimize(t.sight.get());
    });
    base::Time now{std::chrono::hours(1)};
    for (const auto& bytes : packets) {
      now += std::chrono::microseconds(dual ? 664 : 1327);
      revolutions.add(velodyne::decode(bytes).packet, now);
    }
    revolutions.finish();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
}
BENCHMARK(BM_Vlp16Second)->Arg(0)->Arg(1)->ArgName("dual")->Unit(benchmark::kMillisecond);

}  // namespace
