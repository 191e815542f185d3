// Places in a map of three dimensions, from cloud to cloud: a lidar of sixteen rows in a hall whose
// thin walls are in the map with both their faces.

#include "nav/place/cell_tracker.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/cells/cell_map.hpp"
#include "shed.hpp"

namespace roverd::nav::place {
namespace {

using tests::Segment;

constexpr double kHigh_m = 2.5;   // of the walls
constexpr double kLidar_m = 0.7;  // over the ground

/// Walls 0.2 m thick about these lines.
std::vector<Segment> faces(const std::vector<Segment>& lines) {
  std::vector<Segment> out;
  for (const Segment& s : lines) {
    const double length = std::hypot(s.bx_m - s.ax_m, s.by_m - s.ay_m);
    const double nx = -0.1 * (s.by_m - s.ay_m) / length;
    const double ny = 0.1 * (s.bx_m - s.ax_m) / length;
    out.push_back({s.ax_m + nx, s.ay_m + ny, s.bx_m + nx, s.by_m + ny});
    out.push_back({s.ax_m - nx, s.ay_m - ny, s.bx_m - nx, s.by_m - ny});
  }
  return out;
}

//   +---------------+-------------+   15 m x 12 m, a partition with a door
//   |               |             |
//   |--                           |
//   |               |             |
//   +---------------+-------------+
std::vector<Segment> hall() {
  return faces({{-3, -4, 12, -4},
                {12, -4, 12, 8},
                {12, 8, -3, 8},
                {-3, 8, -3, -4},
                {6, -4, 6, 0.6},
                {6, 3.4, 6, 8},
                {-3, 5, -1.2, 5},
                {9, 8, 9, 6.2}});
}

/// A point each five centimetres of walls and ground.
std::shared_ptr<const cells::Relief> surveyed(const std::vector<Segment>& walls, double x0,
                                              double x1, double y0, double y1) {
  cells::Cloud points;
  const auto put = [&](double x, double y, double z) {
    points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  };
  for (double x = x0; x < x1; x += 0.05) {
    for (double y = y0; y < y1; y += 0.05) put(x, y, 0.0);
  }
  for (const Segment& s : walls) {
    const double length = std::hypot(s.bx_m - s.ax_m, s.by_m - s.ay_m);
    for (double d = 0.0; d <= length; d += 0.05) {
      const double part = d / length;
      for (double z = 0.0; z <= kHigh_m; z += 0.05) {
        put(s.ax_m + part * (s.bx_m - s.ax_m), s.ay_m + part * (s.by_m - s.ay_m), z);
      }
    }
  }
  cells::CellMap map(0.2);
  map.add(points);
  return std::make_shared<const cells::Relief>(map);
}

/// What the lidar sees from there: rows 2 degrees apart, a ray each degree.
Cloud seen(const std::vector<Segment>& walls, const Pose2& at, double time_s) {
  Cloud out;
  out.stamp = base::Time{} + base::from_seconds(time_s);
  for (int row = -15; row <= 15; row += 2) {
    const double rise = std::tan(base::rad_from_deg(row));
    for (int i = 0; i < 360; ++i) {
      const double bearing = base::rad_from_deg(i + 0.3 * row);
      double range = tests::range_m(walls, at.x_m, at.y_m, at.yaw_rad + bearing);
      if (range <= 0.0) range = 100.0;
      if (rise < 0.0) range = std::min(range, kLidar_m / -rise);
      const double z = kLidar_m + rise * range;
      if (range > 40.0 || z > kHigh_m) continue;
      out.points.emplace_back(static_cast<float>(range * std::cos(bearing)),
                              static_cast<float>(range * std::sin(bearing)), static_cast<float>(z));
    }
  }
  return out;
}

/// It drives, and its odometry counts 5 % too much.
struct Drive {
  std::vector<Segment> walls;
  Pose2 at;
  CellTracker tracker;
  Pose2 odometry{};
  double time_s = 1.0;

