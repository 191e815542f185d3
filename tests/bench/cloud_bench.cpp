// Frames of a camera, from bytes to points.
//   A depth image 640x480 thirty times a second leaves 33 ms for all that is made of it.

#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "cloud/eye.hpp"

namespace {

using namespace roverd;

std::vector<std::uint8_t> depth_image() {
  std::vector<std::uint16_t> pixels;
  for (unsigned v = 0; v < 480; ++v) {
    for (unsigned u = 0; u < 640; ++u) {
      const unsigned depth = (u * 7 + v * 13) % 11 == 0 ? 0 : 900 + u + 2 * v;
      pixels.push_back(static_cast<std::uint16_t>(depth));
    }
  }
  const auto data = cloud::bytes_of(pixels);
  cloud::Header header;
  return cloud::encode(header,
                       cloud::Depth{640, 480, 525.0F, 525.0F, 319.5F, 239.5F, 0.001F, data});
}

/// In the pieces of a socket.
void look(benchmark::State& state, const std::vector<std::uint8_t>& bytes, cloud::Eye& eye) {
  cloud::Decoder decoder(cloud::kMaxPoints);
  std::size_t points = 0;
  for (auto _ : state) {
    for (base::Bytes rest(bytes); !rest.empty();) {
      const base::Bytes part = rest.first(std::min<std::size_t>(4096, rest.size()));
      rest = rest.subspan(part.size());
      decoder.feed(part, [&](const cloud::Frame& frame) {
        base::Sight sight;
        eye.look(frame, sight);
        points += sight.points.size();
        benchmark::DoNotOptimize(sight.points.data());
      });
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
}

void BM_DepthImage(benchmark::State& state) {
  cloud::Params params;
  params.decimate = static_cast<int>(state.range(0));
  cloud::Eye eye(params);
  look(state, depth_image(), eye);
}
BENCHMARK(BM_DepthImage)
    ->ArgName("decimate")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond);

void BM_Cloud(benchmark::State& state) {
  std::vector<float> xyz;
  for (int i = 0; i < state.range(0); ++i) {
    const auto n = static_cast<float>(i % 1000);
    xyz.insert(xyz.end(), {1.0F + n * 0.01F, n * 0.002F - 1.0F, 0.1F});
  }
  const auto data = cloud::bytes_of(xyz);
  cloud::Header header;
  const auto bytes =
      cloud::encode(header, cloud::Cloud{static_cast<std::uint32_t>(state.range(0)), 0.002F, data});
  cloud::Eye eye{cloud::Params{}};
  look(state, bytes, eye);
}
BENCHMARK(BM_Cloud)->ArgName("points")->Arg(10'000)->Arg(300'000)->Unit(benchmark::kMillisecond);

}  // namespace
