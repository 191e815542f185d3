// The fence, judged by the true outline of the body: no corner of it ever leaves.

#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

/// A fence around the plant's start, `half_m` to each side.
std::shared_ptr<mission::Fence> yard(const RigBase& rig, double half_m) {
  auto fence = std::make_shared<mission::Fence>();
  fence->name = "yard";
  mission::FencePolygon p;
  for (const Metres m : {Metres{-half_m, -half_m}, Metres{half_m, -half_m}, Metres{half_m, half_m},
                         Metres{-half_m, half_m}}) {
    p.points.push_back(rig.place(m));
  }
  fence->areas.push_back({mission::AreaKind::Inclusion, p});
  return fence;
}

void set_fence(RigBase& rig, std::shared_ptr<const mission::Fence> fence) {
  ASSERT_TRUE(rig.ask(robot::SetFence{rig.robot.lay_fence(std::move(fence))}));
}

/// How far inside the square the outermost corner of the body stayed, over the whole track.
double clear_m(const RigBase& rig, const nav::VehicleParams& v, double half_m) {
  const double ahead_m = 0.5 * (v.length_m + (v.steered() ? v.wheelbase_m : 0.0));
  const double back_m = v.length_m - ahead_m;
  double least_m = 1e9;
  for (const sim::Truth& t : rig.track) {
    for (const double x : {ahead_m, -back_m}) {
      for (const double y : {0.5 * v.width_m, -0.5 * v.width_m}) {
        const double east_m = t.local.east_m + x * std::cos(t.yaw_rad) - y * std::sin(t.yaw_rad);
        const double north_m = t.local.north_m + x * std::sin(t.yaw_rad) + y * std::cos(t.yaw_rad);
        least_m = std::min({least_m, half_m - std::abs(east_m), half_m - std::abs(north_m)});
      }
    }
  }
  return least_m;
}

void push(RigBase& rig, double speed_mps, double rate_radps, double seconds) {
  if (rig.state()->teleop.phase != base::TeleopPhase::Held) rig.let_go();
  for (double t = 0.0; t < seconds; t += 0.1) {
    rig.drive(speed_mps, rate_radps);
    rig.run(0.1);
  }
}

class Headings : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Loop, Headings, testing::Values(0, 25, 45, 70, 180, 315));

//   ┌──────────┐
//   │     ╱▶   │ as fast as it can, at any angle, and round
//   └──────────┘
TEST_P(Headings, ByHandAtFullSpeedTheBodyStaysInside) {
  for (const double rate_radps : {0.0, 0.15, -0.4}) {
    RigOptions o;
    o.heading_deg = GetParam();
    o.robot.manual.max_mps = 1.5;
    Rig rig(o);
    rig.arm();
    set_fence(rig, yard(rig, 8.0));
    ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
    push(rig, 1.5, rate_radps, 14.0);
    EXPECT_GT(clear_m(rig, o.robot.vehicle, 8.0), 0.0) << rate_radps;
    EXPECT_LT(clear_m(rig, o.robot.vehicle, 8.0), 2.5) << rate_radps;
    push(rig, 0.0, 0.7, 6.0);  // on the spot, beside the fence
    push(rig, -1.5, 0.0, 14.0);
    EXPECT_GT(clear_m(rig, o.robot.vehicle, 8.0), 0.0) << rate_radps;
  }
}

TEST(FencedLoop, ASlowerDriveThanAssumedStillStopsInside) {
  RigOptions o;
  o.plant.drive.delay_s = 0.25;
  o.plant.drive.lag_s = 0.15;
  o.plant.gnss.profile = "rtk";
  Rig rig(o);
  rig.arm();
  set_fence(rig, yard(rig, 8.0));
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
  push(rig, 1.0, 0.0, 14.0);
  EXPECT_GT(clear_m(rig, o.robot.vehicle, 8.0), 0.0);
  EXPECT_TRUE(rig.stands());
}

TEST(FencedLoop, AMissionUnderWayStopsBeforeAFenceThatComes) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 20}}, 1.2));
  rig.run(4.0);
  set_fence(rig, yard(rig, 9.0));
  rig.run(15.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  EXPECT_GT(clear_m(rig, nav::VehicleParams{}, 9.0), 0.0);
}

class FencedCar : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Loop, FencedCar, testing::Values("uku", "imiev"));

