// What a pose is judged by, asked of squares of ground.

#include "nav/around/field.hpp"

#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/around/price.hpp"
#include "scene.hpp"

namespace roverd::nav::around {
namespace {

using sense::Known;

/// By asking every cell.
bool any_unseen(const sense::Patch& patch, const Field& field, Vec2 low, Vec2 high) {
  for (std::int32_t y = patch.y0; y < patch.y0 + patch.side; ++y) {
    for (std::int32_t x = patch.x0; x < patch.x0 + patch.side; ++x) {
      const Vec2 m{(x + 0.5) * patch.cell_m, (y + 0.5) * patch.cell_m};
      const bool in = m.x >= low.x && m.y >= low.y && m.x <= high.x && m.y <= high.y;
      if (in && field.unseen(m.x, m.y)) return true;
    }
  }
  return false;
}

TEST(FieldTest, WhatIsUnseenSomewhereInASquareIsSaidOfItAndOfNoOther) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2.6, 2.0);
  std::uniform_real_distribution<double> size(0.0, 1.0);
  const Question q = tests::along_x();
  Lane lane;
  lane.lay(q.route);
  int seen = 0;
  int unseen = 0;
  for (const double cell_m : {0.05, 0.04, 0.1}) {
    // Given single cells that nobody saw,
    tests::Scene s(Known::Free, cell_m, 3.0);
    for (int i = 0; i < 30; ++i) {
      s.set(s.cell(place(random)), s.cell(place(random)), Known::Unknown);
    }
    Field field;
    field.lay(s.patch, q, lane);
    for (int i = 0; i < 2000; ++i) {
      const Vec2 low{place(random), place(random)};
      const Vec2 high = low + Vec2{size(random), size(random)};
      // when one is in a square, or in one of the coarse cells that it reaches into, that is said.
      const bool said = field.any_unseen(low, high);
      const Vec2 rim{0.13, 0.13};
      if (any_unseen(s.patch, field, low, high)) {
        ASSERT_TRUE(said) << low.x << ", " << low.y << " to " << high.x << ", " << high.y;
        ++unseen;
      } else if (!any_unseen(s.patch, field, low - rim, high + rim)) {
        ASSERT_FALSE(said) << low.x << ", " << low.y << " to " << high.x << ", " << high.y;
        ++seen;
      }
    }
    EXPECT_TRUE(field.any_unseen({-3.2, 0.0}, {-2.8, 0.2})) << "nobody sees beyond the window";
    EXPECT_TRUE(field.any_unseen({0.0, 2.8}, {0.2, 3.2}));
  }
  EXPECT_GT(seen, 300);
  EXPECT_GT(unseen, 300);
}

//   ▲ ▓   Along a wall, as near as a corner comes while it turns: 11 cm to its cells' middles,
//   where ▭ ▓   14.4 are kept.
TEST(PriceTest, WhoWasRefusedToDriveOnSoNearMayBackOffAndNotDriveOn) {
  tests::Scene s(Known::Free, 0.02, 4.0);
  s.box(0.5, -2.0, 0.7, 2.0);
  Question q = tests::along_x();
  q.pose.yaw_rad = base::rad_from_deg(90.0);
  Lane lane;
  lane.lay(q.route);
  Field field;
  field.lay(s.patch, q, lane);
  Body body;
  body.set(q.body, q.least_m, field);
  field.price_all(q, body.inner_m(), body.least_m(), {});
  body.allow_start(q.pose);
  const Piece on{0.0, 0.1, 0.0};
  const Piece back{0.0, -0.1, 0.0};
  const Price first{&field, &body, q.body.reach_m(), false};
  const Price refused{&field, &body, q.body.reach_m(), true};
  EXPECT_LT(first.of(q.pose, on), Field::kNever);
  EXPECT_EQ(refused.of(q.pose, on), Field::kNever);
  EXPECT_LT(first.of(q.pose, back), Field::kNever);
  EXPECT_LT(refused.of(q.pose, back), Field::kNever);
}

}  // namespace
}  // namespace roverd::nav::around
