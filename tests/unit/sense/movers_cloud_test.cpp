// Who moves, as clouds see it: a lidar of sixteen rings over the body, ten turns a second, and a
// depth camera. What stands hides from them in another way in each piece: rows climb and fall as
// the body nods, and the ground near the robot is not seen.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "nav/sense/movers.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

using Blocks = std::function<std::vector<Block>(double)>;
using Body = std::function<Pose2(double)>;
using Told = std::vector<std::vector<Mover>>;  // at the end of each piece

struct Eye {
  Rays rays;
  base::Mount mount;
  double every_s = 0.1;
};

Eye lidar() {
  return {sixteen_rings(450), {.x_m = 0.1, .z_m = 0.8}};
}
Eye depth_camera() {
  return {camera(), {.x_m = 0.45, .z_m = 0.6, .pitch_rad = 0.3}, 1.0 / 15.0};
}

struct Field {
  unsigned seed = 3;
  double nods_rad = 0.0;  ///< the body, once a second
  bool told = true;       ///< something says how it lies
  Body odometry = {};     ///< if not the truth
};

Told watch(const Eye& with, double lasts_s, const Body& body, const Blocks& blocks,
           const Field& field = {}) {
  constexpr double kNoise_m = 0.03;  // along a ray
  SensorSetup eye;
  eye.name = "eye";
  eye.mount = with.mount;
  eye.health.rate_hz = 1.0 / with.every_s;
  auto chain = Chain::of({}, {eye}, Footprint::box(1.0, 0.8, 0.5), at(0.0));
  EXPECT_TRUE(chain.has_value());
  std::mt19937 random(field.seed);
  std::normal_distribution<double> noise(0.0, kNoise_m);
  const auto nods = [&](double since) {
    return field.nods_rad * std::sin(2.0 * base::kPi * since);
  };
  const auto lies = [&](double since) {
    return Lie3{.pitch_rad = field.told ? nods(since) : 0.0, .told = field.told};
  };
  const Body& odometry = field.odometry ? field.odometry : body;
  Told out;
  for (double since = 0.0; since < lasts_s; since += with.every_s) {
    const double t = since + 1.0;
    Scene scene;
    scene.blocks = blocks(since);
    scene.noise_m = 0.02;
    base::Sight sight = look(
        scene, with.rays, eye.mount, t,
        [&](double when) { return planar_pose(body(when - 1.0), 0.0, -nods(when - 1.0)); }, random,
        12.0);
    for (base::SightPoint& p : sight.points) {
      if (p.echo != base::Echo::Hit) continue;
      const double r = std::hypot(double(p.x_m), double(p.y_m), double(p.z_m));
      const auto k = static_cast<float>(1.0 + noise(random) / r);
      p.x_m *= k;
      p.y_m *= k;
      p.z_m *= k;
    }
    const auto history = driven(
        t + 0.15, [&](double when) { return odometry(when - 1.0); },
        [&](double when) { return lies(when - 1.0); });
    EXPECT_TRUE(chain->take(sight, history, at(t + 0.12)).has_value());
    chain->movers(at(t + 0.12), out.emplace_back());
  }
  return out;
}

Block person(double x, double y) {
  return {x - 0.15, x + 0.15, y - 0.22, y + 0.22, 0.0, 1.7};
}
Block post(double x, double y) {
  return {x - 0.05, x + 0.05, y - 0.05, y + 0.05, 0.0, 1.5};
}
Pose2 stands(double) {
  return {};
}

/// Seconds from the begin; never: 1e9.
double first_told(const Told& seen, double every_s = 0.1) {
  const auto first = std::ranges::find_if(seen, [](const auto& s) { return !s.empty(); });
  return first == seen.end() ? 1e9 : every_s * double(first - seen.begin());
}
std::size_t pieces_told(const Told& seen) {
  return static_cast<std::size_t>(
      std::ranges::count_if(seen, [](const auto& s) { return !s.empty(); }));
}

//   He hides where he was, and stands nearer at every turn. The robot stands, or backs towards him.
TEST(MoversOfClouds, WhoComesStraightAtALidarIsToldInTime) {
  for (const double backs_mps : {0.0, 0.5, 1.0}) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto seen = watch(
          lidar(), 2.0,
          [&](double t) {
            return Pose2{-backs_mps * t, 0.0, 0.0};
          },
          [](double t) { return std::vector{person(-6.5 + 1.2 * t, -0.3)}; }, {.seed = seed});
      EXPECT_LT(first_told(seen), 1.25) << backs_mps << " m/s, " << seed;
      ASSERT_EQ(seen.back().size(), 1U) << backs_mps << " m/s, " << seed;
      EXPECT_NEAR(seen.back().front().v_mps.x, 1.2, 0.2);
      EXPECT_NEAR(seen.back().front().v_mps.y, 0.0, 0.2);
    }
  }
}

