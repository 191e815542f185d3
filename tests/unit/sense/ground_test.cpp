// Ground, and what stands on it.
#include "nav/sense/ground.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kTracked = Footprint::box(1.0, 0.8, 0.5);
const base::Mount kCamera{.x_m = 0.45, .z_m = 0.6, .pitch_rad = 0.45};
const base::Mount kMast{.z_m = 0.7};

struct Seen {
  std::vector<Voxel> voxels;
  std::size_t of(Kind kind, double x0 = -9, double x1 = 9, double y0 = -9, double y1 = 9) const {
    return static_cast<std::size_t>(
        std::count_if(voxels.begin(), voxels.end(), [&](const Voxel& v) {
          const auto x = static_cast<double>(v.x_m);
          const auto y = static_cast<double>(v.y_m);
          return v.kind == kind && x >= x0 && x <= x1 && y >= y0 && y <= y1;
        }));
  }
};

/// @param pitch_rad of the body, nose down positive: parallel to the slope that it stands on
Seen see(const Scene& scene, const Rays& rays, const base::Mount& mount, unsigned seed,
         GroundParams params = {}, double pitch_rad = 0.0) {
  std::mt19937 random(seed);
  const auto sight = look(scene, rays, mount, 1.0, standing({}, 0.0, pitch_rad), random, 20.0);
  Reducer reducer({}, kTracked);
  Reduced out;
  EXPECT_TRUE(reducer.reduce(sight, mount, driven(1.2, [](double) { return Pose2{}; }), out));
  Ground ground(params, 8.0, kTracked);
  ground.judge(out.voxels);
  return {out.voxels};
}

Scene slope(double deg, double from_x = -100.0) {
  Scene s;
  s.ground = [=](double x, double) {
    return x > from_x ? (x - std::max(from_x, 0.0)) * std::tan(base::rad_from_deg(deg)) : 0.0;
  };
  s.noise_m = 0.05;
  return s;
}

//      robot ▭──────  on slopes up and down that it stands on, with grass of ±5 cm
TEST(GroundTest, RoughGrassOnAnySlopeIsNoObstacle) {
  for (const double deg : {-15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const double pitch = -base::rad_from_deg(deg);
      const Seen by_camera = see(slope(deg), camera(), kCamera, seed, {}, pitch);
      EXPECT_EQ(by_camera.of(Kind::Obstacle), 0U) << deg << " deg, camera, seed " << seed;
      EXPECT_GT(by_camera.of(Kind::Ground), 300U);
      const Seen by_mast = see(slope(deg), sixteen_rings(450), kMast, seed, {}, pitch);
      EXPECT_EQ(by_mast.of(Kind::Obstacle), 0U) << deg << " deg, rings, seed " << seed;
    }
  }
}

//      ▭─────────╱   on flat ground before a slope
TEST(GroundTest, ASlopeAheadOfALevelBodyIsGround) {
  for (const double deg : {5.0, 10.0, 15.0}) {
    const Seen seen = see(slope(deg, 2.0), camera(), kCamera, 3);
    EXPECT_EQ(seen.of(Kind::Obstacle), 0U) << deg << " deg";
    EXPECT_GT(seen.of(Kind::Ground, 2.5, 5.0), 100U);
  }
}

TEST(GroundTest, ABankThatIsTooSteepIsAnObstacle) {
  EXPECT_GT(see(slope(35.0, 2.0), camera(), kCamera, 3).of(Kind::Obstacle, 2.0, 5.0), 50U);
}

TEST(GroundTest, AStoneOfTenCentimetresInTheGrassIsFound) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const double x : {1.2, 1.6, 2.0}) {
      Scene scene = slope(0.0);
      scene.blocks.push_back({x, x + 0.15, -0.08, 0.08, -0.1, 0.10});
      const Seen seen = see(scene, camera(), kCamera, seed);
      EXPECT_GE(seen.of(Kind::Obstacle, x - 0.05, x + 0.2, -0.13, 0.13), 1U) << x << " " << seed;
      EXPECT_EQ(seen.of(Kind::Obstacle), seen.of(Kind::Obstacle, x - 0.1, x + 0.25, -0.2, 0.2));
    }
  }
}

