// Dense, noisy points are driven as the smooth way that they are.

#include "nav/track/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

std::vector<Vertex> dense(const std::vector<EnuPoint>& points) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) {
    Vertex vertex{p, 1.0};
    vertex.dense = true;
    v.push_back(vertex);
  }
  return v;
}

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double from(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  double normal(double sigma) {
    return sigma * std::sqrt(-2.0 * std::log(1.0 - from(0.0, 0.999999))) *
           std::cos(from(0.0, 2.0 * base::kPi));
  }

 private:
  std::mt19937 random_;
};

double from_leg_m(EnuPoint a, EnuPoint b, EnuPoint p) {
  const EnuPoint d = b - a;
  const double square = d.east_m * d.east_m + d.north_m * d.north_m;
  const double t =
      square > 0.0
          ? std::clamp(
                ((p.east_m - a.east_m) * d.east_m + (p.north_m - a.north_m) * d.north_m) / square,
                0.0, 1.0)
          : 0.0;
  return std::hypot(p.east_m - a.east_m - t * d.east_m, p.north_m - a.north_m - t * d.north_m);
}

double from_polyline_m(const std::vector<EnuPoint>& line, EnuPoint p) {
  double best = 1e9;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    best = std::min(best, from_leg_m(line[i], line[i + 1], p));
  }
  return best;
}

/// The farthest that any point of the one line is from the other, looked at every 2 cm.
double farthest_m(const std::vector<EnuPoint>& one, const std::vector<EnuPoint>& other) {
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < one.size(); ++i) {
    const EnuPoint d = one[i + 1] - one[i];
    const int n = 1 + static_cast<int>(std::hypot(d.east_m, d.north_m) / 0.02);
    for (int k = 0; k <= n; ++k) {
      const double part = static_cast<double>(k) / n;
      const EnuPoint p = one[i] + EnuPoint{part * d.east_m, part * d.north_m};
      worst = std::max(worst, from_polyline_m(other, p));
    }
  }
  return worst;
}

std::vector<EnuPoint> line_of(const Path& path) {
  std::vector<EnuPoint> out;
  for (const PathPoint& p : path.points) out.push_back(p.at);
  return out;
}

/// Along a way of this length, every so often, and noise beside it.
std::vector<EnuPoint> noisy(const std::function<EnuPoint(double)>& way, double length_m,
                            double every_m, double sigma_m, unsigned seed = 1) {
  Dice dice(seed);
  std::vector<EnuPoint> out;
  for (double s = 0.0; s <= length_m; s += every_m) {
    out.push_back(way(s) + EnuPoint{dice.normal(sigma_m), dice.normal(sigma_m)});
  }
  return out;
}

EnuPoint circle(double s) {
  return {5.0 * std::sin(s / 5.0), 5.0 - 5.0 * std::cos(s / 5.0)};
}

/// Two straight legs of 12 m that meet at a right angle.
EnuPoint right_angle(double s) {
  return s < 12.0 ? EnuPoint{s, 0.0} : EnuPoint{12.0, s - 12.0};
}

struct CircleError {
  double rms_m = 0.0;
  double sharpest_1pm = 0.0;
};

CircleError circle_error(const Path& path) {
  CircleError e;
  for (const PathPoint& p : path.points) {
    const double off = std::hypot(p.at.east_m, p.at.north_m - 5.0) - 5.0;
    e.rms_m += off * off;
    e.sharpest_1pm = std::max(e.sharpest_1pm, std::abs(p.curvature_1pm));
  }
  e.rms_m = std::sqrt(e.rms_m / static_cast<double>(path.points.size()));
  return e;
}

