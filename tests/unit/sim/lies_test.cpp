// Devices that lie: what they tell is wrong as stated, and what they do is not.

#include <gtest/gtest.h>

#include "bunker/codec.hpp"
#include "plant.hpp"

namespace roverd::sim {
namespace {

base::EnuPoint told_place(const Plant& plant) {
  return plant.bunker.frame().to_local(position(plant.lines("GGA").back()));
}

double told_mps(const Plant& plant) {
  return std::stod(split(plant.lines("RMC").back()).at(7)) * 0.514444;
}

/// East at 1 m/s for so long.
void drive(Plant& plant, base::Duration d) {
  plant.enter_can();
  plant.drive(1.0, 0.0, d);
}

TEST(Lies, AFrozenPositionStandsWhileTimeAndVelocityGoOn) {
  Plant plant;
  drive(plant, 4s);
  set_fault(plant, [](Faults& f) { f.gnss_position_frozen = true; });
  const auto at = told_place(plant);
  const auto time = split(plant.lines("GGA").back()).at(1);
  drive(plant, 3s);
  EXPECT_LT(base::distance_m(told_place(plant), at), 0.4);  // the epoch that was on its way
  EXPECT_NEAR(plant.truth().local.east_m - at.east_m, 3.0, 0.5);
  EXPECT_NE(split(plant.lines("GGA").back()).at(1), time);
  EXPECT_NEAR(told_mps(plant), 1.0, 0.02);
  set_fault(plant, [](Faults& f) { f.gnss_position_frozen = false; });
  drive(plant, 1s);
  EXPECT_NEAR(told_place(plant).east_m, plant.truth().local.east_m, 0.5);
}

TEST(Lies, AReceiverThatHangsRepeatsItsBytesWithTheirTime) {
  Plant plant;
  drive(plant, 3s);
  set_fault(plant, [](Faults& f) { f.gnss_repeats = true; });
  drive(plant, 1s);
  const auto line = plant.lines("GGA").back();
  const auto count = plant.lines("GGA").size();
  drive(plant, 2s);
  EXPECT_EQ(plant.lines("GGA").back(), line);
  EXPECT_EQ(plant.lines("GGA").size(), count + 10);
}

TEST(Lies, AVelocityIsFrozenOrOffByWhatIsSaid) {
  Plant plant;
  drive(plant, 4s);
  set_fault(plant, [](Faults& f) { f.gnss_velocity_frozen = true; });
  plant.drive(0.0, 0.0, 4s);
  EXPECT_NEAR(told_mps(plant), 1.0, 0.02);
  set_fault(plant, [](Faults& f) {
    f.gnss_velocity_frozen = false;
    f.gnss_velocity_north_mps = 0.5;
  });
  plant.wait(1s);
  EXPECT_NEAR(told_mps(plant), 0.5, 0.01);
  EXPECT_NEAR(std::stod(split(plant.lines("RMC").back()).at(8)), 0.0, 0.1);  // northwards
}

TEST(Lies, APositionRunsAwayAndComesBackWhenTheFaultEnds) {
  Plant plant;
  plant.wait(2s);
  set_fault(plant, [](Faults& f) { f.gnss_drift_north_mps = 0.25; });
  plant.wait(8s);
  EXPECT_NEAR(told_place(plant).north_m, 2.0, 0.1);
  EXPECT_NEAR(told_place(plant).east_m, 0.0, 0.02);
  set_fault(plant, [](Faults& f) { f.gnss_drift_north_mps = 0.0; });
  plant.wait(1s);
  EXPECT_NEAR(told_place(plant).north_m, 0.0, 0.02);
}

TEST(Lies, TwoAntennasTellTheirHeadingWithoutTheCompassesError) {
  Params p = ideal();
  p.compass.bias_deg = 20.0;
  p.gnss.antennas = true;
  p.gnss.antennas_noise_deg = 0.0;
  p.imu.fitted = true;
  Plant plant(p);
  plant.wait(1s);
  const auto heading = [&] { return std::stod(split(plant.lines("HDT").back()).at(1)); };
  EXPECT_EQ(heading(), 90.0);
  set_fault(plant, [](Faults& f) { f.antennas_extra_deg = 30.0; });
  plant.wait(1s);
  EXPECT_EQ(heading(), 120.0);
  set_fault(plant, [](Faults& f) { f.antennas_frozen = true; });
  plant.enter_can();
  plant.drive(0.0, 0.5, 3s);
  EXPECT_EQ(heading(), 120.0);
}

TEST(Lies, OdometryTellsAShareOrStandsAndTheRobotGoesOn) {
  struct Row {
    std::function<void(Faults&)> fault;
    double left_mm, right_mm, mps, radps;
  };
  const Row rows[] = {
      {[](Faults& f) { f.odometry_share = 2.0; }, 4000, 4000, 2.0, 0.0},
      {[](Faults& f) { f.odometry_frozen = true; }, 0, 0, 1.0, 0.0},
      {[](Faults& f) { f.odometry_left_stuck = true; }, 0, 2000, 0.5, 1.0 / 0.6},
  };
  for (const Row& row : rows) {
    Plant plant;
    drive(plant, 3s);
    const CanFrame before = plant.last(0x311);
    const double at = plant.truth().local.east_m;
    set_fault(plant, row.fault);
    drive(plant, 2s);
    const CanFrame after = plant.last(0x311);
    EXPECT_NEAR(i32(after, 0) - i32(before, 0), row.left_mm, 45.0);
    EXPECT_NEAR(i32(after, 4) - i32(before, 4), row.right_mm, 45.0);
    EXPECT_NEAR(i16(plant.last(0x221), 0) / 1000.0, row.mps, 0.01);
    EXPECT_NEAR(i16(plant.last(0x221), 2) / 1000.0, row.radps, 0.01);
    EXPECT_NEAR(plant.truth().local.east_m - at, 2.0, 0.05);
  }
}

}  // namespace
}  // namespace roverd::sim
