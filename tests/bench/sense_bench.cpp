// What the sense chain costs: clouds and scans of real sizes, and one look of the protection.
//
//   sense_bench --benchmark_filter=cloud    # ROVERD_REAL_DATA or ../shared/data: the recorded
//   cloud

#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "lzf.hpp"
#include "nav/sense/chain.hpp"
#include "nav/sense/foresee.hpp"
#include "nav/sense/marks.hpp"
#include "nav/sense/polar.hpp"
#include "nav/sense/protect.hpp"
#include "nav/sense/rays_rule.hpp"
#include "real_data.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kRobot = Footprint::box(1.0, 0.8, 0.5);

base::Time at(double s) {
  return base::Time{} + base::from_seconds(s);
}

PoseHistory driving(double v) {
  PoseHistory h;
  for (int i = 0; i < 200; ++i) h.push({at(0.02 * i), {0.02 * i * v, 0.0, 0.0}, v, 0.0});
  return h;
}

base::Sight named(const char* name) {
  base::Sight s;
  s.sensor = name;
  s.stamp = at(2.0);
  return s;
}

/// The organised cloud of the field data: x right, y down, z ahead, turned to S.
base::Sight recorded_cloud() {
  const auto bytes =
      tests::read_file(tests::real_data_path("sensors/clouds/table-organised-640x480.pcd"));
  base::Sight s = named("camera");
  const auto raw = tests::pcd_columns(bytes);
  if (!raw) return s;
  const std::size_t n = 640 * 480;
  const auto column = [&](std::size_t c, std::size_t i) {
    float v = 0.0F;
    std::memcpy(&v, raw->data() + 4 * (c * n + i), 4);
    return v;
  };
  for (std::size_t i = 0; i < n; ++i) {
    base::SightPoint p{column(3, i), -column(1, i), -column(2, i), 0.0F, 0, 0, base::Echo::Hit};
    if (!std::isfinite(p.x_m)) p = {1.0F, 0.0F, 0.0F, 0.0F, 0, 0, base::Echo::Unknown};
    s.points.push_back(p);
  }
  return s;
}

/// A depth image: ground before a camera that looks down, a wall behind.
base::Sight image() {
  base::Sight s = named("camera");
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.005);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const double y = (319.5 - u) / 525.0;
      const double z = (239.5 - v) / 525.0;
      const double down = z * std::cos(0.35) - std::sin(0.35);
      const double ahead = std::cos(0.35) + z * std::sin(0.35);
      const double d = std::min(down < 0.0 ? -0.8 / down : 1e9, 6.0 / ahead) + noise(random);
      s.points.push_back({static_cast<float>(d), static_cast<float>(d * y),
                          static_cast<float>(d * z), 0.0F, 0, 0, base::Echo::Hit});
    }
  }
  return s;
}

/// One revolution of sixteen rings in a yard, in 0.1 s: 28,800 points unless told otherwise.
base::Sight revolution(int firings = 1800) {
  base::Sight s = named("rings");
  for (int i = 0; i < firings; ++i) {
    for (int ring = 0; ring < 16; ++ring) {
      const double a = -i * 2.0 * base::kPi / firings;
      const double e = base::rad_from_deg(2.0 * ring - 15.0);
      const double wall =
          5.0 + 2.0 * std::sin(5.0 * a) + (i * 3 % firings < firings / 3 ? 15.0 : 0.0);
      const double d = std::min(e < 0.0 ? 0.7 / std::sin(-e) : 1e9, wall / std::cos(e));
      s.points.push_back({static_cast<float>(d * std::cos(e) * std::cos(a)),
                          static_cast<float>(d * std::cos(e) * std::sin(a)),
                          static_cast<float>(d * std::sin(e)),
                          static_cast<float>(i * 0.1 / firings), 0, static_cast<std::uint8_t>(ring),
                          base::Echo::Hit});
    }
  }
  s.half_step_rad = static_cast<float>(base::kPi / firings);
  return s;
}

base::Sight scan_of_541() {
  base::Sight s = named("scanner");
  for (int i = 0; i < 541; ++i) {
    const double a = base::rad_from_deg(-135.0 + 0.5 * i);
    const double d = 4.0 + 2.5 * std::sin(7.0 * a);
    s.points.push_back({static_cast<float>(d * std::cos(a)), static_cast<float>(d * std::sin(a)),
                        0.0F, static_cast<float>(i * 0.015 / 541.0), 0, 0, base::Echo::Hit});
  }
  s.half_step_rad = 0.0044F;
  return s;
}

Chain chain() {
  SensorSetup camera{.name = "camera", .mount = {.x_m = 0.45, .z_m = 0.8, .pitch_rad = 0.35}};
  SensorSetup rings{.name = "rings", .mount = {.z_m = 0.7}};
  SensorSetup scanner{.name = "scanner", .mount = {.x_m = 0.45, .z_m = 0.3}, .planar = true};
  return *Chain::of({}, {camera, rings, scanner}, kRobot, at(0.0));
}

