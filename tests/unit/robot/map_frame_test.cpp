// Missions that count from a map, before the robot has found it, in it, and after it was laid anew.

#include "robot/map_frame.hpp"

#include "field.hpp"
#include "robot/compile.hpp"

namespace roverd::robot {
namespace {

using base::PlacePhase;

/// The shed's origin lies 10 m north of where the field's robot begins, its x axis looks north.
struct InShed : Field {
  PlacePhase phase = PlacePhase::Known;
  std::string map = "shed";
  std::string reason;
  bool says_cure = false;
  bool seen = true;  ///< its scanner tells something
  std::optional<base::MapLies> lies = base::MapLies{kFrame.to_global({0.0, 10.0}), base::kPi / 2.0};

  InShed() {
    more = [this] {
      if (!seen) return;
      base::PlaceState place;
      place.stamp = now;
      place.phase = phase;
      place.map = map;
      place.reason = reason;
      place.says_cure = says_cure;
      place.lies = lies;
      robot.measurements().put(place);
    };
  }
};

mission::Plan in_the_shed() {
  mission::Plan plan;
  plan.name = "shed";
  plan.frame = mission::MissionMap{"shed"};
  plan.items = {mission::MapPoint{.x_m = 4.0}, mission::MapPoint{.x_m = 4.0, .y_m = 3.0}};
  return plan;
}

std::string refused(const base::Result<void>& answer) {
  return answer ? "" : answer.error().detail;
}

//        2 ── 1       y ◀─┐  so lies the shed
//             │           │ x
//             robot
TEST(MapFrame, ItsPointsLieWhereTheMapDoes) {
  InShed f;
  f.run(8.0);
  const auto made = f.robot.compile({"m", 1, in_the_shed()});
  ASSERT_TRUE(made) << made.error().detail;
  const auto& nodes = (*made)->route.forth.nodes;
  ASSERT_EQ(nodes.size(), 2U);
  const auto first = kFrame.to_local((*made)->frame.to_global(nodes[0].at));
  const auto second = kFrame.to_local((*made)->frame.to_global(nodes[1].at));
  EXPECT_NEAR(first.east_m, 0.0, 1e-3);
  EXPECT_NEAR(first.north_m, 14.0, 1e-3);
  EXPECT_NEAR(second.east_m, -3.0, 1e-3);
  EXPECT_NEAR(second.north_m, 14.0, 1e-3);
}

TEST(MapFrame, IsNotLoadedWhereNobodyKnowsWhereItLies) {
  InShed f;
  const auto why = [&f] {
    f.run(1.0);
    const auto made = f.robot.compile({"m", 1, in_the_shed()});
    EXPECT_FALSE(made);
    return made ? "" : made.error().detail;
  };
  f.run(8.0);
  f.map = "yard";
  EXPECT_EQ(why(), "the mission counts from the map \"shed\": the map in use is \"yard\"");
  f.map = "shed";
  f.lies.reset();
  EXPECT_EQ(why(),
            "the mission counts from the map \"shed\": nobody knows where on the earth it lies");
  f.phase = PlacePhase::Searching;
  f.reason = "looking for the place in the map";
  EXPECT_EQ(
      why(),
      "the mission counts from the map \"shed\": the robot is not found in it yet (looking for "
      "the place in the map): drive some metres by hand, or say where it stands (a tap on the "
      "map)");
  f.phase = PlacePhase::Lost;
  f.reason = "lost: drive by hand to a known place, or tap where the robot is";
  f.says_cure = true;
  EXPECT_EQ(
      why(),
      "the mission counts from the map \"shed\": the robot is lost in it (lost: drive by hand "
      "to a known place, or tap where the robot is)")
      << "what to do is said once";
  f.phase = PlacePhase::Off;
  EXPECT_EQ(why(), "the mission counts from the map \"shed\": no map is in use");
}

//   Switched on indoors: no position at all, and the map is being looked for.
TEST(MapFrame, SaysOfARobotWithoutAPositionThatItsPlaceInTheMapIsMissing) {
  InShed f;
  f.gnss_speaks = false;
  f.phase = PlacePhase::Searching;
  f.run(3.0);
  const auto made = f.robot.compile({"m", 1, in_the_shed()});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, base::Code::Conflict);
  EXPECT_EQ(
      made.error().detail,
      "the mission counts from the map \"shed\": the robot is not found in it yet: drive some "
      "metres by hand, or say where it stands (a tap on the map)");
}

TEST(MapFrame, StartsAndGoesOnOnlyWhereTheRobotIsTrackedInIt) {
  InShed f;
  f.run(8.0);
  f.phase = PlacePhase::Searching;
  f.run(0.5);
  ASSERT_TRUE(f.load(in_the_shed()));
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_EQ(
      refused(f.ask(StartMission{"m", 1})),
      "the mission counts from the map \"shed\": the robot is not found in it yet: drive some "
      "metres by hand, or say where it stands (a tap on the map)");
  const auto told = f.robot.objections(StartMission{"m", 1});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, "not_in_map");
  f.phase = PlacePhase::Known;
  f.run(0.5);
  ASSERT_EQ(refused(f.ask(StartMission{"m", 1})), "");
  f.run(3.0);
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  ASSERT_TRUE(f.ask(PauseMission{}));
  f.map = "yard";
  f.run(0.5);
  EXPECT_EQ(refused(f.ask(ResumeMission{})),
            "the mission counts from the map \"shed\": the map in use is \"yard\"");
  f.map = "shed";
  f.run(0.5);
  EXPECT_EQ(refused(f.ask(ResumeMission{})), "");
}

