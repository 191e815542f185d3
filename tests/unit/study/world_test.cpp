// Drives through simulated worlds: what --world says, what reaches the robot's eyes, and what the
// referee counts.

#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "sick/sight.hpp"
#include "sim/eyes.hpp"
#include "sim/world/random.hpp"
#include "source_folder.hpp"
#include "study/world/comers.hpp"
#include "study/world/eyes.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

TEST(WorldOrderTest, AFileANumberOfWorldsOrOpenFields) {
  const auto file = parse_worlds("config/worlds/yard.json");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->kind, WorldOrder::Kind::File);
  EXPECT_EQ(file->file, "config/worlds/yard.json");

  const auto random = parse_worlds("random:2000");
  ASSERT_TRUE(random);
  EXPECT_EQ(random->kind, WorldOrder::Kind::Random);
  EXPECT_EQ(random->count, 2000);
  EXPECT_EQ(random->seed, 1U);

  const auto open = parse_worlds("open:20:7");
  ASSERT_TRUE(open);
  EXPECT_EQ(open->kind, WorldOrder::Kind::Open);
  EXPECT_EQ(open->count, 20);
  EXPECT_EQ(open->seed, 7U);

  const auto crossing = parse_worlds("crossing:5:9");
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->kind, WorldOrder::Kind::Crossing);
  EXPECT_EQ(crossing->count, 5);

  const auto turning = parse_worlds("turning:6:3");
  ASSERT_TRUE(turning);
  EXPECT_EQ(turning->kind, WorldOrder::Kind::Turning);
  EXPECT_EQ(turning->count, 6);
  EXPECT_EQ(turning->seed, 3U);

  const auto around = parse_worlds("around:4:2");
  ASSERT_TRUE(around);
  EXPECT_EQ(around->kind, WorldOrder::Kind::Around);
  EXPECT_EQ(around->count, 4);
  EXPECT_EQ(around->seed, 2U);
}

TEST(ScenarioTest, PeopleCrossTheCourse) {
  for (std::uint64_t number = 1; number <= 20; ++number) {
    const auto s = scenario_of(*parse_worlds("crossing:1"), number, {}, {});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->kind, "crossing");
    int people = 0;
    for (const auto& thing : s->world.things) {
      if (!sim::world::moves(thing.kind)) continue;
      ++people;
      EXPECT_EQ(thing.kind, sim::world::Kind::Person);
      EXPECT_GE(thing.speed_mps, 0.5);
      EXPECT_LE(thing.speed_mps, 2.0);
    }
    EXPECT_GE(people, 2);
    EXPECT_LE(people, 4);
  }
}

TEST(ScenarioTest, PeopleWanderAboutTheCourseAndTurnByNoMoreThanARightAngle) {
  for (std::uint64_t number = 1; number <= 20; ++number) {
    const auto s = scenario_of(*parse_worlds("turning:1"), number, {}, {});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->kind, "turning");
    int people = 0;
    for (const auto& thing : s->world.things) {
      if (!sim::world::moves(thing.kind)) continue;
      ++people;
      ASSERT_GE(thing.points.size(), 7U);
      for (std::size_t i = 2; i < thing.points.size(); ++i) {
        const auto before = thing.points[i - 1] - thing.points[i - 2];
        const auto after = thing.points[i] - thing.points[i - 1];
        EXPECT_GE(dot(before, after), -1e-9) << number;
      }
    }
    EXPECT_GE(people, 3);
    EXPECT_LE(people, 5);
  }
}

TEST(WorldOrderTest, NonsenseIsNamed) {
  for (const char* text :
       {"", "random:", "random:0", "random:100001", "random:x", "random:5:", "random:5:x",
        "random:5:1:2", "random:-5", "open:", "open:5 ", "around:x"}) {
    const auto order = parse_worlds(text);
    ASSERT_FALSE(order) << text;
    EXPECT_NE(order.error().detail.find("--world"), std::string::npos) << order.error().detail;
  }
}

