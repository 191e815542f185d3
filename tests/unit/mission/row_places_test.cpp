// Where the rows of a block lie that a person has drawn.

#include <string>

#include <gtest/gtest.h>

#include "base/tangent_plane.hpp"
#include "mission/rows/lies.hpp"

namespace roverd::mission {
namespace {

const base::TangentPlane kPlane(LatLon{58.0, 26.0});

LatLon at(double east_m, double north_m) {
  return kPlane.to_global({east_m, north_m});
}

std::string wrong_of(const BlockPlaces& block) {
  const auto laid = lay_rows(block);
  return laid ? "nothing" : laid.error().fields.at(0).pointer;
}

TEST(RowPlaces, LieBesideTheFirstRow) {
  BlockPlaces block{{at(0, 0), at(0, 30)}, 2.5, 3, {}};
  const auto laid = lay_rows(block);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->heading_deg, 0.0);
  EXPECT_EQ(laid->turn, Side::Right);
  ASSERT_EQ(laid->lanes.size(), 3U);
  const auto begin = kPlane.to_local(laid->lanes[2][0]);
  const auto end = kPlane.to_local(laid->lanes[2][1]);
  EXPECT_NEAR(begin.east_m, 5.0, 1e-3);
  EXPECT_NEAR(begin.north_m, 0.0, 1e-3);
  EXPECT_NEAR(end.north_m, 30.0, 1e-3);
  block.turn = Side::Left;
  EXPECT_NEAR(kPlane.to_local(lay_rows(block)->lanes[2][0]).east_m, -5.0, 1e-3);
}

//   (-10, 40) ── ╮             rows lead north, the last one is 40 m long
//      │         (0, 30)
//   (-10, 0) ─── (0, 0)
TEST(RowPlaces, EndWhereTheyMeetTheBorderOfTheBlock) {
  const BlockPlaces block{{at(0, 0), at(0, 30), at(-10, 40), at(-10, 0)}, 2.5, {}, {}};
  const auto laid = lay_rows(block);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->turn, Side::Left);
  ASSERT_EQ(laid->lanes.size(), 5U);  // those on the border, too
  EXPECT_NEAR(kPlane.to_local(laid->lanes[0][1]).north_m, 30.0, 0.02);
  EXPECT_NEAR(kPlane.to_local(laid->lanes[2][1]).north_m, 35.0, 0.02);
  EXPECT_NEAR(kPlane.to_local(laid->lanes[2][0]).north_m, 0.0, 0.02);
}

TEST(RowPlaces, NameWhatIsWrong) {
  const std::vector<LatLon> square{at(0, 0), at(0, 30), at(10, 30), at(10, 0)};
  EXPECT_EQ(wrong_of({{at(0, 0)}, 2.5, 3, {}}), "/block");
  EXPECT_EQ(wrong_of({{at(0, 0), at(0, 0.5)}, 2.5, 3, {}}), "/block/1");
  EXPECT_EQ(wrong_of({{at(0, 0), at(0, 9000)}, 2.5, 3, {}}), "/block/1");
  EXPECT_EQ(wrong_of({{at(0, 0), LatLon{95.0, 0.0}}, 2.5, 3, {}}), "/block/1");
  EXPECT_EQ(wrong_of({{at(0, 0), at(0, 30)}, 2.5, {}, {}}), "/rows");
  EXPECT_EQ(wrong_of({square, 2.5, 9, {}}), "/rows");
  EXPECT_EQ(wrong_of({square, 2.5, 2, Side::Left}), "/turn");
  EXPECT_EQ(wrong_of({square, 2.5, 2, Side::Right}), "nothing");
  // It crosses itself; it has a bay, into which row 2 leads and out again.
  EXPECT_EQ(wrong_of({{at(0, 0), at(0, 20), at(10, 0), at(10, 20)}, 2.5, {}, {}}), "/block");
  const std::vector<LatLon> bay{at(0, 0),     at(0, 16),   at(5.5, 16), at(5.5, 11),
                                at(1.25, 11), at(1.25, 5), at(5.5, 5),  at(5.5, 0)};
  EXPECT_EQ(lay_rows({bay, 2.5, {}, {}}).error().detail,
            "/block is left and entered again by row 2: draw it as several blocks");
  EXPECT_EQ(wrong_of({bay, 2.5, 1, {}}), "nothing");
}

}  // namespace
}  // namespace roverd::mission
