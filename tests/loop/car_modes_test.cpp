// DOCK and SMART_RTL with steered wheels: no turn on the spot, judged by the true pose.

#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

using base::ActivityState;

double heading_of(const sim::Truth& t) {
  return base::heading_from_yaw(t.yaw_rad);
}

double degrees_off(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

bool ended(const RigBase& rig) {
  return rig.state()->mode == Mode::Hold;
}

struct Runner {
  const char* vehicle;
  std::uint64_t seed;
  bool reverse;
};

class CarDock : public testing::TestWithParam<Runner> {};
INSTANTIATE_TEST_SUITE_P(Loop, CarDock,
                         testing::Values(Runner{"uku", 1, false}, Runner{"uku", 2, false},
                                         Runner{"uku", 3, false}, Runner{"uku", 1, true},
                                         Runner{"imiev", 1, false}, Runner{"imiev", 2, true}),
                         [](const auto& made) {
                           return std::string(made.param.vehicle) +
                                  std::to_string(made.param.seed) +
                                  (made.param.reverse ? "_tail" : "_head");
                         });

//             pose ▶      it comes from the south and has to turn by 90 degrees
//          ╭──────
//   0 ─────╯
TEST_P(CarDock, StandsInThePoseAfterASlowStraight) {
  CartRig rig({.vehicle = GetParam().vehicle, .seed = GetParam().seed, .heading_deg = 0.0});
  rig.arm();
  robot::GoTo warm;  // learns the heading
  warm.at = rig.place({0, 15});
  ASSERT_TRUE(rig.ask(warm));
  ASSERT_TRUE(
      rig.run_until([&] { return rig.state()->activity.state == ActivityState::Reached; }, 60.0));
  robot::SetMode dock{Mode::Dock, robot::GoTo{}};
  const Metres pose = GetParam().reverse ? Metres{30, -10} : Metres{45, 45};
  dock.goal->at = rig.place(pose);
  dock.goal->yaw_rad = base::yaw_from_heading(GetParam().reverse ? 270.0 : 90.0);
  dock.goal->reverse = GetParam().reverse;
  const auto taken = rig.ask(dock);
  ASSERT_TRUE(taken) << taken.error().detail;
  ASSERT_TRUE(rig.run_until([&] { return ended(rig); }, 400.0));
  EXPECT_EQ(rig.state()->activity.state, ActivityState::Reached) << rig.state()->activity.reason;
  rig.run(1.0);
  EXPECT_LT(rig.distance_to_m(pose), 0.12);
  EXPECT_LT(degrees_off(heading_of(rig.truth()), GetParam().reverse ? 270.0 : 90.0), 4.0);
  for (const sim::Truth& t : rig.track) {
    if (std::hypot(t.local.east_m - pose.east_m, t.local.north_m - pose.north_m) < 1.0) {
      EXPECT_LT(std::abs(t.twist.linear_mps), 0.35);
    }
  }
}

class CarRetrace : public testing::TestWithParam<std::tuple<const char*, std::uint64_t>> {};
INSTANTIATE_TEST_SUITE_P(Loop, CarRetrace,
                         testing::Combine(testing::Values("uku", "imiev"),
                                          testing::Values(1ull, 2ull)));

//        ╭───── 2     back the same way, tail first: there is no room to turn round on it
//        │
//   home ●
TEST_P(CarRetrace, DrivesBackAlongTheWayTailFirst) {
  const bool large = std::get<0>(GetParam()) == std::string("imiev");
  const double leg_m = large ? 40.0 : 20.0;
  CartRig rig(
      {.vehicle = std::get<0>(GetParam()), .seed = std::get<1>(GetParam()), .heading_deg = 0.0});
  rig.arm_and_start(rig.plan_of({{0, leg_m}, {leg_m, leg_m}}, 1.0));
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  std::vector<Metres> driven;
  for (std::size_t i = 0; i < rig.track.size(); i += 25) {
    driven.push_back({rig.track[i].local.east_m, rig.track[i].local.north_m});
  }
  driven.push_back({rig.truth().local.east_m, rig.truth().local.north_m});
  rig.track.clear();
  const auto taken = rig.ask(robot::SetMode{Mode::SmartRtl});
  ASSERT_TRUE(taken) << taken.error().detail;
  ASSERT_TRUE(rig.run_until([&] { return ended(rig); }, 500.0));
  EXPECT_EQ(rig.state()->activity.state, ActivityState::Reached) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.6);
  EXPECT_LT(rig.farthest_from_path_m(driven), large ? 1.5 : 1.0);  // a swing of its own
  EXPECT_LT(degrees_off(heading_of(rig.truth()), 0.0), 12.0);
}

}  // namespace
}  // namespace roverd::loop
