// A mission that a power cut interrupted: another robot finds it where its place was kept last, and
// the vehicle a little farther on.

#include "rig.hpp"

namespace roverd::loop {
namespace {

//        2 ────────── 3 ╲
//        │                ╲ 4        2: a turn on the spot; 3: passed without a stop
//        │
//        0
const std::vector<Metres> kCutWay{{0, 0}, {0, 8}, {8, 8}, {14, 6}};

/// Arc length of the nearest place, looked for from `from_m` on.
double way_m(base::EnuPoint p, double from_m) {
  double before_m = 0.0;
  double best_m = 1e9;
  double at_m = from_m;
  for (std::size_t i = 0; i + 1 < kCutWay.size(); ++i) {
    const base::EnuPoint a{kCutWay[i].east_m, kCutWay[i].north_m};
    const base::EnuPoint b{kCutWay[i + 1].east_m, kCutWay[i + 1].north_m};
    const double length_m = base::distance_m(a, b);
    const double along = ((p.east_m - a.east_m) * (b.east_m - a.east_m) +
                          (p.north_m - a.north_m) * (b.north_m - a.north_m)) /
                         length_m;
    const double s_m = std::clamp(along, 0.0, length_m);
    const double part = s_m / length_m;
    const double far_m = base::distance_m(
        p, {a.east_m + part * (b.east_m - a.east_m), a.north_m + part * (b.north_m - a.north_m)});
    if (before_m + s_m > from_m - 1.0 && far_m < best_m) {
      best_m = far_m;
      at_m = before_m + s_m;
    }
    before_m += length_m;
  }
  return at_m;
}

/// What is left of a robot that was cut off: its place as kept a second before.
struct Cut {
  std::optional<base::MissionPlace> place;
  sim::Truth truth;
};

Cut cut_after(double seconds, std::uint64_t seed) {
  RigOptions o;
  o.seed = seed;
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({kCutWay.begin() + 1, kCutWay.end()}));
  rig.run(seconds - 1.0);
  Cut c;
  c.place = rig.state()->mission.place;
  rig.run(1.0);
  rig.fault([](sim::Faults& f) { f.bus_off = true; });  // nobody commands it any more
  rig.run(3.0);
  EXPECT_TRUE(rig.stands());
  c.truth = rig.truth();
  return c;
}

class Cuts : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Loop, Cuts, testing::Range(6, 34, 3));

TEST_P(Cuts, GoesOnAheadAndNeverTurnsRound) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const Cut cut = cut_after(GetParam(), seed);
  ASSERT_TRUE(cut.place);
  const double heading_deg = base::heading_from_yaw(cut.truth.yaw_rad);
  RigOptions o;
  o.seed = seed + 100;
  o.heading_deg = heading_deg;
  Rig rig(o);
  rig.plant.place(cut.truth.at, heading_deg);
  rig.arm();
  const auto compiled =
      rig.robot.compile({"m1", 1, rig.plan_of({kCutWay.begin() + 1, kCutWay.end()})});
  ASSERT_TRUE(compiled);
  const auto resumed = rig.ask(robot::ResumeAt{*compiled, *cut.place});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  rig.track.clear();
  const double begun_m = way_m(cut.truth.local, 0.0);
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  double farthest_m = begun_m;
  double back_m = 0.0;
  for (const sim::Truth& t : rig.track) {
    const double s_m = way_m(t.local, farthest_m);
    back_m = std::max(back_m, farthest_m - s_m);
    farthest_m = std::max(farthest_m, s_m);
  }
  EXPECT_LT(back_m, 0.15);
  EXPECT_LT(rig.farthest_from_path_m(kCutWay), 0.45);
  EXPECT_LT(rig.distance_to_m(kCutWay.back()), 0.2);
}

/// Carried away meanwhile, it goes to where it was interrupted.
TEST(CutOnce, ARobotThatWasCarriedGoesToThePlace) {
  const Cut cut = cut_after(20.0, 3);  // between the first item and the second
  ASSERT_TRUE(cut.place);
  ASSERT_GT(cut.place->s_m, 0.5);
  RigOptions o;
  o.heading_deg = 0.0;
  Rig rig(o);
  rig.plant.place(rig.place({4, 0}), 0.0);
  rig.arm();
  const auto compiled =
      rig.robot.compile({"m1", 1, rig.plan_of({kCutWay.begin() + 1, kCutWay.end()})});
  ASSERT_TRUE(compiled);
  const auto resumed = rig.ask(robot::ResumeAt{*compiled, *cut.place});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  rig.track.clear();
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({cut.place->s_m, 8}), 0.3);
  EXPECT_LT(rig.distance_to_m(kCutWay.back()), 0.2);
}

}  // namespace
}  // namespace roverd::loop
