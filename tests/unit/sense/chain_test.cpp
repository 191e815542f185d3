// All of it, from the points of the sensors to how fast the robot may go.
#include "nav/sense/chain.hpp"

#include <gtest/gtest.h>

#include "nav/sense/protect.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kSkid = Footprint::box(1.0, 0.8, 0.5);

SensorSetup scanner(std::string name = "eye") {
  SensorSetup s;
  s.name = std::move(name);
  s.mount = {.x_m = 0.45, .z_m = 0.3};
  s.planar = true;
  s.health.rate_hz = 50.0;
  return s;
}

Chain chain_of(std::vector<SensorSetup> sensors) {
  auto chain = Chain::of({}, std::move(sensors), kSkid, at(0.0));
  EXPECT_TRUE(chain.has_value());
  return std::move(*chain);
}

/// Rain: so many single echoes at random places before what is there.
void rain(base::Sight& sight, int drops, std::mt19937& random) {
  std::uniform_real_distribution<float> part(0.05F, 0.9F);
  for (int i = 0; i < drops; ++i) {
    base::SightPoint& p = sight.points[random() % sight.points.size()];
    const float k = part(random) * (p.echo == base::Echo::Hit ? 1.0F : 8.0F);
    p.x_m *= k;
    p.y_m *= k;
    p.z_m *= k;
    p.echo = base::Echo::Hit;
  }
}

TEST(ChainTest, ASensorInTheGroundOrTwoOfOneNameAreRefusedByName) {
  auto low = scanner("front");
  low.mount.z_m = -0.2;
  const auto refused = Chain::of({}, {low}, kSkid, at(0.0));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().fields.at(0).pointer, "/front/z_m");
  EXPECT_FALSE(Chain::of({}, {scanner("a"), scanner("a")}, kSkid, at(0.0)).has_value());
}

TEST(ChainTest, TheRobotSlowsBeforeAWallAndStandsBeforeItTouches) {
  Chain chain = chain_of({scanner()});
  Scene scene;
  scene.blocks.push_back({4.0, 4.2, -3.0, 3.0, 0.0, 1.0});
  std::mt19937 random(1);
  Patch patch;
  Pose2 pose;
  double part = 1.0;
  bool slowed = false;
  for (double t = 1.0; t < 14.0; t += 0.02) {
    const auto way = [pose](double) { return pose; };
    const auto sight = look(scene, planar(), scanner().mount, t, standing(pose), random);
    ASSERT_TRUE(chain.take(sight, driven(t + 0.02, way), at(t + 0.02)).has_value());
    chain.grid().patch(pose, 5.0, at(t + 0.02), patch);
    const Verdict v = protect(patch, pose, kSkid, {1.0, 0.0}, {});
    slowed |= v.part > 0.2 && v.part < 0.8;
    part += std::clamp(v.part - part, -0.012, 0.014);  // 0.6 m/s² braking
    pose.x_m += 0.02 * part;
  }
  const double left = 4.0 - pose.x_m - 0.5;
  EXPECT_TRUE(slowed);
  EXPECT_GT(left, 0.05);
  EXPECT_LT(left, 0.4);
}

TEST(ChainTest, RainDoesNotStopItAndABoxInTheRainDoes) {
  for (const bool box : {false, true}) {
    Chain chain = chain_of({scanner()});
    Scene scene;
    scene.blocks.push_back({7.0, 7.2, -6.0, 6.0, 0.0, 1.0});
    scene.blocks.push_back({-7.0, 7.2, 6.0, 6.2, 0.0, 1.0});
    scene.blocks.push_back({-7.0, 7.2, -6.2, -6.0, 0.0, 1.0});
    if (box) scene.blocks.push_back({1.5, 1.7, -0.1, 0.1, 0.0, 0.5});
    std::mt19937 random(9);
    int stopped = 0;
    int looked = 0;
    for (double t = 1.0; t < 3.0; t += 0.02) {
      auto sight = look(scene, planar(), scanner().mount, t, standing(), random);
      rain(sight, 3, random);
      ASSERT_TRUE(
          chain.take(sight, driven(t + 0.02, [](double) { return Pose2{}; }), at(t)).has_value());
      Patch patch;
      chain.grid().patch({}, 5.0, at(t), patch);
      const Verdict v = protect(patch, {}, kSkid, {1.0, 0.0}, {});
      stopped += v.limit == Limit::Obstacle;
      ++looked;
    }
    if (box) {
      EXPECT_GE(stopped, looked - 2);
    } else {
      EXPECT_EQ(stopped, 0) << "of " << looked;
    }
  }
}