TEST(MapFrame, IsLoadedAgainWhereTheMapWasLaidElsewhere) {
  InShed f;
  f.run(8.0);
  ASSERT_TRUE(f.load(in_the_shed()));
  ASSERT_TRUE(f.ask(Arm{}));
  f.lies->at = kFrame.to_global({0.0, 10.3});
  f.run(0.5);
  EXPECT_EQ(refused(f.ask(StartMission{"m", 1})),
            "the mission counts from the map \"shed\": it lies elsewhere by now than when the "
            "mission was loaded: load it again");
  ASSERT_TRUE(f.load(in_the_shed()));
  EXPECT_EQ(refused(f.ask(StartMission{"m", 1})), "");
}

//   The street first, by satellites, then the shed: nobody is asked to be in it from afar.
TEST(MapFrame, BeginsOutsideAndWaitsAtTheMapWhereItIsNotFound) {
  InShed f;
  f.run(8.0);
  f.phase = PlacePhase::Searching;
  f.run(0.5);
  mission::Plan plan = in_the_shed();
  mission::Waypoint street;
  street.at = kFrame.to_global({0.0, 5.0});
  plan.items.insert(plan.items.begin(), street);
  ASSERT_TRUE(f.load(plan));
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_TRUE(f.robot.objections(StartMission{"m", 1}).empty());
  ASSERT_EQ(refused(f.ask(StartMission{"m", 1})), "");
  f.run(25.0);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_TRUE(f.has_event("item_reached"));
  EXPECT_LT(f.at.north_m, 9.0) << "two seconds after the street's end it stands";
  EXPECT_NE(refused(f.ask(ResumeMission{})), "");
  f.phase = PlacePhase::Known;
  f.run(0.5);
  ASSERT_EQ(refused(f.ask(ResumeMission{})), "");
  f.run(60.0);
  EXPECT_EQ(f.execution(), ExecutionState::Finished);
}

TEST(MapFrame, StandsWhereTheMapTurnsOutToLieElsewhere) {
  InShed f;
  f.run(8.0);
  ASSERT_TRUE(f.load(in_the_shed()));
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_EQ(refused(f.ask(StartMission{"m", 1})), "");
  f.run(3.0);
  ASSERT_TRUE(f.moves());
  f.lies->at = kFrame.to_global({0.3, 10.0});
  f.run(5.0);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_FALSE(f.moves());
}

TEST(MapFrame, WhatWasSeenLongAgoIsNotWhereItIs) {
  InShed f;
  f.run(8.0);
  ASSERT_TRUE(f.load(in_the_shed()));
  ASSERT_TRUE(f.ask(Arm{}));
  f.seen = false;
  f.run(10.0);
  EXPECT_EQ(refused(f.ask(StartMission{"m", 1})),
            "the mission counts from the map \"shed\": nothing was seen in it for 10 s");
  EXPECT_EQ(f.robot.objections(StartMission{"m", 1}).size(), 1U);
}

TEST(MapFrame, ARefusedWordToGoOnAfterARestartLoadsNothing) {
  InShed f;
  f.run(8.0);
  const auto made = f.robot.compile({"m", 1, in_the_shed()});
  ASSERT_TRUE(made);
  ASSERT_TRUE(f.ask(Arm{}));
  f.phase = PlacePhase::Searching;
  f.run(0.5);
  EXPECT_NE(refused(f.ask(ResumeAt{*made, {}})), "");
  EXPECT_FALSE(f.robot.loaded());
  f.phase = PlacePhase::Known;
  f.run(0.5);
  EXPECT_EQ(refused(f.ask(ResumeAt{*made, {}})), "");
  EXPECT_EQ(f.execution(), ExecutionState::Running);
}

TEST(MapFrame, TheRobotIsFoundInItByWhatIsSeenNow) {
  const base::Time now{std::chrono::seconds(100)};
  base::PlaceState place;
  place.stamp = now;
  place.phase = PlacePhase::Known;
  place.map = "shed";
  place.in_map = base::MapPlace{4.0, 1.5, 0.0};
  const auto why = [&](const std::optional<base::PlaceState>& seen) {
    const auto found = found_in({"shed"}, seen, now);
    return found ? "" : found.error().detail;
  };
  // Wherever it lies, also nowhere.
  ASSERT_EQ(why(place), "");
  EXPECT_EQ(found_in({"shed"}, place, now)->x_m, 4.0);
  EXPECT_NE(why({}).find("no map is in use"), std::string::npos);
  place.stamp = now - std::chrono::seconds(5);
  EXPECT_NE(why(place).find("nothing was seen in it for 5 s"), std::string::npos);
  place.phase = PlacePhase::Searching;
  EXPECT_NE(why(place).find("the robot is not found in it yet"), std::string::npos);
  place.map = "yard";
  EXPECT_NE(why(place).find("the map in use is \"yard\""), std::string::npos);
}

}  // namespace
}  // namespace roverd::robot
