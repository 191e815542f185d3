// The drive along a row, looks made by hand: where it stops when what it sees grows vague or old,
// and when the row's end is told late.

#include <optional>

#include <gtest/gtest.h>

#include "nav/behave/row_drive.hpp"

namespace roverd::nav::rows::tests {
namespace {

constexpr double kBrakeTick_s = 0.02;

/// A robot on the x axis of O that does at once what it is told. Its row lies along y = row_y_m.
struct Lookout {
  RowDrive drive{PathParams{}, RowDriveParams{}};
  Pose2 body;
  base::BodyTwist twist;
  double now_s = 1.0;
  double row_y_m = 0.0;
  double sigma_m = 0.03;
  std::optional<double> end_x_m{};
  bool sees = true;
  RowView view;

  void look() {
    view = {};
    view.stamp = base::Time{base::from_seconds(now_s)};
    view.line = {body.x_m, row_y_m, 0.0};
    view.covariance[0] = sigma_m * sigma_m;
    if (end_x_m) view.to_end_m = *end_x_m - body.x_m;
  }

  void run(double for_s) {
    for (const double until_s = now_s + for_s; now_s < until_s; now_s += kBrakeTick_s) {
      if (sees) look();
      RowSight sight;
      sight.view = &view;
      sight.age_s = now_s - base::seconds(view.stamp.time_since_epoch());
      sight.body = body;
      Vehicle vehicle;
      vehicle.speed_mps = twist.linear_mps;
      vehicle.yaw_rate_radps = twist.angular_radps;
      twist = drive.step(sight, vehicle, 10.0, kBrakeTick_s).command;
      body = body * sense::along(twist.linear_mps, twist.angular_radps, kBrakeTick_s);
    }
  }
};

// 0.6 m/s: 0.2 s until it brakes, the delay, and the way of braking.
constexpr double kBraking_m = 0.6;

TEST(RowBraking, BrakesAtOnceWhereTheRowIsUnsure) {
  Lookout robot;
  robot.drive.begin({});
  robot.run(6.0);
  ASSERT_GT(robot.twist.linear_mps, 0.5);
  const double from_m = robot.body.x_m;
  robot.sigma_m = 0.3;
  robot.run(4.0);
  EXPECT_EQ(robot.twist.linear_mps, 0.0);
  EXPECT_LT(robot.body.x_m - from_m, kBraking_m);
  EXPECT_TRUE(robot.drive.waits());
  robot.sigma_m = 0.03;
  robot.run(3.0);
  EXPECT_GT(robot.twist.linear_mps, 0.5);
}

TEST(RowBraking, StopsWhereAnEndIsToldLate) {
  Lookout robot;
  robot.drive.begin({});
  robot.run(6.0);
  const double from_m = robot.body.x_m;
  robot.end_x_m = from_m;
  robot.run(4.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Done);
  EXPECT_LT(robot.body.x_m - from_m, kBraking_m);
}

TEST(RowBraking, StopsAtAnEndThatIsToldInTime) {
  Lookout robot;
  robot.drive.begin({});
  robot.end_x_m = 5.0;
  robot.run(20.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Done);
  EXPECT_NEAR(robot.body.x_m, 5.0, 0.1);
}

// The row that was driven before lies 3 m to the left: nothing of it is left.
TEST(RowBraking, BrakesAlongTheRowInHandNotTheOneBefore) {
  Lookout robot;
  robot.row_y_m = 0.0;
  robot.drive.begin({});
  robot.end_x_m = 3.0;
  robot.run(15.0);
  ASSERT_EQ(robot.drive.state(), RowDrive::State::Done);
  robot.body = {0.0, -3.0, 0.0};
  robot.twist = {};
  robot.view = {};
  robot.row_y_m = -3.0;
  robot.end_x_m.reset();
  robot.sigma_m = 0.3;  // seen, but vaguely: it creeps on as it looks for it
  robot.drive.begin({});
  robot.sees = false;
  robot.run(2.0);
  robot.sees = true;
  robot.run(2.0);
  ASSERT_GT(robot.twist.linear_mps, 0.1);
  robot.sigma_m = 0.03;
  robot.run(0.02);
  robot.sees = false;
  robot.run(3.0);
  EXPECT_EQ(robot.twist.linear_mps, 0.0);
  EXPECT_NEAR(robot.body.y_m, -3.0, 0.02);
  EXPECT_NEAR(robot.body.yaw_rad, 0.0, 0.02);
}

TEST(RowBraking, StopsForAViewThatIsOlderThanItMayBe) {
  const auto goes_on = [](double old_s) {
    RowDriveParams params;
    params.old_s = old_s;
    Lookout robot{RowDrive{PathParams{}, params}, {}, {}, 1.0, 0.0, 0.03, {}, true, {}};
    robot.drive.begin({});
    robot.run(4.0);
    robot.sees = false;
    robot.run(1.5);
    return robot.twist.linear_mps > 0.3;
  };
  EXPECT_FALSE(goes_on(0.5));
  EXPECT_TRUE(goes_on(2.5));
}

// From before its first plants a row is seen vaguely: to stand there makes it no surer.
TEST(RowBraking, CreepsTowardsARowThatIsSeenVaguelyAtFirst) {
  Lookout robot;
  robot.sigma_m = 0.3;
  robot.drive.begin({});
  robot.run(6.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Seeking);
  EXPECT_NEAR(robot.twist.linear_mps, RowDriveParams{}.creep_mps, 0.02);
  robot.sigma_m = 0.03;
  robot.run(3.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Driving);
  EXPECT_GT(robot.twist.linear_mps, 0.5);
}

TEST(RowBraking, GivesUpWhatStaysVagueAfterThreeMetres) {
  Lookout robot;
  robot.sigma_m = 0.3;
  robot.drive.begin({});
  robot.run(18.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Seeking);  // it stands and looks on
  robot.run(8.0);
  EXPECT_EQ(robot.drive.state(), RowDrive::State::Failed);
  EXPECT_EQ(robot.drive.reason(), "the row is not seen surely enough");
  EXPECT_NEAR(robot.body.x_m, RowDriveParams{}.entry_m, 0.1);
}

}  // namespace
}  // namespace roverd::nav::rows::tests
