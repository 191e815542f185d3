// A hand on the speed of a mission, against the true pose.

#include "rig.hpp"

namespace roverd::loop {
namespace {

template <class Any>
void keep_hand(Any& rig, double share, double seconds) {
  for (double t = 0.0; t < seconds; t += 0.1) {
    rig.robot.request(robot::Throttle{share, true}, rig.state()->now + std::chrono::seconds(1), {});
    rig.run(0.1);
  }
}

//   ▲ 3
//   └──◀ 2      the pad is lost on the way to 2, and again in the turn there
//        ▲
//        1
TEST(HandOnSpeed, AMissionStopsOnItsWayWhenThePadIsLostAndGoesOnAlongIt) {
  Rig rig(RigOptions{});
  const std::vector<Metres> way{{0, 12}, {-6, 12}};
  rig.arm_and_start(rig.plan_of(way));
  keep_hand(rig, 1.0, 6.0);
  const double fast = std::abs(rig.truth().twist.linear_mps);
  ASSERT_GT(fast, 0.6);
  keep_hand(rig, 0.5, 4.0);
  EXPECT_NEAR(std::abs(rig.truth().twist.linear_mps), 0.4, 0.06);
  // When it is lost, the robot stands within time-out and braking,
  const double driven_m = rig.truth().driven_m;
  rig.run(4.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_LT(rig.truth().driven_m - driven_m, 0.4 * 0.5 + 0.5);
  EXPECT_TRUE(rig.has_condition("auto_hand"));
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  // and with a fresh grip goes on along its way to its end.
  ASSERT_TRUE(rig.ask(robot::Throttle{0.0, false}));
  const auto done = [&] {
    keep_hand(rig, 1.0, 0.1);
    return rig.execution() == ExecutionState::Finished;
  };
  bool finished = false;
  for (int i = 0; i < 600 && !finished; ++i) finished = done();
  ASSERT_TRUE(finished) << rig.state()->mission.reason;
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 12}, {-6, 12}}), 0.4);
  EXPECT_FALSE(rig.has_event("blocked"));
}

}  // namespace
}  // namespace roverd::loop
