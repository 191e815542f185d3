// The base of the corrections is moved while the robot drives: every position is three metres off
// from one moment to the next, claims 1.5 cm, and stays so.
//
//   robot   ───────────▶│ holds, and asks: keep the old place, or take the new one?
//   receiver            └ ─ ─ ─ ─ ─ ▶ 3 m beside

#include "rig.hpp"

namespace roverd::loop {
namespace {

constexpr double kShift_m = 3.0;

class BaseShift : public testing::Test {
 protected:
  void SetUp() override {
    RigOptions o;
    o.plant.gnss.profile = "rtk";
    rig_.emplace(o);
    rig_->arm_and_start(rig_->plan_of({{0, 30}}));
    ASSERT_TRUE(rig_->run_until([&] { return rig_->truth().local.north_m > 8.0; }, 60.0));
  }

  void shift(double east_m) {
    sim::Faults f;
    f.gnss_base_shift_east_m = east_m;
    ASSERT_TRUE(rig_->plant.set_faults(f));
  }
  bool asks() { return rig_->has_condition("base_moved"); }
  double error_m() {
    const auto s = rig_->state();
    return base::distance_bearing(s->pose->global, rig_->truth().at).distance_m;
  }

  std::optional<Rig> rig_;
};

TEST_F(BaseShift, IsToldAsSuchAndTheRobotStandsWhereItWas) {
  shift(kShift_m);
  const double from_m = rig_->truth().driven_m;
  ASSERT_TRUE(rig_->run_until([&] { return asks(); }, 9.0));
  rig_->run(3.0);
  EXPECT_TRUE(rig_->stands());
  EXPECT_LT(rig_->truth().driven_m - from_m, 9.0);
  EXPECT_LT(std::abs(rig_->truth().local.east_m), 0.2);  // it followed its way, not the receiver
  EXPECT_LT(error_m(), 0.2);
  EXPECT_GT(rig_->state()->pose->horizontal_sigma_m, 1.0);  // nobody knows which place is right
  ASSERT_TRUE(rig_->state()->estimator.base_shift);
  EXPECT_NEAR(rig_->state()->estimator.base_shift->offset.east_m, kShift_m, 0.15);
  EXPECT_FALSE(rig_->has_condition("estimate_latched"));
  EXPECT_NE(rig_->state()->mission.reason.find("3.0 m"), std::string::npos)
      << rig_->state()->mission.reason;
  EXPECT_FALSE(rig_->ask(robot::ResumeMission{}));
}

TEST_F(BaseShift, TheOldPlaceIsKeptAndTheMissionEndsWhereItShould) {
  shift(kShift_m);
  ASSERT_TRUE(rig_->run_until([&] { return asks() && rig_->stands(); }, 12.0));
  ASSERT_TRUE(rig_->ask(robot::SettleShift{true}));
  rig_->run(1.0);
  EXPECT_FALSE(asks());
  ASSERT_TRUE(rig_->ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig_->run_until([&] { return rig_->execution() == ExecutionState::Finished; }, 90.0));
  EXPECT_NEAR(rig_->truth().local.north_m, 30.0, 0.2);
  EXPECT_NEAR(rig_->truth().local.east_m, 0.0, 0.2);
}

TEST_F(BaseShift, TheNewPlaceIsTaken) {
  shift(kShift_m);
  ASSERT_TRUE(rig_->run_until([&] { return asks() && rig_->stands(); }, 12.0));
  ASSERT_TRUE(rig_->ask(robot::SettleShift{false}));
  rig_->run(2.0);
  EXPECT_FALSE(asks());
  EXPECT_FALSE(rig_->state()->estimator.anchor);
  EXPECT_NEAR(error_m(), kShift_m, 0.2);  // as the receiver says
}

TEST_F(BaseShift, OneThatGoesAwayAsksNobodyAnyMore) {
  shift(kShift_m);
  ASSERT_TRUE(rig_->run_until([&] { return asks() && rig_->stands(); }, 12.0));
  shift(0.0);
  rig_->run(2.0);
  EXPECT_FALSE(asks());
  EXPECT_FALSE(rig_->ask(robot::SettleShift{true}));
  EXPECT_LT(error_m(), 0.2);
}

TEST_F(BaseShift, ARobotThatIsNotArmedMayBeCarried) {
  ASSERT_TRUE(rig_->ask(robot::StopMission{}));
  rig_->run(3.0);
  ASSERT_TRUE(rig_->ask(robot::Disarm{}));
  shift(kShift_m);
  rig_->run(20.0);
  EXPECT_FALSE(asks());
  EXPECT_NEAR(error_m(), kShift_m, 0.2);
}

TEST_F(BaseShift, IsNoneWhileNothingMoved) {
  EXPECT_FALSE(rig_->ask(robot::SettleShift{true}));
  EXPECT_FALSE(rig_->ask(robot::SettleShift{false}));
}

}  // namespace
}  // namespace roverd::loop
