// A scanner's plane grazes the grass of a hollow 0.5 m before the first ground that a lidar saw: of
// many rays few stop, and others each time. What stands there stops the same ones.
//
//    ●─────────────── 0.17 m ──┤tips├──▶
//                                        ════ known from 2.2 m on, 0.06 m
#include "nav/sense/grass.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

constexpr float kTip_m = 0.17F;

Reduced piece(double t) {
  Reduced out;
  out.stamp = at(t);
  out.lie.told = true;
  out.origin_m = {0.0F, 0.0F, kTip_m};
  return out;
}

Hills known_ahead() {
  Hills hills(8.0, 0.18);
  Reduced cloud = piece(0.0);
  for (float x = 2.25F; x < 4.0F; x += 0.1F) {
    for (float y = -0.45F; y < 0.5F; y += 0.1F) {
      cloud.voxels.push_back({x, y, 0.06F, 1, Kind::Ground});
    }
  }
  hills.learn(cloud);
  return hills;
}

using Stops = std::function<bool(double y_m)>;  // whether a ray stops that comes there at 1.7 m

/// 50 scans a second of half a degree, each a little beside the one before, judged as the chain
/// does.
/// @return of the last one, how many echoes are an obstacle
std::size_t scan(Grass& grass, Hills& hills, const Stops& stops, double from_s, double to_s) {
  std::size_t obstacles = 0;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  SightedParams params;
  params.planar = params.thin = true;
  auto sectors = std::make_unique<Sectors>();
  for (double t = from_s; t < to_s; t += 0.02) {
    Reduced in = piece(t);
    const double beside_deg = 0.5 * any(random);
    for (int i = -40; i <= 40; ++i) {
      const double turn = base::rad_from_deg(0.5 * i + beside_deg);
      const bool met = stops(1.7 * std::tan(turn));
      const double d = met ? 1.7 / std::cos(turn) : 8.0;
      in.voxels.push_back({static_cast<float>(d * std::cos(turn)),
                           static_cast<float>(d * std::sin(turn)), kTip_m, 1,
                           met ? Kind::Obstacle : Kind::Clear});
    }
    hills.judge(in);
    obstacles =
        static_cast<std::size_t>(std::ranges::count(in.voxels, Kind::Obstacle, &Voxel::kind));
    sight_sectors(in, static_cast<float>(base::rad_from_deg(0.25)), params, *sectors);
    grass.see(in, *sectors, hills);
  }
  return obstacles;
}

Stops tips(double part) {
  return [part, random = std::mt19937(3)](double) mutable {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) < part;
  };
}

bool is_ground(const Hills& hills, double now_s) {
  return hills.is_ground(1.71, 0.01, kTip_m, at(now_s));
}

TEST(GrassTest, TipsThatFewRaysMeetAreGroundWhereGroundIsKnownBehindThem) {
  Hills hills = known_ahead();
  Grass grass;
  scan(grass, hills, tips(0.06), 0.1, 0.5);
  EXPECT_FALSE(is_ground(hills, 0.5)) << "not before half a second";
  scan(grass, hills, tips(0.06), 0.5, 1.2);
  EXPECT_TRUE(is_ground(hills, 1.2));
  EXPECT_FALSE(hills.is_ground(1.71, 0.01, 0.32F, at(1.2))) << "higher than grass over that ground";
}

TEST(GrassTest, AStakeOfTwoCentimetresAmongThemStays) {
  Hills hills = known_ahead();
  Grass grass;
  scan(
      grass, hills,
      [grows = tips(0.02)](double y_m) { return std::abs(y_m - 0.01) <= 0.01 || grows(y_m); }, 0.1,
      3.0);
  EXPECT_FALSE(is_ground(hills, 3.0));
}

//   Who lies down in the grass, or a board that is put there: grass of before is no excuse.
TEST(GrassTest, WhatComesToStandWhereGrassWasIsAnObstacleWithinASecond) {
  Hills hills = known_ahead();
  Grass grass;
  scan(grass, hills, tips(0.06), 0.1, 3.0);
  ASSERT_TRUE(is_ground(hills, 3.0));
  const auto board = [](double y_m) { return std::abs(y_m) < 0.1; };
  EXPECT_GE(scan(grass, hills, board, 3.0, 4.1), 10U);
  EXPECT_FALSE(is_ground(hills, 4.1));
  EXPECT_GE(scan(grass, hills, board, 4.1, 8.0), 10U) << "and stays one";
}

TEST(GrassTest, AStakeThatIsPutWhereGrassWasIsAnObstacleWithinASecondAndAHalf) {
  Hills hills = known_ahead();
  Grass grass;
  scan(grass, hills, tips(0.06), 0.1, 3.0);
  const auto stake = [](double y_m) { return std::abs(y_m - 0.01) <= 0.01; };
  scan(grass, hills, stake, 3.0, 4.6);
  EXPECT_FALSE(is_ground(hills, 4.6));
}

TEST(GrassTest, ABoardStays) {
  Hills hills = known_ahead();
  Grass grass;
  scan(
      grass, hills, [](double y_m) { return std::abs(y_m) < 0.1; }, 0.1, 3.0);
  EXPECT_FALSE(is_ground(hills, 3.0));
}

//   Rays that went on far above the tips say nothing of what is between them.
TEST(GrassTest, OnlyRaysThatAreAsLowAsTheTipsCount) {
  Hills hills = known_ahead();
  Grass grass;
  scan(
      grass, hills, [](double y_m) { return std::abs(y_m) < 0.1; }, 0.1, 0.2);
  SightedParams params;
  params.planar = params.thin = true;
  auto sectors = std::make_unique<Sectors>();
  for (double t = 0.2; t < 1.1; t += 0.02) {
    Reduced in = piece(t);
    in.lie.z_m = 0.1;  // the robot stands higher
    for (int i = -40; i <= 40; ++i) {
      const double turn = base::rad_from_deg(0.5 * i);
      in.voxels.push_back({static_cast<float>(8.0 * std::cos(turn)),
                           static_cast<float>(8.0 * std::sin(turn)), kTip_m, 1, Kind::Clear});
    }
    sight_sectors(in, static_cast<float>(base::rad_from_deg(0.25)), params, *sectors);
    grass.see(in, *sectors, hills);
  }
  EXPECT_FALSE(is_ground(hills, 1.1));
}

TEST(GrassTest, WhereNoGroundIsKnownWithinReachTipsStay) {
  Hills hills(8.0, 0.18);
  Reduced cloud = piece(0.0);
  for (float x = 2.55F; x < 4.0F; x += 0.1F) {
    cloud.voxels.push_back({x, 0.05F, 0.06F, 1, Kind::Ground});
  }
  hills.learn(cloud);
  Grass grass;
  scan(grass, hills, tips(0.06), 0.1, 2.0);
  EXPECT_FALSE(is_ground(hills, 2.0));
}

}  // namespace
}  // namespace roverd::nav::sense
