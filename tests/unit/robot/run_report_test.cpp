// A run is judged by what its mission asked for, and by nothing else.

#include "robot/run_report.hpp"

#include <gtest/gtest.h>

#include "field.hpp"

namespace roverd::robot {
namespace {

/// What was recorded, five times a second, as a run keeps it.
std::vector<ReportPoint> record(Field& f, double limit_s) {
  std::vector<ReportPoint> out;
  for (double t = 0.0; t < limit_s && f.execution() == ExecutionState::Running; t += 0.2) {
    f.run(0.2);
    const auto s = f.state();
    ReportPoint p;
    p.t_s = base::seconds(f.now.time_since_epoch());
    p.at = s->pose->global;
    p.yaw_rad = s->pose->yaw_rad;
    p.speed_mps = s->pose->speed_mps.value_or(0.0);
    p.yaw_rate_radps = s->pose->yaw_rate_radps.value_or(0.0);
    p.by_itself = s->control == base::Driver::Autonomy;
    p.item = s->mission.current_item;
    out.push_back(p);
  }
  return out;
}

std::vector<ReportPoint> drive(Field& f, const mission::Plan& plan) {
  f.run(8.0);
  EXPECT_TRUE(f.load(plan));
  EXPECT_TRUE(f.ask(Arm{}));
  EXPECT_TRUE(f.ask(StartMission{"m", 1}));
  return record(f, 200.0);
}

double to_leg_m(base::EnuPoint p, base::EnuPoint a, base::EnuPoint b) {
  const base::EnuPoint d = b - a;
  const base::EnuPoint r = p - a;
  const double length2 = d.east_m * d.east_m + d.north_m * d.north_m;
  const double part = std::clamp((d.east_m * r.east_m + d.north_m * r.north_m) / length2, 0.0, 1.0);
  return std::hypot(r.east_m - part * d.east_m, r.north_m - part * d.north_m);
}

/// By itself, from the points alone: the largest distance from the legs between the items.
double farthest_m(const std::vector<ReportPoint>& track, const std::vector<base::EnuPoint>& way) {
  double most_m = 0.0;
  for (const ReportPoint& p : track) {
    if (!p.item || *p.item < 2) continue;
    double near_m = 1e9;
    for (std::size_t i = 1; i < way.size(); ++i) {
      near_m = std::min(near_m, to_leg_m(kFrame.to_local(p.at), way[i - 1], way[i]));
    }
    most_m = std::max(most_m, near_m);
  }
  return most_m;
}

const std::vector<base::EnuPoint> kYard{{6, 4}, {6, 14}, {16, 14}, {16, 4}};

//     2 ──── 3
//     │      │      the robot comes to 1 from the side: that way is nobody's fault
//     1      4
//   ▲
TEST(RunReports, TheWayToTheFirstItemIsShownApart) {
  Field f;
  const auto track = drive(f, plan_of(kYard));
  ASSERT_EQ(f.execution(), ExecutionState::Finished);
  const auto report = report_run(plan_of(kYard), track, 1, {});
  ASSERT_TRUE(report) << report.error().detail;
  ASSERT_TRUE(report->approach);
  EXPECT_NEAR(report->approach->driven_m, std::hypot(6.0, 4.0), 0.4);
  EXPECT_NEAR(report->measure.driven_m, 30.0, 0.6);
  EXPECT_LT(report->measure.cross.max_m, 0.15);
  EXPECT_NEAR(report->measure.cross.max_m, farthest_m(track, kYard), 0.01);
  EXPECT_EQ(report->corner_items, (std::vector<int>{2, 3}));
  EXPECT_LT(report->measure.end_m, 0.1);
}

/// It stands at item 1 already: when the run is first looked at, item 2 is in hand.
TEST(RunReports, ARunThatBeginsAtItsFirstItemHasAllItsCorners) {
  Field f;
  const std::vector<base::EnuPoint> way{{0, 0}, {0, 8}, {8, 8}, {8, 0}};
  const auto track = drive(f, plan_of(way));
  ASSERT_EQ(f.execution(), ExecutionState::Finished);
  ASSERT_EQ(track.front().item, 2);
  const auto report = report_run(plan_of(way), track, 2, {});
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->approach);
  EXPECT_EQ(report->corner_items, (std::vector<int>{2, 3}));
  EXPECT_NEAR(report->measure.driven_m, 24.0, 0.6);
  EXPECT_NEAR(report->measure.cross.max_m, farthest_m(track, way), 0.01);
}

TEST(RunReports, TheWayHomeAndAnotherRoundAreNotJudgedAgainstThePath) {
  auto plan = plan_of({{0, 0}, {0, 8}, {8, 8}});
  plan.settings.at_end = mission::AtEnd::Return;
  Field f;
  const auto track = drive(f, plan);
  ASSERT_EQ(f.execution(), ExecutionState::Finished);
  const auto report = report_run(plan, track, 1, {});
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->driven_m, 16.0 + std::hypot(8.0, 8.0), 1.0);
  EXPECT_NEAR(report->measure.driven_m, 16.0, 0.6);
  EXPECT_LT(report->measure.cross.max_m, 0.15);

