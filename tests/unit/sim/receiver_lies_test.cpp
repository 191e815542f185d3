// Receivers that tell something else than where they are: bases that move, clocks that step,
// antennas mounted askew, trees, and the slow errors of plain receivers.

#include <map>

#include <gtest/gtest.h>

#include "plant.hpp"

namespace roverd::sim {
namespace {

struct Fix {
  base::EnuPoint at;
  int quality = 0;
  double sigma_m = 0.0;
};

/// Of every epoch that has a position.
std::vector<Fix> fixes(const Plant& plant) {
  std::vector<Fix> out;
  const auto gga = plant.lines("GGA");
  const auto gst = plant.lines("GST");
  for (std::size_t i = 0; i < gga.size(); ++i) {
    const auto f = split(gga[i]);
    if (f.at(2).empty()) continue;
    out.push_back({plant.bunker.frame().to_local(position(gga[i])), std::stoi(f.at(6)),
                   std::stod(split(gst.at(i)).at(6))});
  }
  return out;
}

TEST(ReceiverLies, AnotherBaseShiftsFixedPositionsForGoodAndTellsItsNumber) {
  Plant plant;
  plant.wait(2s);
  EXPECT_NEAR(fixes(plant).back().at.east_m, 0.0, 0.001);
  EXPECT_EQ(split(plant.lines("GGA").back()).at(14), "0001");
  set_fault(plant, [](Faults& f) {
    f.gnss_base_shift_east_m = 3.0;
    f.gnss_base_shift_north_m = -1.0;
  });
  plant.wait(60s);
  const Fix shifted = fixes(plant).back();
  EXPECT_NEAR(shifted.at.east_m, 3.0, 0.001);
  EXPECT_NEAR(shifted.at.north_m, -1.0, 0.001);
  EXPECT_EQ(shifted.quality, 4);
  EXPECT_LT(shifted.sigma_m, 0.02);
  EXPECT_EQ(split(plant.lines("GGA").back()).at(14), "0002");
  // Without corrections there is no base.
  set_fault(plant, [](Faults& f) { f.gnss_fix = "gps"; });
  plant.wait(1s);
  EXPECT_NEAR(fixes(plant).back().at.east_m, 0.0, 0.001);
}

TEST(ReceiverLies, AClockStepsBackAndGoesOnFromThere) {
  Plant plant;
  plant.wait(10s);
  const auto told_s = [&] {
    const std::string t = split(plant.lines("GGA").back()).at(1);
    return 3600.0 * std::stod(t.substr(0, 2)) + 60.0 * std::stod(t.substr(2, 2)) +
           std::stod(t.substr(4));
  };
  const double before_s = told_s();
  set_fault(plant, [](Faults& f) { f.gnss_time_step_s = -5.0; });
  plant.wait(2s);
  EXPECT_NEAR(told_s() - before_s, -3.0, 1e-6);
  plant.wait(2s);
  EXPECT_NEAR(told_s() - before_s, -1.0, 1e-6);
}

TEST(ReceiverLies, AntennasMountedAskewShowTheirOffset) {
  Params p = ideal();
  p.gnss.antennas = true;
  p.gnss.antennas_noise_deg = 0.0;
  p.gnss.antennas_offset_deg = 20.0;
  Plant plant(p);
  plant.wait(1s);
  EXPECT_EQ(std::stod(split(plant.lines("HDT").back()).at(1)), 110.0);
  EXPECT_EQ(base::heading_from_yaw(plant.truth().yaw_rad), 90.0);
}

//  uphill north, robot to the east: the mast leans to the south
TEST(ReceiverLies, OnASlopeAMastLeansDownhill) {
  Params p = ideal();
  p.gnss.antenna_up_m = 1.0;
  p.ground.slope_deg = 10.0;
  Plant plant(p);
  plant.wait(1s);
  EXPECT_NEAR(fixes(plant).back().at.north_m, -std::sin(base::rad_from_deg(10.0)), 0.001);
  EXPECT_NEAR(fixes(plant).back().at.east_m, 0.0, 0.001);
}

TEST(ReceiverLies, UnderTreesFixClassesChangeAndPositionsAreWorseThanClaimed) {
  Params p = ideal();
  p.gnss.noise_scale = 1.0;
  p.trees.share = 1.0;
  Plant plant(p);
  plant.wait(600s);
  std::map<int, int> classes;
  for (const auto& line : plant.lines("GGA")) ++classes[std::stoi(split(line).at(6))];
  EXPECT_NEAR(classes[4], 3000 * 0.3, 400.0);
  EXPECT_NEAR(classes[0], 3000 * 0.7 * 0.1, 150.0);
  EXPECT_GT(classes[5], 600);
  EXPECT_GT(classes[2], 300);
  double square = 0.0;
  int fixed = 0;
  for (const Fix& f : fixes(plant)) {
    if (f.quality != 4) continue;
    EXPECT_LT(f.sigma_m, 0.02);
    square += f.at.east_m * f.at.east_m;
    ++fixed;
  }
  EXPECT_NEAR(std::sqrt(square / fixed), 0.8, 0.3);
}

TEST(ReceiverLies, TreesAreAtPlacesAndTheOpenIsAsBefore) {
  Params p = ideal();
  p.trees.share = 0.3;
  int under = 0;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      under += under_trees(p.trees, 1, {3.1 * i, 3.7 * j}) ? 1 : 0;
    }
  }
  EXPECT_NEAR(under / 10000.0, 0.3, 0.12);
  EXPECT_FALSE(under_trees(TreesParams{}, 1, {0.0, 0.0}));

