// Points to voxels in the body's frame.
#include "nav/sense/reduce.hpp"

#include <limits>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kBody = Footprint::box(1.0, 0.8, 0.5);

base::SightPoint hit(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0.0F, 0, 0,
          base::Echo::Hit};
}

PoseHistory still() {
  return driven(1.0, [](double) { return Pose2{}; });
}

base::Sight one(std::vector<base::SightPoint> points) {
  base::Sight s;
  s.sensor = "eye";
  s.stamp = at(0.9);
  s.points = std::move(points);
  return s;
}

TEST(ReduceTest, AVoxelIsTheMeanOfItsPointsByAnIndependentCount) {
  // Given a hundred thousand points in the box of 8 m, seeded
  std::mt19937 random(7);
  std::uniform_real_distribution<double> wide(-5.0, 5.0);
  std::uniform_real_distribution<double> up(-1.0, 2.0);
  std::vector<base::SightPoint> points;
  for (int i = 0; i < 100'000; ++i) points.push_back(hit(wide(random), wide(random), up(random)));
  // When they are reduced
  ReduceParams params;
  Reducer reducer(params, kBody);
  Reduced out;
  ASSERT_TRUE(reducer.reduce(one(points), {.z_m = 0.5}, still(), out).has_value());
  // Then they are those that a map of cubes gives
  std::map<std::tuple<int, int, int>, std::array<double, 4>> cubes;
  for (const base::SightPoint& p : points) {
    const double x = static_cast<double>(p.x_m);
    const double y = static_cast<double>(p.y_m);
    const double z = static_cast<double>(p.z_m + 0.5F);
    if (std::hypot(x, y) > 8.0) continue;
    if (std::abs(x) < 0.55 && std::abs(y) < 0.45 && z < 0.55 && kBody.distance_m({x, y}) <= 0.05)
      continue;
    auto& c =
        cubes[{static_cast<int>((p.x_m + 8.0F) * 20.0F), static_cast<int>((p.y_m + 8.0F) * 20.0F),
               static_cast<int>((p.z_m + 0.5F + 2.5F) * 20.0F)}];
    c[0] += x;
    c[1] += y;
    c[2] += z;
    c[3] += 1.0;
  }
  // A point on the very edge of a cube may fall to either side of it.
  EXPECT_NEAR(static_cast<double>(out.voxels.size()), static_cast<double>(cubes.size()), 5.0);
  std::size_t same = 0;
  double sum = 0.0;
  for (const Voxel& v : out.voxels) {
    sum += v.points;
    const auto c = cubes.find({static_cast<int>((v.x_m + 8.0F) * 20.0F),
                               static_cast<int>((v.y_m + 8.0F) * 20.0F),
                               static_cast<int>((v.z_m + 2.5F) * 20.0F)});
    if (c == cubes.end() || c->second[3] != v.points) continue;
    same += std::abs(c->second[0] / c->second[3] - static_cast<double>(v.x_m)) < 1e-4 &&
            std::abs(c->second[2] / c->second[3] - static_cast<double>(v.z_m)) < 1e-4;
  }
  EXPECT_GT(static_cast<double>(same), 0.999 * static_cast<double>(out.voxels.size()));
  EXPECT_EQ(sum, out.counts.kept);
}

TEST(ReduceTest, EveryPointIsCountedOnce) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<base::SightPoint> points{hit(2.0, 0.0, 0.0),
                                       hit(0.0, 0.0, 0.0),  // there; in the sensor
                                       hit(0.2, 0.1, 0.0),
                                       hit(2.0, 0.0, 4.0),
                                       hit(20.0, 0.0, 0.0),  // body; above; beyond
                                       {nan, 0.0F, 0.0F, 0.0F, 0, 0, base::Echo::Hit},
                                       {0.0F, inf, 0.0F, 0.0F, 0, 0, base::Echo::Hit},
                                       {5.0F, 0.0F, 0.0F, 0.0F, 0, 0, base::Echo::Clear},
                                       {1.0F, 0.0F, 0.0F, 0.0F, 0, 0, base::Echo::Unknown},
                                       {nan, nan, nan, nan, 0, 0, base::Echo::Clear}};
  Reducer reducer({}, kBody);
  Reduced out;
  ASSERT_TRUE(reducer.reduce(one(points), {.z_m = 0.3}, still(), out).has_value());
  const Counts& n = out.counts;
  EXPECT_EQ(n.points, 10U);
  EXPECT_EQ(n.kept, 1U);
  EXPECT_EQ(n.bad, 4U);
  EXPECT_EQ(n.body, 1U);
  EXPECT_EQ(n.outside, 1U);
  EXPECT_EQ(n.clear, 2U);
  EXPECT_EQ(n.unknown, 1U);
  ASSERT_EQ(out.voxels.size(), 3U) << "one obstacle, and two ends of what is clear";
  EXPECT_EQ(out.voxels[0].kind, Kind::Obstacle);
  EXPECT_EQ(out.voxels[1].kind, Kind::Clear);
  EXPECT_NEAR(out.voxels[1].x_m, 8.0F, 0.02F);
}

