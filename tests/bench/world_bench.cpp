// The simulated world: what a ray costs as worlds grow, and a second of each sensor.

#include <numbers>

#include <benchmark/benchmark.h>

#include "sim/world/contact.hpp"
#include "sim/world/random.hpp"
#include "sim/world/sensor.hpp"

namespace {

using namespace roverd::sim::world;

/// Things of the crowded world, as many as wanted.
Scene scene_of(std::int64_t things, bool rough) {
  World world = random_world(1, things > 0 ? RandomKind::Crowded : RandomKind::Static);
  world.things.resize(static_cast<std::size_t>(things));
  world.ground = {};
  if (rough) world.ground.uneven = {{0.05, 0.6}, {0.3, 14.0}};
  return Scene(std::move(world));
}

Pose standing(double) {
  return {};
}

/// Rays as a lidar 0.8 m up casts them, all around, half of them downwards.
void ray(benchmark::State& state) {
  const Scene scene = scene_of(state.range(0), state.range(1) != 0);
  const Moment now = scene.at(0.0);
  std::uint64_t i = 0;
  for (auto _ : state) {
    Draw draw(1, i);
    const double turn = static_cast<double>(i % 1800) * 0.0034906585;
    const double up = kRings_deg[i % 16] * std::numbers::pi / 180.0;
    const Ray beam{{0, 0, 0.8},
                   {std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)}};
    benchmark::DoNotOptimize(scene.cast(beam, 100.0, now, draw));
    ++i;
  }
}
BENCHMARK(ray)
    ->ArgsProduct({{0, 1, 10, 100, 1'000, 10'000}, {0, 1}})
    ->ArgNames({"things", "rough"});

/// "load": share of a core that the sensor's real time takes.
void seconds_of(benchmark::State& state, const char* kind, std::int64_t things, bool rough) {
  const Scene scene = scene_of(things, rough);
  Sensor sensor(usual(kind), 1);
  Sweep out;
  for (auto _ : state) {
    sensor.sweep(scene, standing, {}, out);
    benchmark::DoNotOptimize(out.shots.data());
  }
  const double simulated_s = sensor.next_s();
  state.counters["load"] =
      benchmark::Counter(simulated_s, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.SetItemsProcessed(static_cast<std::int64_t>(out.shots.size()) *
                          static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK_CAPTURE(seconds_of, vlp16_level_100, "vlp16", 100, false);
BENCHMARK_CAPTURE(seconds_of, vlp16_rough_100, "vlp16", 100, true);
BENCHMARK_CAPTURE(seconds_of, vlp16_rough_10000, "vlp16", 10'000, true);
BENCHMARK_CAPTURE(seconds_of, lms_rough_10000, "lms", 10'000, true);
BENCHMARK_CAPTURE(seconds_of, depth_rough_10000, "depth", 10'000, true);

void touch(benchmark::State& state) {
  const Scene scene = scene_of(state.range(0), true);
  const Moment now = scene.at(0.0);
  const Body body = Body::rectangle(0.5, 0.5, 0.7, 0.4, 0.05);
  const Pose pose = scene.terrain().stand({0, 0}, 1.0, 0.3, 0.3);
  for (auto _ : state) benchmark::DoNotOptimize(contact(scene, now, pose, body));
}
BENCHMARK(touch)->Arg(100)->Arg(10'000);

}  // namespace
