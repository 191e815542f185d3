// A mission and a box that stays on its way. The planner is asked as the program's thread asks it,
// but the test says when the answer comes.

#include "robot/guard/detour.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "base/angle.hpp"
#include "robot/guard/around.hpp"
#include "seeing.hpp"

namespace roverd::robot {
namespace {

class Detours : public Seeing {
 protected:
  Detours() {
    BlockedParams blocked;
    blocked.after_s = 1.0;
    blocked.then = "around";
    field.robot.guard_by({}, true, blocked);
    field.more = [this] {
      look();
      std::vector<std::shared_ptr<const AroundQuestion>> asked;
      field.robot.around_questions().take(asked);
      if (!asked.empty()) {
        ++questions;
        answer = answer_around(planner, asked.back());
        if (only_turns) answer = turned(*answer);
        if (finds_none) answer = none(*answer);
        answered_ticks = 0;
      }
      if (answers && answer && answered_ticks++ >= late_ticks)
        field.robot.around_answers().put(std::exchange(answer, nullptr));
    };
  }

  std::ptrdiff_t told(const char* kind) const {
    return std::count_if(field.events.begin(), field.events.end(),
                         [&](const auto& e) { return e.kind == kind; });
  }
  void box_ahead(double by_m) {
    wall_wide_m = 1.0;
    wall_at(driven_m() + by_m);
  }
  /// Northwards, by two places.
  void drive_path() {
    field.run(8.0);
    ASSERT_TRUE(field.load(plan_of({{0, 1}, {0, 20}})));
    ASSERT_TRUE(field.ask(Arm{}));
    ASSERT_TRUE(field.ask(StartMission{"m", 1}));
    for (int i = 0; i < 50 * 20 && driven_m() < 3.0; ++i) field.tick();
    ASSERT_GT(driven_m(), 2.9);
  }
  void until_around(double seconds = 40.0) {
    for (double t = 0.0; t < seconds && !field.state()->detour; t += 0.02) field.tick();
    ASSERT_TRUE(field.state()->detour) << field.events.back().detail;
  }
  /// Beside the box.
  void until_beside() {
    until_around();
    for (int i = 0; i < 3000 && std::abs(field.at.east_m) < 0.8; ++i) field.tick();
    ASSERT_GT(std::abs(field.at.east_m), 0.8);
  }

  /// As far as all is seen it is a turn on the spot, 60 degrees to the left.
  static std::shared_ptr<const AroundAnswer> turned(const AroundAnswer& by) {
    auto out = std::make_shared<AroundAnswer>(by);
    out->found = {};
    out->found.found = nav::around::Found::Part;
    out->found.why = nav::around::Why::Unseen;
    nav::around::Place at;
    at.pose = by.asked->question.pose;
    out->found.path.push_back(at);
    at.pivot = true;
    for (int i = 0; i < 12; ++i) {
      at.pose.yaw_rad = base::wrap_rad(at.pose.yaw_rad + base::rad_from_deg(5.0));
      out->found.path.push_back(at);
    }
    return out;
  }

  static std::shared_ptr<const AroundAnswer> none(const AroundAnswer& by) {
    auto out = std::make_shared<AroundAnswer>(by);
    out->found = {};
    out->found.found = nav::around::Found::None;
    out->found.why = nav::around::Why::Gap;
    return out;
  }