/// Cropped, 5 cm voxels, planar scan of one ray per degree: what the field system did.
void to_scan(benchmark::State& state, const base::Sight& sight) {
  const auto history = driving(0.0);
  Reducer reducer({}, kRobot);
  Reduced reduced;
  std::vector<Ray> rays;
  for (auto _ : state) {
    benchmark::DoNotOptimize(reducer.reduce(sight, {.x_m = 0.45, .z_m = 0.8}, history, reduced));
    rays_of(reduced, {}, rays);
    benchmark::DoNotOptimize(rays.data());
  }
  state.counters["voxels"] = static_cast<double>(reduced.voxels.size());
  state.counters["kept"] = reduced.counts.kept;
  state.counters["ns_per_point"] = benchmark::Counter(
      static_cast<double>(sight.points.size()) * static_cast<double>(state.iterations()) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
void cloud_to_scan(benchmark::State& state) {
  const auto sight = recorded_cloud();
  if (sight.points.empty()) return state.SkipWithError("no recorded cloud");
  to_scan(state, sight);
}
BENCHMARK(cloud_to_scan)->Unit(benchmark::kMillisecond);
void image_to_scan(benchmark::State& state) {
  to_scan(state, image());
}
BENCHMARK(image_to_scan)->Unit(benchmark::kMillisecond);

/// All of it, into the grid. The counter says which part of a core that is at the sensor's rate.
void through_chain(benchmark::State& state, const base::Sight& sight, double rate_hz) {
  const auto history = driving(1.0);
  Chain all = chain();
  for (auto _ : state) {
    benchmark::DoNotOptimize(all.take(sight, history, at(2.1)));
  }
  // Time per piece times pieces per second.
  state.counters["core_pct"] =
      benchmark::Counter(static_cast<double>(state.iterations()) / (100.0 * rate_hz),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["rate_hz"] = rate_hz;
}
void chain_image(benchmark::State& state) {
  through_chain(state, image(), 30.0);
}
void chain_revolution(benchmark::State& state) {
  through_chain(state, revolution(), 10.0);
}
void chain_541(benchmark::State& state) {
  through_chain(state, scan_of_541(), 50.0);
}
/// @param 0: firings a revolution, each of sixteen points; ten revolutions a second.
void chain_grows(benchmark::State& state) {
  const auto firings = static_cast<int>(state.range(0));
  through_chain(state, revolution(firings), 10.0);
  state.counters["points_per_s"] = 160.0 * firings;
}
BENCHMARK(chain_grows)
    ->ArgName("firings")
    ->Arg(62)
    ->Arg(200)
    ->Arg(625)
    ->Arg(2000)
    ->Arg(6250)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(chain_image)->Unit(benchmark::kMicrosecond);
BENCHMARK(chain_revolution)->Unit(benchmark::kMicrosecond);
BENCHMARK(chain_541)->Unit(benchmark::kMicrosecond);

Patch seen() {
  Chain all = chain();
  (void)all.take(revolution(), driving(0.0), at(2.1));
  for (int i = 0; i < 3; ++i) (void)all.take(scan_of_541(), driving(0.0), at(2.1));
  Patch patch;
  all.grid().patch({}, 5.0, at(2.1), patch);
  return patch;
}
void copy_patch(benchmark::State& state) {
  Chain all = chain();
  (void)all.take(revolution(), driving(0.0), at(2.1));
  Patch patch;
  for (auto _ : state) all.grid().patch({}, 5.0, at(2.1), patch);
}
BENCHMARK(copy_patch)->Unit(benchmark::kMicrosecond);
void mark_patch(benchmark::State& state) {
  const Patch patch = seen();
  Marks marks;
  for (auto _ : state) marks.mark(patch);
}
BENCHMARK(mark_patch)->Unit(benchmark::kMicrosecond);
void polar(benchmark::State& state) {
  const Patch patch = seen();
  Polar out;
  for (auto _ : state) polar_of(patch, {}, kRobot, 5.0, out);
}
BENCHMARK(polar)->Unit(benchmark::kMicrosecond);

/// @param 0: obstacles per thousand cells, everywhere.
void one_look(benchmark::State& state, base::BodyTwist twist) {
  Patch patch = seen();
  std::mt19937 random(1);
  for (Patch::Cell& c : patch.cells) {
    c.known =
        random() % 1000 < static_cast<unsigned>(state.range(0)) ? Known::Occupied : Known::Free;
  }
  Marks marks;
  marks.mark(patch);
  for (auto _ : state) {
    benchmark::DoNotOptimize(protect(patch, {}, kRobot, twist, {}, nullptr, &marks));
  }
}
BENCHMARK_CAPTURE(one_look, straight, base::BodyTwist{1.3, 0.0})
    ->Arg(0)
    ->Arg(2)
    ->Arg(50)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(one_look, arc, base::BodyTwist{1.0, 0.4})
    ->Arg(0)
    ->Arg(2)
    ->Arg(50)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(one_look, pivot, base::BodyTwist{0.0, 0.6})
    ->Arg(0)
    ->Arg(2)
    ->Arg(50)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
/// So many who walk about the robot, each of whom it might meet.
void one_look_at_people(benchmark::State& state) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  std::uniform_real_distribution<double> pace(-1.5, 1.5);
  std::vector<Mover> people(static_cast<std::size_t>(state.range(0)));
  for (Mover& m : people) {
    m.at = {place(random), place(random)};
    m.v_mps = {pace(random), pace(random)};
  }
  Odometry now;
  now.v_mps = 1.3;
  for (auto _ : state) {
    benchmark::DoNotOptimize(foresee(people, now, kRobot, {1.3, 0.2}, {}));
  }
}
BENCHMARK(one_look_at_people)
    ->Arg(0)
    ->Arg(1)
    ->Arg(4)
    ->Arg(16)
    ->Arg(64)
    ->Unit(benchmark::kMicrosecond);

}  // namespace roverd::nav::sense