  base::EnuPoint open;
  while (under_trees(p.trees, 1, open)) open.east_m += 1.0;
  Params without = p;
  without.trees.share = 0.0;
  const auto last = [&](const Params& how) {
    Plant plant(how);
    plant.bunker.place(plant.bunker.frame().to_global(open), 90.0);
    plant.wait(30s);
    return plant.lines("GGA").back();
  };
  EXPECT_EQ(last(p), last(without));
}

/// Mean product of neighbours so far apart, over the mean square.
double likeness(const std::vector<double>& all, std::size_t apart) {
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i + apart < all.size(); ++i) {
    square += all[i] * all[i];
    product += all[i] * all[i + apart];
  }
  return product / square;
}

TEST(ReceiverLies, APlainReceiversErrorIsSmoothAndHardlyChangesWithinARun) {
  Params p = ideal();
  p.gnss.profile = "plain";
  p.gnss.noise_scale = 1.0;
  p.gnss.rate_hz = 1.0;
  Plant plant(p);
  plant.wait(2h);
  std::vector<double> east;
  double square = 0.0;
  for (const Fix& f : fixes(plant)) {
    east.push_back(f.at.east_m);
    square += f.at.east_m * f.at.east_m + f.at.north_m * f.at.north_m;
    EXPECT_EQ(f.quality, 1);
    EXPECT_NEAR(f.sigma_m, std::sqrt(0.03 * 0.03 + 0.6 * 0.6 + 1.2 * 1.2 + 0.2 * 0.2), 0.01);
  }
  // 2 h are eight of the longest time constant only.
  EXPECT_NEAR(std::sqrt(square / 2.0 / static_cast<double>(east.size())), 1.36, 0.5);
  EXPECT_GT(likeness(east, 1), 0.98);
  EXPECT_GT(likeness(east, 60), 0.6);  // of 1.36²: 1.2² hardly less, 0.6² to a third
  EXPECT_LT(likeness(east, 60), 0.95);
}

TEST(ReceiverLies, APlainReceiversSpeedErrorIsPartlySlow) {
  Params p = ideal();
  p.gnss.profile = "plain";
  p.gnss.noise_scale = 1.0;
  Plant plant(p);
  plant.enter_can();
  plant.drive(1.0, 0.0, 600s);
  std::vector<double> error;
  for (const auto& line : plant.lines("RMC")) {
    const double mps = std::stod(split(line).at(7)) * 0.514444;
    if (error.size() < 20 && mps < 0.8) continue;
    error.push_back(mps - 1.0);
  }
  double square = 0.0;
  for (const double e : error) square += e * e;
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(error.size())), 0.05, 0.01);
  EXPECT_NEAR(likeness(error, 1), 0.03 * 0.03 / (0.05 * 0.05), 0.12);
}

}  // namespace
}  // namespace roverd::sim
