// Two antennas that are mounted twenty degrees askew, and say a tenth of a degree of themselves.
//
//   they point ↗   it drives ↑   so the heading is found by driving, and they wait for a person

#include "rig.hpp"

namespace roverd::loop {
namespace {

RigOptions mounted(double off_deg) {
  RigOptions o;
  o.plant.gnss.profile = "rtk";
  o.plant.gnss.antennas = true;
  o.plant.gnss.antennas_offset_deg = off_deg;
  o.gnss.heading_source = "dual_antenna";
  return o;
}

TEST(Askew, AntennasAreFoundOutAndTheRobotKeepsToItsWay) {
  for (const double off_deg : {-20.0, -12.0, 12.0, 20.0}) {
    Rig rig(mounted(off_deg));
    rig.arm_and_start(rig.plan_of({{0, 15}, {10, 15}}));
    ASSERT_TRUE(rig.run_until([&] { return rig.has_condition("antennas_askew"); }, 20.0))
        << off_deg;
    EXPECT_LT(rig.truth().driven_m, 4.0) << off_deg;
    const auto askew = rig.state()->estimator.antennas_askew;
    ASSERT_TRUE(askew);
    if (rig.execution() !=
        ExecutionState::Running) {  // far beyond what was claimed: a person looks
      rig.run(2.0);
      ASSERT_TRUE(rig.ask(robot::Acknowledge{})) << off_deg;
      ASSERT_TRUE(rig.ask(robot::ResumeMission{})) << off_deg;
    }
    ASSERT_TRUE(rig.run_until([&] { return rig.execution() != ExecutionState::Running; }, 120.0));
    EXPECT_EQ(rig.execution(), ExecutionState::Finished)
        << off_deg << ": " << rig.state()->mission.reason;
    EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 15}, {10, 15}}), 0.5) << off_deg;
    EXPECT_LT(std::abs(rig.yaw_error_deg()), 3.0) << off_deg;
    // Clockwise they are off, and left is positive.
    const double told_deg = base::deg_from_rad(rig.state()->estimator.antennas_askew->offset_rad);
    EXPECT_NEAR(told_deg, -off_deg, 1.5);
  }
}

TEST(Askew, ConfirmedTheyAreCorrectedAndUsedAgain) {
  Rig rig(mounted(20.0));
  rig.arm_and_start(rig.plan_of({{0, 12}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.has_condition("antennas_askew"); }, 20.0));
  rig.run(8.0);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Hold}));
  rig.run(3.0);
  ASSERT_TRUE(rig.ask(robot::CorrectAntennas{true}));
  rig.run(1.0);
  EXPECT_FALSE(rig.has_condition("antennas_askew"));
  EXPECT_NEAR(base::deg_from_rad(rig.state()->estimator.antennas_offset_rad), -20.0, 2.0);
  EXPECT_LT(std::abs(rig.yaw_error_deg()), 2.5);
  EXPECT_FALSE(rig.ask(robot::CorrectAntennas{true}));
  EXPECT_TRUE(rig.ask(robot::CorrectAntennas{false}));
  EXPECT_FALSE(rig.ask(robot::CorrectAntennas{false}));
}

TEST(Askew, HeldBecauseOfThemAPersonCorrectsAcknowledgesAndResumesAndTheMissionFinishes) {
  int held = 0;
  for (const std::uint64_t seed : {2ULL, 4ULL, 9ULL, 19ULL}) {
    RigOptions o = mounted(22.0);
    o.seed = seed;
    Rig rig(o);
    rig.arm_and_start(rig.plan_of({{0, 12}, {8, 12}, {8, 4}}, 1.0));
    const auto runs = [&] { return rig.execution() == ExecutionState::Running; };
    rig.run_until([&] { return !runs(); }, 120.0);
    if (rig.execution() != ExecutionState::Finished) {
      ++held;
      rig.run(3.0);
      ASSERT_TRUE(rig.ask(robot::CorrectAntennas{true})) << seed;
      ASSERT_TRUE(rig.ask(robot::Acknowledge{})) << seed;
      ASSERT_TRUE(rig.ask(robot::ResumeMission{})) << seed;
      rig.run_until([&] { return !runs(); }, 120.0);
      EXPECT_NEAR(base::deg_from_rad(rig.state()->estimator.antennas_offset_rad), -22.0, 3.0);
    }
    EXPECT_EQ(rig.execution(), ExecutionState::Finished) << rig.state()->mission.reason;
    EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 12}, {8, 12}, {8, 4}}), 0.5) << seed;
    EXPECT_LT(std::abs(rig.yaw_error_deg()), 3.0) << seed;
  }
  EXPECT_GT(held, 0);
}

TEST(Askew, BeforeItHasDrivenTheirHeadingClaimsNoTenthOfADegree) {
  Rig rig(mounted(0.0));
  rig.run(5.0);
  EXPECT_GE(base::deg_from_rad(rig.state()->pose->yaw_sigma_rad), 3.0);
  rig.arm_and_start(rig.plan_of({{0, 10}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 6.0; }, 40.0));
  EXPECT_LT(base::deg_from_rad(rig.state()->pose->yaw_sigma_rad), 1.0);
  EXPECT_FALSE(rig.has_condition("antennas_askew"));
}

//   ↖ points    a crab goes there: ↑    nobody sees it but two antennas
struct Claim {
  double error_in_sigmas = 0.0;  // rms, while it drives
  double sigma_deg = 0.0;        // at the end
};

Claim claim_of(RigOptions o) {
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 15}, {10, 15}}));
  EXPECT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 5.0; }, 40.0));
  double sum = 0.0;
  int n = 0;
  while (rig.execution() == ExecutionState::Running && n < 100) {
    rig.run(0.5);
    const double sigma_deg = base::deg_from_rad(rig.state()->pose->heading_sigma_rad);
    sum += std::pow(rig.yaw_error_deg() / sigma_deg, 2);
    ++n;
  }
  EXPECT_EQ(rig.execution(), ExecutionState::Finished) << rig.state()->mission.reason;
  return {std::sqrt(sum / n), base::deg_from_rad(rig.state()->pose->heading_sigma_rad)};
}

TEST(HeadingClaim, WhatOnlyDrivingShowedIsNoSurerThanACrabLeavesIt) {
  for (const double crab : {-0.10, -0.03, 0.05, 0.08, 0.10}) {
    RigOptions o;
    o.plant.gnss.profile = "rtk";
    o.plant.drive.crab = crab;
    EXPECT_LT(claim_of(o).error_in_sigmas, 1.3) << crab;
  }
}

TEST(HeadingClaim, TwoAntennasThatProvedThemselvesSeeTheCrab) {
  RigOptions o = mounted(0.0);
  o.plant.drive.crab = 0.05;
  const Claim claim = claim_of(o);
  EXPECT_LT(claim.error_in_sigmas, 1.3);
  EXPECT_LT(claim.sigma_deg, 1.0);
}

}  // namespace
}  // namespace roverd::loop