TEST(ScenarioTest, TheNumberTellsAllOfIt) {
  const WorldOrder order = *parse_worlds("random:1");
  for (const std::uint64_t number : {std::uint64_t{3}, std::uint64_t{4}, std::uint64_t{5}}) {
    const auto one = scenario_of(order, number, {}, {});
    const auto two = scenario_of(order, number, {}, {});
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->world, two->world);
    EXPECT_EQ(one->course.points, two->course.points);
    EXPECT_EQ(one->speed_mps, two->speed_mps);
    EXPECT_EQ(one->fault, two->fault);
  }
}

TEST(ScenarioTest, AllSpeedsAllWaysAndFaultsOccur) {
  const WorldOrder order = *parse_worlds("random:200");
  std::map<double, int> speeds;
  std::map<std::string, int> faults;
  int sticks = 0;
  int backwards = 0;
  int lidars = 0;
  for (std::uint64_t number = 1; number <= 200; ++number) {
    const auto s = scenario_of(order, number, {}, {});
    ASSERT_TRUE(s);
    ++speeds[s->speed_mps];
    ++faults[s->fault];
    sticks += s->sticks ? 1 : 0;
    backwards += !s->sticks && s->course.reverse ? 1 : 0;
    lidars += s->lidar ? 1 : 0;
  }
  EXPECT_EQ(speeds.size(), 3U);
  EXPECT_EQ(faults.size(), 8U) << "none, rain, dust, dropouts, sun, dirt, noise, dead";
  EXPECT_GT(sticks, 40);
  EXPECT_GT(backwards, 25);
  EXPECT_GT(lidars, 25);
}

TEST(ScenarioTest, ACourseWithoutPointsIsRefused) {
  Course course;
  course.name = "mission";
  const auto s = scenario_of(*parse_worlds("random:1"), 1, {course}, {});
  ASSERT_FALSE(s);
  EXPECT_NE(s.error().detail.find("mission"), std::string::npos);
}

/// A sweep of a scanner two metres before a wall, in the rain.
sim::world::Sweep a_sweep(const sim::world::SensorParams& p) {
  sim::world::World world;
  sim::world::Thing wall;
  wall.kind = sim::world::Kind::Wall;
  wall.points = {{2.0, -3.0}, {2.0, 3.0}};
  world.things.push_back(wall);
  const sim::world::Scene scene(world);
  sim::world::Sensor sensor(p, 1);
  sim::world::SensorFaults faults;
  faults.rain_per_m = 0.02;
  sim::world::Sweep sweep;
  sensor.sweep(
      scene, [](double) { return sim::world::Pose{}; }, faults, sweep);
  return sweep;
}

//   shots ─▶ scan_of ───────────────────────────────▶ Sight
//        └─▶ telegram ─▶ bytes ─▶ the driver's codec ─▶ the same
TEST(WorldEyeTest, AScanIsWhatItsBytesWouldTell) {
  const EyeSetup front = usual_eyes({}, false).front();
  const sim::world::Sweep sweep = a_sweep(front.seen);
  const base::Sight direct = scan_of(front.seen, sweep, 8.0);

  sim::LmsVoice voice(front.seen, 0.0);
  sick::Writer on(sick::Dialect::B, "sEN", "LMDscandata");
  on.u8(1);
  (void)voice.receive(on.framed());
  const auto bytes = voice.say(sweep, {});
  ASSERT_FALSE(bytes.empty());
  std::optional<base::Sight> heard;
  sick::Framer framer;
  framer.feed(bytes, [&](const sick::Telegram& t) {
    const auto scan = sick::decode_scan(t);
    ASSERT_TRUE(scan) << scan.error().detail;
    const auto sight = sick::to_sight(*scan, {90.0, 8.0});
    ASSERT_TRUE(sight) << sight.error().detail;
    heard = *sight;
  });
  ASSERT_TRUE(heard);
  ASSERT_EQ(direct.points.size(), 541U);
  ASSERT_EQ(heard->points.size(), direct.points.size());
  EXPECT_NEAR(direct.half_step_rad, heard->half_step_rad, 1e-6F);
  EXPECT_EQ(direct.window, heard->window);
  for (std::size_t i = 0; i < direct.points.size(); ++i) {
    const base::SightPoint& a = direct.points[i];
    const base::SightPoint& b = heard->points[i];
    ASSERT_EQ(a.echo, b.echo) << i;
    ASSERT_NEAR(a.x_m, b.x_m, 1e-3F) << i;
    ASSERT_NEAR(a.y_m, b.y_m, 1e-3F) << i;
    ASSERT_NEAR(a.after_s, b.after_s, 1e-5F) << i;
  }
}