TEST(GroundTest, ABoxOfTwentyCentimetresIsFoundByCameraAndRingsOnSlopes) {
  for (const double deg : {-10.0, 0.0, 10.0}) {
    Scene scene = slope(deg);
    const double rise = 2.7 * std::tan(base::rad_from_deg(deg));
    scene.blocks.push_back({2.5, 2.9, -0.2, 0.2, rise - 1.0, rise + 0.20});
    const double pitch = -base::rad_from_deg(deg);
    const double flat = 2.5 / std::cos(pitch);
    EXPECT_GE(see(scene, camera(), kCamera, 2, {}, pitch)
                  .of(Kind::Obstacle, flat - 0.15, flat + 0.6, -0.3, 0.3),
              3U)
        << deg;
    EXPECT_GE(see(scene, sixteen_rings(), kMast, 2, {}, pitch)
                  .of(Kind::Obstacle, flat - 0.15, flat + 0.6, -0.3, 0.3),
              2U)
        << deg;
  }
}

TEST(GroundTest, AWallIsAnObstacleAlsoWhereNoGroundIsSeenBeforeIt) {
  Scene scene;
  scene.ground = [](double, double) { return -50.0; };  // black water: no echo
  scene.blocks.push_back({4.0, 4.2, -6.0, 6.0, -0.2, 2.0});
  const Seen seen = see(scene, sixteen_rings(), kMast, 1);
  // All but the lowest hand of it: what could still be a slope.
  EXPECT_GT(seen.of(Kind::Obstacle, 3.9, 4.3), 200U);
}

TEST(GroundTest, ABarAboveTheBodyIsPassedBelowAndALowOneIsNot) {
  for (const double z : {0.5, 1.2}) {
    Scene scene;
    scene.blocks.push_back({2.0, 2.1, -2.0, 2.0, z, z + 0.1});
    const Seen seen = see(scene, camera(), {.x_m = 0.45, .z_m = 0.6, .pitch_rad = 0.0}, 1);
    if (z > 0.8) {
      EXPECT_GT(seen.of(Kind::Overhang, 1.9, 2.2), 20U);
      EXPECT_EQ(seen.of(Kind::Obstacle), 0U);
    } else {
      EXPECT_GT(seen.of(Kind::Obstacle, 1.9, 2.2), 20U);
    }
  }
}

//   ▭────┐
//        └────  half a metre down at x = 1.5, nearer than where a slope of 20 deg would look the
//        same
TEST(GroundTest, AStepDownIsADropForThoseThatLookForIt) {
  Scene scene;
  scene.noise_m = 0.03;
  scene.ground = [](double x, double) { return x > 1.5 ? -0.5 : 0.0; };
  GroundParams params;
  EXPECT_EQ(see(scene, camera(), kCamera, 1, params).of(Kind::Drop), 0U);
  params.drop = true;
  const Seen seen = see(scene, camera(), kCamera, 1, params);
  EXPECT_GE(seen.of(Kind::Drop, 1.2, 1.8, -0.8, 0.8), 10U);
  EXPECT_EQ(seen.of(Kind::Drop, -9, 1.1, -0.8, 0.8), 0U);
  // A slope down is none.
  EXPECT_EQ(see(slope(-15.0, 1.0), camera(), kCamera, 1, params).of(Kind::Drop), 0U);
}

TEST(GroundTest, AMirroredPointFarBelowDoesNotRaiseTheGroundAroundIt) {
  Scene scene;
  std::mt19937 random(1);
  auto sight = look(scene, camera(), kCamera, 1.0, standing(), random);
  for (std::size_t i = 0; i < sight.points.size(); i += 97) {
    sight.points[i].x_m *= 1.8F;  // behind the surface, as a puddle shows the sky
    sight.points[i].y_m *= 1.8F;
    sight.points[i].z_m *= 1.8F;
  }
  Reducer reducer({}, kTracked);
  Reduced out;
  ASSERT_TRUE(reducer.reduce(sight, kCamera, driven(1.2, [](double) { return Pose2{}; }), out));
  Ground ground({}, 8.0, kTracked);
  ground.judge(out.voxels);
  EXPECT_EQ(Seen{out.voxels}.of(Kind::Obstacle, -9, 4.0), 0U);
}

}  // namespace
}  // namespace roverd::nav::sense
