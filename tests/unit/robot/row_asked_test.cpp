// What the robot asks about a row, and when it asks for the row anew.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "robot/guard/row_watch.hpp"
#include "seeing.hpp"

namespace roverd::robot {
namespace {

class RowAsked : public Seeing {
 protected:
  RowAsked() {
    field.more = [this] {
      look();
      field.robot.row_questions().take(asked);
    };
    field.run(8.0);
    mission::Plan plan;
    plan.name = "row";
    plan.items.emplace_back(mission::Row{});
    EXPECT_TRUE(field.load(plan));
    EXPECT_TRUE(field.ask(Arm{}));
    EXPECT_TRUE(field.ask(StartMission{"m", 1}));
    field.run(2.0);
  }
  std::vector<RowQuestion> asked;
};

TEST_F(RowAsked, OnceThoughSomebodyWalkedBy) {
  ASSERT_TRUE(field.moves());
  wall_at(driven_m() + 1.0);
  field.run(2.0);
  ASSERT_FALSE(field.moves());
  wall_m.reset();
  field.run(5.0);
  ASSERT_TRUE(field.moves());
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_TRUE(asked[0].order);
}

TEST_F(RowAsked, AnewAfterAWord) {
  ASSERT_TRUE(field.ask(SetMode{Mode::Hold}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_FALSE(asked[1].order);
  ASSERT_TRUE(field.ask(ResumeMission{}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_NE(asked[2].id, asked[0].id);
}

TEST_F(RowAsked, OtherParametersAreToldOfTheSameRow) {
  ASSERT_TRUE(field.ask(SetParameter{"nav.rows.plant_m", 0.1}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[1].id, asked[0].id);
  EXPECT_EQ(asked[1].order, asked[0].order);
  EXPECT_EQ(asked[1].params.plant_m, 0.1);
}

/// A row is seen, along x of the odometry, or turned to the left of it.
class InARow : public Seeing {
 protected:
  InARow() {
    field.more = [this] {
      std::vector<RowQuestion> fresh;
      field.robot.row_questions().take(fresh);
      if (!fresh.empty()) question = fresh.back();
      row.reset();
      if (question.order) {
        nav::rows::RowView view;
        view.stamp = field.now;
        view.line = {pose.x_m, pose.x_m * std::tan(turned_rad), turned_rad};
        view.covariance[0] = 0.02 * 0.02;
        view.to_end_m = to_end_m;
        row = RowSeen{question.id, view};
      }
      look();
    };
    field.run(8.0);
  }
  void go() {
    mission::Plan plan;
    plan.name = "row";
    plan.items.emplace_back(mission::Row{});
    plan.items.emplace_back(mission::Move{1.0});
    mission::Waypoint w;
    w.at = kFrame.to_global({0.0, 60.0});
    plan.items.emplace_back(w);
    EXPECT_TRUE(field.load(plan));
    EXPECT_TRUE(field.ask(Arm{}));
    EXPECT_TRUE(field.ask(StartMission{"m", 1}));
  }
  RowQuestion question;
  double turned_rad = 0.0;
  std::optional<double> to_end_m;
};

// Nothing else tells the heading here, and no gyro: elsewhere it holds after 6 s.
TEST_F(InARow, LostSatellitesAreShownAndStopNothingUntilAPlaceIsAskedFor) {
  go();
  field.run(3.0);
  field.gnss_speaks = false;
  field.run(15.0);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  EXPECT_GT(field.command.twist.linear_mps, 0.5);
  EXPECT_TRUE(field.has_condition("gnss_lost"));
  ASSERT_TRUE(field.state()->row);
  EXPECT_EQ(field.state()->row->state, "driving");
  to_end_m = 0.0;
  field.run(15.0);
  EXPECT_EQ(field.state()->mission.current_item, 3);
  EXPECT_EQ(field.execution(), ExecutionState::Paused);
  EXPECT_EQ(field.state()->mode, base::Mode::Hold);
}

TEST_F(InARow, WithoutSatellitesItIsPausedResumedAndStarted) {
  go();
  field.run(3.0);
  field.gnss_speaks = false;
  field.run(15.0);
  ASSERT_TRUE(field.ask(PauseMission{}));
  field.run(1.0);
  GoTo place;
  place.local = base::EnuPoint{0.0, 30.0};
  EXPECT_FALSE(field.ask(place));
  const auto resumed = field.ask(ResumeMission{});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  field.run(3.0);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  EXPECT_GT(field.command.twist.linear_mps, 0.3);
  ASSERT_TRUE(field.ask(StopMission{}));
  field.run(1.0);
  EXPECT_FALSE(field.ask(StartMission{"m", 1, StartMission::From::Item, 3})) << "a place";
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  field.run(3.0);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
}

TEST_F(InARow, WithoutSatellitesAFenceLetsNobodyGoOn) {
  go();
  field.run(3.0);
  field.gnss_speaks = false;
  field.run(15.0);
  ASSERT_TRUE(field.ask(PauseMission{}));
  mission::Fence fence;
  fence.name = "field";
  ASSERT_TRUE(field.ask(SetFence{field.robot.lay_fence(std::make_shared<mission::Fence>(fence))}));
  EXPECT_FALSE(field.ask(ResumeMission{}));
}

TEST_F(Seeing, WaitsBeforeItLooksForItsHeading) {
  field.compass_speaks = false;
  field.run(8.0);
  ASSERT_FALSE(field.state()->pose->heading_known);
  mission::Plan plan = plan_of({{0.0, 20.0}});
  plan.items.insert(plan.items.begin(), mission::Wait{5.0});
  ASSERT_TRUE(field.load(plan));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  for (int i = 0; i < 4 * 50; ++i) {
    field.tick();
    ASSERT_FALSE(field.moves());
  }
  field.run(2.0);
  EXPECT_TRUE(field.moves());
}

// The fence is judged by it.
TEST_F(Seeing, LooksForItsHeadingFirstInARowWithinAFence) {
  field.compass_speaks = false;
  field.run(8.0);
  mission::Fence fence;
  fence.name = "field";
  ASSERT_TRUE(field.ask(SetFence{field.robot.lay_fence(std::make_shared<mission::Fence>(fence))}));
  mission::Plan plan;
  plan.items.emplace_back(mission::Row{});
  ASSERT_TRUE(field.load(plan));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  ASSERT_FALSE(field.state()->pose->heading_known);
  EXPECT_EQ(field.state()->speed_reason, "heading_unknown");
}

TEST_F(InARow, IsSteeredThoughTheHeadingIsUncertain) {
  turned_rad = 0.15;
  go();
  double most_radps = 0.0;
  for (int i = 0; i < 60; ++i) {
    field.tick();
    if (field.state()->estimator.alignment == base::Alignment::Aligned) break;
    most_radps = std::max(most_radps, field.command.twist.angular_radps);
  }
  EXPECT_GT(most_radps, 0.05);
}

}  // namespace
}  // namespace roverd::robot
