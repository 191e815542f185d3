// The planar scan and the simple stop of the field systems.
#include "nav/sense/rays_rule.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav::sense {
namespace {

Reduced seen(std::vector<Voxel> voxels) {
  Reduced r;
  r.origin_m = {0.4F, 0.0F, 0.5F};
  r.voxels = std::move(voxels);
  return r;
}

Voxel from_eye(double range, double bearing_deg, double up = 0.0, Kind kind = Kind::Obstacle) {
  const double b = base::rad_from_deg(bearing_deg);
  return {static_cast<float>(0.4 + range * std::cos(b)), static_cast<float>(range * std::sin(b)),
          static_cast<float>(0.5 + up), 1, kind};
}

TEST(RaysRuleTest, SixtyNineRaysOfADegreeFromRightToLeft) {
  std::vector<Ray> rays;
  rays_of(seen({from_eye(2.0, 10.2)}), {}, rays);
  ASSERT_EQ(rays.size(), 69U);
  EXPECT_NEAR(base::deg_from_rad(static_cast<double>(rays[0].bearing_rad)), -34.0, 1e-4);
  EXPECT_NEAR(rays[44].range_m, 2.0F, 1e-4F);
  EXPECT_FALSE(rays[44].endless);
  EXPECT_TRUE(rays[43].endless);
  EXPECT_EQ(rays[43].range_m, 4.0F) << "written as 4 m";
}

TEST(RaysRuleTest, WhatIsOutsideOfTheBandTooFarTooNearOrOnlyPassingDoesNotCount) {
  RaysParams p;
  p.blind_m = 0.5;
  std::vector<Ray> rays;
  rays_of(seen({from_eye(2.0, 0.0, 0.31), from_eye(2.0, 0.0, -0.31), from_eye(3.1, 0.0),
                from_eye(0.45, 0.0), from_eye(1.0, 0.0, 0.0, Kind::Passing),
                from_eye(1.0, 0.0, 0.0, Kind::Clear), from_eye(1.0, 40.0)}),
          p, rays);
  for (const Ray& ray : rays) EXPECT_TRUE(ray.endless);
}

TEST(RaysRuleTest, FiveShortRaysStopAndFourDoNot) {
  std::vector<Voxel> voxels;
  for (const double b : {-15.0, -8.0, 0.0, 15.0}) voxels.push_back(from_eye(0.69, b));
  voxels.push_back(from_eye(0.60, 16.0));  // beyond ±15.94
  voxels.push_back(from_eye(0.71, 3.0));   // not shorter than 0.70
  std::vector<Ray> rays;
  rays_of(seen(voxels), {}, rays);
  EXPECT_EQ(count_rays(rays, {}).rays, 4);
  EXPECT_FALSE(count_rays(rays, {}).stop);
  voxels.push_back(from_eye(0.65, 5.0));
  rays_of(seen(voxels), {}, rays);
  EXPECT_TRUE(count_rays(rays, {}).stop);
  EXPECT_NEAR(count_rays(rays, {}).nearest_m, 0.65F, 1e-4F);
  EXPECT_NEAR(base::deg_from_rad(double(count_rays(rays, {}).nearest_rad)), 5.0, 1e-4);
}

TEST(RaysRuleTest, RaysOfSeventyCentimetresAreNotShorterThanThat) {
  std::vector<Ray> rays;
  for (int i = -4; i <= 4; ++i) rays.push_back({float(0.03 * i), 0.7F, false});
  EXPECT_EQ(count_rays(rays, {}).rays, 0);
  for (Ray& ray : rays) ray.range_m = 0.699F;
  EXPECT_EQ(count_rays(rays, {}).rays, 9);
}

TEST(RaysRuleTest, NumbersThatContradictEachOtherAreRefusedByTheirKey) {
  const auto refused = [](auto&& change) {
    RaysParams p;
    change(p);
    const auto good = check(p);
    return good ? std::string() : good.error().fields.at(0).pointer;
  };
  EXPECT_EQ(refused([](RaysParams& p) { p.enabled = true; }), "");
  EXPECT_EQ(refused([](RaysParams& p) { p.instead = true; }), "instead");
  EXPECT_EQ(refused([](RaysParams& p) { p.far_as_m = 2.9; }), "far_as_m");
  EXPECT_EQ(refused([](RaysParams& p) { p.stop_m = 3.1; }), "stop_m");
  EXPECT_EQ(refused([](RaysParams& p) { p.blind_m = 0.7; }), "blind_m");
  EXPECT_EQ(refused([](RaysParams& p) { p.stop_fan_deg = 35.0; }), "stop_fan_deg");
  // 15 rays to either side and one straight ahead.
  EXPECT_EQ(refused([](RaysParams& p) { p.stop_rays = 31; }), "");
  EXPECT_EQ(refused([](RaysParams& p) { p.stop_rays = 32; }), "stop_rays");
}

TEST(RaysRuleTest, TheSidesAreTheMeansOfTheOuterFive) {
  std::vector<Voxel> voxels;
  for (int i = 0; i < 5; ++i) voxels.push_back(from_eye(1.0 + 0.1 * i, 34.0 - i));
  voxels.push_back(from_eye(2.0, -33.0));
  std::vector<Ray> rays;
  rays_of(seen(voxels), {}, rays);
  const Sides sides = sides_of(rays, 5);
  EXPECT_NEAR(sides.left_m, 1.2F, 1e-4F);
  EXPECT_EQ(sides.left, 5);
  EXPECT_NEAR(sides.right_m, 2.0F, 1e-4F) << "rays beyond 3 m do not count";
  EXPECT_EQ(sides.right, 1);
}

TEST(RaysRule, TellsHowMuchNearerTheStopIs) {
  const RaysParams p;
  std::vector<float> buffer;
  std::vector<Ray> rays;
  const auto add = [&rays](double deg, float range_m) {
    rays.push_back({static_cast<float>(base::rad_from_deg(deg)), range_m, false});
  };
  // Given four short ones, the fifth at 1.1 m, and what counts not: beside, and too far.
  for (int i = 0; i < 4; ++i) add(i, 0.5F);
  add(-3.0, 1.1F);
  add(-5.0, 1.4F);
  add(20.0, 0.3F);
  add(5.0, 1.6F);
  const Nearing n = nearing(rays, p, buffer);
  EXPECT_TRUE(n.slows);
  EXPECT_EQ(n.rays, 6);
  EXPECT_NEAR(n.way_m, 0.4F, 1e-6F) << "1.1 m until 0.70";
  EXPECT_EQ(n.nearest_m, 0.5F);
  // With the fifth as short, nothing is left of it; with four there is no stop to come.
  add(-1.0, 0.6F);
  EXPECT_EQ(nearing(rays, p, buffer).way_m, 0.0F);
  rays.resize(4);
  EXPECT_FALSE(nearing(rays, p, buffer).slows);
  RaysParams off;
  off.slow_m = 0.0;
  EXPECT_FALSE(nearing(rays, off, buffer).slows);
}

}  // namespace
}  // namespace roverd::nav::sense
