// From scan to scan in a shed: followed, carried away, found again, and never surer than the truth.

#include "nav/place/tracker.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "unit/place/shed.hpp"

namespace {

using namespace roverd;
using nav::place::Phase;
using nav::place::Told;
using nav::place::Tracker;
using nav::sense::Pose2;

/// A drive through the shed in steps of 0.3 m; the odometry drifts.
struct Drive {
  std::vector<Pose2> poses;
  std::vector<Pose2> odometry;
};

Drive round_the_shed(int steps) {
  Drive d;
  Pose2 pose{2.5, 3.0, 0.0};
  Pose2 odometry{100.0, -50.0, 1.0};
  for (int i = 0; i < steps; ++i) {
    d.poses.push_back(pose);
    d.odometry.push_back(odometry);
    const double turn = 0.2;  // a circle of 1.5 m
    pose = pose * Pose2{0.3, 0.0, turn};
    odometry = odometry * Pose2{0.3 * 1.05, 0.0, turn + 0.01};
  }
  return d;
}

double off_m(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

TEST(Tracker, FollowsADriveWhoseOdometryDrifts) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(11);
  const Drive drive = round_the_shed(60);
  tracker.set_pose({2.7, 2.9, 0.1}, 0.3, 0.1);
  for (std::size_t i = 0; i < drive.poses.size(); ++i) {
    const Told told = tracker.feed(
        scanner.look(tests::shed(), drive.poses[i], 1.0 + 0.1 * static_cast<double>(i)),
        drive.odometry[i]);
    ASSERT_EQ(told.phase, Phase::Tracking) << i << " " << told.reason;
    ASSERT_TRUE(told.fix);
    EXPECT_LT(off_m(told.fix->pose, drive.poses[i]), 0.07) << i;
    EXPECT_LT(std::abs(base::angle_diff_rad(told.fix->pose.yaw_rad, drive.poses[i].yaw_rad)), 0.02);
  }
}

/// Four bays of 2 m along a hall, all alike; beyond the last one the hall ends otherwise.
std::vector<tests::Segment> bays() {
  std::vector<tests::Segment> walls{{0, 0, 14, 0}, {14, 0, 14, 4}, {14, 4, 10, 4}, {0, 4, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    const double x = 2.0 + 2.0 * i;
    walls.push_back({x, 4, x, 2.6});
  }
  walls.push_back({0, 4, 10, 4});
  walls.push_back({12, 1.5, 12.6, 1.5});
  walls.push_back({12.6, 1.5, 12.6, 2.3});
  return walls;
}

TEST(Tracker, DoesNotBelieveATapBetweenTwoBaysThatLookAlike) {
  // Given: a scanner that sees 1.6 m far, and so nothing but the bay that it looks into.
  const auto walls = bays();
  const auto field = tests::field_of(walls, 14.0, 4.0);
  Tracker tracker(field);
  tests::Scanner scanner(17);
  const auto near_by = [&](const Pose2& at, double time_s) {
    nav::chart::Scan scan = scanner.look(walls, at, time_s);
    std::erase_if(scan.beams, [](const nav::chart::Beam& b) {
      return b.x_m * b.x_m + b.y_m * b.y_m > 1.6F * 1.6F;
    });
    return scan;
  };
  // When: it stands in the third bay, and the tap is nearer to the second.
  Pose2 at{7.0, 3.0, 0.5 * base::kPi};
  tracker.set_pose({5.9, 3.0, 0.5 * base::kPi}, 0.7, 0.1);
  Told told = tracker.feed(near_by(at, 1.0), at);
  // Then: it is not called known, and never called wrong.
  EXPECT_FALSE(told.fix);
  EXPECT_EQ(told.phase, Phase::Searching);
  EXPECT_GE(told.candidates, 2u);
  for (int i = 1; i < 40; ++i) {
    at = at * Pose2{i < 8 ? -0.1 : 0.0, 0.0, i < 8 ? 0.0 : -0.02};
    told = tracker.feed(near_by(at, 1.0 + 0.1 * i), at);
    if (!told.fix) continue;
    EXPECT_LT(off_m(told.fix->pose, at), 0.2) << i;
  }
}

TEST(Tracker, NoticesThatItWasCarriedAway) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(12);
  const Drive drive = round_the_shed(30);
  tracker.set_pose(drive.poses[0], 0.1, 0.05);
  double time_s = 1.0;
  for (int i = 0; i < 5; ++i) {
    const auto at = static_cast<std::size_t>(i);
    tracker.feed(scanner.look(tests::shed(), drive.poses[at], time_s += 0.1), drive.odometry[at]);
  }
  ASSERT_EQ(tracker.phase(), Phase::Tracking);
  // Set down in the small room, the odometry knows nothing of it.
  const Pose2 carried{9.4, 6.4, -0.5};
  double driven_m = 0.0;
  int i = 5;
  for (; i < 15 && tracker.phase() == Phase::Tracking; ++i, driven_m += 0.3) {
    const auto at = static_cast<std::size_t>(i);
    const Pose2 really = carried * (inverse(drive.poses[5]) * drive.poses[at]);
    tracker.feed(scanner.look(tests::shed(), really, time_s += 0.1), drive.odometry[at]);
  }
  EXPECT_NE(tracker.phase(), Phase::Tracking);
  EXPECT_LT(driven_m, 3.0);
}

TEST(Tracker, IsLostWhereEveryThirdScanFitsOnly) {
  // Given: a robot that knows its place.
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(18);
  const Drive drive = round_the_shed(40);
  tracker.set_pose(drive.poses[0], 0.1, 0.05);
  ASSERT_TRUE(
      tracker.feed(scanner.look(tests::shed(), drive.poses[0], 1.0), drive.odometry[0]).fix);
  // When: of three scans two are of another building.
  double driven_m = 0.0;
  for (std::size_t i = 1; i < 40 && tracker.phase() != Phase::Lost; ++i, driven_m += 0.3) {
    const double time_s = 1.0 + 0.1 * static_cast<double>(i);
    const bool fits = i % 3 == 0;
    tracker.feed(fits ? scanner.look(tests::shed(), drive.poses[i], time_s)
                      : scanner.look(tests::other_building(), {1.5, 1.7, 0.3}, time_s),
                 drive.odometry[i]);
  }
  // Then: the good ones do not hold it.
  EXPECT_EQ(tracker.phase(), Phase::Lost);
  EXPECT_LT(driven_m, 3.0);
}

TEST(Tracker, StaysWhereEveryThirdScanIsOdd) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(19);
  const Drive drive = round_the_shed(60);
  tracker.set_pose(drive.poses[0], 0.1, 0.05);
  for (std::size_t i = 0; i < 60; ++i) {
    const double time_s = 1.0 + 0.1 * static_cast<double>(i);
    const bool odd = i % 3 == 2;
    tracker.feed(odd ? scanner.look(tests::other_building(), {1.5, 1.7, 0.3}, time_s)
                     : scanner.look(tests::shed(), drive.poses[i], time_s),
                 drive.odometry[i]);
    ASSERT_NE(tracker.phase(), Phase::Lost) << i;
  }
}

