// Rays against what was worked out by hand, and against every shape in turn.

#include <numbers>

#include <gtest/gtest.h>

#include "sim/world/random.hpp"
#include "world_scene.hpp"

namespace roverd::sim::world {
namespace {

constexpr double kPi = std::numbers::pi;

//   o ───▶ (  )     radius 0.5, middle 5 m away
TEST(Rays, MeetAPoleWhereItsRoundBegins) {
  const Scene scene(world_of({pole({5, 0}, 0.5)}));
  const Hit straight = cast(scene, {0, 0, 1}, {1, 0, 0});
  EXPECT_NEAR(straight.range_m, 4.5, 1e-12);
  EXPECT_EQ(straight.thing, 0);
  EXPECT_NEAR(straight.cosine, 1.0, 1e-12);
  const Hit aside = cast(scene, {0, 0.3, 1}, {1, 0, 0});
  EXPECT_NEAR(aside.range_m, 5.0 - std::sqrt(0.25 - 0.09), 1e-12);
  EXPECT_NEAR(aside.cosine, 0.8, 1e-12);
  EXPECT_FALSE(cast(scene, {0, 0.51, 1}, {1, 0, 0}).any());
  EXPECT_FALSE(cast(scene, {0, 0, 1}, {1, 0, 0}, 4.49).any()) << "farther than asked for";
}

TEST(Rays, PassOverAPoleAndFallOnItsTop) {
  const Scene scene(world_of({pole({5, 0}, 0.5, 1.0)}));
  EXPECT_FALSE(cast(scene, {0, 0, 1.01}, {1, 0, 0}).any());
  const Hit top = cast(scene, {5.2, 0, 3}, {0, 0, -1});
  EXPECT_NEAR(top.range_m, 2.0, 1e-12);
  EXPECT_EQ(top.cosine, 1.0);
  EXPECT_NEAR(cast(scene, {5.6, 0, 3}, {0, 0, -1}).range_m, 3.0, 1e-9) << "beside it: ground";
}

TEST(Rays, MeetTheNearFaceOfATurnedBox) {
  // Turned by 45 degrees, its edge shows: half a diagonal before the middle.
  const Scene scene(world_of({box({4, 0}, 2, 2, 1, kPi / 4)}));
  EXPECT_NEAR(cast(scene, {0, 0, 0.5}, {1, 0, 0}).range_m, 4.0 - std::sqrt(2.0), 1e-9);
  const Hit face = cast(scene, {0, 0.5, 0.5}, {1, 0, 0});
  EXPECT_NEAR(face.range_m, 4.0 - std::sqrt(2.0) + 0.5, 1e-9);
  EXPECT_NEAR(face.cosine, std::sqrt(0.5), 1e-9);
}

TEST(Rays, MeetAConeOnItsSlantAndMissItAboveItsPoint) {
  Thing cone = thing(Kind::Cone, {{3, 0}});
  cone.radius_m = 0.2;
  cone.height_m = 0.5;
  const Scene scene(world_of({cone}));
  // At half of its height it is half as wide.
  EXPECT_NEAR(cast(scene, {0, 0, 0.25}, {1, 0, 0}).range_m, 2.9, 1e-9);
  EXPECT_NEAR(cast(scene, {3, 0, 2}, {0, 0, -1}).range_m, 1.5, 1e-9);
  EXPECT_FALSE(cast(scene, {0, 0, 0.51}, {1, 0, 0}).any());
}

TEST(Rays, MeetWallsAtTheirThicknessAndFindNoGapAtTheirCorners) {
  Thing wall = thing(Kind::Wall, {{5, -10}, {5, 10}, {-5, 10}});
  wall.thickness_m = 0.2;
  wall.height_m = 2.0;
  const Scene scene(world_of({wall}));
  EXPECT_NEAR(cast(scene, {0, 0, 1}, {1, 0, 0}).range_m, 4.9, 1e-9);
  for (double y = -9.9; y < 10.0; y += 0.37) {
    EXPECT_NEAR(cast(scene, {0, y, 1}, {1, 0, 0}).range_m, 4.9, y < 9.9 ? 1e-9 : 0.2) << y;
  }
  // From outside at the corner: round, but closed.
  EXPECT_TRUE(cast(scene, {8, 13, 1}, unit(-1, -1, 0)).any());
}

TEST(Rays, PassUnderABarAndMeetItInItsHeights) {
  Thing bar = thing(Kind::Bar, {{4, -2}, {4, 2}});
  bar.bottom_m = 1.2;
  bar.height_m = 0.1;
  bar.thickness_m = 0.08;
  const Scene scene(world_of({bar}));
  EXPECT_FALSE(cast(scene, {0, 0, 1.19}, {1, 0, 0}).any());
  EXPECT_NEAR(cast(scene, {0, 0, 1.25}, {1, 0, 0}).range_m, 3.96, 1e-9);
  EXPECT_FALSE(cast(scene, {0, 0, 1.31}, {1, 0, 0}).any());
}

TEST(Rays, MeetLevelAndSlopingGroundWhereThePlaneSays) {
  const Hit level = cast(Scene{}, {0, 0, 1}, unit(1, 0, -0.5));
  EXPECT_NEAR(level.range_m, std::hypot(2.0, 1.0), 1e-9);
  EXPECT_EQ(level.thing, kGround);
  EXPECT_NEAR(level.cosine, 1.0 / std::sqrt(5.0), 1e-9);
  Ground slope;
  slope.slope_rad = std::atan(0.1);
  slope.uphill_rad = 0.0;  // rises to the east
  const Hit up = cast(Scene(world_of({}, slope)), {0, 0, 1}, {1, 0, 0});
  EXPECT_NEAR(up.range_m, 10.0, 1e-9);
  EXPECT_NEAR(up.cosine, 0.1 / std::hypot(1.0, 0.1), 1e-9);
  EXPECT_FALSE(cast(Scene(world_of({}, slope)), {0, 0, 1}, {-1, 0, 0}).any());
}

TEST(Rays, MeetUnevenGroundOnItsSurfaceAndNotBefore) {
  Ground rough;
  rough.uneven = {{0.05, 0.6}, {0.3, 8.0}};
  rough.bumps = {{{3, 0}, 1.0, 0.25}};
  const Scene scene(world_of({}, rough));
  const Terrain& terrain = scene.terrain();
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 dir = unit(std::cos(i * 0.1), std::sin(i * 0.1), -0.02 - 0.0008 * i);
    const Vec3 from{0, 0, terrain.height_m({0, 0}) + 0.7};
    const Hit hit = cast(scene, from, dir, 60.0);
    // Brute force: the first of steps of 1 mm that is below the ground.
    double brute = -1.0;
    for (double t = 0.0; t < 60.0 && brute < 0.0; t += 1e-3) {
      const Vec3 p = from + t * dir;
      if (p.z <= terrain.height_m({p.x, p.y})) brute = t;
    }
    ASSERT_EQ(hit.any(), brute >= 0.0) << i;
    if (!hit.any()) continue;
    ++met;
    // A crest may be grazed by less than its hundredth; then both lie on the surface.
    const Vec3 p = from + hit.range_m * dir;
    EXPECT_NEAR(p.z, terrain.height_m({p.x, p.y}), 2e-3) << i;
    EXPECT_GE(hit.range_m, brute - 2e-3) << i;
  }
  EXPECT_GT(met, 300);
}

//  ____            ____     an edge 1 m deep, 3 to 6 m away
//      |__________|
TEST(Rays, FallIntoADropMeetItsFloorAndItsFarWall) {
  Ground ground;
  ground.drops = {{{{3, -5}, {6, -5}, {6, 5}, {3, 5}}, 1.0}};
  const Scene scene(world_of({}, ground));
  // One metre up: a slant of 1:2.5 would meet level ground at 2.5 m, one of 1:4 at 4 m.
  EXPECT_NEAR(cast(scene, {0, 0, 1}, unit(2.5, 0, -1)).range_m, std::hypot(2.5, 1.0), 1e-6);
  // 1:3.5 passes the edge and falls on the wall at 6 m, 0.714 m down.
  EXPECT_NEAR(cast(scene, {0, 0, 1}, unit(3.5, 0, -1)).range_m, std::hypot(6.0, 6.0 / 3.5), 1e-5);
  // 1:2.8 from half a metre ahead reaches the floor at 6.1 m: the wall again; straight down: floor.
  EXPECT_NEAR(cast(scene, {4, 0, 1}, {0, 0, -1}).range_m, 2.0, 1e-6);
  // Beyond it the ground goes on.
  EXPECT_NEAR(cast(scene, {0, 0, 1}, unit(7, 0, -1)).range_m, std::hypot(7.0, 1.0), 1e-6);
}

TEST(Rays, GoThroughLeavesAsOftenAsTheirDensitySays) {
  World w = world_of({});
  Thing bush = thing(Kind::Bush, {{5, 0}});
  bush.radius_m = 0.6;
  bush.height_m = 1.2;
  bush.density_pm = 1.5;
  w.things = {bush};
  const Scene scene(w);
  const Moment now = scene.at(0.0);
  // What a ray has of each ball of leaves says how often it passes: e^(−density·length).
  std::vector<Shape> shapes;
  build_thing(w, scene.terrain(), 0, shapes);
  const Ray ray{{0, 0.3, 0.6}, {1, 0, 0}};
  double inside_m = 0.0;
  for (const Shape& s : shapes) {
    const Span span = span_in(s, ray.from, ray.dir);
    if (s.density_pm > 0.0F && !span.empty()) inside_m += span.to - span.from;
  }
  ASSERT_GT(inside_m, 0.1);
  const int tries = 20'000;
  int passed = 0;
  for (int i = 0; i < tries; ++i) {
    Draw draw(1, static_cast<std::uint64_t>(i));
    passed += scene.cast(ray, 20.0, now, draw).any() ? 0 : 1;
  }
  EXPECT_NEAR(static_cast<double>(passed) / tries, std::exp(-1.5 * inside_m), 0.012);
}

TEST(Rays, InTheGridAreTheSameAsAgainstEveryShapeInTurn) {
  for (const RandomKind kind : {RandomKind::Static, RandomKind::Moving}) {
    for (std::uint64_t seed = 1; seed < 9; ++seed) {
      const Scene scene(random_world(seed, kind));
      const Moment now = scene.at(3.7);
      Draw pick(seed);
      int met = 0;
      for (std::uint64_t i = 0; i < 1'500; ++i) {
        // From anywhere, roughly towards one of the things.
        const auto& things = scene.world().things;
        const Vec2 to =
            things[static_cast<std::size_t>(pick.below(static_cast<int>(things.size())))].points[0];
        const Vec3 from{pick.uniform(-30, 30), pick.uniform(-30, 30), pick.uniform(0.1, 4.0)};
        const Vec3 dir = unit(to.x - from.x + pick.normal(), to.y - from.y + pick.normal(),
                              pick.uniform(-0.1, 1.5) - from.z);
        Draw one(seed, i);
        Draw two(seed, i);
        const Hit fast = scene.cast({from, dir}, 80.0, now, one);
        const Hit slow = scene.cast_slowly({from, dir}, 80.0, now, two);
        ASSERT_EQ(fast.thing, slow.thing) << seed << " " << i;
        ASSERT_EQ(fast.range_m, slow.range_m) << seed << " " << i;
        met += fast.thing >= 0 ? 1 : 0;
      }
      EXPECT_GT(met, 50) << seed;
    }
  }
}

TEST(Movers, WalkTheirPathBackAndForthWithPauses) {
  Thing walker = thing(Kind::Person, {{0, 0}, {4, 0}, {4, 2}});
  walker.speed_mps = 1.0;
  walker.pause_s = 2.0;
  walker.start_s = 3.0;
  EXPECT_EQ(on_path(walker, 1.0).at, (Vec2{0, 0}));
  EXPECT_EQ(on_path(walker, 1.0).speed_mps, 0.0);
  EXPECT_NEAR(on_path(walker, 5.0).at.x, 2.0, 1e-12);
  EXPECT_NEAR(on_path(walker, 8.0).at.y, 1.0, 1e-12);
  EXPECT_NEAR(on_path(walker, 8.0).yaw_rad, kPi / 2, 1e-12);
  EXPECT_EQ(on_path(walker, 10.0).speed_mps, 0.0) << "pauses at the end";
  EXPECT_NEAR(on_path(walker, 12.0).at.y, 1.0, 1e-12) << "and comes back";
  EXPECT_NEAR(on_path(walker, 17.5).at.x, 0.0, 1e-12);
  walker.motion = Motion::Once;
  EXPECT_EQ(on_path(walker, 1e6).at, (Vec2{4, 2}));
  walker.motion = Motion::Loop;
  EXPECT_NEAR(on_path(walker, 3.0 + 6.0 + std::sqrt(20.0) / 2).at.x, 2.0, 1e-9);
}

TEST(Movers, AreMetWhereTheyAreThen) {
  Thing walker = thing(Kind::Person, {{5, -4}, {5, 4}});
  walker.speed_mps = 1.0;
  walker.height_m = 1.75;
  walker.length_m = 0.3;
  walker.width_m = 0.46;
  const Scene scene(world_of({walker}));
  EXPECT_FALSE(cast(scene, {0, 0, 1.2}, {1, 0, 0}, 20.0, 0.0).any());
  // Walks north: its breast looks north, its width lies east and west.
  EXPECT_NEAR(cast(scene, {0, 0, 1.2}, {1, 0, 0}, 20.0, 4.0).range_m, 5.0 - 0.23, 1e-9);
}

}  // namespace
}  // namespace roverd::sim::world
