#include "nav/track/path.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {
namespace {

using mission::Turn;

std::vector<Vertex> vertices(const std::vector<EnuPoint>& points, Turn turn = Turn::Auto) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) v.push_back({p, 0.8, false, false, turn, 0.1});
  return v;
}

/// Two legs of 10 m that meet with a deflection.
std::vector<Vertex> bend(double deg, Turn turn = Turn::Auto) {
  const double a = base::rad_from_deg(deg);
  return vertices({{0, 0}, {10, 0}, {10 + 10 * std::cos(a), 10 * std::sin(a)}}, turn);
}

double nearest_m(const Path& path, EnuPoint p) {
  double best = 1e9;
  for (double s = 0.0; s < path.length_m(); s += 0.005) {
    best = std::min(best, base::distance_m(path.at(s), p));
  }
  return best;
}

TEST(Path, OnePointOrTwoEqualOnesLeadNowhere) {
  EXPECT_TRUE(build_path(vertices({{1, 1}}), {}).legs.empty());
  const Path two = build_path(vertices({{1, 1}, {1, 1}}), {});
  EXPECT_TRUE(two.legs.empty());
  EXPECT_EQ(two.vertex_m, (std::vector<double>{0.0, 0.0}));
}

//  0 deg: straight on; up to 30 deg: rounded; above: a stop with a turn on the spot
TEST(Path, StopsToTurnOnTheSpotAboveThePivotAngleOnly) {
  EXPECT_EQ(build_path(bend(0.0), {}).legs.size(), 1u);
  EXPECT_EQ(build_path(bend(29.9), {}).legs.size(), 1u);
  EXPECT_EQ(build_path(bend(-29.9), {}).legs.size(), 1u);
  EXPECT_EQ(build_path(bend(30.1), {}).legs.size(), 2u);
  EXPECT_EQ(build_path(bend(-30.1), {}).legs.size(), 2u);
  EXPECT_EQ(build_path(bend(180.0), {}).legs.size(), 2u);
  PathParams wide;
  wide.pivot.angle_deg = 90.0;
  EXPECT_EQ(build_path(bend(60.0), wide).legs.size(), 1u);
}

TEST(Path, AnItemMayAskForPivotOrArc) {
  EXPECT_EQ(build_path(bend(10.0, Turn::Pivot), {}).legs.size(), 2u);
  EXPECT_EQ(build_path(bend(90.0, Turn::Arc), {}).legs.size(), 1u);
  EXPECT_EQ(build_path(bend(150.1, Turn::Arc), {}).legs.size(), 2u);  // an arc cannot reverse
}

TEST(Path, ARoundedCornerPassesTheVertexAtTheAllowedDistance) {
  for (const double deg : {10.0, 30.0, 60.0, 90.0, 120.0}) {
    const Path path = build_path(bend(deg, Turn::Arc), {});
    EXPECT_NEAR(nearest_m(path, {10, 0}), 0.1, 0.012) << deg;
    EXPECT_NEAR(base::distance_m(path.at(path.vertex_m[1]), {10, 0}), 0.1, 0.012) << deg;
  }
}

TEST(Path, ARoundedCornerShrinksWhereItsNeighboursAreNear) {
  const Path path = build_path(vertices({{0, 0}, {0.5, 0}, {0.9, 0.2}, {1.3, 0.2}}, Turn::Arc), {});
  ASSERT_EQ(path.legs.size(), 1u);
  double last = -1.0;
  for (const PathPoint& p : path.points) {
    EXPECT_GT(p.s_m, last);  // never backwards: the two corners do not overlap
    last = p.s_m;
  }
}

TEST(Path, EveryPointCanBeKeptByBrakingForWhatFollows) {
  const PathParams params;
  const Path path = build_path(
      vertices({{0, 0}, {20, 0}, {30, 4}, {30.5, 20}, {31, 20.2}, {50, 20}}, Turn::Arc), params);
  for (const Leg& leg : path.legs) {
    for (std::size_t i = leg.first + 1; i < leg.last; ++i) {
      const PathPoint& a = path.points[i];
      const bool last = i + 1 == leg.last;
      const double v_end = last ? 0.0 : path.points[i + 1].speed_mps;
      const double ds = path.points[i + 1].s_m - a.s_m;
      EXPECT_LE(a.speed_mps, a.segment_mps + 1e-9);
      EXPECT_LE(a.speed_mps * a.speed_mps,
                v_end * v_end + 2.0 * params.speed.decel_mps2 * ds + 1e-9);
    }
  }
}

