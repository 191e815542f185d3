// A range becomes the arc on which its echo may lie.

#include "ranges/fan.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace roverd::ranges {
namespace {

using base::Echo;

constexpr double kDeg = std::numbers::pi / 180.0;

TEST(RangesFan, OneRangeIsAnArcOverItsFieldOfView) {
  Params p;
  p.bearings_deg = "90";
  p.fov_deg = "30";
  p.fan_step_deg = 7.0;  // 30 / 7: five steps of 6 deg
  p.x_m = "0.3";
  p.y_m = "-0.1";
  base::Sight sight;
  Fans(p).spread({{Outcome::Range, 2.0}}, sight);
  ASSERT_EQ(sight.points.size(), 6U);
  for (int k = 0; k < 6; ++k) {
    const double angle_rad = (75.0 + 6.0 * k) * kDeg;
    const auto& point = sight.points[static_cast<std::size_t>(k)];
    EXPECT_NEAR(point.x_m, 0.3 + 2.0 * std::cos(angle_rad), 1e-5);
    EXPECT_NEAR(point.y_m, -0.1 + 2.0 * std::sin(angle_rad), 1e-5);
    EXPECT_EQ(point.z_m, 0.0F);
    EXPECT_EQ(point.echo, Echo::Hit);
  }
  EXPECT_NEAR(sight.half_step_rad, 3.0 * kDeg, 1e-6);
}

TEST(RangesFan, SeveralRangesStandEachAtItsBearing) {
  Params p;
  p.count = 4;
  p.bearings_deg = "45, 0 -45,180";
  p.fov_deg = "1";
  p.max_range_m = 3.0;
  const std::vector<Reading> readings{{Outcome::Range, 1.0},
                                      {Outcome::Nothing, 0.0},
                                      {Outcome::Refused, 0.0},
                                      {Outcome::Range, 3.5}};
  base::Sight sight;
  Fans(p).spread(readings, sight);
  ASSERT_EQ(sight.points.size(), 8U);
  EXPECT_EQ(sight.points[0].echo, Echo::Hit);
  EXPECT_NEAR(sight.points[0].x_m, std::cos(44.5 * kDeg), 1e-5);
  for (const std::size_t i : {2U, 4U, 6U}) EXPECT_EQ(sight.points[i].echo, Echo::Unknown) << i;
  EXPECT_NEAR(sight.points[6].x_m, -1.0, 1e-3);
  p.clear_to_m = 2.5;
  sight = {};
  Fans(p).spread(readings, sight);
  EXPECT_EQ(sight.clear_to_m, 2.5F);
  EXPECT_EQ(sight.points[2].echo, Echo::Clear);
  EXPECT_NEAR(sight.points[2].x_m, 2.5, 1e-3);
  EXPECT_EQ(sight.points[4].echo, Echo::Unknown) << "a broken range vouches for nothing";
  EXPECT_EQ(sight.points[6].echo, Echo::Clear) << "farther than max_range_m";
}

std::string offender(const Params& p) {
  const auto valid = validate(p);
  return valid ? "" : valid.error().fields.at(0).pointer;
}

TEST(RangesParams, ListsThatAreNoneAreRefusedByName) {
  Params p;
  EXPECT_EQ(offender(p), "");
  p.count = 3;
  EXPECT_EQ(offender(p), "") << "one number holds for all";
  p.bearings_deg = "30 0 -30";
  EXPECT_EQ(offender(p), "");
  for (const char* wrong : {"30 0", "30 0 -30 5", "a", "", "30 0 200", "1x 2 3", "nan", "1;2;3"}) {
    Params q = p;
    q.bearings_deg = wrong;
    EXPECT_EQ(offender(q), "bearings_deg") << wrong;
  }
  p.fov_deg = "0";
  EXPECT_EQ(offender(p), "fov_deg");
  p.fov_deg = "30";
  p.unit = "ft";
  EXPECT_EQ(offender(p), "unit");
  p.unit = "mm";
  p.y_m = "11";
  EXPECT_EQ(offender(p), "y_m");
}

}  // namespace
}  // namespace roverd::ranges