Setup setup_of() {
  Setup setup;
  setup.config = tests::in_source("config/robot.toml");
  setup.vehicle = "bunker";
  return setup;
}

/// Straight to the north at 1 m/s, and what stands there.
Scenario ahead(const std::string& things) {
  Scenario s;
  const auto world = sim::world::read_world(R"({"things": [)" + things + "]}");
  EXPECT_TRUE(world) << world.error().detail;
  if (world) s.world = *world;
  s.kind = "file";
  s.fault = "none";
  s.course.name = "straight";
  s.course.points = {{0, 0}, {0, 12}};
  s.course.speed_mps = 1.0;
  s.time_s = 14.0;
  return s;
}

TEST(WorldRunTest, StandsBeforeAWallAndTouchesNothing) {
  const auto run = run_world(
      setup_of(), ahead(R"({"kind": "wall", "points": [[-3, 6], [3, 6]], "height_m": 1})"));
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_EQ(run->problem, "");
  EXPECT_TRUE(run->touches.empty());
  ASSERT_EQ(run->stops.size(), 1U);
  EXPECT_EQ(run->stops[0].what, "obstacle");
  EXPECT_EQ(run->stops[0].cause, "thing");
  EXPECT_FALSE(run->stops[0].needless);
  ASSERT_TRUE(run->stops[0].stands_m);
  EXPECT_GE(*run->stops[0].stands_m, 0.05);
  EXPECT_LE(*run->stops[0].stands_m, 0.40);
  EXPECT_EQ(run->stops[0].thing, "wall 0");
  // The wall's near side at 5.9 m, half of the vehicle 0.51 m.
  EXPECT_NEAR(run->driven_m, 5.9 - 0.51 - *run->stops[0].stands_m, 0.1);
}

//   The scanners look over a beam that lies on the ground; the body does not.
TEST(WorldRunTest, WhatNoSensorSeesIsTouchedAndSaidSo) {
  const auto run = run_world(
      setup_of(),
      ahead(R"({"kind": "box", "at": [0, 4], "length_m": 2, "width_m": 0.2, "height_m": 0.15})"));
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_EQ(run->touches[0].blame, Blame::Unseen);
  EXPECT_NEAR(run->touches[0].speed_mps, 1.0, 0.2);
}

//   Over a bump the scanners' plane tips up and meets the far part of a bar for a moment; level
//   again it passes beneath, and the near part is touched, which no beam ever met.
TEST(WorldRunTest, WhatHangsAboveThePlaneOfItsScannersIsNoContactThatBrakesWouldHaveSpared) {
  Scenario s = ahead(
      R"({"kind": "bar", "points": [[0.2, 6.8], [-1.5, 9.8]], "height_m": 0.1, "bottom_m": 0.36})");
  s.world.ground.bumps = {{{0.0, 1.2}, 0.5, 0.015}};
  const auto run = run_world(setup_of(), s);
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_EQ(run->touches[0].blame, Blame::Unseen);
  EXPECT_GT(run->touches[0].beams, 0U);
}

