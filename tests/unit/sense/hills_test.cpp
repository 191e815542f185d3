// A scanner's plane meets every hill: where a lidar has seen the ground, that is told from what
// stands there.
#include "nav/sense/hills.hpp"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/reduce.hpp"
#include "nav/sense/sectors.hpp"
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
  s.thin = true;
  s.health.rate_hz = 50.0;
  return s;
}

SensorSetup rings_above(double z_m = 0.8) {
  SensorSetup s;
  s.name = "top";
  s.mount = {.z_m = z_m};
  s.health.max_unknown_part = 0.9;  // half of what it looks at is the sky
  return s;
}

struct Going {
  double mps = 0.5;
  bool told = true;                             ///< something tells how the body leans
  base::Window window = base::Window::Unknown;  ///< of the lidar
};

/// Ahead over level ground, both look ten times a second.
class Climb {
 public:
  explicit Climb(std::vector<SensorSetup> eyes, Going going = {})
      : eyes_(eyes), going_(going), chain_(chain_of(std::move(eyes))) {}

  void drive(const Scene& scene, double from_s, double to_s) {
    const auto way = [this](double t) { return Pose2{going_.mps * (t - 1.0), 0.0, 0.0}; };
    const auto lie = [this](double) { return Lie3{.told = going_.told}; };
    for (double t = from_s; t < to_s; t += 0.1) {
      for (const SensorSetup& eye : eyes_) {
        const Rays rays = eye.planar ? planar() : sixteen_rings(300);
        base::Sight sight = look(
            scene, rays, eye.mount, t, [&](double when) { return planar_pose(way(when)); }, random_,
            20.0);
        sight.sensor = eye.name;
        if (!eye.planar) sight.window = going_.window;
        ASSERT_TRUE(chain_.take(sight, driven(t + 0.12, way, lie), at(t + 0.1)).has_value());
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
  static Chain chain_of(std::vector<SensorSetup> eyes) {
    auto chain = Chain::of({}, std::move(eyes), Footprint::box(1.0, 0.8, 0.5), at(0.0));
    return std::move(chain.value());
  }
  std::vector<SensorSetup> eyes_;
  Going going_;
  Chain chain_;
  std::mt19937 random_{1};
  double now_s_ = 0.0;
};

//        ●lidar                 Its rings do not see the foot of what is near: they lay a slope
//       ▭scanner──▶▒            through its face, which is no ground that the scanner may believe.
//   ═══════════════▒══
TEST(HillsTest, WhoComesFromTheSideAndHidesTheGroundFromTheLidarIsAnObstacle) {
  for (const auto& [high_m, x] : {std::pair{0.35, 1.2}, {0.35, 1.7}, {0.4, 1.4}, {0.45, 1.3}}) {
    Climb stands({plane_ahead(), rings_above(0.7)}, {.mps = 0.0});
    stands.drive({}, 1.0, 1.05);
    Scene scene;
    scene.blocks = {{x, x + 0.4, -0.2, 0.2, 0.0, high_m}};
    stands.drive(scene, 1.1, 1.35);
    ASSERT_FALSE(stands.taken(x - 0.06, x + 0.1).empty()) << high_m << " m high at " << x;
  }
}

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

//   A lidar whose window is blocked is not believed to see ground, and heights over a body of
//   which nothing tells how it leans are none in O.
TEST(HillsTest, OnlyWhoSeesAndHeightsThatAreToldMakeItGround) {
  Climb blocked({plane_ahead(), rings_above()}, {.window = base::Window::Blocked});
  blocked.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(blocked.taken(2.5, 7.5).empty());
  Climb untold({plane_ahead(), rings_above()}, {.told = false});
  untold.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(untold.taken(2.5, 7.5).empty());
}

//   The echo of a cone tells no height: it may lie anywhere across it.
TEST(HillsTest, WhatARangeSensorMeetsStaysAnObstacle) {
  SensorSetup cone = plane_ahead();
  cone.thin = false;
  Climb both({cone, rings_above()});
  both.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(both.taken(2.5, 7.5).empty());
}

Reduced piece(double t, std::vector<Voxel> voxels) {
  Reduced out;
  out.stamp = at(t);
  out.lie.told = true;
  out.voxels = std::move(voxels);
  return out;
}

TEST(HillsTest, WhatThePlaneMetBeforeIsGroundOnceTheGroundIsSeen) {
  Hills hills(8.0, 0.08);
  Sectors sectors;
  sectors.planar = sectors.thin = true;
  Grid grid({});
  grid.take(piece(1.0, {{5.9F, 0.0F, 0.3F, 1}, {5.9F, 0.4F, 0.6F, 1}}), sectors, 0, &hills);
  ASSERT_EQ(grid.at(5.9, 0.0, at(1.0)), Known::Occupied);
  const Reduced cloud =
      piece(1.5, {{5.88F, 0.02F, 0.27F, 2, Kind::Ground}, {5.9F, 0.4F, 0.27F, 2, Kind::Ground}});
  hills.learn(cloud);
  sectors.planar = sectors.thin = false;
  grid.take(cloud, sectors, 1, &hills);
  EXPECT_EQ(grid.at(5.9, 0.0, at(1.5)), Known::Unknown) << "a ray must say that it is free";
  EXPECT_EQ(grid.at(5.9, 0.4, at(1.5)), Known::Occupied) << "that stands 0.3 m over the ground";
}

//   What a lidar believed, a plane's echo keeps, and what it takes for ground takes nothing away.
TEST(HillsTest, WhatTheCloudMetBeforeStays) {
  Hills hills(8.0, 0.08);
  Sectors sectors;
  Grid grid({});
  grid.take(piece(1.0, {{5.9F, 0.0F, 0.3F, 1}}), sectors, 1, &hills);
  hills.learn(piece(1.1, {{5.88F, 0.02F, 0.27F, 2, Kind::Ground}}));
  Reduced plane = piece(1.2, {{5.9F, 0.0F, 0.3F, 1}});
  ASSERT_EQ(hills.judge(plane), 1U);
  sectors.planar = sectors.thin = true;
  grid.take(plane, sectors, 0, &hills);
  EXPECT_EQ(grid.at(5.9, 0.0, at(1.2)), Known::Occupied);
}

/// A plane's echo 0.3 m high at 4 m, where the ground was seen before.
std::size_t judged(float ground_m, double later_s) {
  Hills hills(8.0, 0.3);
  Reduced cloud = piece(1.0, {{4.0F, 0.0F, ground_m - 0.5F, 1, Kind::Ground}});
  cloud.lie.z_m = 0.5;
  hills.learn(cloud);
  Reduced plane = piece(1.0 + later_s, {{2.05F, 0.05F, 0.3F, 1}});
  plane.pose = {2.0, 0.0, 0.0};  // it came down by 0.3 m on the way
  plane.lie.z_m = 0.2;
  return hills.judge(plane);
}

//   Heights must agree, and be of these seconds, however tall the grass may be by the settings.
TEST(HillsTest, GroundOfLongAgoAndGroundFarAboveSayNothing) {
  EXPECT_EQ(judged(0.5F, 2.0), 1U);
  EXPECT_EQ(judged(0.43F, 2.0), 1U);
  EXPECT_EQ(judged(0.41F, 2.0), 0U) << "0.09 m over the ground";
  EXPECT_EQ(judged(0.64F, 2.0), 1U);
  EXPECT_EQ(judged(0.66F, 2.0), 0U) << "0.16 m within it";
  EXPECT_EQ(judged(0.5F, 3.9), 1U);
  EXPECT_EQ(judged(0.5F, 8.1), 0U);
}

TEST(HillsTest, TheLowestGroundOfTheseSecondsCounts) {
  Hills hills(8.0, 0.08);
  hills.learn(piece(1.0, {{4.0F, 0.0F, 0.0F, 1, Kind::Ground}}));
  hills.learn(piece(1.2, {{4.0F, 0.0F, 0.3F, 1, Kind::Ground}}));
  EXPECT_FALSE(hills.is_ground(4.0, 0.0, 0.3F, at(1.3))) << "something came to stand there";
  EXPECT_TRUE(hills.is_ground(4.0, 0.0, 0.05F, at(1.3)));
  //   Seen so for long, it is the ground: the lean was wrong before.
  for (double t = 1.5; t < 10.0; t += 0.5) {
    hills.learn(piece(t, {{4.0F, 0.0F, 0.3F, 1, Kind::Ground}}));
  }
  EXPECT_TRUE(hills.is_ground(4.0, 0.0, 0.3F, at(10.0)));
}

//   Steeper than one in ten from the body it may be a face: 0.35 m high, 1.8 m away.
TEST(HillsTest, WhatRisesSteeplyIsNotLearned) {
  Hills hills(8.0, 0.08);
  hills.learn(
      piece(1.0, {{1.8F, 0.0F, 0.2F, 1, Kind::Ground}, {3.0F, 0.0F, 0.2F, 1, Kind::Ground}}));
  EXPECT_FALSE(hills.is_ground(1.8, 0.0, 0.2F, at(1.1)));
  EXPECT_TRUE(hills.is_ground(3.0, 0.0, 0.2F, at(1.1)));
}

//   Behind it lay a hill: 256 cells of 0.1 m farther on nobody has seen the ground.
TEST(HillsTest, PlacesAWindowApartAreTwo) {
  Hills hills(8.0, 0.08);
  hills.learn(piece(1.0, {{4.0F, 0.0F, 0.3F, 1, Kind::Ground}}));
  ASSERT_TRUE(hills.is_ground(4.0, 0.0, 0.3F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(29.6, 0.0, 0.3F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(4.0, -25.6, 0.3F, at(1.1)));
}

TEST(HillsTest, AllOfItIsForgottenWhereNothingTellsTheLeanAnyMore) {
  Hills hills(8.0, 0.08);
  hills.learn(piece(1.0, {{4.0F, 0.0F, 0.3F, 1, Kind::Ground}}));
  Reduced untold = piece(1.1, {{5.0F, 0.0F, 0.3F, 1, Kind::Ground}});
  untold.lie.told = false;
  hills.learn(untold);
  EXPECT_FALSE(hills.is_ground(4.0, 0.0, 0.3F, at(1.2)));
  EXPECT_FALSE(hills.is_ground(5.0, 0.0, 0.3F, at(1.2)));
}

}  // namespace
}  // namespace roverd::nav::sense
