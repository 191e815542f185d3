// Failsafes through real drivers and the plant: leaning, nobody watching, a driver that falls.

#include "rig.hpp"

namespace roverd::loop {
namespace {

std::unique_ptr<Rig> on_a_slope(double roll_deg) {
  RigOptions o;
  o.plant.imu.fitted = true;
  o.plant.imu.roll_deg = roll_deg;
  return std::make_unique<Rig>(o);
}

TEST(Slope, WarnsOfALeanAndRefusesToDriveOnOneThatIsTooSteep) {
  auto lean = on_a_slope(24.0);
  lean->arm_and_start(lean->plan_of({{0, 8}}));
  lean->run(3.0);
  EXPECT_TRUE(lean->has_condition("tilt"));
  EXPECT_FALSE(lean->stands());

  auto steep = on_a_slope(36.0);
  steep->run(12.0);
  EXPECT_TRUE(steep->has_condition("tilt"));
  ASSERT_TRUE(steep->ask(robot::Arm{}));
  const auto refused = steep->ask(robot::SetMode{Mode::Rtl});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the robot leans by 36 deg");

  auto flat = on_a_slope(8.0);
  flat->run(5.0);
  EXPECT_FALSE(flat->has_condition("tilt"));
}

TEST(NobodyWatches, TheRobotComesHome) {
  RigOptions o;
  o.robot.safety.link_lost = "return";
  o.robot.safety.link_timeout_s = 4.0;
  auto rig = std::make_unique<Rig>(o);
  const auto someone_speaks = [&] {
    rig->robot.measurements().put(base::OperatorLink{rig->state()->now, 1});
  };
  rig->run(10.0);
  someone_speaks();
  rig->arm_and_start(rig->plan_of({{0, 30}}));
  for (int i = 0; i < 12; ++i) {
    someone_speaks();
    rig->run(1.0);
  }
  EXPECT_FALSE(rig->stands());
  const double far_m = rig->truth().local.north_m;
  EXPECT_GT(far_m, 4.0);
  ASSERT_TRUE(rig->run_until([&] { return rig->state()->mode == Mode::Rtl; }, 5.0));
  EXPECT_EQ(rig->execution(), ExecutionState::Paused);
  ASSERT_TRUE(rig->run_until([&] { return rig->state()->mode == Mode::Hold; }, 90.0));
  rig->run(1.0);
  EXPECT_LT(rig->distance_to_m({0, 0}), 0.5);
  EXPECT_TRUE(rig->stands());
}

TEST(TakeOver, IsSeenWithinATenthOfASecondAndNothingIsCommandedFromThenOn) {
  for (int phase = 0; phase < 5; ++phase) {
    auto rig = std::make_unique<Rig>(RigOptions{});
    rig->arm_and_start(rig->plan_of({{0, 20}}));
    rig->run(6.0 + 0.02 * phase);
    ASSERT_NE(rig->state()->command.twist, base::BodyTwist{});
    sim::Radio radio;
    radio.swb = base::Switch::Middle;
    rig->plant.set_radio(radio);
    EXPECT_TRUE(rig->run_until(
        [&] {
          return rig->state()->control == base::Driver::Radio &&
                 rig->state()->command == base::DriveCommand{};
        },
        0.1))
        << phase;
  }
}

TEST(RadioThatDrove, IsLostAndTheMissionDoesNotGoOnByItself) {
  auto rig = std::make_unique<Rig>(RigOptions{});
  rig->arm_and_start(rig->plan_of({{0, 20}}));
  rig->run(6.0);
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  rig->plant.set_radio(radio);
  rig->run(2.0);
  EXPECT_EQ(rig->execution(), ExecutionState::Running);
  rig->fault([](sim::Faults& f) { f.radio_loss = true; });
  rig->run(2.0);
  EXPECT_TRUE(rig->has_condition("radio_lost"));
  EXPECT_EQ(rig->execution(), ExecutionState::Paused);
  rig->plant.set_radio({});
  rig->fault([](sim::Faults&) {});
  rig->run(4.0);
  EXPECT_TRUE(rig->stands());
  ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig->finish(60.0));
}

TEST(BaseThatFlaps, HoldsEachTimeAndItsDriverIsNamed) {
  auto rig = std::make_unique<Rig>(RigOptions{});
  rig->run(10.0);
  for (int i = 0; i < 3; ++i) {
    rig->fault([](sim::Faults& f) { f.bus_off = true; });
    rig->run(4.0);
    EXPECT_TRUE(rig->has_condition("base_lost")) << i;
    rig->fault([](sim::Faults&) {});
    rig->run(4.0);
    EXPECT_FALSE(rig->has_condition("base_lost")) << i;
  }
  EXPECT_TRUE(rig->has_condition("driver_falls"));
}

}  // namespace
}  // namespace roverd::loop