//   Of a wall that is seen from end to end, any place is in sight: a guard that believes in better
//   brakes than there are touches it, and that is its own contact.
TEST(WorldRunTest, WhatWasSeenWhereItIsTouchedIsTheRobotsOwnContact) {
  study::Setup blunt = setup_of();
  blunt.sim_overrides = {"drive.decel_mps2=0.2"};
  const auto run =
      run_world(blunt, ahead(R"({"kind": "wall", "points": [[-3, 6], [3, 6]], "height_m": 1})"));
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_EQ(run->touches[0].blame, Blame::Ours);
  EXPECT_GT(run->touches[0].seen_before_s, 2.0);
}

//   A bar 1 cm above the plane: from afar, where beams are thick, they meet it; from nearby all go
//   beneath it, and so does what the robot remembers of it.
TEST(WorldRunTest, WhatIsLookedBeneathFromNearbyLiesBesideThePlane) {
  const auto run =
      run_world(setup_of(), ahead(R"({"kind": "bar", "points": [[-2, 7], [2, 7]], "height_m": 0.07,
                            "bottom_m": 0.31})"));
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_EQ(run->touches[0].blame, Blame::Beside);
  EXPECT_GT(run->touches[0].beams, 100U);
  EXPECT_GT(run->touches[0].seen_before_s, 1.0);
}

//   It stops for what it would pass beneath, for the guard lets nothing pass so low above it: the
//   room before that is told all the same.
TEST(WorldRunTest, TheRoomBeforeWhatHangsOverTheBodyIsMeasured) {
  Scenario s = ahead(R"({"kind": "bar", "points": [[-2, 7], [2, 7]], "height_m": 0.3,
                         "bottom_m": 0.52})");
  s.lidar = true;
  const auto run = run_world(setup_of(), s);
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_TRUE(run->touches.empty());
  ASSERT_FALSE(run->stops.empty());
  ASSERT_TRUE(run->stops[0].stands_m);
  EXPECT_GE(*run->stops[0].stands_m, 0.05);
  EXPECT_LE(*run->stops[0].stands_m, 0.6);
}

//   A lidar meets a flat thing for seconds; by the settings it rises no higher than grass may.
TEST(WorldRunTest, WhatRisesNoHigherThanGrassIsNoContactThatBrakesWouldHaveSpared) {
  Scenario s =
      ahead(R"({"kind": "box", "at": [0, 5], "length_m": 2, "width_m": 1.5, "height_m": 0.22})");
  s.lidar = true;
  study::Setup in_grass = setup_of();
  in_grass.overrides = {"sense.ground.min_height_m=0.2", "sense.ground.rough_m=0.1"};
  const auto run = run_world(in_grass, s);
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_GT(run->touches[0].beams, 100U);
  EXPECT_EQ(run->touches[0].blame, Blame::Beside);
}

Scenario crossed() {
  return ahead(R"({"kind": "person", "path": [[-4, 6], [4, 6]],
      "speed_mps": 1.3, "motion": "once", "start_s": 10.25})");
}

//   Who walks into the way was in sight for long: standing there by then, it would not be touched.
TEST(WorldRunTest, WhoWalksIntoTheWayOfARobotThatSawHimIsItsOwnContactAndSaidToHaveCrossed) {
  study::Setup blunt = setup_of();
  blunt.overrides = {"sense.protect.foresee_s=0"};
  const auto run = run_world(blunt, crossed());
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  const TouchSeen& touch = run->touches[0];
  EXPECT_EQ(touch.blame, Blame::Ours);
  EXPECT_TRUE(touch.crossed);
  EXPECT_NEAR(touch.seen_before_s, 2.5, 0.3);  // since he set out
  EXPECT_LE(touch.way_m, touch.needed_m);
}

