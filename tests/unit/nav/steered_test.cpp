// Paths and steering of a vehicle that cannot turn on the spot.

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/behave/route.hpp"
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

TEST(SteeredPath, ItsWheelsTurnNoFasterThanTheyCanAtTheSpeedOfThePlace) {
  for (const double turn_deg : {15.0, 30.0, 60.0, 90.0, -135.0}) {
    const Path path = corner_path(turn_deg);
    const auto wheel = [&](std::size_t i) { return std::atan(1.3 * path.points[i].curvature_1pm); };
    for (std::size_t i = 1; i + 1 < path.points.size(); ++i) {
      // From the middle of one segment to the middle of the next one; long ones are straight.
      const double way = std::min(0.1, path.points[i + 1].s_m - path.points[i].s_m);
      const double rate = std::abs(wheel(i) - wheel(i - 1)) / way * path.points[i].segment_mps;
      EXPECT_LE(rate, base::rad_from_deg(60.0)) << turn_deg << " " << path.points[i].s_m;
    }
  }
}

TEST(SteeredPath, WithLittleRoomItPassesFartherOffInsteadOfStayingSharp) {
  const Path path = corner_path(60.0, 5.0);
  ASSERT_GT(path.points.size(), 10u);
  const double off_m = passes_at_m(path, {5.0, 0.0});
  EXPECT_GT(off_m, 0.1);
  EXPECT_LT(off_m, 1.1 * min_radius_m(car().vehicle) * (1.0 / std::cos(base::kPi / 6.0) - 1.0));
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

//   ────╮   the chords of an arc, as a survey lays them
TEST(SteeredPath, ATurnOfShortChordsIsOneBendThoughEachAsksForAnArc) {
  const base::LocalFrame frame{1, {58.378, 26.729}};
  mission::Plan plan;
  const auto put = [&](double east_m, double north_m) {
    mission::Waypoint w;
    w.at = frame.to_global({east_m, north_m});
    w.turn = mission::Turn::Arc;
    plan.items.emplace_back(w);
  };
  put(-20.0, 0.0);
  for (double a = 0.0; a < 3.2; a += 0.2) put(2.0 * std::sin(a), 2.0 * (1.0 - std::cos(a)));
  put(-20.0, 4.0);
  const auto route = lay_route(plan, frame, car());
  ASSERT_TRUE(route);
  const Path& path = route->forth.path;
  ASSERT_EQ(path.smoothed.size(), 1u);
  for (std::size_t i = 1; i + 1 < path.points.size(); ++i) {
    const double jump = path.points[i].curvature_1pm - path.points[i - 1].curvature_1pm;
    EXPECT_LT(std::abs(jump), 0.15) << path.points[i].s_m;
  }
}

TEST(SteeredPath, ShortChordsThatAreDrivenOneByOneStayArcs) {
  std::vector<Vertex> v;
  for (double a = 0.0; a < 3.2; a += 0.2) {
    v.push_back({{2.0 * std::sin(a), 2.0 * (1.0 - std::cos(a))},
                 0.5,
                 false,
                 false,
                 mission::Turn::Arc,
                 0.1});
  }
  EXPECT_GT(build_path(v, car()).points.size(), 3 * v.size());
}

//   ───╮ ▲     what is driven backwards from here begins in the direction of the arc
//      ▼ │
TEST(SteeredPath, ABendGoesOnUpToWhereTheDirectionChanges) {
  std::vector<Vertex> v;
  const auto put = [&](EnuPoint at, bool reverse) {
    v.push_back({at, 0.5, reverse, false, mission::Turn::Arc, 0.1});
    v.back().dense = true;
  };
  put({-10.0, 0.0}, false);
  for (int i = 0; i <= 8; ++i) {
    const double a = base::kPi / 16.0 * i;
    put({2.0 * std::sin(a), 2.0 * (1.0 - std::cos(a))}, false);
  }
  put({2.0, -8.0}, true);
  const Path path = build_path(v, car());
  ASSERT_EQ(path.legs.size(), 2u);
  EXPECT_GT(path.points[path.legs[0].last - 1].curvature_1pm, 0.3);
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
  double beside_m = 0.0;      ///< most, from the planned way
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
    seen.beside_m = std::max(seen.beside_m, std::abs(tracker.cross_track_m()));
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

TEST(SteeredTracker, DrivesACornerAsItWasPlanned) {
  for (const double turn_deg : {15.0, 30.0, 60.0, 90.0, -135.0}) {
    EXPECT_LT(run(corner_path(turn_deg), 0.0, {20.0, 0.0}).beside_m, 0.02) << turn_deg;
  }
}

//   ══════╮   backwards the wheels of a left bend make a right one: nothing has to be turned over
//         │
TEST(SteeredTracker, WhereTheDirectionChangesTheWheelsGoOnFromWhereTheyStand) {
  std::vector<Vertex> v;
  for (double a = 0.0; a < 1.6; a += 0.1) {
    v.push_back({{2.0 * std::sin(a), 2.0 * (1.0 - std::cos(a))},
                 0.5,
                 false,
                 false,
                 mission::Turn::Auto,
                 0.1});
    v.back().dense = true;
  }
  v.push_back({{v.back().at.east_m, -6.0}, 0.5, true});
  const Path path = build_path(v, car());
  ASSERT_EQ(path.legs.size(), 2u);
  PathParams params = car();
  params.track.delay_s = 0.0;
  Tracker tracker(params);
  Vehicle body;
  double wheel_rad = 0.0;
  double jump_rad = 0.0;  // of the wheels, from one command to the next
  double beside_m = 0.0;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    tracker.begin(path, leg, path.legs[leg].start_m);
    for (int i = 0; i < 50 * 60 && tracker.phase() != TrackPhase::Done; ++i) {
      const base::BodyTwist t = tracker.step(body, 10.0, 0.02).command;
      if (t.linear_mps != 0.0) {
        const double now_rad = std::atan(1.3 * t.angular_radps / t.linear_mps);
        jump_rad = std::max(jump_rad, std::abs(now_rad - wheel_rad));
        wheel_rad = now_rad;
      }
      drive(body, t);
      beside_m = std::max(beside_m, std::abs(tracker.cross_track_m()));
    }
  }
  EXPECT_LE(jump_rad, base::rad_from_deg(60.0) * 0.02 + 1e-6);
  EXPECT_LT(beside_m, 0.06);
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
