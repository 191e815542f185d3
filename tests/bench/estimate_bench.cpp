// The estimator's figures in the loop, twenty seeds each (tests/loop/figures.hpp), and what one
// step of it costs.

#include <benchmark/benchmark.h>

#include "figures.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::loop {
namespace {

constexpr std::uint64_t kSeeds = 20;

void alignment(benchmark::State& state) {
  for (auto _ : state) {
    const Alignment a = measure_alignment(kSeeds);
    state.counters["after_2m_worst_deg"] = largest(a.after_2m_deg);
    state.counters["after_5m_p95_deg"] = quantile(a.after_5m_deg, 0.95);
    state.counters["swerve_worst_deg"] = largest(a.swerve_deg);
    state.counters["pivot_p95_deg"] = quantile(measure_pivots_deg(kSeeds), 0.95);
  }
}
BENCHMARK(alignment)->Iterations(1)->Unit(benchmark::kSecond);

void rtk(benchmark::State& state) {
  for (auto _ : state) {
    const RtkErrors e = measure_rtk(kSeeds);
    state.counters["position_rms_cm"] = 100.0 * rms(e.position_m);
    state.counters["heading_rms_deg"] = rms(e.heading_deg);
    state.counters["outage_worst_m"] = largest(e.after_outage_m);
    state.counters["outside_pct"] = 100.0 - e.inside_pct;
  }
}
BENCHMARK(rtk)->Iterations(1)->Unit(benchmark::kSecond);

void consumer(benchmark::State& state) {
  for (auto _ : state) {
    // The drift lasts a minute and the estimate's error ten: fewer and shorter runs tell nothing of
    // how often the ellipse is right.
    const ConsumerErrors e = measure_consumer(3 * kSeeds, 1800.0);
    state.counters["error_ratio"] = rms(e.estimate_m) / rms(e.receiver_m);
    state.counters["change_ratio"] = rms(e.estimate_step_m) / rms(e.receiver_step_m);
    state.counters["inside_pct"] = e.inside_pct;
    state.counters["inside_off_pct"] = std::abs(e.inside_pct - 95.0);
    state.counters["nees"] = e.nees;
  }
}
BENCHMARK(consumer)->Iterations(1)->Unit(benchmark::kSecond);

void disturbed(benchmark::State& state) {
  for (auto _ : state) {
    state.counters["jump_worst_m"] = largest(measure_jump_m(kSeeds));
    state.counters["blind_worst_pct"] = largest(measure_blind_pct(kSeeds));
  }
}
BENCHMARK(disturbed)->Iterations(1)->Unit(benchmark::kSecond);

void standing(benchmark::State& state) {
  for (auto _ : state) {
    const Standing s = measure_standing(kSeeds);
    state.counters["moved_worst_cm"] = 100.0 * largest(s.moved_m);
    state.counters["turned_worst_deg"] = largest(s.turned_deg);
  }
}
BENCHMARK(standing)->Iterations(1)->Unit(benchmark::kSecond);

/// 20 ms with everything in them: tracks, two samples of the gyro, currents, position, velocity,
/// compass and antennas.
void one_step(benchmark::State& state) {
  nav::Estimator estimator{nav::EstimateParams{}};
  const base::LocalFrame frame{9, {58.378, 26.729}};
  Time now{};
  double north_m = 0.0;
  const auto feed = [&](const base::Measurement& m) { estimator.take(m, now); };
  for (auto _ : state) {
    now += std::chrono::milliseconds(20);
    north_m += 0.016;
    for (const int ms : {10, 0}) {
      base::Inertial inertial;
      inertial.stamp = now - std::chrono::milliseconds(ms);
      inertial.rate_radps = base::BodyVector{0.0, 0.0, 0.005};
      inertial.accel_mps2 = base::BodyVector{0.0, 0.0, 9.81};
      feed(inertial);
    }
    feed(base::WheelTravel{now, 0.0174, 0.0174});
    feed(base::BaseMotion{now, {0.87, 0.0}});
    for (const int motor : {1, 2}) {
      base::MotorState m;
      m.stamp = now;
      m.motor = motor;
      m.current_a = 2.0;
      feed(m);
    }
    base::GnssFix fix;
    fix.stamp = now;
    fix.fix = base::FixType::RtkFloat;
    fix.position = frame.to_global({0.0, north_m - 0.1});
    feed(fix);
    feed(base::GnssVelocity{now, 0.0, 0.8, {}});
    feed(base::Heading{now, base::kPi / 2.0, base::HeadingSource::Compass});
    feed(base::Heading{now, base::kPi / 2.0, base::HeadingSource::DualAntenna});
    estimator.advance(now);
    benchmark::DoNotOptimize(estimator.pose(now));
  }
  state.counters["step_us"] =
      benchmark::Counter(static_cast<double>(state.iterations()) / 1e6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  if (estimator.health().resets > 1) state.SkipWithError("the measurements contradict each other");
}
BENCHMARK(one_step);

}  // namespace
}  // namespace roverd::loop
