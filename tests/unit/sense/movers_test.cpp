// Whoever walks is told with his velocity; what stands, however it comes to be seen, is not.
#include "nav/sense/movers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

using Blocks = std::function<std::vector<Block>(double)>;
using Body = std::function<Pose2(double)>;
/// Of each metre of a ray's way there, the share that ends in a grain. @param p in O
using Dust = std::function<double(Vec2 p, double since)>;

/// How far from the sensor a ray meets a grain; farther than upto_m: none before that.
double grain_m(const Dust& dust, const Pose2& eye, Vec2 ray, double upto_m, double since,
               std::mt19937& random) {
  constexpr double kStep_m = 0.05;
  if (!dust) return 1e9;
  std::uniform_real_distribution<double> of(0.0, 1.0);
  for (double r = 0.3; r < upto_m; r += kStep_m) {
    const double on_m = r + kStep_m * of(random);
    const Pose2 there = eye * Pose2{on_m * ray.x, on_m * ray.y, 0.0};
    if (of(random) < kStep_m * dust({there.x_m, there.y_m}, since)) return on_m;
  }
  return 1e9;
}

/// A scanner at 25 Hz before the body, for so long. @param late_s between its first piece and the
/// others @param clear_s for so long rays that meet nothing see the way free
/// @return who moves at the end of each piece
std::vector<std::vector<Mover>> watch(double lasts_s, const Body& body, const Blocks& blocks,
                                      double late_s = 0.0, double clear_s = 1e9,
                                      const Dust& dust = {}) {
  SensorSetup eye;
  eye.name = "eye";
  eye.mount = {.x_m = 0.45, .z_m = 0.3};
  eye.planar = true;
  eye.health.rate_hz = 25.0;
  auto chain = Chain::of({}, {eye}, Footprint::box(1.0, 0.8, 0.5), at(0.0));
  EXPECT_TRUE(chain.has_value());
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<std::vector<Mover>> out;
  const Rays rays = planar();
  for (double since = 0.0; since < lasts_s; since += 0.04) {
    const double by_s = since > 0.0 ? 1.0 + late_s : 1.0;
    const double t = since + by_s;
    const Pose2 from = body(since) * Pose2{eye.mount.x_m, 0.0, 0.0};
    Scene scene;
    scene.blocks = blocks(since);
    scene.ground = [](double, double) { return -5.0; };
    base::Sight sight = look(
        scene, rays, eye.mount, t, [&](double when) { return planar_pose(body(when - by_s)); },
        random, 20.0);
    for (base::SightPoint& p : sight.points) {
      const double r = std::hypot(double(p.x_m), double(p.y_m));
      const bool hit = p.echo == base::Echo::Hit;
      const double grain =
          grain_m(dust, from, {p.x_m / r, p.y_m / r}, hit ? r : 6.0, since, random);
      const bool dusty = grain < 1e9;
      const double k = dusty ? grain / r : hit ? 1.0 + noise(random) / r : 6.0 / r;
      if (dusty) p.echo = base::Echo::Hit;
      if (p.echo != base::Echo::Hit) {
        p.echo = since < clear_s ? base::Echo::Clear : base::Echo::Unknown;
      }
      p.x_m = static_cast<float>(k * double(p.x_m));
      p.y_m = static_cast<float>(k * double(p.y_m));
    }
    const auto history = driven(t + 0.05, [&](double when) { return body(when - by_s); });
    EXPECT_TRUE(chain->take(sight, history, at(t + 0.02)).has_value());
    chain->movers(at(t + 0.02), out.emplace_back());
  }
  return out;
}

Block person(double x, double y) {
  return {x - 0.15, x + 0.15, y - 0.22, y + 0.22, -0.2, 1.7};
}
Pose2 stands(double) {
  return {};
}
Dust everywhere(double per_m) {
  return [=](Vec2, double) { return per_m; };
}
Pose2 drives(double t) {
  return {t, 0.0, 0.0};
}
std::size_t most_of(const std::vector<std::vector<Mover>>& seen) {
  std::size_t most = 0;
  for (const auto& one : seen) most = std::max(most, one.size());
  return most;
}

