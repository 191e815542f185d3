// A receiver whose own time steps back, and what arming waits for.

#include "robot/safety/receiver_clock.hpp"

#include "field.hpp"

namespace roverd::robot {
namespace {

/// Fixes every 0.2 s with these times of the receiver.
ReceiverClock after(const std::vector<double>& times_s) {
  ReceiverClock clock;
  base::Time now{};
  for (const double t : times_s) {
    now += std::chrono::milliseconds(200);
    clock.take(base::WallTime{} + base::from_seconds(t), now);
  }
  return clock;
}

TEST(ReceiverClock, ThreeInARowBelowTheNewestAreAStepBack) {
  EXPECT_FALSE(after({10.0, 10.2, 10.4, 10.6}).last_step());
  EXPECT_FALSE(after({10.0, 7.0, 7.2}).last_step());
  const auto step = after({10.0, 7.0, 7.2, 7.4, 7.6}).last_step();
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->back_s, 3.0, 1e-9);
  EXPECT_NEAR(base::seconds(step->stamp.time_since_epoch()), 0.4, 1e-9);
}

TEST(ReceiverClock, TwoReceiversInTurnAndOnesWithoutTimeAreNoStep) {
  EXPECT_FALSE(after({10.0, 8.0, 10.2, 8.2, 10.4, 8.4, 10.6, 8.6}).last_step());
  EXPECT_FALSE(after({10.0, 10.0, 10.0, 10.0, 10.2}).last_step()) << "it stands; others see that";
  EXPECT_FALSE(after({10.0, 9.6, 9.7, 9.8}).last_step()) << "less than half a second";
  ReceiverClock without;
  for (int i = 0; i < 10; ++i) without.take(std::nullopt, base::Time{});
  EXPECT_FALSE(without.last_step());
}

TEST(ArmingWaits, ForAReceiverWhoseTimeSteppedBackAndSaysSo) {
  Field f;
  f.receiver_late_s = 0.0;
  f.run(8.0);
  ASSERT_TRUE(f.state()->ready_to_arm);
  *f.receiver_late_s = 3.0;
  f.run(1.1);
  ASSERT_FALSE(f.check("gnss_fix").ok);
  EXPECT_EQ(f.check("gnss_fix").detail,
            "fix rtk_fixed, but the receiver's time stepped back by 2.8 s, 1 s ago: "
            "waiting 5 s more to trust it");
  f.run(5.0);
  EXPECT_TRUE(f.check("gnss_fix").ok) << f.check("gnss_fix").detail;
  // One that never stops stepping back names it for as long.
  for (int i = 0; i < 20; ++i) {
    *f.receiver_late_s += 2.0;
    f.run(1.2);
    EXPECT_NE(f.check("gnss_fix").detail.find("stepped back by 1.8 s"), std::string::npos)
        << f.check("gnss_fix").detail;
    EXPECT_FALSE(f.ask(Arm{}));
  }
}

TEST(ArmingWaits, SayWhatBrokeTheHealthyTime) {
  Field f;
  f.run(8.0);
  f.fix = base::FixType::None;
  f.run(1.0);
  f.fix = base::FixType::RtkFixed;
  f.run(2.3);
  EXPECT_EQ(f.check("gnss_fix").detail,
            "fix rtk_fixed, waiting 3 s more to trust it: it had no fix 2 s ago");
  f.run(4.0);
  f.gnss_speaks = false;
  f.run(3.0);
  f.gnss_speaks = true;
  f.run(1.1);
  EXPECT_EQ(f.check("gnss_fix").detail,
            "fix rtk_fixed, waiting 4 s more to trust it: it was silent 1 s ago");
}

}  // namespace
}  // namespace roverd::robot
