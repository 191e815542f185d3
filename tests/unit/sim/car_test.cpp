// A car against the bicycle model worked out by hand: ω = v·tan(δ)/L.

#include "sim/car.hpp"

#include <gtest/gtest.h>

#include "ackermann/codec.hpp"
#include "cart.hpp"

namespace roverd::sim {
namespace {

constexpr double kStep_s = 0.005;

std::array<std::uint8_t, 12> order(float speed_mps, float wheel_rad,
                                   ackermann::DriveMode mode = ackermann::DriveMode::Autonomous) {
  return ackermann::encode({speed_mps, wheel_rad, mode});
}

//  L = 1.3 m, δ = 0.5 rad: R = 1.3/tan(0.5) = 2.3796 m. 2 m on it turn by 0.8405 rad:
//  x = R·sin = 1.772 m, y = R·(1 − cos) = 0.793 m.
TEST(Car, DrivesTheCircleOfTheBicycleModel) {
  CartPlant p(ideal_cart("ackermann"));
  p.repeat(order(0.0F, 0.5F), 200ms);  // the wheels first
  EXPECT_EQ(p.truth().driven_m, 0.0);
  p.repeat(order(1.0F, 0.5F), 2s);
  p.repeat(order(0.0F, 0.5F), 1s);
  const Truth t = p.truth();
  EXPECT_NEAR(t.driven_m, 2.0, 0.01);  // 0.1 s up, 0.1 s down
  const double turned = t.driven_m / 2.3796;
  EXPECT_NEAR(t.yaw_rad, turned, 1e-3);
  EXPECT_NEAR(t.local.east_m, 2.3796 * std::sin(turned), 2e-3);
  EXPECT_NEAR(t.local.north_m, 2.3796 * (1.0 - std::cos(turned)), 2e-3);
}

TEST(Car, TheWheelTurnsNoFasterThanItCanAndNotBeyondItsLock) {
  Params p = ideal_cart("ackermann");
  p.car.wheel_rate_radps = 0.5;
  Car car;
  for (int i = 0; i < 100; ++i) car.step(p.drive, p.car, {0.0, 1.0}, false, kStep_s);
  EXPECT_NEAR(car.wheel_rad(), 0.25, 1e-9);  // 0.5 s
  for (int i = 0; i < 400; ++i) car.step(p.drive, p.car, {0.0, 1.0}, false, kStep_s);
  EXPECT_NEAR(car.wheel_rad(), 0.7, 1e-9);
  for (int i = 0; i < 400; ++i) car.step(p.drive, p.car, {0.0, {}}, false, kStep_s);
  EXPECT_NEAR(car.wheel_rad(), 0.7, 1e-9);  // nobody turned it back
}

TEST(Car, SpeedingUpAndBrakingKeepTheLimits) {
  Params p = ideal_cart("ackermann");
  p.drive.accel_mps2 = 0.5;
  p.drive.decel_mps2 = 1.0;
  p.drive.estop_decel_mps2 = 4.0;
  Car car;
  const auto run = [&](double mps, int steps, bool brake = false) {
    for (int i = 0; i < steps; ++i) car.step(p.drive, p.car, {mps, 0.0}, brake, kStep_s);
    return car.wheel_speed_mps();
  };
  EXPECT_NEAR(run(1.0, 200), 0.5, 1e-9);       // 1 s at 0.5 m/s²
  EXPECT_NEAR(run(1.0, 200), 1.0, 1e-9);       // and no more
  EXPECT_NEAR(run(0.0, 100), 0.5, 1e-9);       // 0.5 s at 1 m/s²
  EXPECT_NEAR(run(1.0, 20, true), 0.1, 1e-9);  // 0.1 s at 4 m/s²
  EXPECT_EQ(run(1.0, 20, true), 0.0);
}

TEST(Car, DelayAndLagComeBeforeTheMotion) {
  Params p = ideal_cart("ackermann");
  p.drive.delay_s = 0.1;
  p.drive.lag_s = 0.2;
  Car car;
  for (int i = 0; i < 20; ++i) car.step(p.drive, p.car, {1.0, 0.3}, false, kStep_s);
  EXPECT_EQ(car.wheel_speed_mps(), 0.0);
  EXPECT_EQ(car.wheel_rad(), 0.0);
  for (int i = 0; i < 40; ++i) car.step(p.drive, p.car, {1.0, 0.3}, false, kStep_s);
  EXPECT_NEAR(car.wheel_speed_mps(), 1.0 - std::exp(-1.0), 1e-3);  // one time constant later
}

TEST(Car, TheLinkagesZeroIsHiddenFromTheSensorTheServosIsNot) {
  Params p = ideal_cart("ackermann");
  p.car.linkage_rad = 0.03;
  Car car;
  for (int i = 0; i < 20; ++i) car.step(p.drive, p.car, {1.0, 0.2}, false, kStep_s);
  EXPECT_NEAR(car.seen_rad(), 0.2, 1e-9);
  EXPECT_NEAR(car.wheel_rad(), 0.17, 1e-9);
  EXPECT_NEAR(car.ground().twist.angular_radps,
              car.ground().twist.linear_mps * std::tan(0.17) / 1.3, 1e-9);
  p.car.linkage_rad = 0.0;
  p.car.servo_rad = 0.03;
  for (int i = 0; i < 20; ++i) car.step(p.drive, p.car, {1.0, 0.2}, false, kStep_s);
  EXPECT_NEAR(car.seen_rad(), 0.17, 1e-9);
  EXPECT_NEAR(car.wheel_rad(), 0.17, 1e-9);
}

TEST(Car, SlipMakesTheWayShorterThanTheWheelsTell) {
  Params p = ideal_cart("ackermann");
  p.drive.slip = 0.1;
  CartPlant c(p);
  c.repeat(order(1.0F, 0.0F), 3s);
  EXPECT_NEAR(c.truth().twist.linear_mps, 0.9, 1e-9);
  EXPECT_NEAR(c.truth().left_track_mps, 1.0, 1e-9);
}

/// The antenna is ahead of the rear axle: in a turn it moves sideways.
TEST(Car, TheReceiverSeesTheAntennaNotTheAxle) {
  Params p = ideal_cart("ackermann");
  p.gnss.antenna_forward_m = 1.0;
  p.gnss.latency_s = 0.0;
  CartPlant c(p);
  std::string gnss;
  c.cart.on_gnss = [&](Bytes b, Time) { gnss.append(b.begin(), b.end()); };
  c.wait(1s);
  const auto at = gnss.find("GGA");
  ASSERT_NE(at, std::string::npos);
  const std::string line = gnss.substr(at - 3, gnss.find("\r\n", at) - at + 3);
  const base::EnuPoint seen = c.cart.frame().to_local(position(line));
  EXPECT_NEAR(seen.east_m, 1.0, 0.01);  // it looks east
  EXPECT_NEAR(seen.north_m, 0.0, 0.01);
}

}  // namespace
}  // namespace roverd::sim