TEST(Movers, WhoCrossesIsToldWithHisVelocityWithinASecond) {
  for (const double speed : {0.5, 1.0, 2.0}) {
    const auto seen =
        watch(2.0, stands, [&](double t) { return std::vector{person(4.0, -2.5 + speed * t)}; });
    const auto first =
        std::find_if(seen.begin(), seen.end(), [](const auto& s) { return !s.empty(); });
    ASSERT_NE(first, seen.end()) << speed;
    EXPECT_LT(0.04 * double(first - seen.begin()), 1.2) << speed;
    ASSERT_EQ(seen.back().size(), 1U);
    const Mover& m = seen.back().front();
    EXPECT_NEAR(m.v_mps.y, speed, 0.15) << speed;
    EXPECT_NEAR(m.v_mps.x, 0.0, 0.15) << speed;
    EXPECT_NEAR(m.at.y, -2.5 + speed * 1.98, 0.1) << speed;
    EXPECT_NEAR(m.radius_m, 0.27, 0.1) << speed;
    EXPECT_LT(m.sigma_mps, 0.25) << speed;
  }
}

//   An animal that sniffs its way along, straight on or at the robot. In 0.7 s it leaves hardly a
//   place.
TEST(Movers, WhoCreepsIsToldToo) {
  for (const double fast_mps : {0.3, 0.4}) {
    for (const double aside : {0.0, 0.6, 1.0}) {
      const auto seen = watch(4.0, stands, [&](double t) {
        const double x = 2.2 - aside * fast_mps * t;
        const double y = -1.5 + std::sqrt(1.0 - aside * aside) * fast_mps * t;
        return std::vector<Block>{{x - 0.15, x + 0.15, y - 0.1, y + 0.1, -0.2, 0.5}};
      });
      const auto first = std::ranges::find_if(seen, [](const auto& s) { return !s.empty(); });
      EXPECT_LT(0.04 * double(first - seen.begin()), 2.0) << fast_mps << " m/s, " << aside;
      ASSERT_EQ(seen.back().size(), 1U) << fast_mps << " m/s, " << aside;
      EXPECT_NEAR(seen.back().front().v_mps.x, -aside * fast_mps, 0.12);
      EXPECT_NEAR(seen.back().front().v_mps.y, std::sqrt(1.0 - aside * aside) * fast_mps, 0.12);
    }
  }
}

TEST(Movers, WhoComesStraightAtTheSensorIsToldThoughHeHidesWhereHeWas) {
  const auto seen =
      watch(2.0, stands, [](double t) { return std::vector{person(5.5 - 1.2 * t, 0.3)}; });
  ASSERT_EQ(seen.back().size(), 1U);
  EXPECT_NEAR(seen.back().front().v_mps.x, -1.2, 0.2);
  EXPECT_NEAR(seen.back().front().v_mps.y, 0.0, 0.2);
}

//   The sun is low behind him: rays that meet nothing tell nothing any more. Nobody has seen the
//   places free that he left beside his shadow, nor that anything is there.
TEST(Movers, WhoComesIsToldThoughNobodySawFreeWhatHeLeft) {
  for (const double side : {-1.0, 1.0}) {
    const auto seen = watch(
        3.0, stands,
        [&](double t) {
          const double walks_s = std::max(0.0, t - 1.0);
          return std::vector{person(4.5 - 1.2 * walks_s, side * 2.0)};
        },
        0.0, 1.0);
    ASSERT_EQ(seen.back().size(), 1U) << side;
    EXPECT_NEAR(seen.back().front().v_mps.x, -1.2, 0.25) << side;
    EXPECT_NEAR(seen.back().front().v_mps.y, 0.0, 0.25) << side;
  }
}

//   Half of what is met of him is held back, other places in each piece.
TEST(Movers, WhoComesThroughDustIsToldBeforeHeIsThere) {
  for (const double dust_per_m : {0.02, 0.04}) {
    for (const double side : {-1.0, 1.0}) {
      const auto seen = watch(
          2.6,
          [](double t) {
            return Pose2{0.5 * t, 0.0, 0.0};
          },
          [&](double t) { return std::vector{person(1.9, side * (5.2 - 1.7 * t))}; }, 0.0, 1e9,
          everywhere(dust_per_m));
      const auto comes = [&](const std::vector<Mover>& told) {
        return std::ranges::any_of(told, [&](const Mover& m) { return -side * m.v_mps.y > 1.0; });
      };
      const auto first = std::ranges::find_if(seen, comes);
      EXPECT_LT(0.04 * double(first - seen.begin()), 1.6) << dust_per_m << " " << side;
    }
  }
}

