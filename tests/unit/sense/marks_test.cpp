// The marks of a patch tell what the patch tells; the guard's word is the same with them.
#include "nav/sense/marks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/protect.hpp"
#include "nav/sense/sweep.hpp"

namespace roverd::nav::sense {
namespace {

Patch field_of(std::int32_t side, Known known) {
  Patch p;
  p.x0 = -side / 2;
  p.y0 = -side / 2 + 3;
  p.side = side;
  const auto n = static_cast<std::size_t>(side);
  p.cells.assign(n * n, {known, 1, 2});
  return p;
}

/// Blots of one kind.
void blot(Patch& p, std::mt19937& random, int count, std::int32_t most, Known known) {
  std::uniform_int_distribution<std::int32_t> at(0, p.side - 1);
  std::uniform_int_distribution<std::int32_t> size(1, most);
  for (int i = 0; i < count; ++i) {
    const std::int32_t x0 = at(random);
    const std::int32_t y0 = at(random);
    const std::int32_t x1 = std::min(p.side, x0 + size(random));
    const std::int32_t y1 = std::min(p.side, y0 + size(random));
    for (std::int32_t y = y0; y < y1; ++y) {
      for (std::int32_t x = x0; x < x1; ++x) {
        p.cells[static_cast<std::size_t>(y * p.side + x)].known = known;
      }
    }
  }
}

/// Cells to the nearest unknown one, to all sides.
int brute_about(const Patch& p, std::int32_t ix, std::int32_t iy) {
  for (int r = 0; r <= Marks::kMost; ++r) {
    for (int dy = -r; dy <= r; ++dy) {
      for (int dx = -r; dx <= r; ++dx) {
        if (std::max(std::abs(dx), std::abs(dy)) != r) continue;
        if (p.at(ix + dx, iy + dy).known == Known::Unknown) return r;
      }
    }
  }
  return Marks::kMost + 1;
}

TEST(MarksTest, TheyTellHowFarAllIsSeen) {
  std::mt19937 random(3);
  for (const std::int32_t side : {16, 63, 64, 65, 100, 150}) {
    Patch p = field_of(side, Known::Free);
    blot(p, random, 3, 6, Known::Unknown);
    blot(p, random, 3, 6, Known::Occupied);
    Marks marks;
    marks.mark(p);
    for (std::int32_t iy = p.y0 - 2; iy < p.y0 + side + 2; iy += 3) {
      for (std::int32_t ix = p.x0 - 2; ix < p.x0 + side + 2; ++ix) {
        // The largest of what is told apart that still is less than the way to the nearest.
        const int nearest = brute_about(p, ix, iy);
        int expected = 0;
        for (const int about : Marks::kAbout) expected = about < nearest ? about : expected;
        ASSERT_EQ(marks.seen_about(ix, iy), expected) << side << ": " << ix << " " << iy;
        ASSERT_EQ(marks.unknown(ix, iy), p.at(ix, iy).known == Known::Unknown);
      }
    }
  }
}

TEST(MarksTest, EveryTakenCellOfARectangleIsTold) {
  std::mt19937 random(5);
  Patch p = field_of(150, Known::Free);
  blot(p, random, 20, 9, Known::Occupied);
  blot(p, random, 20, 3, Known::Drop);
  blot(p, random, 20, 9, Known::Unknown);
  Marks marks;
  marks.mark(p);
  std::uniform_int_distribution<std::int32_t> at(0, p.side - 1);
  for (int i = 0; i < 200; ++i) {
    const auto [x0, x1] = std::minmax({p.x0 + at(random), p.x0 + at(random)});
    const auto [y0, y1] = std::minmax({p.y0 + at(random), p.y0 + at(random)});
    std::vector<std::pair<std::int32_t, std::int32_t>> expected;
    for (std::int32_t y = y0; y <= y1; ++y) {
      for (std::int32_t x = x0; x <= x1; ++x) {
        const Known k = p.at(x, y).known;
        if (k == Known::Occupied || k == Known::Drop) expected.emplace_back(x, y);
      }
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> told;
    marks.each_taken(x0, x1, y0, y1,
                     [&](std::int32_t x, std::int32_t y) { told.emplace_back(x, y); });
    EXPECT_EQ(told, expected);
  }
}

TEST(MarksTest, OfAnotherPatchTheyAreNotUsed) {
  Patch p = field_of(64, Known::Free);
  Marks marks;
  EXPECT_FALSE(marks.fit(p));
  marks.mark(p);
  EXPECT_TRUE(marks.fit(p));
  p.x0 += 1;
  EXPECT_FALSE(marks.fit(p));
}

struct Case {
  Pose2 pose;
  Footprint body = Footprint::box(1.0, 0.8, 0.5);
  base::BodyTwist twist;
};

/// Ahead, in reverse, on arcs and on the spot; three bodies.
Case case_of(std::mt19937& random, int i) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Case c;
  c.pose = {unit(random), unit(random), 3.0 * unit(random)};
  c.twist = {1.3 * unit(random), 0.8 * unit(random)};
  if (i % 4 == 0) c.twist.angular_radps = 0.0;
  if (i % 5 == 1) c.twist.linear_mps = 0.0;
  if (i % 3 == 0) c.body = Footprint::box(2.4, 1.2, 0.4);
  if (i % 7 == 0) {
    const Vec2 corners[] = {{-0.6, 0.0}, {-0.3, -0.6}, {0.5, -0.3}, {0.9, 0.1}, {0.2, 0.7}};
    c.body = *Footprint::of(corners);
  }
  return c;
}

void expect_same(const Verdict& a, const Verdict& b, int i) {
  EXPECT_EQ(a.part, b.part) << i;
  EXPECT_EQ(a.limit, b.limit) << i;
  EXPECT_EQ(a.found, b.found) << i;
  EXPECT_EQ(a.touch_s, b.touch_s) << i;
  EXPECT_EQ(a.distance_m, b.distance_m) << i;
  EXPECT_EQ(a.at.x, b.at.x) << i;
  EXPECT_EQ(a.at.y, b.at.y) << i;
  EXPECT_EQ(a.sensor, b.sensor) << i;
}

TEST(MarksTest, TheWordOfTheGuardIsTheSameWithThem) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int limited = 0;
  int unseen = 0;
  for (int i = 0; i < 3000; ++i) {
    // Open ground with holes in what is seen; islands of the seen; a street; all with things.
    Patch p = field_of(200, i % 3 == 1 ? Known::Unknown : Known::Free);
    if (i % 3 == 0) blot(p, random, 1 + i % 11, 30, Known::Unknown);
    if (i % 3 == 1) blot(p, random, 40, 90, Known::Free);
    blot(p, random, i % 13, 6, Known::Occupied);
    blot(p, random, i % 2, 4, Known::Drop);
    Marks marks;
    marks.mark(p);
    const Case c = case_of(random, i);
    ProtectParams params;
    if (i % 2 == 0) params.creep_mps = 0.0;
    const Vec2 from{1.0 + unit(random), -0.5};
    const Spared dock{from, {from.x, 0.5}, 0.3};
    const Spared* spared = i % 6 == 0 ? &dock : nullptr;
    const Verdict slow = protect(p, c.pose, c.body, c.twist, params, spared);
    expect_same(protect(p, c.pose, c.body, c.twist, params, spared, &marks), slow, i);
    limited += slow.limit == Limit::Obstacle || slow.limit == Limit::Drop;
    unseen += slow.limit == Limit::Unseen;
  }
  EXPECT_GT(limited, 200);
  EXPECT_GT(unseen, 500);
}

//   What is found is the first of all cells that the grown body comes to, each tried alone.
TEST(MarksTest, NoCellThatIsComeToEarlierIsLeftOut) {
  std::mt19937 random(11);
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    Patch p = field_of(200, Known::Free);
    blot(p, random, 1 + i % 30, 6, i % 2 == 0 ? Known::Occupied : Known::Drop);
    Marks marks;
    marks.mark(p);
    const Case c = case_of(random, i);
    const ProtectParams params;
    const double grown_m = params.side_m + p.cell_m * std::sqrt(0.5);
    const Pose2 back = inverse(c.pose);
    double nearest_m = 1e9;
    double first_s = 1e9;
    for (std::int32_t iy = p.y0; iy < p.y0 + p.side; ++iy) {
      for (std::int32_t ix = p.x0; ix < p.x0 + p.side; ++ix) {
        if (p.at(ix, iy).known < Known::Occupied) continue;
        const Pose2 at = back * Pose2{(ix + 0.5) * p.cell_m, (iy + 0.5) * p.cell_m, 0.0};
        const Vec2 cell{at.x_m, at.y_m};
        nearest_m = std::min(nearest_m, c.body.distance_m(cell));
        if (const auto t = touch_s(c.body, cell, grown_m, c.twist, 20.0)) {
          first_s = std::min(first_s, *t);
        }
      }
    }
    if (nearest_m < grown_m) continue;  // it stands nearer than the margin: another rule
    const Verdict v = protect(p, c.pose, c.body, c.twist, params, nullptr, &marks);
    if (v.limit == Limit::Unseen) continue;
    if (v.found) {
      EXPECT_NEAR(v.touch_s, first_s, 1e-9) << i;
      ++found;
    } else {
      EXPECT_EQ(part_for(first_s - 0.5, c.twist, params), 1.0) << i << ": " << first_s;
    }
  }
  EXPECT_GT(found, 60);
}

}  // namespace
}  // namespace roverd::nav::sense
