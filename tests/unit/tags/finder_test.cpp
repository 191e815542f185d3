// Tags in pictures of which everything is known.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "picture.hpp"

namespace roverd::nav::tags {
namespace {

Eigen::Matrix3d turned(double yaw_deg, double pitch_deg, double roll_deg) {
  const auto about = [](double deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(base::rad_from_deg(deg), axis).toRotationMatrix();
  };
  return about(yaw_deg, Eigen::Vector3d::UnitY()) * about(pitch_deg, Eigen::Vector3d::UnitX()) *
         about(roll_deg, Eigen::Vector3d::UnitZ());
}

std::vector<Tag> found(const Cells& cells, const Truth& truth, const Shot& shot,
                       TagParams params = {}) {
  params.size_m = shot.size_m;
  const auto bytes = picture(cells, truth, shot);
  Finder finder;
  const auto tags = finder.find(image_of(bytes, shot), shot.lens, params);
  EXPECT_TRUE(tags);
  return tags ? *tags : std::vector<Tag>{};
}

double angle_off_deg(const Tag& tag, const Truth& truth) {
  const Eigen::Matrix3d off = tag.rotation.transpose() * (to_s() * truth.rotation);
  return base::deg_from_rad(std::abs(Eigen::AngleAxisd(off).angle()));
}

TEST(TagFinder, PoseAndIdAreThoseOfThePicture) {
  const Cells cells(17);
  for (const double yaw_deg : {-40.0, -20.0, 25.0, 45.0}) {
    Truth truth{turned(yaw_deg, 10.0, 5.0), {0.1, -0.05, 0.8}};
    const auto tags = found(cells, truth, {});
    ASSERT_EQ(tags.size(), 1U) << yaw_deg;
    EXPECT_EQ(tags[0].id, 17);
    EXPECT_EQ(tags[0].hamming, 0);
    EXPECT_LT((tags[0].place - to_s() * truth.place).norm(), 0.006) << yaw_deg;
    EXPECT_LT(angle_off_deg(tags[0], truth), 1.2) << yaw_deg;
    EXPECT_LT(tags[0].rms_px, 0.4);
    EXPECT_LT(tags[0].doubt, 0.1) << "turned and near, there is no other pose";
  }
}

TEST(TagFinder, AxesAreAheadLeftUpAndIntoTheTag) {
  const auto tags = found(Cells(3), {turned(0.0, 0.0, 0.0), {0.2, 0.1, 1.0}}, {});
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_NEAR(tags[0].place.x(), 1.0, 0.02) << "ahead";
  EXPECT_NEAR(tags[0].place.y(), -0.2, 0.01) << "to the right";
  EXPECT_NEAR(tags[0].place.z(), -0.1, 0.01) << "below";
  EXPECT_GT(tags[0].rotation(0, 2), 0.98) << "its z goes into it: ahead";
}

TEST(TagFinder, TheErrorsAreThoseOfTheCovariance) {
  const Cells cells(5);
  double chi2 = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Shot shot;
    shot.seed = seed;
    shot.noise = 6.0;
    const double s = static_cast<double>(seed);
    Truth truth{turned(30.0 + s * 0.3, 12.0 - s * 0.2, s), {0.004 * s, 0.002 * s, 0.7 + 0.01 * s}};
    const auto tags = found(cells, truth, shot);
    if (tags.size() != 1) continue;
    const Tag& t = tags[0];
    const Eigen::AngleAxisd off(to_s() * truth.rotation * t.rotation.transpose());
    Eigen::Matrix<double, 6, 1> e;
    e << off.angle() * off.axis(), to_s() * truth.place - t.place;
    chi2 += e.dot(t.covariance.ldlt().solve(e));
    ++n;
  }
  ASSERT_GE(n, 19);
  EXPECT_LT(chi2 / n, 9.0) << "never surer than the truth";
  EXPECT_GT(chi2 / n, 0.05);
}

TEST(TagFinder, FromAfarItsPlaceIsStillWhereItIs) {
  const Cells cells(9);
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Shot shot;
    shot.seed = seed;
    const Truth truth{turned(2.0, -1.5, 0.0), {0.0, 0.0, 1.6}};
    for (const Tag& tag : found(cells, truth, shot)) {
      ++n;
      EXPECT_EQ(tag.id, 9);
      EXPECT_LT((tag.place - to_s() * truth.place).norm(), 0.1);
      EXPECT_GE(tag.doubt, 0.0);
      EXPECT_LE(tag.doubt, 1.0);
    }
  }
  EXPECT_GT(n, 0);
}