//   · ·  ·    a circle of 5 m: without smoothing its radius is lost in corners of up to 90 degrees
//  ·      ·
TEST(Smooth, ACircleOfNoisyPointsIsACircle) {
  const struct {
    double every_m, sigma_m, rms_m, sharpest_1pm;
  } cases[] = {{0.1, 0.01, 0.006, 0.3},  {0.1, 0.02, 0.010, 0.35}, {0.1, 0.05, 0.030, 0.8},
               {0.3, 0.01, 0.008, 0.35}, {0.3, 0.02, 0.015, 0.4},  {0.3, 0.05, 0.035, 0.8},
               {1.0, 0.01, 0.012, 0.35}, {1.0, 0.02, 0.022, 0.45}, {1.0, 0.05, 0.055, 0.8}};
  for (const auto& c : cases) {
    SCOPED_TRACE(testing::Message() << c.every_m << " m apart, noise " << c.sigma_m << " m");
    const auto points = noisy(circle, 31.0, c.every_m, c.sigma_m);
    const Path path = build_path(dense(points), {});
    const CircleError e = circle_error(path);
    EXPECT_EQ(path.legs.size(), 1u);
    EXPECT_LT(e.rms_m, c.rms_m);
    EXPECT_LT(e.sharpest_1pm, c.sharpest_1pm);
    ASSERT_EQ(path.smoothed.size(), 1u);
    EXPECT_EQ(path.smoothed[0].first, 0u);
    EXPECT_EQ(path.smoothed[0].last, points.size() - 1);
    const bool many_noisy = c.every_m <= 0.15 && c.sigma_m >= 0.05;  // single ones are thrown out
    EXPECT_LE(path.smoothed[0].deviation_m, (many_noisy ? 1.4 : 1.0) * PathParams{}.track.smooth_m);
  }
}

// Noise alone turns a last leg of 2 cm by a right angle: neither a corner nor a turn on the spot.
TEST(Smooth, AShortLegAtAnEndMakesNoCornerOfNoise) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    auto points = noisy(circle, 31.0, 0.1, 0.02, seed);
    Dice dice(seed + 100);
    points.push_back(circle(31.02) + EnuPoint{dice.normal(0.02), dice.normal(0.02)});
    EXPECT_EQ(build_path(dense(points), {}).legs.size(), 1u);
    std::reverse(points.begin(), points.end());
    EXPECT_EQ(build_path(dense(points), {}).legs.size(), 1u);
  }
}

TEST(Smooth, ASharpTurnShortBeforeTheEndStaysOne) {
  auto points = noisy([](double s) { return EnuPoint{s, 0.0}; }, 10.0, 0.1, 0.002);
  for (double s = 0.1; s < 0.45; s += 0.1) points.push_back(points[100] + EnuPoint{0.0, s});
  EXPECT_EQ(build_path(dense(points), {}).legs.size(), 2u);
}

TEST(Smooth, TheDirectionOfTheWayDoesNotJump) {
  const Path path = build_path(dense(noisy(circle, 31.0, 0.3, 0.01)), {});
  const Leg& leg = path.legs.at(0);
  double before = path.yaw_rad(leg, 0.0, 0);
  for (double s = 0.005; s < path.length_m(); s += 0.005) {
    const double yaw = path.yaw_rad(leg, s, path.segment_at(leg, s, 0));
    EXPECT_LT(std::abs(base::angle_diff_rad(before, yaw)), base::rad_from_deg(0.4)) << s;
    before = yaw;
  }
}

TEST(Smooth, ARightAngleStaysOne) {
  for (const double every_m : {0.1, 0.3, 1.0}) {
    for (const double sigma_m : {0.0, 0.01, 0.02, 0.05}) {
      SCOPED_TRACE(testing::Message() << every_m << " m apart, noise " << sigma_m << " m");
      const auto points = noisy(right_angle, 24.0, every_m, sigma_m, 3);
      const Path path = build_path(dense(points), {});
      ASSERT_EQ(path.legs.size(), 2u);
      const EnuPoint corner = path.points[path.legs[0].last].at;
      EXPECT_LT(base::distance_m(corner, {12.0, 0.0}), 0.05 + 2.0 * sigma_m + 0.5 * every_m * 0.1);
    }
  }
}

TEST(Smooth, WhatMustBeMetIsMet) {
  auto v = dense(noisy(circle, 31.0, 0.3, 0.02));
  v[40].stop = true;
  v[70].dense = false;
  const Path path = build_path(v, {});
  EXPECT_EQ(path.legs.size(), 2u);
  EXPECT_LT(base::distance_m(path.at(path.vertex_m[40]), v[40].at), 1e-6);
  EXPECT_LT(base::distance_m(path.at(path.vertex_m[70]), v[70].at), 0.11);
  EXPECT_LT(base::distance_m(path.points.back().at, v.back().at), 1e-6);
}

