// The whole robot between rows of plants: its mission's items, its sense thread's work, its guard.

#include <cmath>

#include <gtest/gtest.h>

#include "source_folder.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

constexpr double kEnd_m = 14.0;

//   ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓      rows 2.5 m apart, from 1 m ahead of the robot on
// ▭─▶                ↘
//   ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓
Scenario between_rows() {
  Scenario s;
  s.kind = "rows";
  s.world.name = "rows";
  for (const double y : {1.25, -1.25}) {
    sim::world::Thing row;
    row.kind = sim::world::Kind::Row;
    row.points = {{1.0, y}, {kEnd_m, y}};
    row.spacing_m = 0.4;
    row.width_m = 0.5;
    row.height_m = 1.2;
    row.density_pm = 8.0;
    s.world.things.push_back(row);
  }
  s.course.name = "rows";
  s.course.points = {{0.0, 0.0}, {20.0, 0.0}};
  s.time_s = 120.0;
  s.plan.emplace();
  s.plan->name = "rows";
  return s;
}

Setup row_setup() {
  Setup out;
  out.config = tests::in_source("config/robot.toml");
  out.vehicle = "bunker";
  return out;
}

TEST(RowMission, DrivesTheRowToItsEndThenOn) {
  Scenario s = between_rows();
  s.plan->items = {mission::Row{}, mission::Move{1.5}};
  const auto run = run_world(row_setup(), s);
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_EQ(run->problem, "");
  EXPECT_TRUE(run->finished);
  EXPECT_TRUE(run->touches.empty());
  EXPECT_EQ(run->brushes, 0U);
  ASSERT_FALSE(run->track.empty());
  // The end of the row within half a metre, the move behind it.
  EXPECT_NEAR(run->track.back().east_m, kEnd_m + 1.5, 0.6);
  for (const base::EnuPoint& at : run->track) {
    if (at.east_m < 2.0 || at.east_m > kEnd_m) continue;
    EXPECT_LT(std::abs(at.north_m), 0.15) << at.east_m;
  }
}

TEST(RowMission, EndsAfterTheDistanceThatIsAsked) {
  Scenario s = between_rows();
  mission::Row row;
  row.distance_m = 5.0;
  s.plan->items = {row};
  const auto run = run_world(row_setup(), s);
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_TRUE(run->finished);
  EXPECT_NEAR(run->driven_m, 5.0, 0.7);
}

TEST(RowMission, IsBlockedWhereThereIsNoRow) {
  Scenario s = between_rows();
  s.world.things.clear();
  s.plan->items = {mission::Row{}};
  const auto run = run_world(row_setup(), s);
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_FALSE(run->finished);
  EXPECT_NEAR(run->driven_m, 3.0, 0.5);
}

}  // namespace
}  // namespace roverd::study
