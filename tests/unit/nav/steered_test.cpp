// Paths and steering of a vehicle that cannot turn on the spot.

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {
namespace {

/// Wheelbase 1.3 m and 40 deg of lock: 1.55 m of radius at best, 1.70 m planned.
PathParams car() {
  PathParams p;
  p.vehicle.kinematics = "ackermann";
  p.vehicle.wheelbase_m = 1.3;
  p.vehicle.max_steering_deg = 40.0;
  p.vehicle.max_steering_rate_dps = 60.0;
  return p;
}

Path corner_path(double turn_deg, double leg_m = 20.0) {
  const double turn = base::rad_from_deg(turn_deg);
  std::vector<Vertex> v(3);
  v[1].at = {leg_m, 0.0};
  v[2].at = {leg_m + leg_m * std::cos(turn), leg_m * std::sin(turn)};
  return build_path(v, car());
}

double passes_at_m(const Path& path, EnuPoint to) {
  double best = 1e9;
  for (double s = 0.0; s < path.length_m(); s += 0.005) {
    best = std::min(best, base::distance_m(path.at(s), to));
  }
  return best;
}

//            ╭─╮
//   ────────╱─V ╲     passes V at the allowed 0.1 m, swings out, and comes back to the line
//               ╱
//              │
TEST(SteeredPath, ASharpCornerIsASwingThatPassesNearItsVertex) {
  const double lock_1pm = 1.0 / min_radius_m(car().vehicle);
  for (const double turn_deg : {45.0, 90.0, -90.0, 135.0, 175.0}) {
    const Path path = corner_path(turn_deg);
    ASSERT_EQ(path.legs.size(), 1u) << turn_deg;
    EXPECT_NEAR(passes_at_m(path, {20.0, 0.0}), 0.1, 0.02) << turn_deg;
    EXPECT_NEAR(base::distance_m(path.at(path.vertex_m[1]), {20.0, 0.0}), 0.1, 0.03) << turn_deg;
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      EXPECT_LE(std::abs(path.points[i].curvature_1pm), lock_1pm + 1e-9);
      EXPECT_GT(path.points[i + 1].s_m, path.points[i].s_m);
    }
  }
}

TEST(SteeredPath, TheSwingEndsOnTheWayOutAndAlongIt) {
  const Path path = corner_path(90.0);
  const EnuPoint end = path.points.at(path.points.size() - 2).at;
  EXPECT_NEAR(end.east_m, 20.0, 0.001);
  const EnuPoint before = path.points.at(path.points.size() - 3).at;
  EXPECT_NEAR(std::atan2(end.north_m - before.north_m, end.east_m - before.east_m), base::kPi / 2.0,
              0.08);
}

TEST(SteeredPath, ItNeverTurnsOnTheSpotWhateverTheItemSays) {
  std::vector<Vertex> v(3);
  v[1].at = {20.0, 0.0};
  v[1].turn = mission::Turn::Pivot;
  v[2].at = {20.0, 20.0};
  EXPECT_EQ(build_path(v, car()).legs.size(), 1u);
}

TEST(SteeredPath, WithoutRoomTheCornerStaysSharpAndTheOrderKept) {
  const Path path = corner_path(90.0, 3.0);
  EXPECT_EQ(path.points.size(), 3u);
  EXPECT_DOUBLE_EQ(path.vertex_m[1], 3.0);
}

/// A perfect car: what is commanded happens at once.
void drive(Vehicle& v, const base::BodyTwist& t) {
  v.speed_mps = t.linear_mps;
  v.yaw_rate_radps = t.angular_radps;
  v.at.east_m += t.linear_mps * 0.02 * std::cos(v.yaw_rad);
  v.at.north_m += t.linear_mps * 0.02 * std::sin(v.yaw_rad);
  v.yaw_rad = base::wrap_rad(v.yaw_rad + t.angular_radps * 0.02);
}

struct Seen {
  bool done = false;
  double nearest_m = 1e9;     ///< to the corner
  double sharpest_1pm = 0.0;  ///< ever commanded
  double spot_radps = 0.0;    ///< turn rate while standing
  EnuPoint end;
};

Seen run(const Path& path, double yaw_rad, EnuPoint corner) {
  PathParams params = car();
  params.track.delay_s = 0.0;
  Tracker tracker(params);
  Vehicle v;
  v.yaw_rad = yaw_rad;
  tracker.begin(path, 0, 0.0);
  Seen seen;
  for (int i = 0; i < 50 * 240 && !seen.done; ++i) {
    const base::BodyTwist t = tracker.step(v, 10.0, 0.02).command;
    if (t.linear_mps == 0.0) seen.spot_radps = std::max(seen.spot_radps, std::abs(t.angular_radps));
    if (t.linear_mps != 0.0) {
      seen.sharpest_1pm = std::max(seen.sharpest_1pm, std::abs(t.angular_radps / t.linear_mps));
    }
    drive(v, t);
    seen.nearest_m = std::min(seen.nearest_m, base::distance_m(v.at, corner));
    seen.done = tracker.phase() == TrackPhase::Done;
  }
  seen.end = v.at;
  return seen;
}

TEST(SteeredTracker, DrivesTheLWithinItsLockAndPassesTheCorner) {
  const Seen seen = run(corner_path(90.0), 0.0, {20.0, 0.0});
  EXPECT_TRUE(seen.done);
  EXPECT_LT(seen.nearest_m, 0.3);
  EXPECT_LE(seen.sharpest_1pm, std::tan(base::rad_from_deg(40.0)) / 1.3 + 1e-6);
  EXPECT_EQ(seen.spot_radps, 0.0);
  EXPECT_NEAR(seen.end.east_m, 20.0, 0.1);
  EXPECT_NEAR(seen.end.north_m, 20.0, 0.1);
}

TEST(SteeredTracker, PointingTheOtherWayItGoesRoundInsteadOfAway) {
  const Seen seen = run(corner_path(90.0), base::kPi - 0.05, {20.0, 0.0});
  EXPECT_TRUE(seen.done);
  EXPECT_LT(seen.nearest_m, 0.3);
  EXPECT_EQ(seen.spot_radps, 0.0);
  EXPECT_NEAR(seen.end.north_m, 20.0, 0.1);
}

}  // namespace
}  // namespace roverd::nav
