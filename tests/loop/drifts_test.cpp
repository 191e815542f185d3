// A fixed solution that runs away slowly is found before it has led the robot astray; honest
// positions on ground that slides are not. tests/bench/drift_bench.cpp measures it with a hundred.

#include "drifts.hpp"

namespace roverd::loop {
namespace {

TEST(Drifts, AFixThatRunsAwayIsFoundWithinThreeSecondsWhateverItsDirectionAndTheGround) {
  for (std::uint64_t i = 0; i < 10; ++i) {
    const DriftLie lie = drift_lie(i, 0.1, 0.8);
    const DriftSeen seen = DriftDrive(100 + i, i, lie).run();
    EXPECT_GE(seen.found_s, 0.0) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_LE(seen.found_s, 3.0 + lie.hidden_s()) << i << ": " << lie.mps << " m/s";
    EXPECT_GE(seen.stands_s, 0.0) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_LT(seen.astray_m, 0.5) << i << ": " << lie.mps << " m/s, " << ground_name(i);
  }
}

TEST(Drifts, ASlowerOneLeadsNobodyFarAstrayBeforeItIsFound) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    const DriftLie lie = drift_lie(i, 0.05, 0.1);
    const DriftSeen seen = DriftDrive(300 + i, i, lie).run();
    EXPECT_GE(seen.found_s, 0.0) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_LT(seen.astray_m, 0.4) << i << ": " << lie.mps << " m/s, " << ground_name(i);
  }
}

TEST(Drifts, HonestPositionsOnGroundThatSlidesAreNeverAccused) {
  for (std::uint64_t i = 0; i < 2 * kGrounds; ++i) {
    DriftDrive drive(200 + i, i, {});
    EXPECT_TRUE(drive.run().arrived) << ground_name(i);
    EXPECT_EQ(drive.accusations, 0u) << ground_name(i);
  }
}

TEST(Drifts, AReceiverWhoseVelocityGoesAlongIsFoundByTracksAndGyro) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    DriftLie lie = drift_lie(i, 0.3, 0.8);
    lie.velocity_too = true;
    const DriftSeen seen = DriftDrive(500 + i, i, lie).run();
    EXPECT_GE(seen.found_s, 0.0) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_TRUE(seen.held) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_LT(seen.astray_m, 0.5) << i << ": " << lie.mps << " m/s, " << ground_name(i);
  }
}

TEST(Drifts, AVelocityThatLagsHidesNoDriftAndAccusesNobody) {
  for (std::uint64_t i = 0; i < 6; ++i) {
    DriftDrive honest(400 + i, i, {}, 0.15);
    EXPECT_TRUE(honest.run().arrived) << ground_name(i);
    EXPECT_EQ(honest.accusations, 0u) << ground_name(i);
    const DriftLie lie = drift_lie(i, 0.1, 0.8);
    const DriftSeen seen = DriftDrive(450 + i, i, lie, 0.15).run();
    EXPECT_GE(seen.found_s, 0.0) << i << ": " << lie.mps << " m/s, " << ground_name(i);
    EXPECT_LE(seen.found_s, 3.0 + lie.hidden_s()) << i << ": " << lie.mps << " m/s";
    EXPECT_LT(seen.astray_m, 0.5) << i << ": " << lie.mps << " m/s, " << ground_name(i);
  }
}

}  // namespace
}  // namespace roverd::loop