TEST(Movers, DustAboutWhatStandsIsNobody) {
  const Blocks yard = [](double) {
    return std::vector<Block>{{2.0, 2.6, -1.5, -1.0, -1.0, 1.0},
                              {4.0, 4.1, 1.0, 1.1, -1.0, 1.0},
                              {5.0, 5.8, -2.0, -1.9, -1.0, 1.0}};
  };
  std::size_t told = 0;
  for (const auto& one : watch(8.0, stands, yard, 0.0, 1e9, everywhere(0.04))) told += one.size();
  for (const auto& one : watch(5.0, drives, yard, 0.0, 1e9, everywhere(0.04))) told += one.size();
  EXPECT_EQ(told, 0U);
}

//   What the wind takes along is no wider than somebody, and goes as fast. A thing it is all the
//   same to who stops before it; but nobody's way, whom to let by.
TEST(Movers, APlumeOfDustThatDriftsIsNobody) {
  for (const double fast_mps : {0.5, 1.0}) {
    for (const double per_m : {0.3, 1.0}) {
      const auto in_plume = [&](Vec2 p, double since) {
        return std::hypot(p.x - 3.0, p.y + 2.5 - fast_mps * since) < 0.5 ? per_m : 0.01;
      };
      std::size_t told = 0;
      for (const auto& one : watch(
               4.0, stands, [](double) { return std::vector<Block>{}; }, 0.0, 1e9, in_plume)) {
        told += one.empty() ? 0 : 1;
      }
      EXPECT_EQ(told, 0U) << fast_mps << " m/s, " << per_m << " per metre";
    }
  }
}

TEST(Movers, HeIsToldFromARobotThatDrives) {
  const auto seen =
      watch(2.0, drives, [](double t) { return std::vector{person(6.0, -2.5 + 1.2 * t)}; });
  ASSERT_EQ(seen.back().size(), 1U);
  EXPECT_NEAR(seen.back().front().v_mps.y, 1.2, 0.2);
  EXPECT_NEAR(seen.back().front().v_mps.x, 0.0, 0.2);
}

TEST(Movers, HeIsToldOnAndOnAfterHours) {
  // The times are counted anew 8192 s after the first piece: 1.2 s after this begins.
  const auto seen = watch(
      2.0, stands, [](double t) { return std::vector{person(4.0, -2.5 + t)}; }, 8190.8);
  for (std::size_t i = 25; i < seen.size(); ++i) EXPECT_EQ(seen[i].size(), 1U) << i;
}

/// One of two or more scanners that see 6 m far.
SensorSetup one_of(const char* name, base::Mount mount) {
  SensorSetup eye;
  eye.name = name;
  eye.mount = mount;
  eye.planar = true;
  eye.health.rate_hz = 25.0;
  return eye;
}

void looks(Chain& chain, const SensorSetup& eye, const Block& there, double t,
           std::mt19937& random) {
  Scene scene;
  scene.blocks = {there};
  scene.ground = [](double, double) { return -5.0; };
  base::Sight sight = look(
      scene, planar(), eye.mount, t, [](double) { return planar_pose({}); }, random, 6.0);
  sight.sensor = eye.name;
  for (base::SightPoint& p : sight.points) {
    if (p.echo == base::Echo::Hit) continue;
    p.echo = base::Echo::Clear;
    const double k = 6.0 / std::hypot(double(p.x_m), double(p.y_m));
    p.x_m = static_cast<float>(k * double(p.x_m));
    p.y_m = static_cast<float>(k * double(p.y_m));
  }
  ASSERT_TRUE(chain.take(sight, driven(t + 0.05, stands), at(t + 0.02)).has_value());
}

