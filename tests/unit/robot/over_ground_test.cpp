// The picture of the surroundings moves with the robot as that moves over ground, not as its tracks
// say.

#include "seeing.hpp"

namespace roverd::robot {
namespace {

class OverGround : public Seeing {
 protected:
  void SetUp() override {
    field.run(8.0);
    ASSERT_TRUE(field.ask(Arm{}));
    ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
    field.let_go();
  }
  void drive(double v_mps, double w_radps, double for_s) {
    for (int i = 0; i < for_s * 50.0; ++i) {
      field.robot.request(Drive{{v_mps, w_radps}, true}, field.now + std::chrono::milliseconds(250),
                          {});
      field.tick();
    }
  }
  /// What the odometry makes of a drive, less what it was, along the axes at its begin.
  base::EnuPoint error_of(double v_mps, double w_radps, double for_s) {
    const nav::sense::Pose2 before = pose;
    const base::EnuPoint from = field.at;
    const double yaw_rad = field.yaw_rad;
    drive(v_mps, w_radps, for_s);
    const nav::sense::Pose2 moved = inverse(before) * pose;
    const base::EnuPoint went = field.at - from;
    const double c = std::cos(yaw_rad);
    const double s = std::sin(yaw_rad);
    return {moved.x_m - (c * went.east_m + s * went.north_m),
            moved.y_m - (c * went.north_m - s * went.east_m)};
  }
};

//   A load in the front: it turns about a place 10 cm ahead, so that half a turn moves it by 20 cm.
TEST_F(OverGround, ATurnAboutAPlaceAheadMovesThePicture) {
  field.pivot_m = 0.1;
  drive(0.5, 0.0, 8.0);
  for (const double way : {0.5, -0.5, 0.5, -0.5}) drive(0.0, way, 15.0);
  const auto off = error_of(0.0, 0.5, 6.28);
  EXPECT_NEAR(std::hypot(off.east_m, off.north_m), 0.0, 0.03);
}

//   Tracks that lose a tenth of their way: ten metres that they count are nine.
TEST_F(OverGround, WhatTheTracksLoseIsNotDriven) {
  field.grip = 0.9;
  drive(0.8, 0.0, 15.0);
  const auto ahead = error_of(0.8, 0.0, 5.0);
  EXPECT_NEAR(ahead.east_m, 0.0, 0.04);
  drive(-0.5, 0.0, 3.0);
  const auto back = error_of(-0.5, 0.0, 5.0);
  EXPECT_NEAR(back.east_m, 0.0, 0.04);
}

}  // namespace
}  // namespace roverd::robot
