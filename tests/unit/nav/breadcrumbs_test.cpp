// The way back: what it keeps, what it forgets.

#include "nav/behave/breadcrumbs.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

constexpr double kAccuracy_m = 0.5;

struct Walk {
  Breadcrumbs crumbs{kAccuracy_m};
  EnuPoint at;
  std::vector<EnuPoint> driven{at};
  Breadcrumbs::May may{};

  Walk() { crumbs.take(at, 0.02, false); }

  void step(EnuPoint to, double sigma_m = 0.02, bool jumped = false) {
    at = to;
    driven.push_back(at);
    crumbs.take(at, sigma_m, jumped, may);
  }
  void to(EnuPoint goal, double sigma_m = 0.02) {
    const EnuPoint from = at;
    const double far_m = base::distance_m(from, goal);
    for (double s = 0.02; s < far_m; s += 0.02) {
      step({from.east_m + (goal.east_m - from.east_m) * s / far_m,
            from.north_m + (goal.north_m - from.north_m) * s / far_m},
           sigma_m);
    }
    step(goal, sigma_m);
  }
  void circle(EnuPoint middle, double radius_m, double turns) {
    const double start = std::atan2(at.north_m - middle.north_m, at.east_m - middle.east_m);
    for (double a = 0.0; a < turns * 2.0 * base::kPi; a += 0.02 / radius_m) {
      step({middle.east_m + radius_m * std::cos(start + a),
            middle.north_m + radius_m * std::sin(start + a)});
    }
  }
  double way_m() const {
    const auto way = crumbs.way_back();
    double sum = 0.0;
    for (std::size_t i = 1; i < way.size(); ++i) sum += base::distance_m(way[i - 1], way[i]);
    return sum;
  }
  /// Farthest of the way back from where the robot really was.
  double worst_m() const {
    double worst = 0.0;
    const auto way = crumbs.way_back();
    for (std::size_t i = 1; i < way.size(); ++i) {
      for (double t = 0.0; t <= 1.0; t += 0.02) {
        const EnuPoint p{way[i - 1].east_m + t * (way[i].east_m - way[i - 1].east_m),
                         way[i - 1].north_m + t * (way[i].north_m - way[i - 1].north_m)};
        double best = 1e9;
        for (const EnuPoint& d : driven) best = std::min(best, base::distance_m(p, d));
        worst = std::max(worst, best);
      }
    }
    return worst;
  }
};

TEST(Breadcrumbs, AStraightWayIsTwoPointsAndACornerOneMore) {
  Walk w;
  w.to({0, 40});
  EXPECT_EQ(w.crumbs.way_back().size(), 2u);
  w.to({40, 40});
  const auto way = w.crumbs.way_back();
  EXPECT_LE(way.size(), 4u);
  EXPECT_LT(w.worst_m(), kAccuracy_m);
  EXPECT_LT(base::distance_m(way.back(), {0, 0}), 1e-9);
}

TEST(Breadcrumbs, FiftyCirclesLeaveOneArcAtMost) {
  Walk w;
  w.to({0, 10});
  w.circle({5, 10}, 5.0, 50.3);
  EXPECT_LT(w.way_m(), 10.0 + 2.0 * base::kPi * 5.0);
  EXPECT_LT(w.crumbs.size(), 120u);
  EXPECT_LT(w.worst_m(), 0.6);
}

TEST(Breadcrumbs, OutAndBackIsForgotten) {
  Walk w;
  w.to({0, 30});
  w.to({0.2, 2});
  EXPECT_LT(w.way_m(), 4.0);
  EXPECT_LT(base::distance_m(w.crumbs.way_back().back(), {0, 0}), 1e-9);
}

TEST(Breadcrumbs, ASpiralStays) {
  Walk w;
  double driven_m = 0.0;
  for (double a = 0.0; a < 8.0 * base::kPi; a += 0.005) {
    const double r = 0.4 * a;  // 2.5 m between the turns
    const EnuPoint next{r * std::cos(a), r * std::sin(a)};
    driven_m += base::distance_m(w.at, next);
    w.step(next);
  }
  EXPECT_GT(w.way_m(), 0.9 * driven_m);
  EXPECT_LT(w.worst_m(), 0.3);
}

TEST(Breadcrumbs, TheWayHomeCanBeginWithinALoop) {
  Walk w;
  w.to({0, 10});
  w.to({10, 10});
  w.to({10, 4});
  w.to({3, 4});
  EXPECT_NEAR(w.way_m(), 10.0 + 10.0 + 6.0 + 7.0, 1.5);
  w.to({-1, 4});  // over its own way
  EXPECT_LT(w.way_m(), 6.5);
}

TEST(Breadcrumbs, AJoinThatMayNotBeDrivenIsNotMade) {
  Walk w;
  w.may = [](EnuPoint, EnuPoint) { return false; };
  w.to({0, 10});
  w.to({0, 0.5});
  EXPECT_GT(w.way_m(), 17.0);
}

TEST(Breadcrumbs, AJumpAndAnUncertainPieceAreGaps) {
  Walk w;
  w.to({0, 10});
  EXPECT_EQ(w.crumbs.longest_gap_m(), 0.0);
  w.step({6, 10}, 0.02, true);
  EXPECT_NEAR(w.crumbs.longest_gap_m(), 6.0, 0.6);
  Walk unsure;
  unsure.to({0, 10});
  unsure.to({0, 22}, 1.0);
  unsure.to({0, 25});
  EXPECT_NEAR(unsure.crumbs.longest_gap_m(), 12.0, 1.0);
}

TEST(Breadcrumbs, NeverGrowBeyondTheirMemoryAndKeepBothEnds) {
  Walk w;
  for (int lane = 0; lane < 60; ++lane) {  // 3.6 km of lanes 2 m apart
    const double east = lane * 2.0;
    w.to({east, lane % 2 == 0 ? 60.0 : 0.0});
    w.to({east + 2.0, lane % 2 == 0 ? 60.0 : 0.0});
  }
  EXPECT_LT(w.crumbs.size(), Breadcrumbs::kMost);
  const auto way = w.crumbs.way_back();
  EXPECT_LT(base::distance_m(way.back(), {0, 0}), 1e-9);
  EXPECT_LT(base::distance_m(way.front(), w.at), kAccuracy_m);
  EXPECT_GT(w.way_m(), 3600.0);
}

TEST(Breadcrumbs, WhatIsNoNumberIsLeftOut) {
  Walk w;
  w.crumbs.take({std::nan(""), 0.0}, 0.02, false);
  w.crumbs.take({3.0, 0.0}, std::nan(""), false);
  EXPECT_EQ(w.crumbs.size(), 1u);
}

}  // namespace
}  // namespace roverd::nav
