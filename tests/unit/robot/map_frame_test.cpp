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
  std::optional<base::MapLies> lies = base::MapLies{kFrame.to_global({0.0, 10.0}), base::kPi / 2.0};

  InShed() {
    more = [this] {
      base::PlaceState place;
      place.stamp = now;
      place.phase = phase;
      place.map = map;
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
            "the mission counts from the map \"shed\": where it lies is not known before the robot "
            "is found in it");
  f.phase = PlacePhase::Off;
  EXPECT_EQ(why(), "the mission counts from the map \"shed\": no map is in use");
}

TEST(MapFrame, StartsAndGoesOnOnlyWhereTheRobotIsTrackedInIt) {
  InShed f;
  f.run(8.0);
  f.phase = PlacePhase::Searching;
  f.run(0.5);
  ASSERT_TRUE(f.load(in_the_shed()));
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_EQ(refused(f.ask(StartMission{"m", 1})),
            "the mission counts from the map \"shed\": where the robot is in it is not known");
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

}  // namespace
}  // namespace roverd::robot