TEST(ReduceTest, WhatIsBeyondTheCropIsClearAsFarAsThatFromASensorOffTheMiddle) {
  Reducer reducer({}, kBody);
  Reduced out;
  const auto sight = one({hit(6.0, 6.0, 0.6), hit(-9.0, 1.0, 0.0)});
  const base::Mount mount{.x_m = 0.45, .y_m = -0.2, .z_m = 0.3};
  ASSERT_TRUE(reducer.reduce(sight, mount, still(), out).has_value());
  ASSERT_EQ(out.voxels.size(), 2U);
  for (const Voxel& v : out.voxels) {
    EXPECT_EQ(v.kind, Kind::Clear);
    EXPECT_NEAR(std::hypot(v.x_m, v.y_m), 8.0F, 0.02F);
  }
  const Voxel& v = out.voxels[0];
  EXPECT_NEAR((v.y_m + 0.2F) / (v.x_m - 0.45F), 1.0F, 1e-5F) << "along its ray";
  EXPECT_NEAR((v.z_m - 0.3F) / (v.x_m - 0.45F), 0.1F, 1e-5F);
}

TEST(ReduceTest, AFilteredBodyDoesNotHideWhatStandsBesideOrAboveIt) {
  Reducer reducer({}, kBody);
  Reduced out;
  const auto sight = one({hit(0.56, 0.0, 0.0), hit(0.3, 0.0, 0.3)});
  ASSERT_TRUE(reducer.reduce(sight, {.z_m = 0.3}, still(), out).has_value());
  EXPECT_EQ(out.counts.kept, 2U);
}

//   While the body turns, a wall is seen from many headings: it must stay one straight wall.
//   A scanner on the bumper whose window is dirty gets echoes of the glass itself.
TEST(ReduceTest, OfADirtyWindowWhatIsAtTheGlassTellsNothing) {
  Reducer reducer({}, kBody);
  Reduced out;
  base::Sight sight = one({hit(0.09, 0.02, 0.0), hit(0.2, 0.0, 0.0)});
  const base::Mount bumper{.x_m = 0.52, .z_m = 0.3};
  ASSERT_TRUE(reducer.reduce(sight, bumper, still(), out).has_value());
  EXPECT_EQ(out.counts.kept, 2U) << "clean: something stands there";
  sight.window = base::Window::Dirty;
  ASSERT_TRUE(reducer.reduce(sight, bumper, still(), out).has_value());
  EXPECT_EQ(out.counts.unknown, 1U);
  EXPECT_EQ(out.counts.kept, 1U);
}