TEST(Tracker, FindsItsPlaceWithoutAPose) {
  tests::Scanner scanner(13);
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  for (const std::size_t begin : {0U, 9U, 17U}) {
    Tracker tracker(field);
    const Drive drive = round_the_shed(30);
    int scans = 0;
    for (; scans < 10 && tracker.phase() != Phase::Tracking; ++scans) {
      const std::size_t at = begin + static_cast<std::size_t>(scans);
      const Told told = tracker.feed(
          scanner.look(tests::shed(), drive.poses[at], 1.0 + 0.1 * scans), drive.odometry[at]);
      if (told.fix) {
        EXPECT_LT(off_m(told.fix->pose, drive.poses[at]), 0.1);
      }
    }
    EXPECT_EQ(tracker.phase(), Phase::Tracking);
  }
}

TEST(Tracker, BelievesNoScanOfAnotherBuilding) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(14);
  const auto walls = tests::other_building();
  for (int i = 0; i < 12; ++i) {
    const Told told =
        tracker.feed(scanner.look(walls, {1.5 + 0.3 * i, 1.7, 0.05 * i}, 1.0 + 0.1 * i),
                     {0.3 * i, 0.0, 0.05 * i});
    EXPECT_FALSE(told.fix) << i;
  }
}

TEST(Tracker, UglyInputIsLeftOut) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(15);
  const Pose2 pose{2.5, 3.0, 0.0};
  tracker.set_pose(pose, 0.1, 0.05);
  ASSERT_TRUE(tracker.feed(scanner.look(tests::shed(), pose, 1.0), pose).fix);
  EXPECT_FALSE(tracker.feed(scanner.look(tests::shed(), pose, 1.0), pose).fix) << "not newer";
  EXPECT_FALSE(tracker.feed(scanner.look(tests::shed(), pose, 2.0), {std::nan(""), 0.0, 0.0}).fix);
  nav::chart::Scan empty;
  empty.stamp = base::Time{} + base::from_seconds(3.0);
  const Told told = tracker.feed(empty, pose);
  EXPECT_EQ(told.phase, Phase::Doubtful);
  EXPECT_EQ(told.reason, "too little to see");
  ASSERT_TRUE(tracker.feed(scanner.look(tests::shed(), pose, 4.0), pose).fix) << "and back";
}

}  // namespace
