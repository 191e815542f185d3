// A way is driven by hand, recorded, and driven again: the true robot passes where it passed
// before.

#include "mission/edit/teach.hpp"

#include "rig.hpp"

namespace roverd::loop {
namespace {

class Teaching : public testing::TestWithParam<std::uint64_t> {
 protected:
  /// Drives by hand and records 20 times a second, as the api does.
  void teach(Rig& rig, double seconds, double speed_mps, double yaw_rate_radps) {
    const auto ticks = std::lround(seconds / base::seconds(Rig::kTick));
    for (long i = 0; i < ticks; ++i) {
      rig.drive(speed_mps, yaw_rate_radps);
      rig.tick();
      if (i % 5 != 0 && i % 5 != 2) continue;
      const auto s = rig.state();
      mission::TeachSample sample;
      sample.trusted = s->pose && s->pose->horizontal_sigma_m < 0.5;
      if (s->pose) {
        sample.stamp = s->pose->stamp;
        sample.at = s->pose->global;
        sample.yaw_rad = s->pose->yaw_rad;
        sample.speed_mps = s->pose->speed_mps.value_or(0.0);
      }
      keep(sampler_.take(sample));
    }
  }
  void keep(const std::vector<mission::TaughtPoint>& more) {
    points_.insert(points_.end(), more.begin(), more.end());
  }

  mission::Sampler sampler_{mission::TeachSettings{}};
  std::vector<mission::TaughtPoint> points_;
};
INSTANTIATE_TEST_SUITE_P(Loop, Teaching, testing::Values(1, 2, 3));

//        ╭──────   forward, a bend, forward, and a piece backwards
//   ─────╯  ◀┄┄
TEST_P(Teaching, ADrivenWayIsRepeatedWhereItWas) {
  RigOptions o;
  o.seed = GetParam();
  Rig rig(o);
  rig.arm();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
  rig.let_go();
  // The heading is found while driving, before the recording begins.
  for (int i = 0; i < 400; ++i) {
    rig.drive(0.5, 0.0);
    rig.tick();
  }
  rig.track.clear();
  teach(rig, 1.0, 0.0, 0.0);
  teach(rig, 10.0, 0.6, 0.0);
  teach(rig, 6.0, 0.5, 0.25);
  teach(rig, 8.0, 0.6, 0.0);
  teach(rig, 6.0, 0.5, -0.2);
  teach(rig, 6.0, 0.6, 0.0);
  teach(rig, 1.0, 0.0, 0.0);
  teach(rig, 8.0, -0.4, 0.0);
  teach(rig, 2.0, 0.0, 0.0);
  keep(sampler_.finish());
  std::vector<Metres> taught;
  for (const auto& t : rig.track) {
    if (taught.empty() || std::hypot(t.local.east_m - taught.back().east_m,
                                     t.local.north_m - taught.back().north_m) > 0.02) {
      taught.push_back({t.local.east_m, t.local.north_m});
    }
  }
  const auto plan = mission::mission_of(points_, "taught", 0.03);
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_LT(plan->items.size(), 40u);
  rig.load(*plan);
  rig.start();
  // Back to its beginning first; what counts is the way from there.
  ASSERT_TRUE(
      rig.run_until([&] { return rig.state()->mission.current_item.value_or(0) >= 2; }, 90));
  rig.track.clear();
  ASSERT_TRUE(rig.finish(200.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.farthest_from_path_m(taught), 0.25);
  double sum = 0.0;
  int count = 0;
  bool backed = false;
  for (const auto& t : rig.track) {
    if (std::abs(t.twist.linear_mps) < 0.05) continue;
    backed |= t.twist.linear_mps < -0.1;
    double best = 1e9;
    for (const Metres& m : taught) {
      best = std::min(best, std::hypot(t.local.east_m - m.east_m, t.local.north_m - m.north_m));
    }
    sum += best;
    ++count;
  }
  EXPECT_LT(sum / count, 0.06);
  EXPECT_TRUE(backed);
  EXPECT_LT(rig.distance_to_m(taught.back()), 0.15);
  // The other way round: the true robot came everywhere where it had been.
  for (const Metres& m : taught) EXPECT_LT(rig.nearest_m(m), 0.3);
}

}  // namespace
}  // namespace roverd::loop
