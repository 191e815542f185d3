// Who drives by hand over a late link drives slowly, and from half a second on not at all.

#include <cmath>

#include "field.hpp"

namespace roverd::robot {
namespace {

using base::Mode;

/// MANUAL; somebody pushes 0.8 m/s, ten times a second.
class LateLink : public Field {
 public:
  LateLink() {
    run(8.0);
    EXPECT_TRUE(ask(Arm{}));
    EXPECT_TRUE(ask(SetMode{Mode::Manual}));
    let_go();
  }

  /// @param late_s of the k-th message; it is good for a second.
  template <class Late>
  void push(double seconds, Late late_s, double turn_radps = 0.0) {
    for (int k = 0; k < std::lround(10.0 * seconds); ++k) {
      const Drive stick{{0.8, turn_radps}, true, 1, now - base::from_seconds(late_s(k))};
      robot.request(stick, now + std::chrono::seconds(1), {});
      run(0.1);
    }
  }
  void push_late(double late_s) {
    push(4.0, [late_s](int) { return late_s; });
  }
  double speed_mps() const { return command.twist.linear_mps; }
};

TEST(LateLink, OnAGoodOneItDrivesAsItIsTold) {
  LateLink f;
  f.push_late(0.05);
  EXPECT_DOUBLE_EQ(f.speed_mps(), 0.8);
  EXPECT_FALSE(f.has_condition("link_delay"));
  EXPECT_EQ(f.state()->speed_reason, "manual");
  EXPECT_NEAR(f.state()->teleop.delay_s.value(), 0.15, 0.03) << "the newest is 0.1 s older by now";
}

TEST(LateLink, BetweenTheLimitsTheSpeedFallsEvenlyAndItSaysSo) {
  LateLink f;
  f.push_late(0.275);  // 0.375 just before the next: half way from 0.25 to 0.5
  EXPECT_NEAR(f.speed_mps(), 0.5 * 1.0, 0.1);
  EXPECT_TRUE(f.has_condition("link_delay"));
  EXPECT_EQ(f.state()->speed_reason, "link_delay");
  EXPECT_EQ(f.state()->teleop.phase, base::TeleopPhase::Held);
}

TEST(LateLink, FromHalfASecondOnItStands) {
  LateLink f;
  f.push_late(0.5);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.has_condition("link_delay"));
}

TEST(LateLink, TurnsAreSlowerToo) {
  LateLink f;
  f.push(
      4.0, [](int) { return 0.5; }, 0.5);
  EXPECT_EQ(f.command.twist.angular_radps, 0.0);
}

TEST(LateLink, OneThatJittersCountsAsLateAsItsWorst) {
  // 0.02 and 0.18 s in turn: 0.1 in the mean, and nobody knows which comes next.
  LateLink f;
  f.push(6.0, [](int k) { return k % 2 == 0 ? 0.02 : 0.18; });
  EXPECT_GT(f.state()->teleop.delay_s.value(), 0.3);
  EXPECT_LT(f.speed_mps(), 0.75);
}

TEST(LateLink, WhenItIsGoodAgainTheSpeedComesBack) {
  LateLink f;
  f.push_late(0.45);
  EXPECT_LT(f.speed_mps(), 0.1);
  f.push(8.0, [](int) { return 0.05; });
  EXPECT_DOUBLE_EQ(f.speed_mps(), 0.8);
}

TEST(LateLink, BetweenTwoMessagesItGrowsOlder) {
  LateLink f;
  f.push_late(0.05);
  f.run(0.26);  // 0.36 s since the newest was sent
  EXPECT_LT(f.speed_mps(), 0.65);
  EXPECT_GT(f.speed_mps(), 0.3);
}

}  // namespace
}  // namespace roverd::robot