//   He has stood for so long that he counts as what stands. Then he steps towards the robot.
TEST(MoversOfClouds, WhoStoodBesideALidarIsToldSoonAfterHeStepsAway) {
  constexpr double kStands_s = 2.5;
  for (const double creeps_mps : {0.0, 0.3}) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto seen = watch(
          lidar(), kStands_s + 1.4,
          [&](double t) {
            return Pose2{creeps_mps * t, 0.0, 0.0};
          },
          [](double t) {
            return std::vector{person(0.6, 2.2 - 0.8 * std::max(0.0, t - kStands_s))};
          },
          {.seed = seed});
      EXPECT_LT(first_told(seen) - kStands_s, 1.15) << creeps_mps << " m/s, " << seed;
      EXPECT_GE(first_told(seen), kStands_s);
    }
  }
}

//        ▪
//   ░ →      ▭    through a gate of two posts, and they do not hold his box in its place
//        ▪
TEST(MoversOfClouds, WhoComesThroughAGateIsToldBeforeHeIsThere) {
  constexpr double kStands_s = 2.0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const auto seen =
        watch(lidar(), kStands_s + 2.5, stands,
              [](double t) {
                return std::vector{person(4.35 - 1.2 * std::max(0.0, t - kStands_s), 0.0),
                                   post(4.0, 0.4), post(4.0, -0.4)};
              },
              {.seed = seed});
    EXPECT_LT(first_told(seen) - kStands_s, 1.6) << seed;
    EXPECT_GE(first_told(seen), kStands_s) << seed;
  }
}

//   He is known to move as he passes posts a hand's breadth away: he stays known.
TEST(MoversOfClouds, WhoGoesPastPostsIsToldAllTheWay) {
  const auto seen = watch(lidar(), 4.4, stands, [](double t) {
    return std::vector{person(3.5, -2.2 + t), post(3.25, -0.6), post(3.25, 0.3), post(3.25, 1.2)};
  });
  for (std::size_t i = 20; i < 40; ++i) {
    ASSERT_FALSE(seen[i].empty()) << 0.1 * double(i) << " s";
    const bool goes = std::ranges::any_of(
        seen[i], [](const Mover& m) { return std::abs(m.v_mps.y - 1.0) < 0.4; });
    EXPECT_TRUE(goes) << 0.1 * double(i) << " s";
  }
}

//   The wheels turn on the spot, and all that stands goes by half a metre, as the odometry has it.
//   One of the five may be taken for somebody for that time, not each in its turn.
TEST(MoversOfClouds, WhatStandsIsNotTakenForACrowdWhileTheOdometrySlips) {
  const Blocks yard = [](double) {
    return std::vector<Block>{post(3.0, 1.0),
                              post(3.2, -1.0),
                              {2.0, 2.3, 2.0, 2.4, 0.0, 0.8},
                              {2.2, 2.6, -2.4, -2.0, 0.0, 1.2},
                              post(-3.0, 0.3)};
  };
  const auto slips = [](double t) { return Pose2{0.45 * std::clamp(t - 3.0, 0.0, 1.0), 0.0, 0.0}; };
  const auto seen = watch(lidar(), 5.0, stands, yard, {.odometry = slips});
  std::size_t most = 0;
  for (const auto& piece : seen) most = std::max(most, piece.size());
  EXPECT_LE(most, 1U);
}

//   Past walls, boxes of all heights and posts, before and behind gaps: straight on, in a turn,
//   swinging and nodding.
class WhatStands : public testing::Test {
 protected:
  static std::vector<Block> yard(double) {
    return {{-2.0, 30.0, 2.0, 2.2, 0.0, 2.0}, {2.0, 2.6, -1.5, -1.0, 0.0, 0.4},
            {4.0, 4.1, 0.9, 1.0, 0.0, 1.6},   {3.0, 4.0, -2.0, -1.9, 0.0, 1.1},
            {5.0, 5.8, -2.0, -1.9, 0.0, 1.1}, {0.0, 30.0, -4.2, -4.0, 0.0, 2.0},
            {5.5, 5.6, -1.2, -1.1, 0.0, 0.7}, {6.0, 6.8, -1.5, -1.1, 0.0, 0.25},
            {7.0, 7.3, 0.8, 1.1, 0.0, 0.5},   {9.0, 9.4, -3.0, 1.2, 0.0, 1.2}};
  }
  void nobody(const Eye& eye) {
    const Body ways[] = {[](double t) {
                           return Pose2{t, 0.0, 0.0};
                         },
                         [](double t) {
                           return Pose2{8.0 - 1.3 * t, 0.0, 0.0};
                         },
                         [](double t) {
                           return Pose2{4.5, 0.2, 0.7 * t};
                         },
                         [](double t) {
                           return Pose2{1.3 * t, 0.05 * std::sin(3.0 * t), 0.3 * std::sin(2.0 * t)};
                         }};
    for (const Body& way : ways) {
      for (const Field& field : {Field{}, Field{.nods_rad = 0.03}, Field{.nods_rad = 0.08},
                                 Field{.nods_rad = 0.05, .told = false}}) {
        EXPECT_EQ(pieces_told(watch(eye, 4.5, way, yard, field)), 0U)
            << "way " << &way - ways << ", nods " << field.nods_rad;
      }
    }
  }
};
TEST_F(WhatStands, IsNobodyForALidar) {
  nobody(lidar());
}
TEST_F(WhatStands, IsNobodyForADepthCamera) {
  nobody(depth_camera());
}

}  // namespace
}  // namespace roverd::nav::sense