  auto rounds = plan_of({{0, 0}, {0, 8}, {8, 8}});
  rounds.items.push_back(mission::Jump{1, 1});
  Field g;
  const auto twice = drive(g, rounds);
  ASSERT_EQ(g.execution(), ExecutionState::Finished);
  const auto judged = report_run(rounds, twice, 1, {});
  ASSERT_TRUE(judged);
  EXPECT_NEAR(judged->measure.driven_m, 16.0, 0.6);
  EXPECT_LT(judged->measure.cross.max_m, 0.15);
}

TEST(RunReports, TwoCentimetresTellNothing) {
  const auto plan = plan_of({{0, 0}, {0, 8}, {8, 8}});
  std::vector<ReportPoint> track(3);
  for (int i = 0; i < 3; ++i) {
    track[static_cast<std::size_t>(i)].t_s = 0.2 * i;
    track[static_cast<std::size_t>(i)].at = kFrame.to_global({0.0, 0.01 * i});
    track[static_cast<std::size_t>(i)].item = 2;
  }
  const auto report = report_run(plan, track, 2, {});
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->driven_m, 0.02, 0.001);
  EXPECT_FALSE(report->tells_way());
  EXPECT_FALSE(report->tells_corners());
  EXPECT_FALSE(report->tells_straights());
}

/// Three items by sight: a row driven 1 m without one in sight, 4 m 0.1 m left and 2 m 0.2 m right
/// of it; a person's metre and a pause do not count; a wall that was seen for too short; landmarks
/// that were never begun.
TEST(RunReports, WhatIsDrivenBySightIsJudgedByWhatWasSeen) {
  mission::Plan plan = plan_of({{0, 0}, {0, 8}});
  mission::Wall beside;
  beside.distance_m = 0.8;
  plan.items = {mission::Row{}, mission::Move{1.0}, beside, mission::Landmarks{"any", 1.0}};
  std::vector<ReportPoint> track;
  double t_s = 0.0;
  double north_m = 0.0;
  const auto drive = [&](int item, double way_m, std::optional<double> cross_m, bool by_itself) {
    for (double s_m = 0.0; s_m < way_m - 1e-9; s_m += 0.1) {
      ReportPoint p;
      p.t_s = t_s += 0.2;
      p.at = kFrame.to_global({0.0, north_m += 0.1});
      p.item = item;
      p.cross_m = cross_m;
      p.by_itself = by_itself;
      track.push_back(p);
    }
  };
  drive(1, 1.1, std::nullopt, true);
  drive(1, 4.0, 0.1, true);
  drive(1, 1.0, 3.0, false);
  t_s += 60.0;
  north_m += 5.0;
  drive(1, 2.1, -0.2, true);
  drive(2, 1.0, std::nullopt, true);
  drive(3, 0.9, 0.05, true);

  const auto report = report_run(plan, track, 1, {});
  ASSERT_TRUE(report) << report.error().detail;
  ASSERT_EQ(report->by_sight.size(), 2U);
  const SightMeasure& row = report->by_sight[0];
  EXPECT_EQ(row.item, 1);
  EXPECT_EQ(row.type, "row");
  EXPECT_NEAR(row.driven_m, 7.0, 0.01);
  EXPECT_NEAR(row.judged_m, 6.0, 0.01);
  EXPECT_TRUE(row.tells());
  EXPECT_NEAR(row.cross.rms_m, std::sqrt((4.0 * 0.01 + 2.0 * 0.04) / 6.0), 1e-3);
  EXPECT_NEAR(row.cross.mean_m, 0.8 / 6.0, 1e-3);
  EXPECT_NEAR(row.cross.p95_m, 0.2, 1e-9);
  EXPECT_NEAR(row.cross.max_m, 0.2, 1e-9);
  const SightMeasure& wall = report->by_sight[1];
  EXPECT_EQ(wall.type, "wall");
  EXPECT_FALSE(wall.tells());
}

}  // namespace
}  // namespace roverd::robot
