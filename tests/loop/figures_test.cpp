// The estimator's figures with a few seeds; tests/bench measures them with twenty.

#include "figures.hpp"

namespace roverd::loop {
namespace {

constexpr std::uint64_t kSeeds = 3;

TEST(Figures, ACompassTwentyDegreesOffNeitherMisleadsNorSwerves) {
  const Alignment a = measure_alignment(kSeeds);
  EXPECT_LT(largest(a.after_2m_deg), 5.0);
  EXPECT_LT(largest(a.after_5m_deg), 1.5);
  EXPECT_LT(largest(a.swerve_deg), 15.0);
}

TEST(Figures, ATurnOnTheSpotKeepsTheHeading) {
  EXPECT_LT(largest(measure_pivots_deg(kSeeds)), 2.0);
}

TEST(Figures, RtkFixedIsAsGoodAsItSays) {
  const RtkErrors e = measure_rtk(kSeeds);
  EXPECT_LT(rms(e.position_m), 0.025);
  EXPECT_LT(rms(e.heading_deg), 0.8);
  EXPECT_LT(largest(e.after_outage_m), 0.25);
  EXPECT_GT(e.inside_pct, 85.0);
}

TEST(Figures, AConsumerReceiverIsSmoothedAndNotMadeWorse) {
  const ConsumerErrors e = measure_consumer(kSeeds, 200.0);
  EXPECT_LT(rms(e.estimate_m), rms(e.receiver_m));
  EXPECT_LT(rms(e.estimate_step_m), 0.7 * rms(e.receiver_step_m));
  EXPECT_GT(e.inside_pct, 70.0);  // ten minutes in all are too little to tell 93 from 97
}

TEST(Figures, AJumpOfThreeMetresHardlyMovesTheEstimate) {
  EXPECT_LT(largest(measure_jump_m(kSeeds)), 0.5);
}

TEST(Figures, ThirtyMetresWithoutGnssEndWithinTwoPercent) {
  EXPECT_LT(largest(measure_blind_pct(kSeeds)), 2.0);
}

TEST(Figures, StandingTenMinutesItStays) {
  const Standing s = measure_standing(1);
  EXPECT_LT(largest(s.moved_m), 0.05);
  EXPECT_LT(largest(s.turned_deg), 0.5);
}

}  // namespace
}  // namespace roverd::loop
