// The bumper: a hit is an emergency stop that stays until somebody has looked.

#include "field.hpp"

namespace roverd::robot {
namespace {

TEST(Bumper, AHitShorterThanATickLatchesTheStop) {
  Field f;
  f.drive_mission();
  f.robot.measurements().put(base::Bumper{f.now, true, "front left"});
  f.robot.measurements().put(base::Bumper{f.now, false, ""});
  f.tick();
  EXPECT_TRUE(f.state()->estop);
  EXPECT_FALSE(f.moves());
  const auto said = std::find_if(f.events.begin(), f.events.end(),
                                 [](const auto& e) { return e.kind == "estop"; });
  ASSERT_NE(said, f.events.end());
  EXPECT_EQ(said->detail, "emergency stop by the bumper (front left)");
}

TEST(Bumper, IsNotResetWhilePressed) {
  Field f;
  f.run(1.0);
  f.robot.measurements().put(base::Bumper{f.now, true, ""});
  f.tick();
  EXPECT_TRUE(f.has_condition("bumper"));
  const auto refused = f.ask(ResetEstop{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the bumper is still pressed: free it first");
  f.robot.measurements().put(base::Bumper{f.now, false, ""});
  f.tick();
  EXPECT_TRUE(f.ask(ResetEstop{}));
  f.run(0.1);
  EXPECT_FALSE(f.state()->estop);
}

TEST(Bumper, ThatFallsSilentHoldsTheRobot) {
  Field f;
  f.run(1.0);
  f.robot.measurements().put(base::Bumper{f.now, false, ""});
  f.run(0.5);
  EXPECT_FALSE(f.has_condition("bumper_lost"));
  f.run(1.0);
  EXPECT_TRUE(f.has_condition("bumper_lost"));
}

}  // namespace
}  // namespace roverd::robot