TEST(TagFinder, BlurAndNoiseCostTagsButInventNone) {
  const Cells cells(11);
  for (const double blur_px : {0.5, 1.5, 3.0, 8.0}) {
    Shot shot;
    shot.blur_px = blur_px;
    shot.noise = 10.0;
    const Truth truth{turned(20.0, 0.0, 0.0), {0.0, 0.0, 0.9}};
    const auto tags = found(cells, truth, shot);
    if (blur_px < 2.0) {
      EXPECT_EQ(tags.size(), 1U) << blur_px;
    }
    for (const Tag& t : tags) {
      EXPECT_EQ(t.id, 11);
      EXPECT_LT((t.place - to_s() * truth.place).norm(), 0.03) << blur_px;
    }
  }
  Shot noise;
  noise.noise = 80.0;
  EXPECT_TRUE(found(cells, {turned(0, 0, 0), {0.0, 0.0, 50.0}}, noise).empty());
}

TEST(TagFinder, MarginAndHammingAreLimits) {
  Shot dull;
  TagParams strict;
  strict.min_margin = 200.0;  // more than black and white differ here
  const Truth truth{turned(20.0, 0.0, 0.0), {0.0, 0.0, 0.8}};
  EXPECT_TRUE(found(Cells(2), truth, dull, strict).empty());
  EXPECT_EQ(found(Cells(2), truth, dull).size(), 1U);
}

TEST(TagFinder, ImagesAndLensesThatCannotBeAreRefusedByName) {
  Finder finder;
  const std::vector<std::uint8_t> bytes(64 * 64);
  const auto field = [&](GreyImage image, Lens lens) {
    const auto got = finder.find(image, lens, {});
    return got ? std::string("taken") : got.error().fields.at(0).pointer;
  };
  const Lens lens{60.0, 60.0, 32.0, 32.0};
  EXPECT_EQ(field({64, 64, 64, bytes}, lens), "taken");
  EXPECT_EQ(field({0, 64, 64, bytes}, lens), "width");
  EXPECT_EQ(field({64, 100000, 64, bytes}, lens), "height");
  EXPECT_EQ(field({64, 64, 63, bytes}, lens), "stride");
  EXPECT_EQ(field({64, 65, 64, bytes}, lens), "bytes");
  EXPECT_EQ(field({64, 64, 64, bytes}, {0.0, 60.0, 32.0, 32.0}), "fx");
  EXPECT_EQ(field({64, 64, 64, bytes}, {60.0, 60.0, std::numeric_limits<double>::quiet_NaN(), 1.0}),
            "cx");
}

//   camera on the left side of the body, looking left: the tag is left of it, facing it
TEST(TagPlace, OnTheBodyItsYawIsWhereOneLooksWhoFacesIt) {
  Tag tag;
  tag.rotation = to_s();
  tag.place = {1.0, 0.0, 0.2};
  tag.doubt = 0.0;
  tag.covariance.diagonal() << 1e-4, 4e-4, 9e-4, 1e-4, 1e-6, 1e-6;
  const base::Mount mount{0.3, 0.1, 0.5, 0.0, 0.0, base::kPi / 2.0};
  const TagPlace place = on_body(tag, mount, {});
  EXPECT_NEAR(place.pose.x_m, 0.3, 1e-12);
  EXPECT_NEAR(place.pose.y_m, 1.1, 1e-12);
  EXPECT_NEAR(place.pose.yaw_rad, base::kPi / 2.0, 1e-12);
  EXPECT_NEAR(place.sigma_range_m, 0.01, 1e-9);
  EXPECT_NEAR(place.sigma_across_m, 0.001, 1e-9);
  EXPECT_NEAR(place.sigma_yaw_rad, 0.03, 1e-9);
  EXPECT_TRUE(place.yaw_known);
  tag.doubt = 0.5;
  EXPECT_FALSE(on_body(tag, mount, {}).yaw_known);
}

}  // namespace
}  // namespace roverd::nav::tags