  nav::around::Planner planner;
  bool only_turns = false;
  bool finds_none = false;
  std::shared_ptr<const AroundAnswer> answer;
  bool answers = true;
  int late_ticks = 0;  ///< that an answer takes
  int answered_ticks = 0;
  int questions = 0;
};

TEST_F(Detours, ABoxThatStaysIsDrivenAroundAndTheMissionGoesOnBehindIt) {
  // Given a mission northwards, and a box on its way,
  drive_path();
  box_ahead(4.0);
  const double box_m = *wall_m;
  // when nobody takes it away,
  double beside_m = 0.0;
  double nearest_m = 1e9;
  for (int i = 0; i < 50 * 90 && told("around_done") == 0; ++i) {
    field.tick();
    beside_m = std::max(beside_m, std::abs(field.at.east_m));
    const double ahead_m =
        std::max({box_m - field.at.north_m, field.at.north_m - box_m - 1.0, 0.0});
    const double aside_m = std::max(std::abs(field.at.east_m) - 0.5, 0.0);
    nearest_m = std::min(nearest_m, std::hypot(ahead_m, aside_m));
  }
  // then it is driven around: nothing is touched, and it is back on its way behind the box.
  EXPECT_EQ(told("going_around"), 1);
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_EQ(told("no_way_around"), 0) << field.events.back().detail;
  EXPECT_GT(nearest_m, 0.39 + 0.05);  // half of its width
  EXPECT_LT(beside_m, 2.5);
  EXPECT_GT(field.at.north_m, box_m + 1.0);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  field.run(1.0);
  EXPECT_FALSE(field.state()->detour);
  EXPECT_LT(std::abs(field.at.east_m), 0.3);
}

TEST_F(Detours, WhoStandsTooNearToTurnBacksOffFirst) {
  drive_path();
  // Given something that is there all at once, a hand's breadth before it,
  box_ahead(0.5 * VehicleLength + 0.3);
  for (int i = 0; i < 50 * 3; ++i) field.tick();
  const double stood_m = field.at.north_m;
  wall_m = stood_m + 0.5 * VehicleLength + 0.12;
  const double box_m = *wall_m;
  // when it may go around,
  double least_m = stood_m;
  for (int i = 0; i < 50 * 90 && told("around_done") == 0; ++i) {
    field.tick();
    least_m = std::min(least_m, field.at.north_m);
  }
  // then it backs off to where it can turn, and does so.
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_LT(least_m, stood_m - 0.05);
  EXPECT_GT(field.at.north_m, box_m + 1.0);
}

/// A busy processor: what is answered begins where the robot was.
class LateAnswers : public Detours, public ::testing::WithParamInterface<int> {};

TEST_P(LateAnswers, DoNotLeadBackToWhereTheyWereAsked) {
  late_ticks = GetParam() / 20;
  drive_path();
  box_ahead(4.0);
  const double box_m = *wall_m;
  until_around();
  double farthest_m = field.at.north_m;
  double back_m = 0.0;
  double turned_back_s = 0.0;
  for (int i = 0; i < 50 * 60 && told("around_done") == 0; ++i) {
    // Given a box that is seen to be wider once it is driven around,
    if (std::abs(field.at.east_m) > 0.4) wall_wide_m = 1.3;
    if (field.at.north_m > box_m) wall_wide_m = 1.5;
    field.tick();
    farthest_m = std::max(farthest_m, field.at.north_m);
    back_m = std::max(back_m, farthest_m - field.at.north_m);
    const double off_rad = base::angle_diff_rad(base::kPi / 2.0, field.yaw_rad);
    if (std::abs(off_rad) > base::rad_from_deg(110.0)) turned_back_s += 0.02;
  }
  // when another way is found for where it was, then it is joined where it is.
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_LT(back_m, 0.3);
  EXPECT_LT(turned_back_s, 0.1);
  EXPECT_EQ(told("no_way_around"), 0);
}

INSTANTIATE_TEST_SUITE_P(Detours, LateAnswers, ::testing::Range(0, 1300, 100));

TEST(WayOf, ATurnOnItsWayIsTurnedOnTheSpotHoweverSlight) {
  // Given a way that turns by 20 degrees on the spot after half a metre,
  AroundAnswer answer;
  answer.asked = std::make_shared<AroundQuestion>();
  const auto add = [&](double x_m, double y_m, double deg, bool pivot) {
    nav::around::Place p;
    p.pose = {x_m, y_m, base::rad_from_deg(deg)};
    p.pivot = pivot;
    answer.found.path.push_back(p);
  };
  add(0.0, 0.0, 0.0, false);
  add(0.5, 0.0, 0.0, false);
  add(0.5, 0.0, 20.0, true);
  add(0.97, 0.17, 20.0, false);
  // then it stops there, and turns.
  const auto way = way_of(answer, 0.5);
  ASSERT_EQ(way.size(), 2U);
  EXPECT_TRUE(way[0].stop);
  EXPECT_EQ(way[0].turn, mission::Turn::Pivot);
  EXPECT_EQ(way[1].turn, mission::Turn::Auto);
}

/// What is seen of a box flickers by a cell each way, and answers come when they can.
class FlickeringBoxes : public Detours, public ::testing::WithParamInterface<unsigned> {
 protected:
  double from(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  std::mt19937 random_{GetParam()};
};

TEST_P(FlickeringBoxes, AreDrivenAround) {
  // Given a box somewhere on the way,
  drive_path();
  box_ahead(4.0);
  wall_mid_m = from(-0.5, 0.5);
  const double wide_m = from(0.6, 1.6);
  const double box_m = *wall_m;
  const double late = from(0, 50);
  // when each look sees it otherwise, and each answer takes up to a second,
  double nearest_m = 1e9;
  for (int i = 0; i < 50 * 60 && told("around_done") == 0; ++i) {
    late_ticks = static_cast<int>(from(0, late));
    wall_wide_m = wide_m + from(-0.1, 0.1);
    wall_m = box_m + from(-0.05, 0.05);
    field.tick();
    const double ahead_m =
        std::max({box_m - field.at.north_m, field.at.north_m - box_m - 1.0, 0.0});
    const double aside_m = std::max(std::abs(field.at.east_m + wall_mid_m) - 0.5 * wide_m, 0.0);
    nearest_m = std::min(nearest_m, std::hypot(ahead_m, aside_m));
  }
  // then it is behind it within a minute, and has touched nothing.
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_GT(nearest_m, 0.39 + 0.05);
}

// Each of these stood for good where a turn on the spot was driven as a bend instead.
INSTANTIATE_TEST_SUITE_P(Detours, FlickeringBoxes,
                         ::testing::Values(14, 23, 24, 33, 39, 41, 61, 72, 85, 98));

TEST_F(Detours, NoOtherWayIsAskedForInTheMiddleOfATurn) {
  drive_path();
  box_ahead(4.0);
  until_around();
  // Given turns on the spot, which take more than a second,
  int turning = 0;
  int asked = 0;
  for (int i = 0; i < 50 * 60 && told("around_done") == 0; ++i) {
    const double yaw_rad = field.yaw_rad;
    const base::EnuPoint at = field.at;
    const int before = questions;
    field.tick();
    const bool turns = std::abs(base::angle_diff_rad(yaw_rad, field.yaw_rad)) > 0.1 * 0.02 &&
                       base::distance_m(at, field.at) < 0.02 * 0.02;
    if (!turns) continue;
    ++turning;
    asked += questions - before;
  }
  ASSERT_GT(turning, 60);
  // then nobody asks for another way until they are ended.
  EXPECT_EQ(asked, 0);
  EXPECT_EQ(told("around_done"), 1);
}

TEST_F(Detours, WhoHoldsItOnItsWayAroundAndLetsItGoOnSeesItGoOnFromThere) {
  drive_path();
  box_ahead(4.0);
  until_beside();
  // Given a pause while it is beside the box,
  ASSERT_TRUE(field.ask(PauseMission{}));
  field.run(3.0);
  EXPECT_FALSE(field.moves());
  EXPECT_FALSE(field.state()->detour);
  const double paused_m = field.at.north_m;
  // when it may go on,
  ASSERT_TRUE(field.ask(ResumeMission{}));
  double least_m = paused_m;
  for (int i = 0; i < 50 * 60 && told("around_done") == 0; ++i) {
    field.tick();
    least_m = std::min(least_m, field.at.north_m);
  }
  // then it does so from there, and not from before the box.
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_GT(least_m, paused_m - 0.5);
}

TEST_F(Detours, WhileItDrivesAroundNobodyIsToldThatThereIsNoWay) {
  drive_path();
  box_ahead(4.0);
  until_beside();
  // Given a way around that is driven, when a look finds none for some seconds,
  finds_none = true;
  for (int i = 0; i < 50 * 3 && told("around_done") == 0; ++i) {
    field.tick();
    // then it is not told beside the way that is shown.
    if (field.state()->detour) {
      EXPECT_EQ(told("no_way_around"), 0);
    }
  }
  finds_none = false;
  for (int i = 0; i < 50 * 60 && told("around_done") == 0; ++i) field.tick();
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_EQ(told("no_way_around"), 0);
}

TEST_F(Detours, WhereItIsHeldOnItsWayAroundItDoesNotSayAgainAndAgainThatThereIsNone) {
  drive_path();
  box_ahead(4.0);
  until_beside();
  // Given somebody who stands before it,
  nav::sense::Mover somebody;
  somebody.at = {pose.x_m + 0.9 * std::cos(pose.yaw_rad), pose.y_m + 0.9 * std::sin(pose.yaw_rad)};
  somebody.radius_m = 0.3;
  somebody.seen = field.now;
  walker = somebody;
  // when every other look finds a way, and every other none,
  for (int i = 0; i < 50 * 30; ++i) {
    finds_none = questions % 4 < 2;
    field.tick();
  }
  // then beginning the same way anew is no news: one other way, perhaps, and none once more.
  EXPECT_GE(told("no_way_around"), 1);
  EXPECT_LE(told("no_way_around"), 2);
}

TEST_F(Detours, AnAnswerThatComesTooLateIsNotDriven) {
  field.drive_mission();
  box_ahead(3.0);
  // Given a question whose answer takes its time,
  answers = false;
  for (int i = 0; i < 50 * 30 && questions == 0; ++i) field.tick();
  ASSERT_EQ(questions, 1);
  // when the robot was told to hold meanwhile, and goes on later,
  ASSERT_TRUE(field.ask(SetMode{Mode::Hold}));
  field.run(3.0);
  std::shared_ptr<const AroundAnswer> old = answer;
  ASSERT_TRUE(old);
  answer.reset();
  field.robot.around_answers().put(old);
  ASSERT_TRUE(field.ask(ResumeMission{}));
  field.run(0.5);
  // then that answer is of no use.
  EXPECT_EQ(told("going_around"), 0);
  EXPECT_FALSE(field.state()->detour);
}

TEST_F(Detours, TheEmergencyStopAndAnotherItemEndIt) {
  field.run(8.0);
  ASSERT_TRUE(field.load(plan_of({{0, 20}, {10, 20}})));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  field.run(5.0);
  box_ahead(4.0);
  until_beside();
  ASSERT_TRUE(field.ask(SkipItem{0}));
  field.run(0.1);
  EXPECT_FALSE(field.state()->detour) << "the operator's word counts";
  ASSERT_TRUE(field.ask(Estop{"a test"}));
  field.run(1.0);
  EXPECT_FALSE(field.moves());
}

TEST_F(Detours, WhatIsNoMissionWaitsAndClaimsNoMore) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Guided}));
  ASSERT_TRUE(field.ask(MoveBy{10.0, {}, {}, {}}));
  wall_at(4.0);
  field.run(20.0);
  EXPECT_EQ(questions, 0);
  const auto said = std::find_if(field.events.begin(), field.events.end(),
                                 [](const auto& e) { return e.kind == "blocked"; });
  ASSERT_NE(said, field.events.end());
  EXPECT_NE(said->detail.find("it waits until the way is clear"), std::string::npos);
}

