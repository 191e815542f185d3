// A lidar's clouds along a drive become a map in three dimensions.

#include "nav/mapping/clouds.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "nav/chart/stood.hpp"
#include "rooms.hpp"

namespace roverd::nav::mapping {
namespace {

using Cloud = std::vector<Eigen::Vector3f>;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr float kLidar_m = 0.6F;  // over the ground
constexpr double kDeg = 57.29577951;

/// The ground rises gently to the middle of the longer walls, by a metre.
double ground_m(double x, double y) {
  return 0.5 * std::sin(0.14 * x) + 0.25 * std::cos(0.2 * y) - 0.25;
}

/// Where the ray meets the ground; at least `most_m` where it does not before.
double to_ground_m(const Vector3d& eye, const Vector3d& way, double most_m) {
  constexpr double kStep_m = 0.25;
  double over = eye.z() - ground_m(eye.x(), eye.y());
  for (double r = kStep_m; r < most_m + kStep_m; r += kStep_m) {
    const Vector3d p = eye + r * way;
    const double now = p.z() - ground_m(p.x(), p.y());
    if (now <= 0.0) return r - kStep_m * now / (now - over);
    over = now;
  }
  return most_m + kStep_m;
}

/// Sixteen rows from -15 to 15 degrees, deviation 2 cm. Walls are 3 m high.
Cloud look(const Plan& plan, const Isometry3d& x_mb, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.02);
  Cloud out;
  const Vector3d eye = x_mb * Vector3d(0, 0, kLidar_m);
  for (int row = -15; row <= 15; row += 2) {
    for (int i = 0; i < 360; ++i) {
      const Vector3d b(std::cos(i / kDeg) * std::cos(row / kDeg),
                       std::sin(i / kDeg) * std::cos(row / kDeg), std::sin(row / kDeg));
      const Vector3d way = x_mb.linear() * b;
      const double flat = way.head<2>().norm();
      const double wall = range_m(plan, eye.x(), eye.y(), std::atan2(way.y(), way.x())) / flat;
      const double r = to_ground_m(eye, way, std::min(wall, 25.0));
      if (r >= 25.0 || (r >= wall && (eye + wall * way).z() > 3.0)) continue;
      const double told = std::min(r, wall) + noise(random);
      out.push_back((Vector3d(0, 0, kLidar_m) + told * b).cast<float>());
    }
  }
  return out;
}

/// One and a quarter times around the block, a body each metre; it lies as the ground does.
struct HillyDrive {
  std::vector<Isometry3d> bodies;
  std::vector<sense::Pose2> path;  ///< as the plane's mapper has laid it
  Clouds clouds;

  explicit HillyDrive(const Plan& plan, double walker_m = 0.0) {
    std::mt19937 random(7);
    std::normal_distribution<double> unit;
    double drift_m = 0.0;
    for (std::size_t i = 0; i < 80; ++i) {
      const sense::Pose2 at = around(static_cast<double>(i));
      const sense::Lie3 lies = lie(at);
      bodies.push_back(chart::stood(at, lies.z_m, lies));
      const double off = i == 0 ? 0.0 : 1.0;
      path.push_back({at.x_m + 0.03 * off * unit(random), at.y_m + 0.03 * off * unit(random),
                      at.yaw_rad + 0.005 * off * unit(random)});
      sense::Lie3 told = lies;
      told.roll_rad += 0.008 * off * unit(random);
      told.pitch_rad += 0.008 * off * unit(random);
      told.z_m += drift_m += 0.03;  // 2.4 m in the end
      Cloud seen = look(plan, bodies.back(), random);
      if (walker_m > 0.0) {
        const double behind_m = walker_m + 0.3 * unit(random);
        for (int k = 0; k < 300; ++k) {
          seen.emplace_back(static_cast<float>(-behind_m + 0.1 * unit(random)),
                            static_cast<float>(0.1 * unit(random)),
                            static_cast<float>(1.2 + 0.3 * unit(random)));
        }
      }
      EXPECT_TRUE(clouds.add(seen, {i, {}, told, {0, 0, kLidar_m}, static_cast<double>(i)}));
    }
  }
  /// Along a rectangle of 20 by 12 m with round corners enough for a test: 64 m.
  static sense::Pose2 around(double way_m) {
    const double s = std::fmod(way_m, 64.0);
    if (s < 20.0) return {s, 0.0, 0.0};
    if (s < 32.0) return {22.0, s - 20.0, 90.0 / kDeg};
    if (s < 52.0) return {22.0 - (s - 32.0), 12.0, 180.0 / kDeg};
    return {0.0, 12.0 - (s - 52.0), -90.0 / kDeg};
  }
  static sense::Lie3 lie(const sense::Pose2& at) {
    const double c = std::cos(at.yaw_rad);
    const double s = std::sin(at.yaw_rad);
    const auto slope = [&](double ax, double ay) {
      return (ground_m(at.x_m + 0.3 * ax, at.y_m + 0.3 * ay) -
              ground_m(at.x_m - 0.3 * ax, at.y_m - 0.3 * ay)) /
             0.6;
    };
    return {ground_m(at.x_m, at.y_m), std::atan(slope(-s, c)), std::atan(slope(c, s)), true};
  }
};

struct Off {
  double height_m = 0.0;
  double place_m = 0.0;
  double tilt_rad = 0.0;
};
Off rms(const std::vector<Isometry3d>& found, const std::vector<Isometry3d>& truth) {
  Off sum;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Vector3d d = found[i].translation() - truth[i].translation();
    const double tilt = found[i].linear().col(2).dot(truth[i].linear().col(2));
    sum.height_m += d.z() * d.z();
    sum.place_m += d.head<2>().squaredNorm();
    sum.tilt_rad += 2.0 * (1.0 - tilt);
  }
  const auto n = static_cast<double>(truth.size());
  return {std::sqrt(sum.height_m / n), std::sqrt(sum.place_m / n), std::sqrt(sum.tilt_rad / n)};
}