TEST(ReduceTest, AWallStaysStraightWhileTheBodyDrivesAndTurns) {
  Scene scene;
  scene.ground = [](double, double) { return -100.0; };
  scene.blocks.push_back({3.0, 3.5, -20.0, 20.0, -1.0, 3.0});
  const auto pose = [](double t) { return along(1.3, 1.0, t - 1.0); };
  std::mt19937 random(1);
  const base::Mount mount{.x_m = 0.3, .y_m = 0.1, .z_m = 0.6, .yaw_rad = 0.2};
  const auto sight = look(
      scene, sixteen_rings(), mount, 1.0, [&](double t) { return planar_pose(pose(t)); }, random);
  Reducer reducer({.voxel_m = 0.01, .high_m = 5.0}, kBody);
  Reduced out;
  ASSERT_TRUE(reducer.reduce(sight, mount, driven(1.1, pose), out).has_value());
  EXPECT_NEAR(base::seconds(out.stamp - at(1.1)), 0.0, 1e-6);
  std::size_t looked = 0;
  for (const Voxel& v : out.voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const Pose2 in_world =
        out.pose * Pose2{static_cast<double>(v.x_m), static_cast<double>(v.y_m), 0.0};
    ASSERT_NEAR(in_world.x_m, 3.0, 0.01);
    ++looked;
  }
  EXPECT_GT(looked, 1000U);
}

//   Over a bump the nose rises and the body rolls within one turn of a lidar; the ground stays
//   flat.
TEST(ReduceTest, TheGroundStaysFlatWhileTheBodyLeansMoreAndMore) {
  const auto pose = [](double t) { return along(1.0, 0.3, t - 1.0); };
  const auto lie = [](double t) {
    return Lie3{0.1 * (t - 1.0), -0.3 * (t - 1.0), 0.6 * (t - 1.0)};
  };
  const auto body = [&](double t) {
    return planar_pose(pose(t), lie(t).z_m, -lie(t).pitch_rad) *
           Eigen::Isometry3d(Eigen::AngleAxisd(lie(t).roll_rad, Eigen::Vector3d::UnitX()));
  };
  const base::Mount mount{.x_m = 0.3, .y_m = 0.1, .z_m = 0.6, .yaw_rad = 0.2};
  std::mt19937 random(1);
  const auto sight = look({}, sixteen_rings(), mount, 1.0, body, random, 6.0);
  Reducer reducer({.voxel_m = 0.02, .high_m = 5.0}, kBody);
  Reduced out;
  ASSERT_TRUE(reducer.reduce(sight, mount, driven(1.1, pose, lie), out).has_value());
  EXPECT_NEAR(out.lie.pitch_rad, 0.06, 1e-9) << "the reference is the turn's end";
  const auto up = up_in_body(out.lie);
  std::size_t looked = 0;
  for (const Voxel& v : out.voxels) {
    const double height_m = out.lie.z_m + up[0] * static_cast<double>(v.x_m) +
                            up[1] * static_cast<double>(v.y_m) + up[2] * static_cast<double>(v.z_m);
    ASSERT_NEAR(height_m, 0.0, 0.01) << v.x_m << " " << v.y_m;
    ++looked;
  }
  EXPECT_GT(looked, 500U);
}

TEST(ReduceTest, WithoutTheBodysWayAPieceIsRefused) {
  Reducer reducer({}, kBody);
  Reduced out;
  auto sight = one({hit(2.0, 0.0, 0.0)});
  EXPECT_FALSE(reducer.reduce(sight, {.z_m = 0.3}, PoseHistory{}, out).has_value());
  sight.stamp = at(9.0);
  EXPECT_EQ(reducer.reduce(sight, {.z_m = 0.3}, still(), out).error().code,
            base::Code::Unavailable);
  sight.stamp = at(0.9);
  sight.points[0].after_s = std::numeric_limits<float>::infinity();
  EXPECT_EQ(reducer.reduce(sight, {.z_m = 0.3}, still(), out).error().code, base::Code::Invalid);
}

TEST(ReduceTest, ACloudOfTenMillionPointsIsRefusedBeforeItCostsAnything) {
  Reducer reducer({}, kBody);
  Reduced out;
  const auto sight = one(std::vector<base::SightPoint>(10'000'000));
  const auto refused = reducer.reduce(sight, {.z_m = 0.3}, still(), out);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, base::Code::TooLarge);
}

}  // namespace
}  // namespace roverd::nav::sense