TEST(Smooth, EveryPointIsPassedInOrderAndWithItsSpeed) {
  auto v = dense(noisy(circle, 31.0, 0.3, 0.02));
  for (std::size_t k = 50; k < v.size(); ++k) v[k].speed_mps = 0.5;
  const Path path = build_path(v, {});
  ASSERT_EQ(path.vertex_m.size(), v.size());
  for (std::size_t k = 1; k < v.size(); ++k) {
    EXPECT_GT(path.vertex_m[k], path.vertex_m[k - 1]);
    EXPECT_LE(base::distance_m(path.at(path.vertex_m[k]), v[k].at), 0.16) << k;
  }
  for (const PathPoint& p : path.points) {
    if (p.s_m < path.vertex_m[49] - 0.3) {
      EXPECT_DOUBLE_EQ(p.segment_mps, 1.0);
    } else if (p.s_m > path.vertex_m[49] + 0.3) {
      EXPECT_DOUBLE_EQ(p.segment_mps, 0.5);
    }
  }
}

TEST(Smooth, LongLegsStayAsTheyAreAndLeadInTangentially) {
  std::vector<EnuPoint> points{{-30, 0}, {-15, 0}};
  for (const EnuPoint& p : noisy(circle, 15.0, 0.3, 0.01)) points.push_back(p);
  points.push_back(points.back() + EnuPoint{-20.0, 0.0});
  const Path path = build_path(dense(points), {});
  EXPECT_EQ(path.legs.size(), 1u);
  for (const PathPoint& p : path.points) {
    if (p.at.east_m < -3.0 && p.at.north_m < 5.0) {
      EXPECT_NEAR(p.at.north_m, 0.0, 0.02);
    }
  }
}

TEST(Smooth, WithoutToleranceEachPointIsACorner) {
  PathParams exact;
  exact.track.smooth_m = 0.0;
  const Path path = build_path(dense(noisy(circle, 31.0, 0.3, 0.02)), exact);
  EXPECT_TRUE(path.smoothed.empty());
  EXPECT_GT(circle_error(path).sharpest_1pm, 1.5);
}

/// Runs, noise, turns back, places twice, outliers: whatever somebody may load.
std::vector<EnuPoint> ugly(unsigned seed) {
  Dice dice(seed);
  std::vector<EnuPoint> out{{0, 0}};
  double yaw = 0.0;
  const int runs = 2 + static_cast<int>(dice.from(0.0, 6.0));
  for (int run = 0; run < runs; ++run) {
    const double step_m = std::exp(dice.from(std::log(0.01), std::log(2.5)));
    const double bend = dice.from(0.0, 1.0) < 0.5 ? 0.0 : dice.from(-0.5, 0.5) * step_m;
    const double sigma = dice.from(0.0, 1.0) < 0.2 ? 0.0 : dice.from(0.0, 0.06);
    const int n = 1 + static_cast<int>(dice.from(0.0, 40.0));
    EnuPoint at = out.back();
    for (int i = 0; i < n; ++i) {
      at = at + EnuPoint{step_m * std::cos(yaw), step_m * std::sin(yaw)};
      yaw += bend;
      EnuPoint p = at + EnuPoint{dice.normal(sigma), dice.normal(sigma)};
      if (dice.from(0.0, 1.0) < 0.01) p = p + EnuPoint{dice.from(-0.5, 0.5), dice.from(-0.5, 0.5)};
      out.push_back(p);
      if (dice.from(0.0, 1.0) < 0.03) out.push_back(p);
      if (dice.from(0.0, 1.0) < 0.02 && out.size() > 3) out.push_back(out[out.size() - 3]);
    }
    yaw += dice.from(0.0, 1.0) < 0.2 ? base::kPi : dice.from(-2.0, 2.0);
  }
  return out;
}

void expect_sound(const Path& path, const std::vector<EnuPoint>& points) {
  double last = -1.0;
  for (const PathPoint& p : path.points) {
    EXPECT_TRUE(std::isfinite(p.at.east_m) && std::isfinite(p.at.north_m));
    EXPECT_GT(p.s_m, last);
    last = p.s_m;
  }
  ASSERT_EQ(path.vertex_m.size(), points.size());
  for (std::size_t k = 1; k < points.size(); ++k) {
    EXPECT_GE(path.vertex_m[k], path.vertex_m[k - 1] - 1e-9) << k;
    for (const Leg& leg : path.legs) {
      const double left_m = leg.end_m - path.vertex_m[k];
      EXPECT_FALSE(left_m > 1e-6 && left_m < 0.0015) << k << ": stops before it has passed";
    }
  }
}

