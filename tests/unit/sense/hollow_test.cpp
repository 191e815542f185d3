// From a hollow, and beside what was seen: the ground of hills where a lidar sees little of it.
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/hills.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

constexpr double kLidar_m = 0.8;
constexpr double kLowest_deg = 15.0;

using Surface = std::function<double(double x, double y)>;

/// Where a ray meets the surface within 8 m, from the robot's middle; a face as well.
std::optional<Voxel> met(const Surface& surface, double bearing_rad, double down_deg) {
  for (double r = 0.6; r < 8.0; r += 0.005) {
    const double x = r * std::cos(bearing_rad);
    const double y = r * std::sin(bearing_rad);
    const double z = kLidar_m - r * std::tan(base::rad_from_deg(down_deg));
    if (z > surface(x, y)) continue;
    return Voxel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 1,
                 Kind::Ground};
  }
  return std::nullopt;
}

/// Four rings of a lidar, laid as ground wherever they lie.
Reduced rings(const Surface& surface) {
  Reduced out;
  out.stamp = at(1.0);
  out.lie.told = true;
  out.origin_m = {0.0F, 0.0F, static_cast<float>(kLidar_m)};
  for (int degree = 0; degree < 360; ++degree) {
    for (const double down_deg : {kLowest_deg, 13.0, 11.0, 9.0}) {
      if (const auto v = met(surface, base::rad_from_deg(degree), down_deg))
        out.voxels.push_back(*v);
    }
  }
  return out;
}

/// A plane's echo 5 cm over where the first ring ahead lies.
bool is_ground_ahead(const Surface& surface) {
  Hills hills(8.0, 0.15);
  hills.learn(rings(surface));
  const auto first = met(surface, 0.0, kLowest_deg);
  return first &&
         hills.is_ground(static_cast<double>(first->x_m), 0.0, first->z_m + 0.05F, at(1.1));
}

double hill_around(double x, double y) {
  return 0.12 * std::max(0.0, std::hypot(x, y) - 0.8);
}

//        ●            ___---    The robot stands in a hollow: its first ring lies 0.17 m over its
//       ▭       ___---          plane, and nothing before it is seen.
//   ═════════---
TEST(HollowTest, AWideHillAboutTheRobotIsGroundThoughItsFootIsHidden) {
  EXPECT_TRUE(is_ground_ahead(hill_around));
  EXPECT_TRUE(is_ground_ahead([](double x, double) { return 0.1 * std::max(0.0, x - 0.8); }))
      << "a bank across";
}

//   On the level, so high and so far off: its foot is hidden, and more of it may lie behind.
TEST(HollowTest, ALowBlockOrAKerbThereIsNone) {
  for (const double wide_m : {0.3, 0.6, 1.0, 1.6}) {
    EXPECT_FALSE(is_ground_ahead([wide_m](double x, double y) {
      return x > 2.4 && x < 5.0 && std::abs(y) < 0.5 * wide_m ? 0.25 : 0.0;
    })) << wide_m
        << " m wide";
  }
  for (const double askew : {0.0, 0.3, -0.3}) {
    EXPECT_FALSE(is_ground_ahead([askew](double x, double y) {
      return x > 2.4 + askew * y ? 0.25 : 0.0;
    })) << "a kerb, askew by "
        << askew;
  }
}

TEST(HollowTest, ABlockOnTheHillAroundIsNone) {
  EXPECT_FALSE(is_ground_ahead([](double x, double y) {
    return hill_around(x, y) + (x > 1.5 && x < 4.0 && std::abs(y) < 0.3 ? 0.2 : 0.0);
  }));
}

TEST(HollowTest, TooSteepAHillAroundIsNone) {
  EXPECT_FALSE(is_ground_ahead(
      [](double x, double y) { return 0.22 * std::max(0.0, std::hypot(x, y) - 0.8); }));
}

TEST(HollowTest, AHillOfWhichLittleIsSeenIsNone) {
  Hills hills(8.0, 0.15);
  Reduced in = rings(hill_around);
  std::erase_if(in.voxels,
                [n = 0](const Voxel& v) mutable { return v.y_m > 0.0F && ++n % 5 != 0; });
  hills.learn(in);
  const auto first = met(hill_around, 0.0, kLowest_deg);
  ASSERT_TRUE(first);
  EXPECT_FALSE(hills.is_ground(static_cast<double>(first->x_m), 0.0, first->z_m + 0.05F, at(1.1)));
}

//   Between rings, and near what only others saw, the ground goes on as it may.
TEST(HollowTest, AHandBesideKnownGroundItIsKnownToRiseByItsSlope) {
  Hills hills(8.0, 0.15);
  Reduced in;
  in.stamp = at(1.0);
  in.lie.told = true;
  for (float x = 0.55F; x < 3.0F; x += 0.1F) in.voxels.push_back({x, 0.05F, 0.0F, 1, Kind::Ground});
  hills.learn(in);
  EXPECT_TRUE(hills.is_ground(2.05, 0.35, 0.19F, at(1.1))) << "0.3 m beside it: 0.15 and 0.045 m";
  EXPECT_FALSE(hills.is_ground(2.05, 0.35, 0.2F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(2.05, 0.45, 0.1F, at(1.1))) << "0.4 m beside it";
  //   Known ground about it says more than what lies farther off.
  EXPECT_TRUE(hills.is_ground(2.05, 0.15, 0.16F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(2.05, 0.15, 0.17F, at(1.1)));
}

}  // namespace
}  // namespace roverd::nav::sense
