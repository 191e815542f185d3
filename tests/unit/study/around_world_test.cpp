// Ways around in simulated worlds: whether there is one, and whether it is driven.

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "source_folder.hpp"
#include "study/world/passable.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

using sim::world::Body;
using sim::world::Kind;
using sim::world::Scene;
using sim::world::Thing;
using sim::world::Vec2;
using sim::world::World;

Thing wall(Vec2 from, Vec2 to) {
  Thing t;
  t.kind = Kind::Wall;
  t.thickness_m = 0.1;
  t.points = {from, to};
  return t;
}
Scene scene_of(std::vector<Thing> things) {
  World world;
  world.things = std::move(things);
  return Scene(std::move(world));
}
/// Across a way to the north, 5 m ahead, with a gap whose middle lies so far to its right.
Scene gap(double wide_m, double right_m = 0.0) {
  return scene_of({wall({-4.0, 5.0}, {right_m - 0.5 * wide_m, 5.0}),
                   wall({right_m + 0.5 * wide_m, 5.0}, {4.0, 5.0})});
}

const Body kBody = Body::rectangle(0.5, 0.5, 0.8, 0.5, 0.05);
const Passage kNorth{{0.0, 0.0}, {0.0, 10.0}, 3.0, 0.3};

TEST(Passable, WhereNothingStandsAndWhereAWallStandsAcross) {
  EXPECT_TRUE(passable(scene_of({}), kBody, kNorth));
  EXPECT_FALSE(passable(scene_of({wall({-4.0, 5.0}, {4.0, 5.0})}), kBody, kNorth));
}

TEST(Passable, AGapIsAsWideAsTheBodyAndItsRoom) {
  EXPECT_TRUE(passable(gap(1.45), kBody, kNorth));
  EXPECT_FALSE(passable(gap(1.35), kBody, kNorth));
  Passage narrow = kNorth;
  narrow.room_m = 0.1;
  EXPECT_TRUE(passable(gap(1.05), kBody, narrow));
  EXPECT_FALSE(passable(gap(0.95), kBody, narrow));
}

TEST(Passable, EveryPartOfTheBodyStaysInTheCorridor) {
  // Given a gap whose outer end is 0.7 m beyond its middle, which is 2.2 m aside,
  const Scene scene = gap(1.5, 2.2);
  // then a body of 0.8 m in its middle needs 2.6 m of corridor, and some for turning.
  Passage passage = kNorth;
  EXPECT_TRUE(passable(scene, kBody, passage));
  passage.side_m = 2.5;
  EXPECT_FALSE(passable(scene, kBody, passage));
}

TEST(Passable, ACornerThatTheBodyCannotTurnRoundIn) {
  // Given a passage that is wide enough to drive, and turns by a right angle,
  const auto corner = [](double wide_m) {
    return scene_of({wall({-0.5 * wide_m, -1.5}, {-0.5 * wide_m, 4.0 + wide_m}),
                     wall({0.5 * wide_m, -1.5}, {0.5 * wide_m, 4.0}),
                     wall({0.5 * wide_m, 4.0}, {2.6 - wide_m, 4.0}),
                     wall({-0.5 * wide_m, 4.0 + wide_m}, {2.6 - wide_m, 4.0 + wide_m}),
                     wall({2.6, 4.0}, {2.6, 4.0 + wide_m})});
  };
  // then it is passed where there is room to turn: 1.28 m across the body, and what it keeps.
  Passage passage = kNorth;
  passage.room_m = 0.05;
  EXPECT_TRUE(passable(corner(1.6), kBody, passage));
  EXPECT_FALSE(passable(corner(1.2), kBody, passage));
}

TEST(AroundWorld, TheNumberTellsWhatStandsThere) {
  const WorldOrder order = *parse_worlds("around:1");
  bool noisy = false;
  for (std::uint64_t number = 1; number <= 30; ++number) {
    const auto s = scenario_of(order, number, {}, {});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->kind, "around");
    EXPECT_EQ(s->world, scenario_of(order, number, {}, {})->world);
    ASSERT_TRUE(s->around_late_s);
    EXPECT_FALSE(s->sticks);
    ASSERT_GE(s->world.things.size(), 1U);
    // Something stands on the way, and nothing where it begins.
    EXPECT_LT(std::abs(s->world.things.front().points.front().x), 0.61);
    for (const Thing& t : s->world.things) EXPECT_GE(t.points.front().y, 4.0);
    noisy |= s->fault == "noise";
  }
  EXPECT_TRUE(noisy);
}

TEST(AroundWorld, ItIsDrivenAroundTwice) {
  // Given two things on the way, noise, and answers that take up to half a second,
  const auto scenario = scenario_of(*parse_worlds("around:1"), 5, {}, {});
  ASSERT_TRUE(scenario);
  study::Setup setup;
  setup.config = tests::in_source("config/robot.toml");
  setup.vehicle = "bunker";
  const auto run = run_world(setup, *scenario);
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_EQ(run->problem, "");
  // then it goes around both, and comes to the end.
  EXPECT_EQ(run->way, true);
  EXPECT_TRUE(run->finished);
  EXPECT_EQ(run->detours, 2U);
  EXPECT_TRUE(run->touches.empty());
  EXPECT_NE(to_table({*run}).find("1 of 1 worlds with a way that keeps 0.3 m were driven to the "
                                  "end, and 0 of 0 others"),
            std::string::npos);
}

}  // namespace
}  // namespace roverd::study
