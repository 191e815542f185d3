// One cloud laid on another: where it is known, where it cannot be known, and what is said then.

#include "nav/cells/align.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "scenes.hpp"

namespace roverd::nav::cells {
namespace {

TEST(Align, FindsAYardAgainFromAMetreAndTenDegrees) {
  const Relief map = relief_of(yard(1).cloud());
  std::mt19937 random(3);
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) {
    // Given the same yard, sampled anew, seen from somewhere,
    const Eigen::Isometry3d truth = pose(1.0, -0.5, 0.3, 0.4 * i);
    const Relief seen = relief_of(yard(100U + unsigned(i)).seen_from(truth));
    // when it is laid on from a start that is wrong,
    Eigen::Isometry3d start = random_offset(random, 1.0, 10.0);
    start.linear() = start.linear() * truth.linear();
    start.translation() += truth.translation();
    const Alignment found = align(seen, map, start);
    // then it is found, and as surely as it is said.
    const Off wrong = off(found.x_ts, truth);
    EXPECT_EQ(found.verdict, Verdict::Good) << i << " " << to_string(found.verdict);
    EXPECT_LT(wrong.m, 0.02) << i;
    EXPECT_LT(wrong.deg, 0.2) << i;
    EXPECT_GT(found.overlap, 0.9);
    const Eigen::Vector3d e = found.x_ts.translation() - truth.translation();
    sum += e.dot(found.covariance.topLeftCorner<3, 3>().inverse() * e);
  }
  // The 99 % bound of chi² with 60 degrees of freedom.
  EXPECT_LT(sum, 88.4);
}

TEST(Align, ACorridorHoldsNothingAlong) {
  // Given a corridor of 40 m of which both see a part without an end,
  const auto corridor = [](unsigned seed) {
    Scene s(seed);
    s.plane({-20, -1.2, 0}, {40, 0, 0}, {0, 2.4, 0}).plane({-20, -1.2, 0}, {40, 0, 0}, {0, 0, 2.5});
    s.plane({-20, 1.2, 0}, {40, 0, 0}, {0, 0, 2.5});
    return s;
  };
  const Relief map = relief_of(corridor(1).cloud());
  Scene part(2);
  part.plane({-8, -1.2, 0}, {16, 0, 0}, {0, 2.4, 0}).plane({-8, -1.2, 0}, {16, 0, 0}, {0, 0, 2.5});
  part.plane({-8, 1.2, 0}, {16, 0, 0}, {0, 0, 2.5});
  const Alignment found = align(relief_of(part.cloud()), map, pose(0.6, 0.2, 0.0, 0.05));
  // then across it fits, along it is not held, and that is said.
  EXPECT_NE(found.verdict, Verdict::Good);
  EXPECT_LT(std::abs(found.x_ts.translation().y()), 0.03);
  EXPECT_GT(found.covariance(0, 0), 25.0 * found.covariance(1, 1));
}

TEST(Align, BareGroundHoldsNothingButHeightAndTilt) {
  Scene ground(1);
  ground.plane({-10, -10, 0}, {20, 0, 0}, {0, 20, 0});
  Scene again(2);
  again.plane({-6, -6, 0}, {12, 0, 0}, {0, 12, 0});
  const Alignment found =
      align(relief_of(again.cloud()), relief_of(ground.cloud()), pose(0.3, 0.3, 0.2, 0.05));
  EXPECT_NE(found.verdict, Verdict::Good);
}

TEST(Align, AColonnadeFitsInSeveralPlaces) {
  // Given posts every 1.5 m along a wall, of which neither end is seen,
  const auto posts = [](unsigned seed, int from, int to) {
    Scene s(seed);
    const double length = 1.5 * (to - from);
    s.plane({1.5 * from, 0, 0}, {length, 0, 0}, {0, 6, 0}, 40.0);
    s.plane({1.5 * from, 6, 0}, {length, 0, 0}, {0, 0, 3});
    for (int i = from; i < to; ++i) s.box({1.5 * i + 0.5, 2, 0}, {0.4, 0.4, 3});
    return s;
  };
  const Relief map = relief_of(posts(1, -15, 15).cloud());
  const Relief seen = relief_of(posts(2, -5, 5).cloud());
  // when the start may be wrong by more than a post's distance,
  AlignParams wide;
  wide.search_m = 1.5;
  const Alignment found = align(seen, map, pose(0.75, 0.0, 0.0, 0.0), wide);
  // then nobody can say which post it is.
  EXPECT_NE(found.verdict, Verdict::Good);
}

TEST(Align, AnotherPlaceIsNeverGood) {
  Scene hall(9);
  hall.plane({-12, -12, 0}, {24, 0, 0}, {0, 24, 0}, 30.0);
  hall.plane({-12, -12, 0}, {24, 0, 0}, {0, 0, 5}).plane({-12, 12, 0}, {24, 0, 0}, {0, 0, 5});
  for (int i = 0; i < 4; ++i) hall.box({-9.0 + 5 * i, -4.0 + 2 * i, 0}, {2, 1, 4});
  const Relief map = relief_of(hall.cloud());
  const Relief seen = relief_of(yard(4).cloud());
  std::mt19937 random(4);
  for (int i = 0; i < 10; ++i) {
    const Alignment found = align(seen, map, random_offset(random, 8.0, 90.0));
    EXPECT_NE(found.verdict, Verdict::Good) << found.overlap << " " << found.upright;
  }
}

TEST(Align, OfNothingIsNothing) {
  const Relief none = relief_of({});
  const Relief one = relief_of({{1, 2, 3}});
  const Relief map = relief_of(yard(1).cloud());
  EXPECT_EQ(align(none, map, pose(0, 0, 0, 0)).verdict, Verdict::Nothing);
  EXPECT_EQ(align(map, none, pose(0, 0, 0, 0)).verdict, Verdict::Nothing);
  EXPECT_NE(align(one, map, pose(0, 0, 0, 0)).verdict, Verdict::Good);
  EXPECT_NE(align(map, one, pose(0, 0, 0, 0)).verdict, Verdict::Good);
  Eigen::Isometry3d bad = pose(0, 0, 0, 0);
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(align(map, map, bad).verdict, Verdict::Nothing);
  EXPECT_NE(align(map, map, pose(1e9, 0, 0, 0)).verdict, Verdict::Good);
}

}  // namespace
}  // namespace roverd::nav::cells