TEST(Smooth, TheWayIsNeverFartherFromThePointsThanTheTolerance) {
  for (const double smooth_m : {0.05, 0.15, 0.4}) {
    PathParams params;
    params.track.smooth_m = smooth_m;
    // Where points stay corners, these are rounded as ever.
    const double most_m = std::max(smooth_m, params.track.corner_deviation_m) + 0.003;
    for (unsigned seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(testing::Message() << "tolerance " << smooth_m << " m, seed " << seed);
      const auto points = ugly(seed);
      const Path path = build_path(dense(points), params);
      const auto way = line_of(path);
      ASSERT_GE(way.size(), 2u);
      expect_sound(path, points);
      // Farther only beside one or two of many points, side by side, that noise threw out.
      const double thrown_m = std::max(1.4 * smooth_m + 0.003, most_m);
      EXPECT_LE(farthest_m(way, points), thrown_m);
      std::vector<EnuPoint> beside;  // in a row, that differ
      for (const EnuPoint& p : points) {
        const double off_m = from_polyline_m(way, p);
        EXPECT_LE(off_m, thrown_m);
        if (off_m <= most_m) beside.clear();
        if (off_m <= most_m || (!beside.empty() && base::distance_m(beside.back(), p) < 0.001)) {
          continue;
        }
        beside.push_back(p);
        EXPECT_LE(beside.size(), 2u) << "a third beside them";
      }
    }
  }
}

// 5 cm of noise throw some of 300 points farther than the tolerance: only one or two side by side.
TEST(Smooth, OnlyOneOrTwoOfManyPointsLieFartherBesideItThanTheTolerance) {
  const double smooth_m = PathParams{}.track.smooth_m;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const auto points = noisy(circle, 31.0, 0.1, 0.05, seed);
    const Path path = build_path(dense(points), {});
    EXPECT_LT(circle_error(path).rms_m, 0.035);
    int in_a_row = 0;
    for (const EnuPoint& p : points) {
      const double off_m = from_polyline_m(line_of(path), p);
      EXPECT_LE(off_m, 1.4 * smooth_m + 0.001);
      in_a_row = off_m > smooth_m + 0.001 ? in_a_row + 1 : 0;
      EXPECT_LE(in_a_row, 2);
    }
  }
}

TEST(Smooth, PointsFartherApartKeepTheToleranceThoughOthersOfTheirPieceAreMany) {
  const double smooth_m = PathParams{}.track.smooth_m;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    auto points = noisy(circle, 20.0, 0.05, 0.05, seed);
    const std::size_t many = points.size();
    Dice dice(seed + 100);
    for (double s = 20.5; s <= 31.0; s += 0.5) {
      points.push_back(circle(s) + EnuPoint{dice.normal(0.05), dice.normal(0.05)});
    }
    const auto way = line_of(build_path(dense(points), {}));
    for (std::size_t i = many + 2; i < points.size(); ++i) {
      EXPECT_LE(from_polyline_m(way, points[i]), smooth_m + 0.003) << i;
    }
  }
}

TEST(Smooth, AnOutlierIsFollowedAsFarAsTheToleranceAsks) {
  auto points = noisy([](double s) { return EnuPoint{s, 0.0}; }, 30.0, 0.3, 0.01);
  points[50].north_m += 0.5;
  const Path path = build_path(dense(points), {});
  EXPECT_LE(from_polyline_m(line_of(path), points[50]), 0.151);
}

TEST(Smooth, ASteeredVehicleIsNotAskedForMoreThanItsLock) {
  PathParams car;
  car.vehicle.kinematics = "ackermann";
  car.vehicle.wheelbase_m = 2.5;
  car.vehicle.max_steering_deg = 35.0;
  const auto wide = [](double s) {
    return EnuPoint{8.0 * std::sin(s / 8.0), 8.0 - 8.0 * std::cos(s / 8.0)};
  };
  const Path path = build_path(dense(noisy(wide, 40.0, 0.3, 0.03)), car);
  ASSERT_EQ(path.legs.size(), 1u);
  for (const PathPoint& p : path.points) {
    EXPECT_LT(std::abs(p.curvature_1pm), 1.1 / min_radius_m(car.vehicle)) << p.s_m;
  }
}

TEST(Smooth, AHundredThousandPointsAreNoTrouble) {
  const auto wave = [](double s) { return EnuPoint{s, 5.0 * std::sin(0.05 * s)}; };
  const auto points = noisy(wave, 9999.0, 0.1, 0.02);
  const Path path = build_path(dense(points), {});
  expect_sound(path, points);
  EXPECT_EQ(path.legs.size(), 1u);
}

}  // namespace
}  // namespace roverd::nav
