#include "nav/measure/measure.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

Path path_through(const std::vector<EnuPoint>& points, bool second_backwards = false) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) v.push_back({p, 0.8, false, false, mission::Turn::Auto, 0.1});
  if (second_backwards) v[2].reverse = true;
  return build_path(v, {});
}

/// A body that moves straight from place to place at 1 m/s, 50 points a second, beside the line by
/// `aside(metres driven)`. Turns on the spot take no time.
std::vector<DrivenPoint> drive(const std::vector<EnuPoint>& points,
                               const std::function<double(double)>& aside = {},
                               bool second_backwards = false) {
  std::vector<DrivenPoint> out;
  double driven_m = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const EnuPoint d = points[i + 1] - points[i];
    const double length = std::hypot(d.east_m, d.north_m);
    const double c = d.east_m / length;
    const double s = d.north_m / length;
    const bool back = second_backwards && i == 1;
    for (double along = 0.0; along < length; along += 0.02, driven_m += 0.02) {
      const double e = aside ? aside(driven_m) : 0.0;
      DrivenPoint p;
      p.t_s = 0.02 * static_cast<double>(out.size());
      p.at = {points[i].east_m + along * c - e * s, points[i].north_m + along * s + e * c};
      p.yaw_rad = base::wrap_rad(std::atan2(s, c) + (back ? base::kPi : 0.0));
      p.speed_mps = back ? -1.0 : 1.0;
      out.push_back(p);
    }
  }
  return out;
}

const std::vector<EnuPoint> kSquare{{0, 0}, {20, 0}, {20, 20}, {0, 20}};

TEST(Measure, APerfectDriveHasNoError) {
  const auto run = measure_run(path_through(kSquare), kSquare, drive(kSquare));
  EXPECT_LT(run.cross.max_m, 1e-6);
  EXPECT_EQ(run.corners.size(), 2u);
  EXPECT_LT(run.corner_max_m, 0.02);
  EXPECT_EQ(run.straights.size(), 3u);
  EXPECT_LT(run.slalom_max_m, 1e-9);
  EXPECT_NEAR(run.driven_m, 60.0, 0.1);
  EXPECT_NEAR(run.time_s, 60.0, 0.1);
  EXPECT_LT(run.end_m, 0.03);
}

TEST(Measure, AnOffsetIsAnErrorButNoSlalom) {
  const std::vector<EnuPoint> line{{0, 0}, {30, 0}};
  const auto run = measure_run(path_through(line), line, drive(line, [](double) { return 0.1; }));
  EXPECT_NEAR(run.cross.rms_m, 0.1, 1e-3);
  EXPECT_NEAR(run.cross.mean_m, 0.1, 1e-3);
  EXPECT_NEAR(run.cross.p95_m, 0.1, 1e-3);
  EXPECT_NEAR(run.slalom_max_m, 0.0, 1e-9);
}

//  a wave of ±5 cm and 3 m: rms 5/√2 cm, peak to peak 10 cm
TEST(Measure, AWaveIsSlalom) {
  const std::vector<EnuPoint> line{{0, 0}, {60, 0}};
  const auto wave = [](double m) { return 0.05 * std::sin(2.0 * base::kPi * m / 3.0); };
  const auto run = measure_run(path_through(line), line, drive(line, wave));
  EXPECT_NEAR(run.cross.rms_m, 0.0354, 0.001);
  EXPECT_NEAR(run.cross.max_m, 0.05, 0.001);
  EXPECT_NEAR(run.slalom_max_m, 0.10, 0.004);
}

TEST(Measure, OutAndBackOnOneLineIsMatchedInOrder) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}, {0, 0}};
  const auto run = measure_run(path_through(way), way, drive(way));
  EXPECT_NEAR(run.matched_m, 20.0, 0.05);
  EXPECT_LT(run.cross.max_m, 1e-6);
}