TEST(Path, ASlowerItemAheadIsBrakedForAndNamed) {
  auto v = vertices({{0, 0}, {10, 0}, {20, 0}});
  v[2].speed_mps = 0.3;
  const Path path = build_path(v, {});
  ASSERT_EQ(path.points.size(), 3u);
  EXPECT_DOUBLE_EQ(path.points[0].segment_mps, 0.8);
  EXPECT_DOUBLE_EQ(path.points[1].segment_mps, 0.3);
  EXPECT_DOUBLE_EQ(path.points[1].speed_mps, 0.3);
  EXPECT_EQ(path.points[1].reason, SpeedReason::Item);
}

TEST(Path, AChangeOfDirectionEndsALeg) {
  auto v = vertices({{0, 0}, {5, 0}, {1, 0}});
  v[2].reverse = true;
  const Path path = build_path(v, {});
  ASSERT_EQ(path.legs.size(), 2u);
  EXPECT_FALSE(path.legs[0].reverse);
  EXPECT_TRUE(path.legs[1].reverse);
  EXPECT_EQ(path.leg_from(0.0), 0u);
  EXPECT_EQ(path.leg_from(5.0), 1u);
  EXPECT_EQ(path.leg_from(9.0), 2u);
}

TEST(Path, AHundredThousandPointsAreNoTrouble) {
  std::vector<EnuPoint> points;
  for (int i = 0; i < 100'000; ++i) points.push_back({i * 0.05, std::sin(i * 0.01)});
  const Path path = build_path(vertices(points), {});
  EXPECT_EQ(path.vertex_m.size(), points.size());
  EXPECT_GT(path.length_m(), 4900.0);
}

TEST(Rules, AnArcThroughAPointHasTheCurvatureOfCoulter) {
  EXPECT_DOUBLE_EQ(arc_curvature_1pm({1.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(arc_curvature_1pm({1.0, 1.0}), 1.0);
  EXPECT_DOUBLE_EQ(arc_curvature_1pm({1.0, -1.0}), -1.0);
  EXPECT_DOUBLE_EQ(arc_curvature_1pm({0.02, 0.02}), 0.0);
}

TEST(Rules, TheStoppingSpeedNeedsExactlyTheDistance) {
  const double v = stopping_mps(1.0, 0.4, 0.2);
  EXPECT_NEAR(v * 0.2 + v * v / 0.8, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(stopping_mps(0.0, 0.4, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(stopping_mps(-1.0, 0.4, 0.2), 0.0);
}

TEST(Rules, LookaheadGrowsWithSpeedAndWithTheDistanceFromThePath) {
  const TrackParams p;
  EXPECT_DOUBLE_EQ(lookahead_m(0.0, 0.0, p), p.lookahead_min_m);
  EXPECT_DOUBLE_EQ(lookahead_m(-1.0, 0.0, p), p.lookahead_time_s);
  EXPECT_DOUBLE_EQ(lookahead_m(9.0, 0.0, p), p.lookahead_max_m);
  EXPECT_DOUBLE_EQ(lookahead_m(0.0, -2.0, p), 3.46);
}

TEST(Rules, APivotTurnsTowardsTheErrorAndSlowsDownBeforeItsEnd) {
  const PivotParams p;
  EXPECT_DOUBLE_EQ(pivot_rate_radps(3.0, p), p.max_rate_radps);
  EXPECT_DOUBLE_EQ(pivot_rate_radps(-3.0, p), -p.max_rate_radps);
  EXPECT_LT(pivot_rate_radps(0.1, p), 0.26);
  EXPECT_GT(pivot_rate_radps(0.03, p), 0.1);
}

}  // namespace
}  // namespace roverd::nav
