// The text of a vision program, sign by sign, and what is not taken for it.

#include "vision/codec.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace roverd::vision {
namespace {

Decoded decoded(std::string_view text) {
  return decode({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}
/// "a number that is none: field 2 (landmarks), byte 27", or "understood".
std::string said(std::string_view text) {
  return describe(decoded(text));
}

constexpr std::string_view kWhole =
    "cone#box#door: 0 2: 0.5 0.1 2 -0.3 0.1 3: 1 0.2 1.5: 0.9 0 2 -1 0 0: 5200";

TEST(VisionCodec, SixFieldsAreReadByTheirMeaning) {
  const Decoded d = decoded(kWhole);
  ASSERT_EQ(d.fault, Fault::None) << describe(d);
  EXPECT_EQ(d.datagram.names, (std::vector<std::string>{"cone", "box", "door"}));
  ASSERT_EQ(d.datagram.landmarks.size(), 2U);
  EXPECT_EQ(d.datagram.landmarks[0], (Landmark{0, {0.5, 0.1, 2.0}})) << "index 0 is the first name";
  EXPECT_EQ(d.datagram.landmarks[1], (Landmark{2, {-0.3, 0.1, 3.0}})) << "and 2 the third";
  EXPECT_EQ(d.datagram.obstacles, (std::vector<Point>{{1.0, 0.2, 1.5}}));
  EXPECT_EQ(d.datagram.planes, (std::vector<Plane>{{{0.9, 0.0, 2.0}, {-1.0, 0.0, 0.0}, 5200.0}}));
}

TEST(VisionCodec, FieldsMayBeEmpty) {
  EXPECT_EQ(said(":::::"), "understood");
  EXPECT_EQ(said("cone:::::"), "understood");
  EXPECT_EQ(said("cone#box: 1: 0 0 1:::"), "understood");
  EXPECT_EQ(said("::: 1 2 3 4 5 6::"), "understood");
  EXPECT_EQ(said(":::: 1 2 3 0 0 -1: 12"), "understood");
}

TEST(VisionCodec, NumbersAreWrittenInManyWays) {
  const Decoded d = decoded("a: 0: -0.5 1e-1 .25:::");
  ASSERT_EQ(d.fault, Fault::None) << describe(d);
  EXPECT_EQ(d.datagram.landmarks[0].at, (Point{-0.5, 0.1, 0.25}));
}

//   camera: x right, y down, z ahead        S: x ahead, y left, z up
TEST(VisionCodec, TheCamerasAxesEndHere) {
  const base::Vision v =
      seen(decoded("cone: 0: 0.5 0.1 2: 1 0.2 1.5: 0.9 -0.3 2 0 0 -1.01: 9").datagram);
  EXPECT_EQ(v.landmarks, (std::vector<base::VisionLandmark>{{"cone", {2.0, -0.5, -0.1}}}));
  EXPECT_EQ(v.obstacles, (std::vector<base::VisionPoint>{{1.5, -1.0, -0.2}}));
  ASSERT_EQ(v.planes.size(), 1U);
  EXPECT_EQ(v.planes[0].centre, (base::VisionPoint{2.0, -0.9, 0.3}));
  EXPECT_DOUBLE_EQ(v.planes[0].normal.x_m, -1.0) << "of length 1 whatever was said";
  EXPECT_EQ(v.planes[0].size, 9.0);
}

TEST(VisionCodec, AFalsePlaneBehindTheCameraIsNoMalformedOne) {
  EXPECT_LT(seen(decoded(":::: 1 0 -2 0 0 1: 9000").datagram).planes.at(0).centre.x_m, 0.0);
}

TEST(VisionCodec, ARefusalNamesCauseFieldAndByte) {
  EXPECT_EQ(said("cone"), "not six fields between colons: field 0 (names), byte 4");
  EXPECT_EQ(said("::::"), "not six fields between colons: field 4 (planes), byte 4");
  EXPECT_EQ(said("::::::"), "not six fields between colons: field 5 (plane sizes), byte 5");
  const std::string name =
      "a name that is empty, too long, one too many or not printable: field 0 ";
  EXPECT_EQ(said("#cone:::::"), name + "(names), byte 0");
  EXPECT_EQ(said("cone#:::::"), name + "(names), byte 5");
  EXPECT_EQ(said("co\x01ne:::::"), name + "(names), byte 0");
  EXPECT_EQ(said(std::string(33, 'x') + ":::::"), name + "(names), byte 0");
  const std::string blank =
      "a number without exactly one blank before it: field 1 (indices), byte ";
  EXPECT_EQ(said("a:0: 1 2 3:::"), blank + "2");
  EXPECT_EQ(said("a:  0: 1 2 3:::"), blank + "3");
  EXPECT_EQ(said("a: 0 : 1 2 3:::"), blank + "5") << "a blank without its number";
  const std::string none = "a number that is none: field 2 (landmarks), byte ";
  EXPECT_EQ(said("a: 0: 1 x 3:::"), none + "8");
  EXPECT_EQ(said("a: 0: 1 2\t3:::"), none + "8");
  EXPECT_EQ(said("a: 0: 1 2 nan:::"), none + "10");
  EXPECT_EQ(said("a: 0: 1 2 -inf:::"), none + "10");
  EXPECT_EQ(said("a: 0: +1 2 3:::"), none + "6");
  EXPECT_EQ(said("a: 0: 1,5 2 3:::"), none + "6");
  EXPECT_EQ(said(":::: 1 2 3 0 0 1: 12\n"),
            "a number that is none: field 5 (plane sizes), byte 18");
}

TEST(VisionCodec, CountsThatDoNotFitAreRefused) {
  EXPECT_EQ(decoded("a: 0: 1 2:::").fault, Fault::Landmarks);
  EXPECT_EQ(decoded("a: 0: 1 2 3 4 5 6:::").fault, Fault::Landmarks);
  EXPECT_EQ(decoded("a:: 1 2 3:::").fault, Fault::Landmarks);
  EXPECT_EQ(decoded("::: 1 2::").fault, Fault::Triples);
  EXPECT_EQ(decoded(":::: 1 2 3 0 0: 4").fault, Fault::Planes);
  EXPECT_EQ(decoded(":::: 1 2 3 0 0 1:").fault, Fault::Sizes);
  EXPECT_EQ(decoded("::::: 4").fault, Fault::Sizes);
  EXPECT_EQ(decoded(":::: 1 2 3 0 0 1: 4 5").fault, Fault::Sizes);
}

TEST(VisionCodec, ValuesThatCannotBeAreRefused) {
  EXPECT_EQ(decoded("a: 1: 1 2 3:::").fault, Fault::Index) << "index 1 of one name";
  EXPECT_EQ(decoded("a: -1: 1 2 3:::").fault, Fault::Index);
  EXPECT_EQ(decoded("a: 0.5: 1 2 3:::").fault, Fault::Index);
  EXPECT_EQ(decoded(": 0: 1 2 3:::").fault, Fault::Index);
  EXPECT_EQ(decoded("a: 0: 1 2 1001:::").fault, Fault::Range);
  EXPECT_EQ(decoded("a: 0: 1 2 1e999:::").fault, Fault::Range);
  EXPECT_EQ(decoded(":::: 1 2 3 0 0 1: -1").fault, Fault::Range);
  EXPECT_EQ(decoded(":::: 1 2 3 0 0 0: 5000").fault, Fault::Normal);
  EXPECT_EQ(decoded(":::: 1 2 3 0.8 0.8 0: 5000").fault, Fault::Normal);
}

TEST(VisionCodec, NothingGrowsWithoutABound) {
  std::string many = "a:";
  for (std::size_t i = 0; i <= kMostLandmarks; ++i) many += " 0";
  EXPECT_EQ(decoded(many + "::::").fault, Fault::TooMany);
  many = ":::";
  for (std::size_t i = 0; i <= 3 * kMostObstacles; ++i) many += " 1";
  EXPECT_EQ(decoded(many + "::").fault, Fault::TooMany);
  many = "a";
  for (std::size_t i = 0; i < kMostNames; ++i) many += "#a";
  EXPECT_EQ(decoded(many + ":::::").fault, Fault::Name);
}

TEST(VisionCodec, WhatIsWrittenIsReadBack) {
  EXPECT_EQ(encode(decoded(kWhole).datagram), kWhole);
  EXPECT_EQ(encode({}), ":::::");
}

}  // namespace
}  // namespace roverd::vision