TEST(ChainTest, ABlindedSensorIsToldAndWhatItDoesNotSeeIsUnknown) {
  Chain chain = chain_of({scanner()});
  Scene open;
  open.ground = [](double, double) { return -90.0; };
  std::mt19937 random(1);
  const auto history = driven(1.1, [](double) { return Pose2{}; });
  ASSERT_TRUE(
      chain.take(look(open, planar(), scanner().mount, 1.0, standing(), random), history, at(1.0))
          .has_value());
  EXPECT_EQ(chain.blind(at(1.0)).value_or(""), "eye: too many directions tell nothing");
  EXPECT_EQ(chain.grid().at(2.0, 0.0, at(1.0)), Known::Unknown);
}

TEST(ChainTest, SilenceOfANeededSensorIsToldWithinThreeTenthsOfASecond) {
  auto extra = scanner("rear");
  extra.needed = false;
  Chain chain = chain_of({scanner(), extra});
  Scene room;
  room.blocks.push_back({3.0, 3.2, -9.0, 9.0, 0.0, 1.0});
  room.blocks.push_back({-9.0, 9.0, 2.0, 2.2, 0.0, 1.0});
  room.blocks.push_back({-9.0, 9.0, -2.2, -2.0, 0.0, 1.0});
  std::mt19937 random(1);
  const auto history = driven(1.1, [](double) { return Pose2{}; });
  ASSERT_TRUE(
      chain.take(look(room, planar(), scanner().mount, 1.0, standing(), random), history, at(1.0))
          .has_value());
  EXPECT_FALSE(chain.blind(at(1.25)).has_value());
  EXPECT_EQ(chain.blind(at(1.31)).value_or(""), "eye: it is silent");
}

//   A camera's program says that its points lie 0.00001 rad apart. They do not.
TEST(ChainTest, ATooFineStepThatACameraTellsHidesNoObstacle) {
  for (const auto& [across, up] : {std::pair{40, 30}, std::pair{160, 120}}) {
    auto eye = scanner();
    eye.planar = false;
    eye.mount = {.x_m = 0.45, .z_m = 0.5};
    Chain chain = chain_of({eye});
    Scene scene;
    scene.blocks.push_back({2.5, 2.6, 0.0, 0.08, 0.0, 0.3});  // three echoes of the coarser
    Rays rays = camera(across, up);
    rays.half_step_rad = 0.5e-5F;
    std::mt19937 random(1);
    for (double t = 1.0; t < 1.45; t += 0.1) {
      const auto sight = look(scene, rays, eye.mount, t, standing(), random);
      const auto still = driven(t + 0.02, [](double) { return Pose2{}; });
      ASSERT_TRUE(chain.take(sight, still, at(t)).has_value());
    }
    int taken = 0;
    for (const double y : {0.025, 0.075}) {
      taken += chain.grid().at(2.475, y, at(1.45)) == Known::Occupied ||
               chain.grid().at(2.525, y, at(1.45)) == Known::Occupied;
    }
    EXPECT_GE(taken, 1) << across << " by " << up;
  }
}

TEST(ChainTest, PiecesOfStrangersAndOfSensorsThatAreNotReadyChangeNothing) {
  Chain chain = chain_of({scanner()});
  base::Sight sight;
  sight.sensor = "nobody";
  EXPECT_EQ(chain.take(sight, {}, at(1.0)).error().code, base::Code::NotFound);
  sight.sensor = "eye";
  sight.good = false;
  EXPECT_FALSE(chain.take(sight, {}, at(1.0)).has_value());
  EXPECT_EQ(chain.health(0, at(1.0)).refused, 1U);
}

}  // namespace
}  // namespace roverd::nav::sense