TEST(Clouds, AreLevelledWhereTheWayComesByAgainAndLaidOnEachOther) {
  const HillyDrive drive(block_of_rooms());
  const auto poses = drive.clouds.settled(drive.path, 0.2);
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->size(), drive.bodies.size());
  const Off off = rms(*poses, drive.bodies);
  EXPECT_LT(off.height_m, 0.05) << "the odometry's height was 2.4 m off";
  EXPECT_LT(off.place_m, 0.03) << "the plane's way was 0.042 m off";
  EXPECT_LT(off.tilt_rad, 0.006) << "the body's lie was 0.011 rad off";
}

//   Somebody walks some two metres behind the lidar all the way, a quarter of it twice. Where he is
//   met again the others saw through him, but for his head, over which few rays go.
TEST(Clouds, BecomeCellsOfWhatStandsAndNotOfWhoWalksBehind) {
  const HillyDrive drive(block_of_rooms(), 2.0);
  const auto map = drive.clouds.laid(drive.path, 0.2);
  ASSERT_TRUE(map) << map.error().detail;
  std::size_t upright = 0;
  std::size_t on_wall = 0;
  std::size_t ground = 0;
  std::size_t on_ground = 0;
  std::size_t walker = 0;
  for (const cells::Cell& c : map->cells()) {
    const double over_m = c.mean_m.z() - ground_m(c.mean_m.x(), c.mean_m.y());
    const double wall_m = to_wall_m(block_of_rooms(), c.mean_m.x(), c.mean_m.y());
    if (over_m >= 0.25) {
      ++upright;
      if (wall_m < 0.08) ++on_wall;
      if (wall_m > 0.5) ++walker;
    } else if (wall_m > 0.25) {
      ++ground;
      if (std::abs(over_m) < 0.08) ++on_ground;
    }
  }
  EXPECT_GT(upright, 4000U);
  EXPECT_GT(ground, 4000U);
  EXPECT_LT(walker, 120U) << "he met 3500 cells";
  EXPECT_GT(static_cast<double>(on_wall), 0.95 * static_cast<double>(upright));
  EXPECT_GT(static_cast<double>(on_ground), 0.95 * static_cast<double>(ground));
}

TEST(Clouds, OfAShortDriveAllIsKeptAndOfNoneThereIsNoMap) {
  Clouds none;
  EXPECT_EQ(none.laid(std::vector<sense::Pose2>{{}}, 0.2).error().code, base::Code::Invalid);
  Clouds one;
  EXPECT_TRUE(one.wants(0.0));
  const float nan = std::nanf("");
  ASSERT_TRUE(one.add(Cloud{{nan, 0, 0}}, {}));
  EXPECT_EQ(one.size(), 0U) << "no number, no cloud";
  ASSERT_TRUE(one.add(Cloud{{2, 0, 1}, {2.01F, 0.01F, 1.01F}, {nan, 1, 1}, {0, 40, 1}}, {}));
  EXPECT_FALSE(one.wants(0.9));
  EXPECT_TRUE(one.wants(1.0));
  const auto map = one.laid(std::vector<sense::Pose2>{{5.0, 0.0, 0.0}}, 0.2);
  ASSERT_TRUE(map);
  ASSERT_EQ(map->cells().size(), 1U);
  EXPECT_NEAR(map->cells()[0].mean_m.x(), 7.0, 1e-5);
  EXPECT_EQ(map->cells()[0].points, 1.0) << "thinned";
}

TEST(Clouds, AreGivenUpWhenAskedTo) {
  Clouds clouds;
  ASSERT_TRUE(clouds.add(Cloud{{2, 0, 1}}, {}));
  const std::vector<sense::Pose2> path{{}};
  EXPECT_EQ(clouds.laid(path, 0.2, [] { return true; }).error().code, base::Code::Unavailable);
}

//   0 ── 1 ── 2 ── 3 ── 4    The odometry says 0.1 m up each; 4 stands where 0 did, and one rise
//   └───────── same ────┘    is a lie of 2 m.
TEST(Heights, DriftIsSpreadOverTheWayAndALieIsNotFollowed) {
  std::vector<Rise> rises;
  for (std::size_t i = 1; i < 5; ++i) rises.push_back({i - 1, i, 0.1, 0.07});
  rises.push_back({0, 4, 0.0, 0.03});
  rises.push_back({1, 4, -0.02, 0.03});
  rises.push_back({0, 3, 2.0, 0.03});
  const auto heights = levelled(5, rises);
  EXPECT_EQ(heights[0], 0.0);
  EXPECT_NEAR(heights[4], 0.0, 0.06);
  for (const double h : heights) EXPECT_LT(std::abs(h), 0.2);
  EXPECT_EQ(levelled(1, {}), std::vector<double>{0.0});
  EXPECT_TRUE(levelled(0, {}).empty());
}

}  // namespace
}  // namespace roverd::nav::mapping
