// What is forbidden in a map, as areas that the robot keeps out of.

#include "app/keep_out.hpp"

#include <cmath>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "base/geo.hpp"

namespace roverd {
namespace {

constexpr base::LatLon kAt{58.378, 26.729};
constexpr maps::Anchor kAnchor{kAt, 90.0, 0.1, 0.5};

/// Laid out around the map's origin.
mission::CompiledFence laid(const std::vector<maps::Area>& forbidden, double heading_deg) {
  const maps::Anchor anchor{kAt, heading_deg, 0.1, 0.5};
  return {{"forbidden", keep_out_of(forbidden, anchor).areas, {}}, base::LocalFrame(7, kAt)};
}

//    y ▲   ┌──┐          x axis to the north (heading 0): y is west
//      │   │  └──┐
//      │   └─────┘
//      └──────────▶ x
const maps::Area kCorner{{2, 1}, {6, 1}, {6, 2}, {4, 2}, {4, 4}, {2, 4}};

TEST(KeepOut, LiesWhereTheMapLies) {
  const auto east = laid({kCorner}, 90.0);
  EXPECT_FALSE(east.contains({3.0, 3.0}));
  EXPECT_FALSE(east.contains({5.5, 1.5}));
  EXPECT_TRUE(east.contains({5.5, 3.5})) << "the notch of the L is free";
  EXPECT_NEAR(east.clearance_m({0.0, 2.0}), 2.0, 0.01);
  const auto north = laid({kCorner}, 0.0);
  EXPECT_FALSE(north.contains({-3.0, 3.0}));
  EXPECT_TRUE(north.contains({3.0, 3.0}));
  EXPECT_NEAR(north.clearance_m({-2.0, 0.0}), 2.0, 0.01);
}

TEST(KeepOut, OfSidesThatCrossNeverLessThanWasDrawn) {
  const maps::Area bow{{0, 0}, {4, 4}, {4, 0}, {0, 4}};
  const auto fence = laid({bow, kCorner}, 90.0);
  for (const base::EnuPoint p : {base::EnuPoint{3.5, 2.0}, {0.5, 2.0}, {2.0, 3.5}, {5.5, 1.5}}) {
    EXPECT_FALSE(fence.contains(p)) << p.east_m << " " << p.north_m;
  }
  EXPECT_TRUE(fence.contains({5.5, 3.5}));
}

TEST(KeepOut, WhatCoversNothingForbidsNothing) {
  EXPECT_TRUE(keep_out_of({}, kAnchor).areas.empty());
  const auto nothing =
      keep_out_of({{{1, 1}, {1, 1}, {1, 1}}, {{0, 0}, {1, 1}, {2, 2}}, {}}, kAnchor);
  EXPECT_TRUE(nothing.areas.empty());
  EXPECT_EQ(nothing.left_out, 0u);
  // A corner that was set twice does no harm.
  EXPECT_EQ(keep_out_of({{{0, 0}, {2, 0}, {2, 0}, {2, 2}}}, kAnchor).areas.size(), 1u);
}

TEST(KeepOut, WhatNoFenceMayHaveIsCounted) {
  const maps::Area everything{{-30e3, -30e3}, {30e3, -30e3}, {30e3, 30e3}, {-30e3, 30e3}};
  const auto out = keep_out_of({everything, kCorner}, kAnchor);
  EXPECT_EQ(out.areas.size(), 1u);
  EXPECT_EQ(out.left_out, 1u);
}

TEST(KeepOut, HasNoMoreCornersThanAFenceMayHave) {
  // Given areas like stars, the hull of each with half as many corners, and round ones,
  maps::Area star, round;
  for (int i = 0; i < 500; ++i) {
    const double angle = i * 3.141592653589793 / 250.0;
    const double r = i % 2 == 0 ? 10.0 : 8.0;
    star.push_back({r * std::cos(angle), r * std::sin(angle)});
    round.push_back({10.0 * std::cos(angle), 10.0 * std::sin(angle)});
  }
  // when there are more corners than a fence may have beside another, hulls hold,
  const auto stars = keep_out_of(std::vector<maps::Area>(12, star), kAnchor);
  EXPECT_EQ(stars.areas.size(), 12u);
  EXPECT_EQ(std::get<mission::FencePolygon>(stars.areas[0].shape).points.size(), 250u);
  EXPECT_EQ(stars.left_out, 0u);
  // and what is too much for that is told.
  const auto rounds = keep_out_of(std::vector<maps::Area>(12, round), kAnchor);
  EXPECT_EQ(rounds.areas.size(), 10u);
  EXPECT_EQ(rounds.left_out, 2u);
}

}  // namespace
}  // namespace roverd
