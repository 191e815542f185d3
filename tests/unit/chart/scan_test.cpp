// A sensor's piece becomes a scan of one moment.

#include "nav/chart/scan.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace {

using namespace roverd;
using base::Echo;
using base::SightPoint;
using nav::chart::scan_of;

base::Time at(double s) {
  return base::Time{} + base::from_seconds(s);
}

/// Turns on the spot at 1 rad/s, 50 states a second.
nav::sense::PoseHistory turning() {
  nav::sense::PoseHistory h;
  for (int i = 0; i <= 50; ++i) {
    h.push({at(0.02 * i), {0.0, 0.0, 0.02 * i}, 0.0, 1.0});
  }
  return h;
}

SightPoint point(float x, float y, float after_s, Echo echo = Echo::Hit) {
  SightPoint p;
  p.x_m = x;
  p.y_m = y;
  p.after_s = after_s;
  p.echo = echo;
  return p;
}

const base::Mount kMount{0.2, 0.0, 0.3, 0.0, 0.0, 0.0};

TEST(Scan, EachPointIsCarriedToTheMomentOfTheLast) {
  base::Sight sight;
  sight.stamp = at(0.5);
  sight.points = {point(5.0F, 0.0F, 0.0F), point(5.0F, 0.0F, 0.1F)};
  const auto scan = scan_of(sight, kMount, turning());
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->stamp, at(0.5) + base::from_seconds(static_cast<double>(0.1F)));
  EXPECT_FLOAT_EQ(scan->eye_x_m, 0.2F);
  ASSERT_EQ(scan->beams.size(), 2U);
  // A tenth of a second ago the body looked 0.1 rad further to the right.
  EXPECT_NEAR(scan->beams[0].x_m, 5.2 * std::cos(0.1), 0.006);
  EXPECT_NEAR(scan->beams[0].y_m, -5.2 * std::sin(0.1), 0.006);
  EXPECT_NEAR(scan->beams[1].x_m, 5.2, 1e-3);
  EXPECT_NEAR(scan->beams[1].y_m, 0.0, 0.006);
}

TEST(Scan, UnknownDirectionsAndUglyNumbersAreLeftOut) {
  base::Sight sight;
  sight.stamp = at(0.5);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sight.points = {point(1.0F, 0.0F, 0.0F, Echo::Unknown),
                  point(nan, 0.0F, 0.0F),
                  point(1.0F, 0.0F, nan),
                  point(0.01F, 0.0F, 0.0F),
                  point(2.0F, 0.0F, -1.0F),
                  point(3.0F, 0.0F, 0.0F, Echo::Clear),
                  point(100.0F, 0.0F, 0.0F),
                  point(4.0F, 0.0F, 0.0F)};
  sight.points.back().z_m = 3.0F;  // over the band
  const auto scan = scan_of(sight, kMount, turning());
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->beams.size(), 2U);
  EXPECT_FALSE(scan->beams[0].hit) << "nothing came back from 3 m";
  EXPECT_FALSE(scan->beams[1].hit) << "100 m is too far to be believed: clear to 40 m";
  EXPECT_NEAR(scan->beams[1].x_m, 40.2, 0.01);
}

TEST(Scan, WithoutOdometryOrGoodDataThereIsNone) {
  base::Sight sight;
  sight.stamp = at(0.5);
  sight.points = {point(5.0F, 0.0F, 0.0F)};
  EXPECT_FALSE(scan_of(sight, kMount, nav::sense::PoseHistory{}));
  sight.good = false;
  EXPECT_FALSE(scan_of(sight, kMount, turning()));
  sight.good = true;
  sight.stamp = at(5.0);
  EXPECT_FALSE(scan_of(sight, kMount, turning()));
  sight.points.clear();
  EXPECT_FALSE(scan_of(sight, kMount, turning()));
}

TEST(Scan, OfTooManyBeamsEveryNthIsTaken) {
  base::Sight sight;
  sight.stamp = at(0.5);
  sight.points.assign(1001, point(5.0F, 0.0F, 0.0F));
  nav::chart::ScanParams p;
  p.most = 100;
  EXPECT_EQ(scan_of(sight, kMount, turning(), p)->beams.size(), 91U);
}

}  // namespace
