// Where the points of a frame lie.

#include "cloud/eye.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "frames.hpp"

namespace roverd::cloud {
namespace {

using base::Echo;
using base::SightPoint;

Params every_pixel() {
  Params params;
  params.decimate = 1;
  return params;
}

/// Shows one encoded frame to an eye.
struct Look {
  explicit Look(const Blob& bytes, const Params& params = every_pixel()) : eye(params) {
    show(bytes);
  }
  void show(const Blob& bytes) {
    Decoder decoder(kMaxPoints);
    decoder.feed(bytes, [&](const Frame& f) {
      sight = {};
      seen = eye.look(f, sight);
    });
  }
  const SightPoint& operator[](std::size_t i) const { return sight.points.at(i); }
  Eye eye;
  base::Sight sight;
  Eye::Seen seen;
};

void expect_at(const SightPoint& p, double x_m, double y_m, double z_m, Echo echo = Echo::Hit) {
  EXPECT_NEAR(p.x_m, x_m, 1e-5);
  EXPECT_NEAR(p.y_m, y_m, 1e-5);
  EXPECT_NEAR(p.z_m, z_m, 1e-5);
  EXPECT_EQ(p.echo, echo);
}

TEST(CloudEye, ACloudIsTakenAsItIsOrTurnedOutOfOpticalAxes) {
  const std::vector<float> xyz{2.0F, 0.5F, -0.1F, kNan, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F};
  const Look plain(cloud_frame(header_of(1), xyz));
  ASSERT_EQ(plain.sight.points.size(), 1U);
  expect_at(plain[0], 2.0, 0.5, -0.1);
  EXPECT_EQ(plain.seen.missing, 2U);
  EXPECT_EQ(plain.seen.directions, 3U);
  EXPECT_EQ(plain.sight.half_step_rad, 0.005F);
  Header optical = header_of(1);
  optical.optical = true;
  optical.good = false;
  // 0.5 right, 0.1 up, 2 ahead.
  const Look turned(cloud_frame(optical, {0.5F, -0.1F, 2.0F}));
  expect_at(turned[0], 2.0, -0.5, 0.1);
  EXPECT_FALSE(turned.sight.good);
}

//   A length so small that, turned, it is 0: what would be divided by it has no direction.
TEST(CloudEye, APointWithoutDirectionIsMissingAndMakesNoPoint) {
  Header posed = header_of(1);
  posed.pose = base::Mount{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const Look seen(cloud_frame(posed, {2.7e-23F, 2.7e-23F, 2e-24F, 3.0F, 0.0F, 0.0F}));
  EXPECT_EQ(seen.seen.missing, 1U);
  ASSERT_EQ(seen.sight.points.size(), 1U);
  EXPECT_TRUE(std::isfinite(seen[0].x_m));
}

TEST(CloudEye, ADepthImageIsSeenThroughItsLens) {
  //  u  0     1     2          f = 100, c = (1, 0.5)
  const std::vector<std::uint16_t> pixels{1000, 2000, 0,  //
                                          1000, 50,   30'000};
  Params params = every_pixel();
  const Look look(depth_frame(header_of(1), 3, pixels), params);
  ASSERT_EQ(look.sight.points.size(), 6U);
  expect_at(look[0], 1.0, 0.01, 0.005);
  expect_at(look[1], 2.0, 0.0, 0.01);
  const double n = std::hypot(1.0, 0.01, 0.005);
  expect_at(look[2], 1.0 / n, -0.01 / n, 0.005 / n, Echo::Unknown);
  expect_at(look[3], 1.0, 0.01, -0.005);
  EXPECT_EQ(look[4].echo, Echo::Unknown) << "5 cm is too near to be believed";
  EXPECT_EQ(look[5].echo, Echo::Unknown) << "30 m is more than max_range_m";
  EXPECT_EQ(look.seen.missing, 3U);
  EXPECT_NEAR(look.sight.half_step_rad, 0.005, 1e-7);
  params.clear_to_m = 4.0;
  const Look vouched(depth_frame(header_of(1), 3, pixels), params);
  expect_at(vouched[2], 4.0 / n, -0.04 / n, 0.02 / n, Echo::Clear);
  EXPECT_EQ(vouched[4].echo, Echo::Unknown) << "something may be there";
  EXPECT_EQ(vouched[5].echo, Echo::Clear);
  EXPECT_EQ(vouched.sight.clear_to_m, 4.0F);
}

TEST(CloudEye, OfASquareOfPixelsTheNearestIsTaken) {
  const std::vector<std::uint16_t> pixels{3000, 2900, 0, 0, 3000,  //
                                          1500, 0,    0, 0, 2000};
  Params params;
  params.decimate = 2;
  const Look look(depth_frame(header_of(1), 5, pixels), params);
  ASSERT_EQ(look.sight.points.size(), 3U);
  expect_at(look[0], 1.5, 1.5 * 0.02, -1.5 * 0.005);  // at (0, 1)
  EXPECT_EQ(look[1].echo, Echo::Unknown);
  expect_at(look[2], 2.0, -2.0 * 0.02, -2.0 * 0.005);  // at (4, 1), the square is cut
  EXPECT_NEAR(look.sight.half_step_rad, 0.01, 1e-7);
}

TEST(CloudEye, ACameraThatChangesItsLensIsFollowed) {
  Look look(depth_frame(header_of(1), 2, {1000, 1000}, 100.0F));
  expect_at(look[0], 1.0, 0.005, 0.0);
  look.show(depth_frame(header_of(2), 2, {1000, 1000}, 50.0F));
  expect_at(look[0], 1.0, 0.01, 0.0);
  look.show(depth_frame(header_of(3), 1, {1000, 1000}, 50.0F));
  expect_at(look[0], 1.0, 0.0, 0.01);
}

TEST(CloudEye, PlanarRangesTellHitsClearAndUnknown) {
  constexpr auto kQuarter = static_cast<float>(std::numbers::pi / 2.0);
  Params params;
  params.clear_to_m = 3.0;
  const Look look(
      ranges_frame(header_of(1), -kQuarter, kQuarter, {2.0F, kInfinity, 1.0F, kNan, 0.0F, -1.0F}),
      params);
  ASSERT_EQ(look.sight.points.size(), 6U);
  expect_at(look[0], 0.0, -2.0, 0.0);
  expect_at(look[1], 3.0, 0.0, 0.0, Echo::Clear);
  expect_at(look[2], 0.0, 1.0, 0.0);
  for (const std::size_t i : {3U, 4U, 5U}) EXPECT_EQ(look[i].echo, Echo::Unknown) << i;
  EXPECT_EQ(look.seen.missing, 4U);
  EXPECT_NEAR(look.sight.half_step_rad, kQuarter / 2.0F, 1e-6);
}

TEST(CloudEye, APoseTurnsAndMovesThePointsOfEveryKind) {
  // Turned a quarter to the left, 0.2 m ahead of its mount and 1 m above: ahead becomes left.
  Header h = header_of(1);
  h.pose = base::Mount{0.2, 0.0, 1.0, 0.0, 0.0, std::numbers::pi / 2.0};
  expect_at(Look(cloud_frame(h, {2.0F, 0.5F, 0.0F}))[0], -0.3, 2.0, 1.0);
  expect_at(Look(depth_frame(h, 1, {3000}))[0], 0.2, 3.0, 1.0);
  expect_at(Look(ranges_frame(h, 0.0F, 0.1F, {3.0F}))[0], 0.2, 3.0, 1.0);
  // Nose down by 30 deg: what is ahead lies lower.
  h.pose = base::Mount{0.0, 0.0, 0.0, 0.0, std::numbers::pi / 6.0, 0.0};
  expect_at(Look(depth_frame(h, 1, {2000}))[0], 2.0 * std::cos(std::numbers::pi / 6.0), 0.0, -1.0);
  // Left side up by a quarter: left becomes up.
  h.pose = base::Mount{0.0, 0.0, 0.0, std::numbers::pi / 2.0, 0.0, 0.0};
  expect_at(Look(cloud_frame(h, {1.0F, 0.5F, 0.0F}))[0], 1.0, 0.0, 0.5);
}

}  // namespace
}  // namespace roverd::cloud