//   Whoever of them meets him first in a place takes it from the others: one is told, all follow.
TEST(Movers, WhoComesStraightIsToldByEachOfSeveralSensorsThatTakeTurns) {
  const std::vector<SensorSetup> eyes{one_of("left", {.x_m = 0.45, .y_m = 0.2, .z_m = 0.3}),
                                      one_of("middle", {.x_m = 0.45, .z_m = 0.3}),
                                      one_of("right", {.x_m = 0.45, .y_m = -0.2, .z_m = 0.3})};
  auto chain = Chain::of({}, eyes, Footprint::box(1.0, 0.8, 0.5), at(0.0));
  ASSERT_TRUE(chain.has_value());
  std::mt19937 random(3);
  for (int piece = 0; piece < 3 * 50; ++piece) {
    const double since = 0.04 / 3.0 * piece;
    looks(*chain, eyes[static_cast<std::size_t>(piece % 3)], person(5.5 - 1.2 * since, 0.0),
          1.0 + since, random);
  }
  std::vector<Mover> seen;
  chain->movers(at(3.0), seen);
  EXPECT_EQ(seen.size(), 3U);
  for (const Mover& m : seen) {
    EXPECT_NEAR(m.v_mps.x, -1.2, 0.25) << int(m.sensor);
    EXPECT_NEAR(m.v_mps.y, 0.0, 0.25) << int(m.sensor);
  }
}

//   Past the robot, out of the view of the scanner ahead and into that of the one behind: it sees
//   his near edge first.
TEST(Movers, WhoGoesFromOneSensorsViewIntoAnothersIsToldAllTheWay) {
  const std::vector<SensorSetup> eyes{
      one_of("front", {.x_m = 0.45, .z_m = 0.3}),
      one_of("back", {.x_m = -0.45, .z_m = 0.3, .yaw_rad = base::kPi})};
  auto chain = Chain::of({}, eyes, Footprint::box(1.0, 0.8, 0.5), at(0.0));
  ASSERT_TRUE(chain.has_value());
  std::mt19937 random(3);
  std::vector<Mover> seen;
  for (double since = 0.0; since < 3.6; since += 0.04) {
    for (const SensorSetup& eye : eyes) {
      looks(*chain, eye, person(3.0 - 1.5 * since, 0.9), 1.0 + since, random);
    }
    if (since < 1.0) continue;
    chain->movers(at(1.02 + since), seen);
    ASSERT_FALSE(seen.empty()) << since << " s";
    for (const Mover& m : seen) {
      EXPECT_NEAR(m.v_mps.x, -1.5, 0.45) << since << " s, sensor " << int(m.sensor);
      EXPECT_NEAR(m.v_mps.y, 0.0, 0.45) << since << " s, sensor " << int(m.sensor);
    }
  }
}

TEST(Movers, WhoStopsMovesNoMore) {
  const auto seen = watch(
      3.0, stands, [](double t) { return std::vector{person(4.0, -2.0 + std::min(t, 1.5))}; });
  EXPECT_GE(most_of(seen), 1U);
  EXPECT_TRUE(seen.back().empty());
}

TEST(Movers, WhatStandsIsNobodyHoweverItComesIntoSight) {
  // Past a wall, a box, a pole, through gaps before a far wall; and in a turn.
  const Blocks yard = [](double) {
    return std::vector<Block>{{0.0, 30.0, 2.0, 2.2, -1.0, 1.0},  {2.0, 2.6, -1.5, -1.0, -1.0, 1.0},
                              {4.0, 4.1, 1.0, 1.1, -1.0, 1.0},   {3.0, 4.0, -2.0, -1.9, -1.0, 1.0},
                              {5.0, 5.8, -2.0, -1.9, -1.0, 1.0}, {0.0, 30.0, -5.2, -5.0, -1.0, 1.0},
                              {6.5, 6.6, -1.2, -1.1, -1.0, 1.0}, {8.0, 9.5, -1.6, -1.2, -1.0, 1.0}};
  };
  EXPECT_EQ(most_of(watch(5.0, drives, yard)), 0U);
  EXPECT_EQ(most_of(watch(
                3.0,
                [](double t) {
                  return Pose2{0.0, 0.0, 0.7 * t};
                },
                yard)),
            0U);
  // Straight towards them, swinging as it goes, faster than anybody would be told.
  const Blocks ahead = [](double) {
    return std::vector<Block>{{5.5, 5.6, 0.2, 0.3, -1.0, 1.0},
                              {6.0, 6.4, -0.6, -0.2, -1.0, 1.0},
                              {6.8, 7.0, 0.5, 1.2, -1.0, 1.0},
                              {9.0, 9.2, -4.0, 4.0, -1.0, 1.0}};
  };
  EXPECT_EQ(most_of(watch(
                3.5,
                [](double t) {
                  return Pose2{1.3 * t, 0.05 * std::sin(3.0 * t), 0.3 * std::sin(2.0 * t)};
                },
                ahead)),
            0U);
}

}  // namespace
}  // namespace roverd::nav::sense