TEST_F(Detours, AWayThatIsOnlyATurnIsTurnedOnceAndThenToldToBeNone) {
  // Given a box, and a way around it that is seen no farther than a turn on the spot,
  drive_path();
  only_turns = true;
  box_ahead(4.0);
  for (int i = 0; i < 50 * 40 && told("going_around") == 0; ++i) field.tick();
  ASSERT_EQ(told("going_around"), 1);
  const double before_rad = field.yaw_rad;
  const double north_m = driven_m();
  // when it has turned there and sees no more than before,
  double most_rad = 0.0;
  for (int i = 0; i < 50 * 12 && told("no_way_around") == 0; ++i) {
    field.tick();
    most_rad = std::max(most_rad, base::angle_diff_rad(before_rad, field.yaw_rad));
  }
  // then it says so, and has not driven.
  EXPECT_NEAR(base::deg_from_rad(most_rad), 60.0, 6.0);
  EXPECT_EQ(told("no_way_around"), 1);
  EXPECT_NEAR(driven_m(), north_m, 0.05);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
}

TEST_F(Detours, WhenTheTurnShowsAWayItIsDriven) {
  drive_path();
  only_turns = true;
  box_ahead(4.0);
  for (int i = 0; i < 50 * 40 && told("going_around") == 0; ++i) field.tick();
  only_turns = false;
  for (int i = 0; i < 50 * 90 && told("around_done") == 0; ++i) field.tick();
  EXPECT_EQ(told("going_around"), 2);
  EXPECT_EQ(told("around_done"), 1);
  EXPECT_EQ(told("no_way_around"), 0);
}

TEST_F(Detours, WithoutAWayItSaysSoOnceAndWaits) {
  field.drive_mission();
  wall_at(driven_m() + 3.0);  // across everything
  field.run(30.0);
  EXPECT_EQ(told("no_way_around"), 1);
  EXPECT_FALSE(field.moves());
  // The state says so as well, for whoever looks later.
  const auto said = std::ranges::find(field.events, "no_way_around", &base::Event::kind);
  const auto obstacle = field.state()->obstacle;
  ASSERT_TRUE(obstacle);
  ASSERT_NE(obstacle->no_way, "");
  EXPECT_EQ("no way around it: " + obstacle->no_way, said->detail);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
}

}  // namespace
}  // namespace roverd::robot