TEST_P(FencedCar, ItsFrontStaysInsideToo) {
  for (const double sign : {1.0, -1.0}) {
    CartRig rig({.vehicle = GetParam(), .heading_deg = 30.0});
    const nav::VehicleParams body = settings_of(GetParam()).robot.vehicle;
    rig.arm();
    set_fence(rig, yard(rig, 20.0));
    ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
    push(rig, sign * 1.0, 0.03, 40.0);
    EXPECT_GT(clear_m(rig, body, 20.0), 0.0) << sign;
    EXPECT_TRUE(rig.stands()) << sign;
  }
}

//   home ●   │
//        ╲   │     the straight way home leads over a hole: the rally point does not
//   hole ▒▒╲ │
//   rally ◆  ●
TEST(FencedLoop, RtlGoesToTheRallyPointWhereHomeCannotBeReached) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{7, 0}, {7, 8}}));
  ASSERT_TRUE(rig.finish(120.0));
  auto fence = yard(rig, 14.0);
  mission::FencePolygon hole;
  for (const Metres m : {Metres{1.5, 3}, Metres{4, 3}, Metres{4, 5.5}, Metres{1.5, 5.5}}) {
    hole.points.push_back(rig.place(m));
  }
  fence->areas.push_back({mission::AreaKind::Exclusion, hole});
  fence->rally.push_back({rig.place({7, -4}), {}});
  set_fence(rig, fence);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Rtl}));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mode == Mode::Hold; }, 90.0));
  EXPECT_LT(rig.distance_to_m({7, -4}), 0.25);
  EXPECT_TRUE(rig.has_event("home_reached"));
}

/// A way home over a hole, a jump or a lap over it: refused before anything moves.
TEST(FencedLoop, TheWholeWayIsLookedAtBeforeItStarts) {
  Rig rig({});
  rig.arm();
  auto fence = yard(rig, 14.0);
  mission::FencePolygon hole;
  for (const Metres m : {Metres{3, 3}, Metres{6, 3}, Metres{6, 6}, Metres{3, 6}}) {
    hole.points.push_back(rig.place(m));
  }
  fence->areas.push_back({mission::AreaKind::Exclusion, hole});
  set_fence(rig, fence);
  const auto refusal = [&](mission::Plan plan) {
    rig.load(plan);
    const auto r = rig.ask(robot::StartMission{"m1", 1});
    return r ? std::string() : r.error().detail;
  };
  const auto round = rig.plan_of({{0, 8}, {8, 8}});  // past the hole; straight back is over it
  EXPECT_EQ(refusal(round), "");
  ASSERT_TRUE(rig.ask(robot::StopMission{}));
  rig.run(2.0);
  auto home = round;
  home.settings.at_end = mission::AtEnd::Return;
  EXPECT_EQ(refusal(home), "the mission's way home leaves the fence");
  auto item = round;
  item.items.push_back(mission::ReturnHome{});
  EXPECT_EQ(refusal(item), "item 3 drives a way to or from home that leaves the fence");
  auto laps = rig.plan_of({{0, 1.5}, {0, 8}, {8, 8}});
  laps.settings.at_end = mission::AtEnd::Repeat;
  EXPECT_EQ(refusal(laps), "the way back to the first item leaves the fence");
  auto jump = rig.plan_of({{0, 1.5}, {0, 8}, {8, 8}});
  jump.items.push_back(mission::Jump{1, 1});
  EXPECT_EQ(refusal(jump), "item 4 jumps over a way that leaves the fence");
  EXPECT_TRUE(rig.stands());
}

/// Compiled and laid out without knowing of each other: refused until they have been compared.
TEST(FencedLoop, FenceAndMissionOfTheSameMomentAreComparedFirst) {
  Rig rig({});
  rig.arm();
  const auto fence = yard(rig, 6.0);
  const auto laid = rig.robot.lay_fence(fence);
  const auto compiled = rig.robot.compile({"m1", 1, rig.plan_of({{0, 20}})});
  ASSERT_TRUE(compiled);
  ASSERT_TRUE(rig.ask(robot::LoadMission{*compiled}));
  ASSERT_TRUE(rig.ask(robot::SetFence{laid}));
  ASSERT_TRUE(rig.state()->fence);
  EXPECT_FALSE(rig.state()->fence->compared);
  const auto early = rig.ask(robot::StartMission{"m1", 1});
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().detail, "fence and mission are being compared: try again");
  set_fence(rig, fence);
  EXPECT_TRUE(rig.state()->fence->compared);
  const auto refused = rig.ask(robot::StartMission{"m1", 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "item 1 lies outside the fence");
}

}  // namespace
}  // namespace roverd::loop
