// Poses that are brought to agree.

#include "nav/mapping/graph.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace roverd::nav::mapping {
namespace {

Eigen::Matrix3d sure(double m, double rad) {
  return Eigen::Vector3d(m * m, m * m, rad * rad).asDiagonal();
}

/// A circle of 40 poses, measured step by step with a heading that drifts.
struct Circle {
  std::vector<Pose2> truth;
  std::vector<Pose2> poses;
  std::vector<Edge> edges;

  explicit Circle(double drift_rad) {
    for (int i = 0; i < 40; ++i) {
      const double a = 2.0 * std::numbers::pi * i / 40.0;
      truth.push_back({10.0 * std::sin(a), 10.0 - 10.0 * std::cos(a), base::wrap_rad(a)});
    }
    poses.push_back(truth[0]);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      Pose2 step = inverse(truth[i - 1]) * truth[i];
      step.yaw_rad += drift_rad;
      edges.push_back({i - 1, i, step, sure(0.05, 0.01)});
      poses.push_back(poses.back() * step);
    }
  }
  double worst_m() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      worst = std::max(worst, std::hypot(poses[i].x_m - truth[i].x_m, poses[i].y_m - truth[i].y_m));
    }
    return worst;
  }
  void close(std::size_t a, std::size_t b, const Pose2& wrong_by = {}) {
    edges.push_back({a, b, inverse(truth[a]) * truth[b] * wrong_by, sure(0.03, 0.005), true});
  }
};

TEST(Graph, ALoopBendsTheWholeWay) {
  Circle circle(0.01);
  const double before_m = circle.worst_m();
  EXPECT_GT(before_m, 2.0);
  circle.close(0, 39);
  ASSERT_TRUE(relax(circle.edges, circle.poses));
  EXPECT_LT(circle.worst_m(), 0.1 * before_m);
  EXPECT_LT(strain(circle.edges.back(), circle.poses), 2.0);
  EXPECT_EQ(circle.poses[0].x_m, circle.truth[0].x_m);  // the first one stays
}

TEST(Graph, AWrongLoopAmongRightOnesPullsNothing) {
  Circle circle(0.002);
  circle.close(0, 39);
  circle.close(1, 38);
  circle.close(5, 37);
  ASSERT_TRUE(relax(circle.edges, circle.poses));
  const double right_m = circle.worst_m();
  // When somebody takes one corner for another,
  circle.close(3, 22, {4.0, -3.0, 0.5});
  ASSERT_TRUE(relax(circle.edges, circle.poses));
  // then the way hardly moves, and the loop is known by its strain.
  EXPECT_LT(circle.worst_m(), right_m + 0.1);
  EXPECT_GT(strain(circle.edges.back(), circle.poses), 20.0);
  EXPECT_LT(strain(circle.edges[39], circle.poses), 3.0);
}

TEST(Graph, HeadingsMeetAcrossTheHalfTurn) {
  std::vector<Pose2> poses = {{0, 0, std::numbers::pi - 0.01}, {0, 0, -std::numbers::pi + 0.05}};
  const std::vector<Edge> edges = {{0, 1, {1.0, 0.0, 0.02}, sure(0.1, 0.1)}};
  EXPECT_NEAR(strain(edges[0], poses), std::hypot(10.0, 0.4), 1e-9);
  ASSERT_TRUE(relax(edges, poses));
  EXPECT_NEAR(poses[1].yaw_rad, -std::numbers::pi + 0.01, 1e-6);
  EXPECT_NEAR(poses[1].x_m, std::cos(std::numbers::pi - 0.01), 1e-6);
}

TEST(Graph, OfOnePoseThereIsNothingToRelax) {
  std::vector<Pose2> one = {{1, 2, 3}};
  EXPECT_FALSE(relax({}, one));
  EXPECT_EQ(one[0].x_m, 1.0);
}

}  // namespace
}  // namespace roverd::nav::mapping
