// What counts as a place where the robot slipped, and how often it is told.

#include "services/slip_recorder.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace roverd::services {
namespace {

constexpr base::LatLon kMeadow{58.378, 26.729};

/// A robot that drives north; every sample is looked at.
struct Drive {
  SlipRecorder recorder;
  base::Snapshot s;
  std::vector<store::Slip> told;
  double north_m = 0.0;

  Drive() {
    recorder.note = [this](const store::Slip& slip) { told.push_back(slip); };
    s.pose.emplace();
    s.pose->horizontal_sigma_m = 0.02;
    s.pose->speed_mps = 0.8;
  }
  void drive(double way_m) {
    for (double done_m = 0.0; done_m < way_m - 1e-9; done_m += 0.05) {
      north_m += 0.05;
      look();
    }
  }
  void look() {
    s.pose->global = base::destination(kMeadow, 0.0, north_m);
    recorder.look(s);
  }
  void spin(bool on) {
    s.safety.clear();
    if (on) s.safety.emplace_back().id = "wheels_spin";
  }
};

TEST(SlipRecorder, TellsAStretchEveryTwoMetresAndNoFirmGround) {
  Drive d;
  d.s.estimator.odometry_scale = 0.9;
  d.drive(10.0);
  EXPECT_TRUE(d.told.empty());
  d.s.estimator.odometry_scale = 0.6;
  d.drive(5.0);
  ASSERT_EQ(d.told.size(), 3u);
  EXPECT_EQ(d.told[0].kind, store::SlipKind::Slip);
  EXPECT_NEAR(d.told[0].percent, 40.0, 1e-9);
  EXPECT_NEAR(base::distance_bearing(d.told[0].at, d.told[1].at).distance_m, 2.0, 0.06);
  d.s.estimator.odometry_scale = 1.0;
  d.drive(5.0);
  EXPECT_EQ(d.told.size(), 3u);
}

TEST(SlipRecorder, TellsASlideAsideOfEitherSide) {
  for (const double side : {0.2, -0.2}) {
    Drive d;
    d.s.estimator.side_slip = side;
    d.drive(1.0);
    ASSERT_EQ(d.told.size(), 1u);
    EXPECT_EQ(d.told[0].kind, store::SlipKind::Side);
    EXPECT_NEAR(d.told[0].percent, 20.0, 1e-9);
  }
}

TEST(SlipRecorder, TellsOnceWhereItDugInAndAgainWhenItIsFree) {
  Drive d;
  d.s.pose->speed_mps = 0.0;
  d.spin(true);
  for (int i = 0; i < 100; ++i) d.look();
  ASSERT_EQ(d.told.size(), 1u);
  EXPECT_EQ(d.told[0].kind, store::SlipKind::Dug);
  d.spin(false);
  d.look();
  d.s.mission.state = base::ExecutionState::Blocked;
  d.s.mission.reason = "no progress for 10 s";
  d.look();
  EXPECT_EQ(d.told.size(), 2u);
}

TEST(SlipRecorder, KeepsNoPlaceThatIsNotKnown) {
  Drive d;
  d.s.estimator.odometry_scale = 0.5;
  d.s.pose->horizontal_sigma_m = 3.0;
  d.drive(3.0);
  d.s.pose.reset();
  d.recorder.look(d.s);
  EXPECT_TRUE(d.told.empty());
  Drive stands;
  stands.s.estimator.odometry_scale = 0.5;
  stands.s.pose->speed_mps = 0.0;
  stands.look();
  EXPECT_TRUE(stands.told.empty()) << "what was measured before it stood";
}

}  // namespace
}  // namespace roverd::services
