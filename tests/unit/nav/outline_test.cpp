#include "nav/track/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

Path way_of(const std::vector<EnuPoint>& points) {
  Path path;
  for (const EnuPoint at : points) path.points.push_back({.at = at});
  return path;
}

double beside_m(EnuPoint p, EnuPoint a, EnuPoint b) {
  const double east = b.east_m - a.east_m;
  const double north = b.north_m - a.north_m;
  const double square = east * east + north * north;
  const double along =
      square > 0.0
          ? std::clamp(((p.east_m - a.east_m) * east + (p.north_m - a.north_m) * north) / square,
                       0.0, 1.0)
          : 0.0;
  return std::hypot(p.east_m - a.east_m - along * east, p.north_m - a.north_m - along * north);
}

double farthest_m(const Path& path, const std::vector<EnuPoint>& line) {
  double worst = 0.0;
  for (const PathPoint& p : path.points) {
    double nearest = std::hypot(p.at.east_m - line[0].east_m, p.at.north_m - line[0].north_m);
    for (std::size_t i = 1; i < line.size(); ++i) {
      nearest = std::min(nearest, beside_m(p.at, line[i - 1], line[i]));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::vector<EnuPoint> spiral() {
  std::vector<EnuPoint> points;
  for (int i = 0; i <= 6'000; ++i) {
    const double turn = 0.01 * i;
    points.push_back({(1.0 + 0.3 * turn) * std::cos(turn), (1.0 + 0.3 * turn) * std::sin(turn)});
  }
  return points;
}

TEST(Outline, IsOfFewPointsAndNowhereFartherThanItSays) {
  const Path path = way_of(spiral());
  const Outline drawn = outline(path, 0.01, 5'000);
  EXPECT_EQ(drawn.within_m, 0.01);
  EXPECT_LT(drawn.points.size(), 700u);
  EXPECT_LE(farthest_m(path, drawn.points), 0.01 + 1e-9);
}

TEST(Outline, GetsCoarserWhereItMayNotHaveAsManyPoints) {
  const Path path = way_of(spiral());
  const Outline drawn = outline(path, 0.01, 100);
  EXPECT_LE(drawn.points.size(), 100u);
  EXPECT_GE(drawn.within_m, 0.08);
  EXPECT_LE(farthest_m(path, drawn.points), drawn.within_m + 1e-9);
}

TEST(Outline, KeepsWhereAWayTurnsBackAndItsEnds) {
  std::vector<EnuPoint> points;
  for (int i = 0; i <= 100; ++i) points.push_back({0.0, 0.1 * i});
  for (int i = 0; i <= 150; ++i) points.push_back({0.0, 10.0 - 0.1 * i});
  const Outline drawn = outline(way_of(points), 0.05, 5'000);
  ASSERT_EQ(drawn.points.size(), 3u);
  EXPECT_NEAR(drawn.points[1].north_m, 10.0, 1e-9);
  EXPECT_NEAR(drawn.points[2].north_m, -5.0, 1e-9);
}

TEST(Outline, EndsWhereAWayTurnsBackMoreOftenThanItMayHavePoints) {
  // Given a thousand rounds on one circle of 2 m, and three thousand lanes of 1 m,
  std::vector<EnuPoint> points;
  for (int i = 0; i < 36'000; ++i) {
    const double turn = std::numbers::pi * i / 18.0;
    points.push_back({2.0 * std::cos(turn), 2.0 * std::sin(turn)});
  }
  for (int i = 0; i < 6'000; ++i) {
    points.push_back({10.0 + 0.3 * (i / 2), (i + 1) / 2 % 2 == 0 ? 0.0 : 1.0});
  }
  // then few points are left, however coarse that is.
  const Outline drawn = outline(way_of(points), 0.01, 1'000);
  EXPECT_LE(drawn.points.size(), 1'000u);
  EXPECT_LE(farthest_m(way_of(points), drawn.points), drawn.within_m + 1e-9);
}

TEST(Outline, OfNothingIsNothingAndOfOnePlaceThatPlace) {
  EXPECT_TRUE(outline({}, 0.01, 100).points.empty());
  const Outline one = outline(way_of({{3, 4}, {3, 4}}), 0.01, 100);
  ASSERT_FALSE(one.points.empty());
  EXPECT_EQ(one.points.front().east_m, 3.0);
  EXPECT_EQ(one.points.back().north_m, 4.0);
}

}  // namespace
}  // namespace roverd::nav
