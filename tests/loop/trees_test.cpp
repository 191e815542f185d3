// Under trees a receiver claims 1.5 cm and errs by a metre, from the first position on. What the
// robot cannot know it neither claims nor drives by.

#include "rig.hpp"

namespace roverd::loop {
namespace {

struct UnderTrees {
  double astray_m = 0.0;  ///< of the true robot, from its way
  int claims = 0;         ///< while it drove
  int true_ones = 0;      ///< of these: the truth was within 2.45 sigma, 95 %
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
    if (std::abs(rig.truth().twist.linear_mps) < 0.05) continue;
    ++seen.claims;
    const double claim_m = 2.45 * rig.state()->pose->horizontal_sigma_m;
    seen.true_ones += rig.position_error_m() < claim_m ? 1 : 0;
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

// It hardly scatters, and never loses its fix: only that it wanders tells.
TEST(Trees, AFixThatStaysAndWandersLeadsItNoFarther) {
  sim::TreesParams trees;
  trees.share = 0.4;
  trees.noise = 2.0;
  trees.fixed_share = 1.0;
  for (const std::uint64_t seed : {1U, 3U, 4U, 6U, 8U}) {
    const UnderTrees seen = drive_under(trees, seed);
    EXPECT_LT(seen.astray_m, 0.5) << seed << ": " << seen.reason;
  }
}

// Where it may drive on, it says how little it knows of its place.
TEST(Trees, WhatItClaimsBelowThemIsTrueOfTheTime) {
  sim::TreesParams trees;
  trees.share = 1.0;
  trees.noise = 2.0;
  trees.fixed_share = 1.0;
  int claims = 0;
  int true_ones = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const UnderTrees seen = drive_under(trees, seed);
    claims += seen.claims;
    true_ones += seen.true_ones;
  }
  ASSERT_GT(claims, 1000);
  EXPECT_GT(static_cast<double>(true_ones) / claims, 0.9) << claims;
}

/// Beside a wall it stood long, and its positions were a metre off all the time. After so much of
/// the way they jump to the truth. @return by how much the error passes three sigmas and 0.15 m.
double too_sure_m(double jumps_after_m, std::uint64_t seed) {
  RigOptions o;
  o.seed = seed;
  Rig rig(o);
  rig.fault([](sim::Faults& f) { f.gnss_jump_east_m = 1.0; });
  rig.run(20.0);
  EXPECT_NEAR(rig.position_error_m(), 1.0, 0.1);
  rig.arm_and_start(rig.plan_of({{0, 30}}, 1.0));
  EXPECT_TRUE(rig.run_until([&] { return rig.truth().driven_m > jumps_after_m; }, 20.0));
  rig.fault([](sim::Faults&) {});
  rig.run(2.0);
  double most_m = -1e9;
  for (int i = 0; i < 50 * 10; ++i) {
    rig.tick();
    const double claim_m = 3.0 * rig.state()->pose->horizontal_sigma_m + 0.15;
    most_m = std::max(most_m, rig.position_error_m() - claim_m);
  }
  return most_m;
}

TEST(Trees, WhatWasToldWhileItStoodProvesNothingOnceThePositionsJumpToTheTruth) {
  for (const double after_m : {2.0, 4.0, 6.0}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      EXPECT_LT(too_sure_m(after_m, seed), 0.0) << after_m << " m, " << seed;
    }
  }
}

}  // namespace
}  // namespace roverd::loop
