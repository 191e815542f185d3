// What a body touches, against dense sampling of it.

#include <numbers>

#include <gtest/gtest.h>

#include "sim/world/contact.hpp"
#include "sim/world/random.hpp"
#include "world_scene.hpp"

namespace roverd::sim::world {
namespace {

const Body kBody = Body::rectangle(0.5, 0.5, 0.7, 0.4, 0.05);

Contact at(const Scene& scene, Vec2 place, double yaw_rad = 0.0, double at_s = 0.0) {
  Pose pose;
  pose.x_m = place.x;
  pose.y_m = place.y;
  pose.yaw_rad = yaw_rad;
  return contact(scene, scene.at(at_s), pose, kBody);
}

//  [body]  o    its front is half a metre ahead of it
TEST(Contact, TellsTheRoomToAPoleExactly) {
  const Scene scene(world_of({pole({2, 0}, 0.1)}));
  const Contact c = at(scene, {0, 0});
  EXPECT_NEAR(c.clearance_m, 1.4, 1e-12);
  EXPECT_EQ(c.nearest, 0);
  EXPECT_NEAR(c.bearing_rad, 0.0, 1e-12);
  EXPECT_TRUE(c.touches.empty());
  EXPECT_NEAR(at(scene, {1.3999, 0}).clearance_m, 1e-4, 1e-9);
  const Contact touching = at(scene, {1.4001, 0});
  ASSERT_EQ(touching.touches.size(), 1u);
  EXPECT_EQ(touching.touches[0].thing, 0);
  EXPECT_FALSE(touching.touches[0].soft);
  EXPECT_EQ(touching.clearance_m, 0.0);
  EXPECT_EQ(at(scene, {2, 0}).clearance_m, 0.0) << "a pole under the middle of it";
}

//  [body]      o    off its corner, and another one nearer
TEST(Contact, TellsTheRoomToOneThingOfSeveral) {
  const Scene scene(world_of({pole({0.8, 0.75}, 0.1), pole({0.7, 0}, 0.1), pole({9, 0}, 0.1)}));
  const Pose pose;
  const auto to = [&](int thing) { return room_m(scene, scene.at(0.0), pose, kBody, thing, 1.0); };
  EXPECT_NEAR(to(0), std::hypot(0.3, 0.4) - 0.1, 1e-12);
  EXPECT_NEAR(to(1), 0.1, 1e-12);
  EXPECT_EQ(to(2), 1.0);
}

TEST(Contact, TellsTheRoomToABushByItsLeaves) {
  Thing bush = thing(Kind::Bush, {{2, 0}});
  bush.radius_m = 0.5;
  bush.height_m = 0.8;
  const Scene scene(world_of({bush}));
  const double room = room_m(scene, scene.at(0.0), Pose{}, kBody, 0, 3.0);
  EXPECT_GT(room, 0.95);
  EXPECT_LT(room, 1.25);
  EXPECT_LT(room, at(scene, {0, 0}).clearance_m);
}

TEST(Contact, ALowStonePassesUnderAndABarOverTheBody) {
  Thing bar = thing(Kind::Bar, {{0, -2}, {0, 2}});
  bar.bottom_m = 0.39;
  bar.height_m = 0.1;
  World w = world_of({box({0, 0}, 0.2, 0.2, 0.04)});
  EXPECT_TRUE(at(Scene(w), {0, 0}).touches.empty());
  w.things[0].height_m = 0.06;
  EXPECT_TRUE(at(Scene(w), {0, 0}).hard());
  EXPECT_TRUE(at(Scene(world_of({bar})), {0, 0}).hard());
  bar.bottom_m = 0.41;
  EXPECT_TRUE(at(Scene(world_of({bar})), {0, 0}).touches.empty());
}

TEST(Contact, OverTheEdgeOfADropIsAContactWithTheGround) {
  Ground ground;
  ground.drops = {{{{3, -5}, {6, -5}, {6, 5}, {3, 5}}, 1.0}};
  const Scene scene(world_of({}, ground));
  EXPECT_NEAR(at(scene, {1.5, 0}).clearance_m, 1.0, 1e-12);
  const Contact over = at(scene, {2.6, 0});
  ASSERT_EQ(over.touches.size(), 1u);
  EXPECT_EQ(over.touches[0].thing, kGround);
}

TEST(Contact, OnASlopeHeightsAreThoseOverThePlaneThatTheBodyStandsOn) {
  Ground slope;
  slope.slope_rad = std::atan(0.2);
  slope.uphill_rad = 0.0;
  const Scene scene(world_of({box({0.45, 0}, 0.05, 0.05, 0.04)}, slope));
  const Pose stands = scene.terrain().stand({0, 0}, 0.0, 0.3, 0.3);
  EXPECT_NEAR(stands.pitch_rad, -std::atan(0.2), 1e-9);
  EXPECT_TRUE(contact(scene, scene.at(0), stands, kBody).touches.empty());
}

TEST(Contact, AgreesWithDenseSamplingOfTheBody) {
  int touched = 0;
  for (std::uint64_t seed = 1; seed < 7; ++seed) {
    const Scene scene(random_world(seed, RandomKind::Moving));
    const Moment now = scene.at(5.0);
    std::vector<Shape> all = now.shapes;
    for (std::uint32_t i = 0; i < scene.world().things.size(); ++i) {
      build_thing(scene.world(), scene.terrain(), i, all);
    }
    Draw pick(seed);
    for (int i = 0; i < 120; ++i) {
      Pose pose;
      const auto& things = scene.world().things;
      const auto which = static_cast<std::size_t>(pick.below(static_cast<int>(things.size())));
      pose.x_m = things[which].points[0].x + pick.uniform(-1.5, 1.5);
      pose.y_m = things[which].points[0].y + pick.uniform(-1.5, 1.5);
      pose.yaw_rad = pick.uniform(-3, 3);
      pose.z_m = scene.terrain().height_m({pose.x_m, pose.y_m});
      // Points of the outline and the inside, each against every shape: the least room.
      double least = 3.0;
      for (double f = -0.5; f <= 0.5001; f += 0.02) {
        for (double l = -0.35; l <= 0.3501; l += 0.02) {
          const Vec2 p{pose.x_m + std::cos(pose.yaw_rad) * f - std::sin(pose.yaw_rad) * l,
                       pose.y_m + std::sin(pose.yaw_rad) * f + std::cos(pose.yaw_rad) * l};
          for (const Shape& s : all) {
            if (s.density_pm > 0.0F) continue;
            const Section cut = section_of(s, pose.z_m + 0.05, pose.z_m + 0.4);
            if (!cut.any) continue;
            const Vec2 off = p - cut.middle;
            const double a = cut.c * off.x + cut.s * off.y;
            const double b = -cut.s * off.x + cut.c * off.y;
            const double room = cut.disc ? length(off) - cut.a
                                         : std::hypot(std::max(0.0, std::abs(a) - cut.a),
                                                      std::max(0.0, std::abs(b) - cut.b));
            least = std::min(least, std::max(0.0, room));
          }
        }
      }
      const Contact c = contact(scene, now, pose, kBody);
      EXPECT_LE(c.clearance_m, least + 1e-9) << seed << " " << i;
      EXPECT_GE(c.clearance_m, least - 0.03) << seed << " " << i;  // samples lie 2 cm apart
      touched += c.hard() ? 1 : 0;
    }
  }
  EXPECT_GT(touched, 20);
}

TEST(Witness, CountsAThingOnceUntilItWasLeft) {
  const Scene scene(world_of({pole({2, 0}, 0.1), pole({-2, 0}, 0.1)}));
  const Moment now = scene.at(1.0);
  Witness witness(kBody);
  const auto drive_to = [&](double x) {
    Pose pose;
    pose.x_m = x;
    return witness.step(scene, now, pose, 0.5);
  };
  EXPECT_TRUE(drive_to(1.0).empty());
  EXPECT_NEAR(witness.least_m(), 0.4, 1e-12);
  const auto begun = drive_to(1.45);
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_EQ(begun[0].speed_mps, 0.5);
  EXPECT_TRUE(drive_to(1.5).empty()) << "still the same";
  EXPECT_TRUE(drive_to(1.38).empty()) << "2 cm off it: trembling, not left";
  EXPECT_TRUE(drive_to(1.45).empty());
  EXPECT_TRUE(drive_to(1.0).empty());
  EXPECT_EQ(drive_to(1.45).size(), 1u) << "left, and touched again";
  EXPECT_EQ(drive_to(-1.45).size(), 1u) << "another one";
  EXPECT_EQ(witness.hard(), 3u);
  EXPECT_EQ(witness.soft(), 0u);
  witness.forget();
  EXPECT_EQ(witness.hard(), 0u);
}

TEST(Witness, LeavesBrushAndStemsHit) {
  Thing bush = thing(Kind::Bush, {{2, 0}});
  bush.radius_m = 0.5;
  bush.height_m = 0.8;
  const Scene scene(world_of({bush}));
  Witness witness(kBody);
  Pose pose;
  pose.x_m = 1.25;
  witness.step(scene, scene.at(0), pose, 0.1);
  EXPECT_EQ(witness.soft(), 1u);
  EXPECT_EQ(witness.hard(), 0u);
  pose.x_m = 1.55;
  witness.step(scene, scene.at(0), pose, 0.1);
  EXPECT_EQ(witness.hard(), 1u);
}

}  // namespace
}  // namespace roverd::sim::world
