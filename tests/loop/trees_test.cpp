// Under trees a receiver claims 1.5 cm and errs by a metre, from the first position on. What the
// robot cannot know it neither claims nor drives by.

#include "rig.hpp"

namespace roverd::loop {
namespace {

struct UnderTrees {
  double astray_m = 0.0;  ///< of the true robot, from its way
  double surest_m = 1e9;  ///< smallest claim while it drove and the truth was half a metre off
  bool started = false;
  std::string reason;
};

/// Straight ahead for 20 m at 1 m/s, if it may.
UnderTrees drive_under(const sim::TreesParams& trees, std::uint64_t seed) {
  RigOptions o;
  o.seed = seed;
  o.plant.gnss.noise_scale = 1.44;
  o.plant.trees = trees;
  Rig rig(o);
  UnderTrees seen;
  rig.run_until([&] { return rig.state()->ready_to_arm; }, 40.0);
  if (!rig.ask(robot::Arm{})) return seen;
  rig.load(rig.plan_of({{0, 20}}, 1.0));
  const auto started = rig.ask(robot::StartMission{"m1", 1});
  seen.started = started.has_value();
  if (!started) seen.reason = started.error().detail;
  rig.track.clear();
  for (int i = 0; i < 50 * 50 && rig.execution() == ExecutionState::Running; ++i) {
    rig.tick();
    const bool drives = std::abs(rig.truth().twist.linear_mps) > 0.05;
    if (drives && rig.position_error_m() > 0.5) {
      seen.surest_m = std::min(seen.surest_m, rig.state()->pose->horizontal_sigma_m);
    }
  }
  if (seen.started) seen.reason = rig.state()->mission.reason;
  if (!rig.track.empty()) seen.astray_m = rig.farthest_from_line_m({0, 0}, {0, 20});
  return seen;
}

TEST(Trees, NeverLeadItHalfAMetreFromItsWay) {
  sim::TreesParams trees;
  trees.share = 0.4;
  for (const std::uint64_t seed : {1U, 3U, 5U, 7U, 9U, 15U, 16U, 18U}) {
    const UnderTrees seen = drive_under(trees, seed);
    EXPECT_LT(seen.astray_m, 0.5) << seed << ": " << seen.reason;
  }
}

TEST(Trees, AStartBelowThemIsRefusedOrHeldWithTheReason) {
  sim::TreesParams trees;
  trees.share = 1.0;
  for (const std::uint64_t seed : {5U, 16U, 18U}) {
    const UnderTrees seen = drive_under(trees, seed);
    EXPECT_NE(seen.reason.find("position"), std::string::npos) << seed << ": " << seen.reason;
    EXPECT_LT(seen.astray_m, 0.5) << seed << ": " << seen.reason;
  }
}

// Beside a wall it stood long, and its positions were a metre off all the time.
TEST(Trees, WhatWasToldWhileItStoodProvesNothingOnceThePositionsJumpToTheTruth) {
  Rig rig{RigOptions{}};
  rig.fault([](sim::Faults& f) { f.gnss_jump_east_m = 1.0; });
  rig.run(20.0);
  EXPECT_NEAR(rig.position_error_m(), 1.0, 0.1);
  rig.arm_and_start(rig.plan_of({{0, 30}}, 1.0));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 2.0; }, 20.0));
  rig.fault([](sim::Faults&) {});
  rig.run(2.0);
  for (int i = 0; i < 50 * 10; ++i) {
    rig.tick();
    const double claim_m = 3.0 * rig.state()->pose->horizontal_sigma_m + 0.15;
    ASSERT_LT(rig.position_error_m(), claim_m) << i;
  }
}

}  // namespace
}  // namespace roverd::loop
