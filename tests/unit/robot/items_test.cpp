// Items beside waypoints, what follows an item that cannot be reached, and a mission that goes on
// after a restart.

#include "field.hpp"

namespace roverd::robot {
namespace {

mission::Plan items(std::vector<mission::Item> list) {
  mission::Plan plan;
  plan.name = "items";
  plan.home = mission::Home{kFrame.origin(), {}};
  plan.items = std::move(list);
  return plan;
}

struct Worker : Field {
  explicit Worker(const Config& config = {}) : Field(config) { run(8.0); }
  void go(const mission::Plan& plan) {
    const auto loaded = load(plan);
    ASSERT_TRUE(loaded) << loaded.error().detail;
    ASSERT_TRUE(ask(Arm{}));
    const auto started = ask(StartMission{"m", 1});
    ASSERT_TRUE(started) << started.error().detail;
  }
  bool done(double limit_s) {
    for (double t = 0.0; t < limit_s && execution() == ExecutionState::Running; t += 0.5) run(0.5);
    return execution() == ExecutionState::Finished;
  }
  std::string told(const std::string& kind) const {
    std::string text;
    for (const auto& e : events) {
      if (e.kind == kind) text += e.detail + "\n";
    }
    return text;
  }
};

TEST(Items, LocalPosesMovesTurnsAndActionsAreDriven) {
  Worker f;
  mission::Action action;
  action.name = "set_home";
  f.go(items({mission::Local{3.0, 4.0, 90.0}, action, mission::Move{2.0},
              mission::TurnBy{-90.0, {}}, mission::Move{-1.0}, mission::TurnBy{{}, 180.0}}));
  ASSERT_TRUE(f.done(120.0)) << f.state()->mission.reason;
  // At (3, 4) it faced east, went 2 m, turned north, backed 1 m.
  EXPECT_NEAR(f.at.east_m, 5.0, 0.15);
  EXPECT_NEAR(f.at.north_m, 3.0, 0.15);
  // Within the first 10 s of driving nothing has proved the positions: the course turns the heading
  // less.
  EXPECT_NEAR(base::heading_from_yaw(f.yaw_rad), 180.0, 4.0);
  EXPECT_EQ(f.told("action"), "item 2: set_home\n");
  EXPECT_EQ(f.told("item_reached"),
            "item 1 reached\nitem 3 reached\nitem 4 reached\nitem 5 reached\nitem 6 reached\n");
}

/// The name is nobody's; the others are told, so that a slip shows.
TEST(Items, AnEndBesideAPlaceThatNobodyEnteredNamesThePlace) {
  Worker f;
  mission::Row row;
  row.until.place = "gate";
  const auto why = [&f, &row] {
    const auto made = f.robot.compile({"m", 1, items({row})});
    EXPECT_FALSE(made);
    return made ? base::Error{} : made.error();
  };
  EXPECT_EQ(why().fields.at(0).pointer, "/items/0/until_place");
  EXPECT_EQ(why().detail,
            "item 1 ends at \"gate\", which nobody has entered as a known place; none is");
  base::KnownPlace pole;
  pole.name = "pole";
  pole.at = kFrame.origin();
  f.robot.know(std::make_shared<const std::vector<base::KnownPlace>>(1, pole));
  EXPECT_EQ(why().detail,
            "item 1 ends at \"gate\", which nobody has entered as a known place; known are: pole");
}

/// Nothing here pumps: the mission is not driven as if something did.
TEST(Items, AnActionThatNobodyDoesIsRefusedWithItsItem) {
  Worker f;
  mission::Action pump;
  pump.name = "pump_on";
  mission::Action home;
  home.name = "set_home";
  const auto refused = f.load(items({mission::Local{3.0, 4.0, {}}, home, pump}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Invalid);
  ASSERT_EQ(refused.error().fields.size(), 1u);
  EXPECT_EQ(refused.error().fields[0].pointer, "/items/2");
  EXPECT_EQ(refused.error().detail,
            "item 3 asks for the action \"pump_on\", which nothing here does; built in: set_home");
  EXPECT_EQ(f.execution(), ExecutionState::Idle);
}

TEST(Items, AMoveGoesOnWithWhatIsLeftAfterAPause) {
  Worker f;
  f.go(items({mission::Move{6.0}}));
  f.run(12.0);
  ASSERT_TRUE(f.ask(PauseMission{}));
  f.run(2.0);
  EXPECT_GT(f.at.north_m, 1.0);
  EXPECT_LT(f.at.north_m, 5.0);
  ASSERT_TRUE(f.ask(ResumeMission{}));
  ASSERT_TRUE(f.done(60.0));
  EXPECT_NEAR(f.at.north_m, 6.0, 0.1);
}

TEST(Items, GoalsAreCutWhereTheParametersAskForIt) {
  Config config;
  config.modes.goal_cut_m = 3.0;
  Worker f(config);
  f.go(plan_of({{0, 12}, {6, 12}}));
  ASSERT_TRUE(f.done(90.0)) << f.state()->mission.reason;
  EXPECT_LT(base::distance_m(f.at, {6, 12}), 1.2);
}

/// Stuck on the way to item 1.
void get_stuck(Worker& f) {
  f.run(3.0);
  f.obeys = false;
  f.does = {0.0, 0.0};
  f.run(0.1);
}

Config patient(const char* rule) {
  Config config;
  config.behave.unreachable = rule;
  config.behave.stuck_s = 3.0;
  config.safety.follow_timeout_s = 10.0;
  return config;
}

TEST(Items, OneThatCannotBeReachedIsHandledByRule) {
  {
    Worker f(patient("stop"));
    f.go(plan_of({{0, 10}, {5, 10}}));
    get_stuck(f);
    f.run(5.0);
    EXPECT_EQ(f.execution(), ExecutionState::Blocked);
  }
  {
    Worker f(patient("skip"));
    f.go(plan_of({{0, 10}, {5, 3}}));
    get_stuck(f);
    f.run(4.0);
    EXPECT_EQ(f.state()->mission.current_item, 2);
    f.obeys = true;
    ASSERT_TRUE(f.done(60.0)) << f.state()->mission.reason;
    EXPECT_LT(base::distance_m(f.at, {5, 3}), 0.2);
    EXPECT_NE(f.told("item_missed").find("item 1 left out: no progress"), std::string::npos);
  }
  {
    Worker f(patient("return"));
    f.go(plan_of({{0, 10}, {5, 10}}));
    get_stuck(f);
    f.run(4.0);
    f.obeys = true;
    f.run(40.0);
    EXPECT_EQ(f.execution(), ExecutionState::Aborted);
    EXPECT_LT(base::distance_m(f.at, {0, 0}), 0.3);
    EXPECT_NE(f.state()->mission.reason.find("returned home"), std::string::npos);
  }
}

//   1 ──────▶ 2     another robot object takes over at ✕, as after a restart
//             │
//   4 ◀──✕─── 3
TEST(Items, AMissionGoesOnAfterARestart) {
  mission::Plan plan = plan_of({{0, 6}, {6, 6}, {6, 0}, {0, 0}});
  plan.items.emplace_back(mission::Jump{1, 2});
  std::optional<base::MissionPlace> place;
  base::EnuPoint at;
  double yaw_rad = 0.0;
  {
    Worker f;
    f.go(plan);
    while (f.state()->mission.current_item != 4) f.run(0.5);
    f.run(2.0);
    place = f.state()->mission.place;
    at = f.at;
    yaw_rad = f.yaw_rad;
    ASSERT_TRUE(place);
  }
  Field f;
  f.at = at;
  f.yaw_rad = yaw_rad;
  f.run(8.0);
  auto compiled = f.robot.compile({"m", 1, plan});
  ASSERT_TRUE(compiled);
  const auto unarmed = f.ask(ResumeAt{*compiled, *place});
  ASSERT_FALSE(unarmed);
  EXPECT_EQ(f.robot.loaded(), nullptr);  // refused, and not half done
  ASSERT_TRUE(f.ask(Arm{}));
  const auto resumed = f.ask(ResumeAt{*compiled, *place});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_EQ(f.state()->mission.current_item, 4);
  const double north_m = f.at.north_m;
  f.run(3.0);
  EXPECT_LT(std::abs(f.at.north_m - north_m), 0.3);  // on along the same side
  for (int i = 0; i < 400 && f.execution() == ExecutionState::Running; ++i) f.run(0.5);
  EXPECT_EQ(f.execution(), ExecutionState::Finished);
  int laps = 0;
  for (const auto& e : f.events) laps += e.detail == "item 2 reached" ? 1 : 0;
  EXPECT_EQ(laps, 2);
}

TEST(Items, APlaceOfAnotherMissionIsRefused) {
  Worker f;
  ASSERT_TRUE(f.ask(Arm{}));
  auto compiled = f.robot.compile({"m", 1, plan_of({{0, 6}})});
  ASSERT_TRUE(compiled);
  base::MissionPlace place;
  place.step = 7;
  EXPECT_FALSE(f.ask(ResumeAt{*compiled, place}));
  place.step = 0;
  place.s_m = std::nan("");
  EXPECT_FALSE(f.ask(ResumeAt{*compiled, place}));
  EXPECT_EQ(f.robot.loaded(), nullptr);
}

}  // namespace
}  // namespace roverd::robot
