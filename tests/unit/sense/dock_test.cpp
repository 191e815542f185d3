// A dock may be come to; what is before it, and a hole behind it, may not.
#include <cmath>

#include <gtest/gtest.h>

#include "nav/sense/protect.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kBox = Footprint::box(1.0, 0.8, 0.5);  // as far behind the origin as before it
constexpr double kDocked_m = 0.25;                     // the body has so far to go

Patch field(Known known = Known::Free) {
  Patch p;
  p.cell_m = 0.05;
  p.x0 = -100;
  p.y0 = -100;
  p.side = 200;
  p.cells.assign(200 * 200, {known, 0, 0});
  return p;
}

/// Across the way, its near side so far beyond the end line, 10 cm thick.
void across(Patch& p, double beyond_m, Known known, double side = 1.0) {
  for (double y = -0.4; y < 0.4; y += 0.05) {
    for (const double deep_m : {0.025, 0.075}) {
      const double x = side * (0.5 + kDocked_m + beyond_m + deep_m);
      const auto ix = static_cast<std::int32_t>(std::floor(x / p.cell_m)) - p.x0;
      const auto iy = static_cast<std::int32_t>(std::floor((y + 0.01) / p.cell_m)) - p.y0;
      p.cells[static_cast<std::size_t>(iy * p.side + ix)].known = known;
    }
  }
}

Spared dock(double side = 1.0) {
  const double x = side * (0.5 + kDocked_m);
  return {{x, -0.4}, {x, 0.4}, 0.3, {side, 0.0}, 0.15};
}

Verdict verdict(const Patch& p, double v_mps, const Spared& s) {
  return protect(p, {}, kBox, {v_mps, 0.0}, {}, &s);
}

TEST(DockTest, ItIsComeToButNoFasterThanItMayBeTouched) {
  Patch p = field();
  across(p, 0.0, Known::Occupied);
  const Spared there = dock();
  const Verdict v = verdict(p, 0.6, there);
  EXPECT_NEAR(v.part * 0.6, 0.15, 1e-9);
  EXPECT_EQ(v.limit, Limit::Obstacle);
  EXPECT_NEAR(v.at.x, 0.775, 1e-9);
  EXPECT_EQ(verdict(p, 0.1, there).part, 1.0) << "slower it is already";
  EXPECT_EQ(verdict(field(), 0.6, there).part, 1.0) << "nothing is there";
}

TEST(DockTest, TailFirstItIsTheSame) {
  Patch p = field();
  across(p, 0.0, Known::Occupied, -1.0);
  EXPECT_NEAR(verdict(p, -0.6, dock(-1.0)).part * 0.6, 0.15, 1e-9);
  across(p, -0.15, Known::Occupied, -1.0);
  EXPECT_LT(verdict(p, -0.6, dock(-1.0)).part * 0.6, 0.1);
}

//   ▭ ─ ─ ▌ ┊▐    a crate 15 cm before the dock: as if there were no dock
TEST(DockTest, WhatStandsBetweenRobotAndDockStopsIt) {
  Patch p = field();
  across(p, 0.0, Known::Occupied);
  across(p, -0.15, Known::Occupied);
  const Spared there = dock();
  const Verdict none = protect(p, {}, kBox, {0.6, 0.0}, {});
  EXPECT_EQ(verdict(p, 0.6, there).part, none.part);
  EXPECT_EQ(verdict(p, 0.6, there).limit, Limit::Obstacle);
  EXPECT_LT(none.part * 0.6, 0.15);
}

TEST(DockTest, GroundThatEndsIsNoDock) {
  for (const double beyond_m : {0.0, 0.1}) {
    Patch p = field();
    across(p, beyond_m, Known::Drop);
    const Spared there = dock();
    const Verdict v = verdict(p, 0.6, there);
    EXPECT_EQ(v.limit, Limit::Drop);
    EXPECT_EQ(v.part, protect(p, {}, kBox, {0.6, 0.0}, {}).part);
  }
}

//   What nobody has seen there is come to, too; before the dock it is crept into as ever.
TEST(DockTest, WhatIsUnseenBehindTheLineIsTheDockAndBeforeItIsNot) {
  ProtectParams no_creep;
  no_creep.creep_mps = 0.0;
  const Spared there = dock();
  Patch p = field();
  across(p, 0.0, Known::Unknown);
  const Verdict v = protect(p, {}, kBox, {0.6, 0.0}, no_creep, &there);
  EXPECT_NEAR(v.part * 0.6, 0.15, 1e-9);
  EXPECT_EQ(v.limit, Limit::Unseen);
  across(p, -0.25, Known::Unknown);
  EXPECT_LT(protect(p, {}, kBox, {0.6, 0.0}, no_creep, &there).part * 0.6, 0.15);
}

}  // namespace
}  // namespace roverd::nav::sense