  Told step(double ahead_m, double turn_rad) {
    time_s += 0.25;
    at = at * sense::along(ahead_m / 0.25, turn_rad / 0.25, 0.25);
    odometry = odometry * sense::along(1.05 * ahead_m / 0.25, turn_rad / 0.25, 0.25);
    return tracker.feed(seen(walls, at, time_s), odometry);
  }
  double off_m(const Pose2& p) const { return std::hypot(p.x_m - at.x_m, p.y_m - at.y_m); }
};

TEST(CellTrackerTest, FollowsADriveThroughTheDoorAndNeverTakesAWallsOtherFace) {
  // given: somebody's tap, 0.3 m and 8 degrees off
  Drive d{hall(), {0.0, 2.0, 0.0}, CellTracker(surveyed(hall(), -3, 12, -4, 8))};
  d.tracker.set_pose({-0.22, 2.2, base::rad_from_deg(8)}, 0.5, 0.26);
  // when: it drives through the door, turns, and comes near the other room's wall
  for (int i = 0; i < 60; ++i) {
    const Told told = d.step(i < 45 ? 0.2 : 0.1, i < 40 ? 0.0 : 0.08);
    // then: each cloud tells the place, within centimetres
    ASSERT_TRUE(told.fix) << i << ": " << told.reason;
    EXPECT_LT(d.off_m(told.fix->pose), 0.04) << i;
    EXPECT_LT(std::abs(base::angle_diff_rad(told.fix->pose.yaw_rad, d.at.yaw_rad)), 0.01) << i;
    EXPECT_LT(std::sqrt(told.fix->covariance(0, 0)), 0.05) << i;
  }
  EXPECT_EQ(d.tracker.phase(), Phase::Tracking);
}

//   ════════════════════   Nothing tells where along it the robot is: the covariance says so, and
//     ●─▶                  the odometry carries it on.
//   ════════════════════
TEST(CellTrackerTest, ABareCorridorHoldsItAcrossAndLeavesItOpenAlong) {
  const auto walls = faces({{-60, -1.2, 60, -1.2}, {-60, 1.2, 60, 1.2}});
  Drive d{walls, {0.0, 0.3, 0.0}, CellTracker(surveyed(walls, -60, 60, -1.2, 1.2))};
  d.tracker.set_pose({0.0, 0.25, 0.0}, 0.1, 0.05);
  Told told;
  for (int i = 0; i < 20; ++i) {
    told = d.step(0.2, 0.0);
    ASSERT_TRUE(told.fix) << i << ": " << told.reason;
  }
  EXPECT_NEAR(told.fix->pose.y_m, 0.3, 0.03);
  EXPECT_LT(std::sqrt(told.fix->covariance(1, 1)), 0.05);
  EXPECT_GT(std::sqrt(told.fix->covariance(0, 0)), 0.3);
  EXPECT_NEAR(told.fix->pose.x_m, d.at.x_m, 0.3) << "4 m, of which the odometry makes 4.2";
}

TEST(CellTrackerTest, WhatIsSeenInAnotherBuildingIsLostWithinAMetreOfDriving) {
  Drive d{hall(), {2.0, 2.0, 0.0}, CellTracker(surveyed(hall(), -3, 12, -4, 8))};
  d.tracker.set_pose(d.at, 0.1, 0.05);
  ASSERT_TRUE(d.step(0.1, 0.0).fix);
  d.walls = faces(tests::other_building());
  double way_m = 0.0;
  Told told;
  for (; way_m < 2.0 && told.phase != Phase::Lost; way_m += 0.2) {
    told = d.step(0.2, 0.1);
    EXPECT_FALSE(told.fix) << way_m;
  }
  EXPECT_LE(way_m, 1.25);
  EXPECT_EQ(told.reason, kLostWords);
  EXPECT_FALSE(told.pose);
}

TEST(CellTrackerTest, SaysNothingByAFewPointsByAnOldCloudOrBeforeAnybodyToldAPlace) {
  Drive d{hall(), {2.0, 2.0, 0.0}, CellTracker(surveyed(hall(), -3, 12, -4, 8))};
  EXPECT_EQ(d.step(0.1, 0.0).phase, Phase::Searching);
  d.tracker.set_pose(d.at, 0.1, 0.05);
  Cloud few = seen(d.walls, d.at, 10.0);
  few.points.resize(50);
  EXPECT_EQ(d.tracker.feed(few, d.odometry).reason, "too little to see");
  EXPECT_FALSE(d.tracker.feed(seen(d.walls, d.at, 9.0), d.odometry).fix) << "older than the last";
  const double nan = std::nan("");
  EXPECT_FALSE(d.tracker.feed(seen(d.walls, d.at, 11.0), {nan, 0.0, 0.0}).fix);
  EXPECT_TRUE(d.tracker.feed(seen(d.walls, d.at, 12.0), d.odometry).fix);
}

TEST(CloudTest, ATurningBodysPointsAreBroughtToOneMoment) {
  // given: half a turn a second, and a wall's point at each moment of a tenth of a second
  sense::PoseHistory history;
  for (int i = 0; i <= 20; ++i) {
    const double t = 1.0 + 0.01 * i;
    history.push({base::Time{} + base::from_seconds(t), {0.0, 0.0, 3.0 * (t - 1.0)}});
  }
  base::Sight sight;
  sight.stamp = base::Time{} + base::from_seconds(1.0);
  for (int i = 0; i <= 10; ++i) {
    const double turned = 3.0 * 0.01 * i;
    base::SightPoint p;
    p.x_m = static_cast<float>(5.0 * std::cos(-turned));
    p.y_m = static_cast<float>(5.0 * std::sin(-turned));
    p.z_m = 1.0F;
    p.after_s = 0.01F * static_cast<float>(i);
    p.echo = base::Echo::Hit;
    sight.points.push_back(p);
  }
  sight.points.push_back({});  // in the sensor itself
  // then: all of them are one, where the last one is
  const auto cloud = cloud_of(sight, {.z_m = 0.7}, history);
  ASSERT_TRUE(cloud);
  ASSERT_EQ(cloud->points.size(), 11U);
  for (const auto& p : cloud->points) {
    EXPECT_NEAR(p.x(), 5.0 * std::cos(0.3), 0.03);
    EXPECT_NEAR(p.y(), -5.0 * std::sin(0.3), 0.03);
    EXPECT_NEAR(p.z(), 1.7, 1e-5);
  }
}

}  // namespace
}  // namespace roverd::nav::place
