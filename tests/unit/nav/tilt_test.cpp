// How the robot leans and how its heading turns, told of a body that is moved in space.

#include "nav/estimate/tilt.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

using base::deg_from_rad;
using base::rad_from_deg;

/// A body in space and what its device shows, a hundred times a second if not said otherwise.
class Body {
 public:
  explicit Body(const Eigen::Matrix3d& R_EB, bool tells_lean = false, int every_ms = 10)
      : R_EB_(R_EB), tells_(tells_lean), every_ms_(every_ms) {
    show(Eigen::Vector3d::Zero());
    heading_rad_ = yaw_rad();
  }

  /// @param rate_dps about its own axes ahead, left, up
  void turn(const Eigen::Vector3d& rate_dps, double for_s) {
    const double step_s = 1e-3 * every_ms_;
    for (int i = 0; i < std::lround(for_s / step_s); ++i) {
      const Eigen::Vector3d by = rate_dps * rad_from_deg(1.0) * step_s;
      now_ += std::chrono::milliseconds(every_ms_);
      move(by);
      const base::BodyVector rate = show(by / step_s);
      heading_rad_ += tilt.heading_radps(rate, now_) * step_s;
      heading_off_deg = std::max(heading_off_deg,
                                 std::abs(deg_from_rad(base::wrap_rad(heading_rad_ - yaw_rad()))));
      lean_off_deg = std::max(lean_off_deg, off_deg());
    }
  }
  /// Nothing is heard meanwhile.
  void turn_unheard(const Eigen::Vector3d& by_deg, double for_s) {
    now_ += base::from_seconds(for_s);
    move(by_deg * rad_from_deg(1.0));
  }
  /// @return between the told lean and the true one.
  double off_deg() const {
    const auto lean = tilt.at(now_);
    if (!lean) return 180.0;
    return deg_from_rad(
        std::max(std::abs(lean->roll_rad - roll_rad()), std::abs(lean->pitch_rad - pitch_rad())));
  }

  Tilt tilt;
  double heading_off_deg = 0.0;  ///< at most
  double lean_off_deg = 0.0;

 private:
  double roll_rad() const { return std::atan2(R_EB_(2, 1), R_EB_(2, 2)); }
  double pitch_rad() const { return std::asin(R_EB_(2, 0)); }
  double yaw_rad() const { return std::atan2(R_EB_(1, 0), R_EB_(0, 0)); }
  void move(const Eigen::Vector3d& by_rad) {
    const double angle_rad = by_rad.norm();
    if (angle_rad == 0.0) return;
    R_EB_ = R_EB_ * Eigen::AngleAxisd(angle_rad, by_rad / angle_rad).toRotationMatrix();
  }

  base::BodyVector show(const Eigen::Vector3d& radps) {
    const Eigen::Vector3d up = R_EB_.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
    base::Inertial one;
    one.stamp = now_;
    one.rate_radps = base::BodyVector{radps.x(), radps.y(), radps.z()};
    one.accel_mps2 = base::BodyVector{up.x(), up.y(), up.z()};
    tilt.put(one, 0.0, radps.z());
    if (tells_) tilt.put(base::Attitude{now_, roll_rad(), pitch_rad()});
    return *one.rate_radps;
  }

  Eigen::Matrix3d R_EB_;
  bool tells_;
  int every_ms_;
  base::Time now_{};
  double heading_rad_ = 0.0;
};

