// What is left in the battery, where only its voltage is known.

#include "field.hpp"
#include "robot/safety/battery_gauge.hpp"
#include "robot/world.hpp"

namespace roverd::robot {
namespace {

constexpr const char* kLithium = "41.6 0, 46.8 30, 54.0 100";

base::BaseStatus status_at(base::Time stamp, double voltage_v) {
  base::BaseStatus s;
  s.stamp = stamp;
  s.battery_v = voltage_v;
  return s;
}

TEST(BatteryCurve, IsLinearBetweenItsPointsAndFlatBeyondThem) {
  const auto curve = battery_curve(kLithium);
  ASSERT_TRUE(curve);
  EXPECT_DOUBLE_EQ(charge_pct(*curve, 46.8), 30.0);
  EXPECT_NEAR(charge_pct(*curve, 44.2), 15.0, 1e-9);
  EXPECT_NEAR(charge_pct(*curve, 50.4), 65.0, 1e-9);
  EXPECT_DOUBLE_EQ(charge_pct(*curve, 12.0), 0.0);
  EXPECT_DOUBLE_EQ(charge_pct(*curve, 60.0), 100.0);
}

TEST(BatteryCurve, ThatIsDamagedIsRefusedWithThePartThatIsWrong) {
  const auto why = [](const char* text) {
    const auto curve = battery_curve(text);
    return curve ? std::string() : curve.error().detail;
  };
  EXPECT_EQ(why(""), "");
  EXPECT_EQ(why("  "), "");
  EXPECT_EQ(why("42"), "curve: \"42\" must be a voltage (0 to 1000) and a charge (0 to 100)");
  EXPECT_EQ(why("42 0, 54 101"),
            "curve: \"54 101\" must be a voltage (0 to 1000) and a charge (0 to 100)");
  EXPECT_EQ(why("42 0, nan 50"),
            "curve: \"nan 50\" must be a voltage (0 to 1000) and a charge (0 to 100)");
  EXPECT_EQ(why("42 0, 42 50"),
            "curve: \"42 50\" must lie above the point before it, in voltage and in charge");
  EXPECT_EQ(why("42 0"), "curve: \"42 0\" needs at least two points");
  EXPECT_EQ(why("42 0, 54 100,"), "curve: \"42 0, 54 100,\" ends in a comma");
}

TEST(BatteryGauge, ASagUnderLoadHardlyMovesTheCharge) {
  BatteryGauge gauge(BatteryParams{kLithium});
  base::Time now{};
  for (int i = 0; i < 100; ++i) gauge.step(status_at(now += std::chrono::milliseconds(100), 50.4));
  const auto before = gauge.step(status_at(now, 50.4));
  // 4 V less for a second, as when the robot sets off.
  std::optional<base::BatteryState> after;
  for (int i = 0; i < 10; ++i) {
    after = gauge.step(status_at(now += std::chrono::milliseconds(100), 46.4));
  }
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(before->charge_pct, 65.0, 0.01);
  EXPECT_NEAR(after->charge_pct, 65.0, 2.0);
  EXPECT_DOUBLE_EQ(after->voltage_v, 46.4);
}

TEST(BatteryGauge, OfAnEmptyCurveSaysNothing) {
  BatteryGauge gauge(BatteryParams{});
  EXPECT_FALSE(gauge.step(status_at(base::Time{}, 50.0)));
}

TEST(Battery, TheBatterysOwnWordCountsBeforeTheVoltage) {
  World world;
  world.gauge = BatteryGauge(BatteryParams{kLithium});
  base::Time now{};
  world.take(status_at(now, 46.8));
  ASSERT_TRUE(world.battery);
  EXPECT_NEAR(world.battery->charge_pct, 30.0, 1e-9);
  world.take(base::BatteryState{now, 77.0, 50.0, {}, {}, {}});
  world.take(status_at(now + std::chrono::seconds(5), 46.8));
  EXPECT_NEAR(world.battery->charge_pct, 77.0, 1e-9);
  // It fell silent: the voltage is what there is.
  world.take(status_at(now + std::chrono::seconds(11), 46.8));
  EXPECT_NEAR(world.battery->charge_pct, 30.0, 1e-9);
}

}  // namespace
}  // namespace roverd::robot
