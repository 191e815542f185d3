// A scanner's plane meets every hill: where a lidar has seen the ground, that is told from what
// stands there.
#include "nav/sense/hills.hpp"

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

//                  ___●lidar           ___---    rises by 6 deg from x = 3 m on: it meets the
//                 ▭scanner──────▶___---          scanner's plane at 5.9 m
//   ══════════════════════════════
constexpr double kRises = 0.105;

Scene hill() {
  Scene s;
  s.ground = [](double x, double) { return x > 3.0 ? kRises * (x - 3.0) : 0.0; };
  return s;
}

SensorSetup plane_ahead() {
  SensorSetup s;
  s.name = "front";
  s.mount = {.x_m = 0.45, .z_m = 0.3};
  s.planar = true;
  s.health.rate_hz = 50.0;
  return s;
}

SensorSetup rings_above() {
  SensorSetup s;
  s.name = "top";
  s.mount = {.z_m = 0.8};
  return s;
}

/// At half a metre a second ahead over level ground, both look ten times a second.
class Climb {
 public:
  explicit Climb(std::vector<SensorSetup> eyes)
      : eyes_(eyes),
        chain_(std::move(*Chain::of({}, std::move(eyes), Footprint::box(1.0, 0.8, 0.5), at(0.0)))) {
  }

  void drive(const Scene& scene, double from_s, double to_s) {
    const auto way = [](double t) { return Pose2{0.5 * (t - 1.0), 0.0, 0.0}; };
    for (double t = from_s; t < to_s; t += 0.1) {
      for (const SensorSetup& eye : eyes_) {
        const Rays rays = eye.planar ? planar() : sixteen_rings(450);
        const auto sight = named(
            eye.name, look(
                          scene, rays, eye.mount, t,
                          [&](double when) { return planar_pose(way(when)); }, random_, 20.0));
        ASSERT_TRUE(chain_.take(sight, driven(t + 0.12, way), at(t + 0.1)).has_value());
      }
      now_s_ = t;
    }
  }
  /// Along y = 0, that is taken.
  std::vector<double> taken(double from_m, double to_m) const {
    std::vector<double> out;
    for (double x = from_m; x < to_m; x += 0.05) {
      if (chain_.grid().at(x, 0.0, at(now_s_)) == Known::Occupied) out.push_back(x);
    }
    return out;
  }

 private:
  static base::Sight named(const std::string& name, base::Sight sight) {
    sight.sensor = name;
    return sight;
  }
  std::vector<SensorSetup> eyes_;
  Chain chain_;
  std::mt19937 random_{1};
  double now_s_ = 0.0;
};

TEST(HillsTest, AHillThatTheLidarSeesIsGroundToTheScannerAsWell) {
  Climb both({plane_ahead(), rings_above()});
  both.drive(hill(), 1.0, 5.0);
  EXPECT_TRUE(both.taken(2.5, 7.5).empty()) << both.taken(2.5, 7.5).front();
}

TEST(HillsTest, WhereNobodySawTheGroundItIsAnObstacle) {
  Climb alone({plane_ahead()});
  alone.drive(hill(), 1.0, 5.0);
  ASSERT_FALSE(alone.taken(2.5, 7.5).empty());
  EXPECT_NEAR(alone.taken(2.5, 7.5).front(), 3.0 + 0.3 / kRises, 0.15);
}

TEST(HillsTest, ABoxOnTheHillStaysWhoeverSeesIt) {
  Scene scene = hill();
  scene.blocks.push_back({5.0, 5.3, -0.2, 0.2, 0.0, kRises * 2.0 + 0.25});
  Climb both({plane_ahead(), rings_above()});
  both.drive(scene, 1.0, 5.0);
  ASSERT_FALSE(both.taken(2.5, 7.5).empty());
  EXPECT_NEAR(both.taken(2.5, 7.5).front(), 5.0, 0.1);
}

//   Before its rings come by: three seconds of the scanner alone, whose echoes are kept.
TEST(HillsTest, WhatThePlaneMetBeforeIsGroundOnceTheGroundIsSeen) {
  Reduced plane;
  plane.stamp = at(1.0);
  plane.voxels = {{5.9F, 0.0F, 0.3F, 1, Kind::Obstacle}, {5.9F, 0.4F, 0.6F, 1, Kind::Obstacle}};
  Sectors sectors;
  sectors.planar = true;
  Grid grid({});
  grid.take(plane, sectors, 0);
  ASSERT_EQ(grid.at(5.9, 0.0, at(1.0)), Known::Occupied);
  Reduced cloud;
  cloud.stamp = at(1.5);
  cloud.voxels = {{5.88F, 0.02F, 0.27F, 2, Kind::Ground}, {5.9F, 0.4F, 0.27F, 2, Kind::Ground}};
  sectors.planar = false;
  grid.take(cloud, sectors, 1);
  EXPECT_EQ(grid.at(5.9, 0.0, at(1.5)), Known::Unknown) << "a ray must say that it is free";
  EXPECT_EQ(grid.at(5.9, 0.4, at(1.5)), Known::Occupied) << "that stands 0.3 m over the ground";
}

//   Heights must agree, and be of these seconds.
TEST(HillsTest, GroundOfLongAgoAndGroundFarAboveSayNothing) {
  const auto judged = [](float ground_m, double later_s) {
    Hills hills(8.0, 0.08);
    Reduced cloud;
    cloud.stamp = at(1.0);
    cloud.lie.z_m = 0.5;
    cloud.voxels = {{4.0F, 0.0F, ground_m - 0.5F, 1, Kind::Ground}};
    hills.learn(cloud);
    Reduced plane;
    plane.stamp = at(1.0 + later_s);
    plane.pose = {2.0, 0.0, 0.0};  // it climbed by 0.2 m on the way
    plane.lie.z_m = 0.2;
    plane.voxels = {{2.05F, 0.05F, 0.3F, 1, Kind::Obstacle}};
    return hills.judge(plane);
  };
  EXPECT_EQ(judged(0.5F, 2.0), 1U);
  EXPECT_EQ(judged(0.43F, 2.0), 1U);
  EXPECT_EQ(judged(0.41F, 2.0), 0U) << "0.09 m over the ground";
  EXPECT_EQ(judged(0.64F, 2.0), 1U);
  EXPECT_EQ(judged(0.66F, 2.0), 0U) << "0.16 m within it";
  EXPECT_EQ(judged(0.5F, 8.5), 0U);
}

}  // namespace
}  // namespace roverd::nav::sense