TEST(Measure, LeftOfTheWayIsPositiveForthAndBackwards) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}, {0, 0}};
  const auto driven = drive(
      way, [](double) { return 0.2; }, true);
  const auto all = match_run(path_through(way, true), driven);
  ASSERT_FALSE(all.empty());
  EXPECT_NEAR(all[200].cross_m, 0.2, 1e-6);
  EXPECT_NEAR(all.back().cross_m, 0.2, 1e-6);
  EXPECT_NEAR(all.back().s_m, 20.0, 0.05);
  EXPECT_NEAR(all.back().heading_rad, 0.0, 1e-6);
}

TEST(Measure, ACrossingDoesNotShortenTheWay) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, -5}};
  const auto run = measure_run(path_through(way), way, drive(way));
  EXPECT_NEAR(run.matched_m, 30.0, 0.05);
  EXPECT_LT(run.cross.max_m, 1e-6);
}

//  ───────────╮ cut 0.5 m before the corner: 0.354 m from it
//             │
TEST(Measure, WhoIsAWholeLaneOffIsOffByThatAndNotOnTheNextOne) {
  // Given lanes 2 m apart, and a receiver that is 2.2 m off to where the next lane is,
  std::vector<EnuPoint> lanes;
  for (int i = 0; i < 6; ++i) {
    const double north = 2.0 * i;
    lanes.push_back({i % 2 == 0 ? 0.0 : 30.0, north});
    lanes.push_back({i % 2 == 0 ? 30.0 : 0.0, north});
  }
  const auto thought = drive(lanes);
  auto driven = thought;
  for (DrivenPoint& p : driven) p.at.north_m += 2.2;
  // then it was at most as far off its way as the receiver was, on whichever lane,
  const Path path = path_through(lanes);
  const auto run = measure_run(path, lanes, driven, 0.0, Counts::All, thought);
  EXPECT_NEAR(run.cross.max_m, 2.2, 0.05);
  EXPECT_GT(run.cross.mean_m, 1.9);  // along the headlands, it is off along them
  EXPECT_NEAR(run.matched_m, path.length_m(), 0.1);
  // and who knows where it is is measured by where it is.
  const auto known = measure_run(path, lanes, thought, 0.0, Counts::All, thought);
  EXPECT_LT(known.cross.max_m, 0.2);
}

TEST(Measure, ACutCornerIsInsideAndFarFromItsVertex) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}, {10, 10}};
  const auto run =
      measure_run(path_through(way), way, drive({{0, 0}, {9.5, 0}, {10, 0.5}, {10, 10}}));
  ASSERT_EQ(run.corners.size(), 1u);
  EXPECT_NEAR(run.corners[0].distance_m, 0.354, 0.01);
  EXPECT_NEAR(run.corners[0].inside_m, 0.25, 0.02);
  EXPECT_LT(run.corners[0].outside_m, 0.01);
  EXPECT_NEAR(base::deg_from_rad(run.corners[0].deflection_rad), 90.0, 1e-6);
}

TEST(Measure, OvershootOfAStopIsOutside) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}, {10, 10}};
  const auto run =
      measure_run(path_through(way), way, drive({{0, 0}, {10.3, 0}, {10, 0.3}, {10, 10}}));
  EXPECT_NEAR(run.overshoot_max_m, 0.3, 0.03);
}

TEST(Measure, TheWayToTheStartDoesNotCount) {
  const std::vector<EnuPoint> way{{0, 0}, {10, 0}};
  const auto run = measure_run(path_through(way), way, drive({{-8, 6}, {0, 0}, {10, 0}}));
  EXPECT_LT(run.cross.max_m, 0.55);
  EXPECT_LT(run.cross.p95_m, 0.2);
}

TEST(Measure, NothingDrivenOrNoPathIsNoError) {
  EXPECT_EQ(measure_run({}, {}, {}).time_s, 0.0);
  const std::vector<EnuPoint> line{{0, 0}, {3, 0}};
  EXPECT_EQ(measure_run(path_through(line), line, {}).cross.max_m, 0.0);
  EXPECT_EQ(measure_run({}, {}, drive(line)).cross.max_m, 0.0);
}

}  // namespace
}  // namespace roverd::nav
