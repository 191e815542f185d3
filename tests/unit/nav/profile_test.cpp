#include "nav/track/profile.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {
namespace {

Path planned(const std::vector<EnuPoint>& points, const PathParams& params = {},
             mission::Turn turn = mission::Turn::Arc) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) v.push_back({p, 1.0, false, false, turn, 0.1});
  return build_path(v, params);
}

const std::vector<EnuPoint> kWay{{0, 0}, {10, 0}, {14, 4}, {14, 12}, {10, 12}};

TEST(Profile, NoPlaceIsFasterThanItsLimitsOrThanBrakingAllows) {
  const PathParams p;
  const Path path = planned(kWay);
  for (const Leg& leg : path.legs) {
    for (std::size_t i = leg.first; i < leg.last; ++i) {
      const PathPoint& a = path.points[i];
      const PathPoint& b = path.points[i + 1];
      const double ds = b.s_m - a.s_m;
      const double k = std::abs(a.curvature_1pm);
      EXPECT_LE(a.segment_mps, 1.0);
      EXPECT_LE(a.segment_mps * a.segment_mps * k, p.speed.lateral_mps2 + 1e-9);
      EXPECT_LE(a.segment_mps * k, 0.7 * p.speed.max_yaw_rate_radps + 1e-9);
      EXPECT_LE(a.speed_mps, a.segment_mps);
      EXPECT_LE(a.speed_mps * a.speed_mps,
                b.speed_mps * b.speed_mps + 2.0 * p.speed.decel_mps2 * ds + 1e-9);
      EXPECT_LE(a.plan_mps, a.speed_mps + 1e-9);
      EXPECT_LE(b.plan_mps * b.plan_mps,
                a.plan_mps * a.plan_mps + 2.0 * p.speed.accel_mps2 * ds + 1e-9);
      EXPECT_GT(b.plan_s, a.plan_s);
    }
    EXPECT_EQ(path.points[leg.last].speed_mps, 0.0);
  }
}

//   10 m from stop to stop at 1 m/s: 1/0.7 s up, 1/0.6 s down, the rest between
TEST(Profile, ThePlannedTimeIsThatOfTheTrapezoid) {
  const Path path = planned({{0, 0}, {10, 0}});
  const double ramps_m = 0.5 / 0.7 + 0.5 / 0.6;
  EXPECT_NEAR(path.left_s(0.0), 1.0 / 0.7 + 1.0 / 0.6 + (10.0 - ramps_m), 1e-6);
  EXPECT_EQ(path.left_s(10.0), 0.0);
  EXPECT_LT(path.left_s(5.0), path.left_s(2.0));
}

TEST(Profile, AWayTooShortForItsSpeedPeaksBelowIt) {
  const Path path = planned({{0, 0}, {0.5, 0}});
  const double peak = std::sqrt(2.0 * 0.5 * 0.7 * 0.6 / 1.3);
  EXPECT_NEAR(path.left_s(0.0), peak / 0.7 + peak / 0.6, 1e-6);
}

TEST(Profile, TurnsOnTheSpotTakeTimeToo) {
  const Path one = planned({{0, 0}, {10, 0}});
  const Path two = planned({{0, 0}, {10, 0}, {10, 10}}, {}, mission::Turn::Pivot);
  EXPECT_GT(two.left_s(0.0), 2.0 * one.left_s(0.0) + 2.0);
}

TEST(Profile, TheReasonOfALimitIsNamed) {
  PathParams p;
  EXPECT_EQ(to_string(bend_limit(0.2, p).reason), "bend");
  EXPECT_EQ(to_string(bend_limit(3.0, p).reason), "turn_rate");
  p.vehicle.kinematics = "ackermann";
  p.vehicle.max_steering_rate_dps = 10.0;
  p.speed.lateral_mps2 = 2.0;
  std::vector<Vertex> corner(3);
  corner[1].at = {20.0, 0.0};
  corner[2].at = {20.0, 20.0};
  const Path path = build_path(corner, p);
  const bool named = std::ranges::any_of(path.points, [](const PathPoint& at) {
    return at.segment_reason == SpeedReason::Steer && at.segment_mps < 0.5;
  });
  EXPECT_TRUE(named);
  EXPECT_EQ(to_string(SpeedReason::Steer), "steering");
}

/// A body that does at once what it is told.
struct Told {
  std::vector<double> speeds;
  std::vector<SpeedReason> reasons;
};
Told told(const Path& path, double limit_mps, double limit_after_s = 1e9, double then_mps = 0.0) {
  PathParams p;
  p.track.delay_s = 0.0;
  Tracker tracker(p);
  Vehicle v;
  Told out;
  tracker.begin(path, 0, 0.0);
  for (int i = 0; i < 3000 && tracker.phase() != TrackPhase::Done; ++i) {
    const auto t = tracker.step(v, i * 0.02 < limit_after_s ? limit_mps : then_mps, 0.02);
    v.speed_mps = t.command.linear_mps;
    v.yaw_rate_radps = t.command.angular_radps;
    v.at.east_m += v.speed_mps * 0.02 * std::cos(v.yaw_rad);
    v.at.north_m += v.speed_mps * 0.02 * std::sin(v.yaw_rad);
    v.yaw_rad += v.yaw_rate_radps * 0.02;
    out.speeds.push_back(v.speed_mps);
    out.reasons.push_back(t.reason);
  }
  return out;
}

TEST(Profile, SpeedingUpAndBrakingSetInGradually) {
  const PathParams p;
  const Told run = told(planned({{0, 0}, {12, 0}}), 10.0, 6.0, 0.4);
  double accel_before = 0.0;
  for (std::size_t i = 1; i < run.speeds.size(); ++i) {
    const double accel = (run.speeds[i] - run.speeds[i - 1]) / 0.02;
    if (run.speeds[i] == 0.0 || run.speeds[i - 1] == 0.0) {
      accel_before = accel;
      continue;  // the last centimetres end in a stop
    }
    EXPECT_LE(accel, p.speed.accel_mps2 + 1e-6);
    EXPECT_GE(accel, -p.speed.hold_decel_mps2 - 1e-6);
    // Letting go may be at once; pressing may not.
    if (std::abs(accel) > std::abs(accel_before)) {
      EXPECT_LE(std::abs(accel - accel_before), p.speed.jerk_mps3 * 0.02 + 1e-6) << i;
    }
    accel_before = accel;
  }
}

TEST(Profile, TheLastHalfMetreIsDrivenWithoutStalling) {
  const PathParams p;
  const Told run = told(planned({{0, 0}, {5, 0}}), 10.0);
  std::size_t end = run.speeds.size();
  while (end > 0 && run.speeds[end - 1] == 0.0) --end;
  ASSERT_GT(end, 50u);
  for (std::size_t i = end - 40; i < end; ++i) EXPECT_GE(run.speeds[i], p.speed.min_mps - 1e-9);
  EXPECT_EQ(run.reasons[end - 10], SpeedReason::Approach);
}

TEST(Path, DirectionsOnAnArcAreThoseOfTheArc) {
  const Path path = planned({{0, 0}, {10, 0}, {10, 10}});
  const Leg& leg = path.legs[0];
  double last = 0.0;
  for (double s = 0.0; s < path.length_m(); s += 0.005) {
    const double yaw = path.yaw_rad(leg, s, leg.first);
    EXPECT_GE(yaw, last - 1e-6) << s;
    EXPECT_LE(yaw - last, 0.005 / 0.24 + 1e-6) << s;
    last = yaw;
  }
  EXPECT_NEAR(last, base::kPi / 2.0, 1e-6);
}

}  // namespace
}  // namespace roverd::nav
