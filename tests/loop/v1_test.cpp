// The base with older firmware, protocol V1: recognised, driven, stopped.

#include "bunker/v1.hpp"

#include "rig.hpp"

namespace roverd::loop {
namespace {

class OldBase : public testing::TestWithParam<std::uint64_t> {
 protected:
  static RigOptions options(std::uint64_t seed) {
    RigOptions o;
    o.seed = seed;
    o.plant.base.protocol = "v1";
    o.robot.safety.radio_required = false;  // this base tells nothing of its transmitter
    return o;
  }
  Rig rig{options(GetParam())};

  std::string fact(const std::string& name) const {
    for (const auto& d : rig.state()->drivers) {
      if (d.name != "bunker" || !d.detail || !d.detail->facts.contains(name)) continue;
      return d.detail->facts.at(name);
    }
    return {};
  }
};
INSTANTIATE_TEST_SUITE_P(Loop, OldBase, testing::Values(1, 2, 3));

//   1 ──▶ 2     starts below 1, looking north; no odometer: only the base's own speeds
//   ▲
//   0
TEST_P(OldBase, DrivesAnLMission) {
  rig.arm_and_start(rig.plan_of({{0, 12}, {10, 12}}));
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_EQ(fact("protocol"), "V1");
  EXPECT_LT(rig.nearest_m({0, 12}), 0.3);
  EXPECT_LT(rig.distance_to_m({10, 12}), 0.2);
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 12}, {10, 12}}), 0.5);
  EXPECT_TRUE(rig.stands());
}

TEST_P(OldBase, TheEmergencyStopStopsItAndTheBaseIsGivenBack) {
  rig.arm_and_start(rig.plan_of({{0, 30}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 3.0; }, 60.0));
  EXPECT_EQ(rig.truth().control_mode, base::ControlMode::Can);
  ASSERT_TRUE(rig.ask(robot::Estop{"anna"}));
  rig.run(2.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.truth().control_mode, base::ControlMode::Standby);
}

TEST_P(OldBase, ABaseThatFallsSilentStopsTheMission) {
  rig.arm_and_start(rig.plan_of({{0, 30}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 3.0; }, 60.0));
  rig.fault([](sim::Faults& f) { f.bus_off = true; });
  rig.run(2.0);
  EXPECT_TRUE(rig.has_condition("base_lost"));
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  EXPECT_TRUE(rig.stands()) << "its own time-out of half a second";
}

TEST_P(OldBase, WhenTheRadioTakesOverNothingIsCommandedUntilItGivesBack) {
  rig.arm_and_start(rig.plan_of({{0, 30}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 3.0; }, 60.0));
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  rig.plant.set_radio(radio);
  rig.run(0.5);
  const auto commands = rig.truth().commands;
  rig.run(1.0);
  EXPECT_EQ(rig.truth().commands, commands) << "silent while the radio drives";
  rig.run(8.0);
  EXPECT_EQ(rig.truth().vehicle_state, base::VehicleState::Normal) << "no fight with the radio";
  EXPECT_TRUE(rig.stands());
  radio.swb = base::Switch::Up;
  rig.plant.set_radio(radio);
  rig.run(3.0);
  if (rig.execution() != ExecutionState::Running) {
    ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  }
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({0, 30}), 0.2);
}

TEST_P(OldBase, ASecondCommanderIsAHazardHereToo) {
  rig.arm_and_start(rig.plan_of({{0, 30}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 3.0; }, 60.0));
  for (std::uint8_t i = 0; i < 100; ++i) {
    rig.put_on_bus(bunker::v1::encode(
        bunker::v1::Command{.mode = bunker::v1::RequestedMode::Can, .linear_pct = 5, .count = i}));
    rig.tick();
  }
  EXPECT_TRUE(rig.has_condition("driver_hazard"));
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
}

}  // namespace
}  // namespace roverd::loop