/// It rises towards the east.
Eigen::Matrix3d on_slope(double slope_deg, double turned_deg) {
  return (Eigen::AngleAxisd(-rad_from_deg(slope_deg), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rad_from_deg(turned_deg), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

TEST(Tilt, WhoTurnsTwiceOnASlopePointsAndLeansAsBefore) {
  struct {
    double slope_deg;
    double heading_deg;
    double lean_deg;
  } const most[] = {{0.0, 1e-6, 1e-6}, {5.0, 0.01, 0.01}, {10.0, 0.02, 0.01}, {20.0, 0.06, 0.01}};
  for (const auto& m : most) {
    for (const double turn_dps : {-30.0, 30.0, 90.0}) {
      for (const bool told : {false, true}) {
        Body body(on_slope(m.slope_deg, 25.0), told);
        body.turn({0.0, 0.0, turn_dps}, 720.0 / std::abs(turn_dps));
        EXPECT_LE(body.heading_off_deg, m.heading_deg) << m.slope_deg << ", " << turn_dps;
        EXPECT_LE(body.lean_off_deg, m.lean_deg) << m.slope_deg << ", " << turn_dps;
      }
    }
  }
}

TEST(Tilt, TwentySamplesASecondAreEnoughForIt) {
  Body body(on_slope(20.0, 25.0), false, 50);
  body.turn({0.0, 0.0, 90.0}, 8.0);
  EXPECT_LT(body.heading_off_deg, 0.3);
  EXPECT_LT(body.lean_off_deg, 0.1);
}

//   One track over stones, uphill: it rolls about its own nose, which stays where it points.
TEST(Tilt, WhoRollsAboutHisNoseTurnsNowhere) {
  for (const double slope_deg : {-15.0, 15.0}) {
    for (const bool told : {false, true}) {
      Body body(on_slope(slope_deg, 0.0), told);
      for (int i = 0; i < 20; ++i) body.turn({i % 2 == 0 ? 40.0 : -40.0, 0.0, 0.0}, 0.2);
      EXPECT_LT(body.heading_off_deg, 0.01) << slope_deg;
    }
  }
}

//   Across the slope its nose goes over a stone: about its axle, which does not lie level.
TEST(Tilt, WhoNodsAcrossASlopeTurnsByThat) {
  for (const bool told : {false, true}) {
    Body body(on_slope(15.0, 90.0), told);
    body.turn({0.0, -40.0, 0.0}, 0.3);
    EXPECT_LT(body.heading_off_deg, 0.02) << told;
  }
}

//   What it turned in a gap is not known: it is not turned by what came after.
TEST(Tilt, AfterAGapItGoesOnFromTheLeanBeforeAndThenByGravity) {
  Body body(on_slope(20.0, 0.0));
  body.turn({0.0, 0.0, 0.0}, 1.0);
  body.turn_unheard({0.0, 0.0, 0.0}, 0.4);
  body.turn({0.0, 0.0, 90.0}, 0.1);
  EXPECT_LT(body.off_deg(), 1.0);
  // One of more than half a second begins anew.
  body.turn_unheard({0.0, 0.0, 120.0}, 0.6);
  body.turn({0.0, 0.0, 0.0}, 0.02);
  EXPECT_LT(body.off_deg(), 0.1);
}

base::Inertial shows(base::Time stamp, base::BodyVector accel_mps2) {
  base::Inertial one;
  one.stamp = stamp;
  one.rate_radps = base::BodyVector{};
  one.accel_mps2 = accel_mps2;
  return one;
}

TEST(Tilt, ABlowIsNoGravityNeitherAsTheFirstSampleNorLater) {
  Tilt tilt;
  base::Time now{};
  const auto hear = [&](base::BodyVector accel) {
    now += std::chrono::milliseconds(10);
    tilt.put(shows(now, accel), 0.0, 0.0);
  };
  const base::BodyVector blow{20.0, 0.0, 9.81};
  const base::BodyVector leans{9.81 * std::sin(rad_from_deg(20.0)), 0.0,
                               9.81 * std::cos(rad_from_deg(20.0))};
  hear(blow);
  EXPECT_FALSE(tilt.at(now));
  hear(leans);
  ASSERT_TRUE(tilt.at(now));
  EXPECT_NEAR(deg_from_rad(tilt.at(now)->pitch_rad), 20.0, 1e-6);
  // A second of blows; then one sample that looks level counts no more than one.
  for (int i = 0; i < 100; ++i) hear(blow);
  hear({0.0, 0.0, 9.81});
  ASSERT_TRUE(tilt.at(now));
  EXPECT_GT(deg_from_rad(tilt.at(now)->pitch_rad), 19.0);
}

TEST(Tilt, AnOlderWordOfADeviceIsNone) {
  Tilt tilt;
  const base::Time now = base::Time{} + std::chrono::seconds(1);
  tilt.put(base::Attitude{now, 0.1, 0.2});
  tilt.put(base::Attitude{now - std::chrono::milliseconds(50), 0.3, 0.4});
  ASSERT_TRUE(tilt.at(now));
  EXPECT_EQ(tilt.at(now)->roll_rad, 0.1);
  EXPECT_EQ(tilt.at(now)->pitch_rad, 0.2);
}

//   Straight up a slope of 15 degrees, tracks, satellites and compass well; the gyro turns.
TEST(Tilt, AGyroThatLiesAboutATurnDoesNotTurnTheLean) {
  Drive d;
  d.pitch_rad = rad_from_deg(15.0);
  d.gyro = true;
  d.speed_mps = 0.6;
  d.run(40.0);
  d.gyro_bias_radps = rad_from_deg(30.0);
  d.run(10.0);
  ASSERT_TRUE(d.estimator.attitude(d.now()));
  EXPECT_TRUE(d.estimator.health().votes[base::Sense::Gyro].left_out);
  EXPECT_NEAR(deg_from_rad(d.estimator.attitude(d.now())->pitch_rad), 15.0, 1.0);
  EXPECT_NEAR(deg_from_rad(d.estimator.attitude(d.now())->roll_rad), 0.0, 1.0);
}

}  // namespace
}  // namespace roverd::nav