TEST(ComersTest, AnEdgeThatGoesAwayDoesNotComeNearer) {
  const std::vector<sim::world::Vec2> body{{0.5, -0.4}, {0.5, 0.4}, {-0.5, 0.4}, {-0.5, -0.4}};
  const auto nears = [&](sim::world::Vec2 place, double v_mps, double w_radps) {
    return nears_mps(body, place, {v_mps, w_radps});
  };
  EXPECT_NEAR(nears({0.8, 0.1}, 0.5, 0.0), 0.5, 1e-9);
  EXPECT_NEAR(nears({0.8, 0.1}, -0.5, 0.0), -0.5, 1e-9);
  EXPECT_NEAR(nears({0.1, 0.7}, 1.0, 0.0), 0.0, 1e-9);  // along his side
  // Turning to the left, the left side's front half comes to him, and its rear half leaves.
  EXPECT_NEAR(nears({0.4, 0.7}, 0.0, 0.5), 0.2, 1e-9);
  EXPECT_NEAR(nears({-0.4, 0.7}, 0.0, 0.5), -0.2, 1e-9);
}

TEST(ComersTest, HeSetsOutWhereHeStoodOrTurnedBack) {
  sim::world::Thing who;
  who.kind = sim::world::Kind::Person;
  who.points = {{0, 0}, {4, 0}};
  who.speed_mps = 1.0;
  who.start_s = 3.0;
  who.pause_s = 2.0;  // there at 7, back from 9 to 13, and again from 15
  EXPECT_EQ(set_out_s(who, 2.0), 0.0);
  EXPECT_NEAR(set_out_s(who, 5.0), 3.0, 0.05);
  EXPECT_NEAR(set_out_s(who, 8.5), 3.0, 0.05);  // he stands where that led
  EXPECT_NEAR(set_out_s(who, 11.0), 9.0, 0.05);
  who.pause_s = 0.0;
  EXPECT_NEAR(set_out_s(who, 9.0), 7.0, 0.05);
}

//   He stands beside the way, in sight all the while, and then walks into the robot's side.
TEST(WorldRunTest, WhoSetsOutTooLateForAnyBrakesIsNotTheRobotsOwnContact) {
  study::Setup blunt = setup_of();
  blunt.overrides = {"sense.protect.foresee_s=0"};
  const auto run = run_world(blunt, ahead(R"({"kind": "person", "path": [[-1.2, 4], [2, 4]],
      "speed_mps": 1.6, "motion": "once", "start_s": 10.6})"));
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_FALSE(run->touches.empty());
  EXPECT_EQ(run->touches[0].blame, Blame::Late);
  EXPECT_LT(run->touches[0].seen_before_s, 0.7);
  EXPECT_GT(run->touches[0].beams, 1000U);
}

TEST(WorldRunTest, WhoIsForeseenToWalkIntoTheWayIsNotTouched) {
  const auto run = run_world(setup_of(), crossed());
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_TRUE(run->touches.empty());
  EXPECT_GT(run->driven_m, 4.0);  // on its way
}

//   The room is to be 0.05 to 0.40 m: what stands at either end of that is right.
TEST(WorldReport, CountsWhoStandsTooNearAndTooFar) {
  WorldRun run;
  for (const double room_m : {0.049, 0.05, 0.3, 0.4, 0.401, 1.0}) {
    StopSeen stop;
    stop.cause = "thing";
    stop.stands_m = room_m;
    run.stops.push_back(stop);
  }
  const std::string table = to_table({run});
  const std::string all = table.substr(table.rfind("\nall"));
  std::istringstream words(all.substr(all.find("0.05/")));
  std::string rooms;
  int of = 0, near = 0, far = 0;
  words >> rooms >> of >> near >> far;
  EXPECT_EQ(rooms, "0.05/0.37/1.00");
  EXPECT_EQ(of, 6);
  EXPECT_EQ(near, 1);
  EXPECT_EQ(far, 2);
}

TEST(WorldRunTest, TheSameNumberDrivesTheSame) {
  auto scenario = scenario_of(*parse_worlds("random:1"), 6, {}, {});
  ASSERT_TRUE(scenario);
  scenario->time_s = 4.0;
  const auto one = run_world(setup_of(), *scenario);
  const auto two = run_world(setup_of(), *scenario);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(to_json({*one}, setup_of()), to_json({*two}, setup_of()));
  EXPECT_NE(to_table({*one}).find("all"), std::string::npos);
}

}  // namespace
}  // namespace roverd::study
