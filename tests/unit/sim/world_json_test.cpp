// The file format of worlds: what is taken, what is refused and how it is named.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "sim/world/contact.hpp"
#include "sim/world/random.hpp"
#include "sim/world/scene.hpp"
#include "source_folder.hpp"

namespace roverd::sim::world {
namespace {

std::string refused(std::string_view text) {
  const auto world = read_world(text);
  return world ? "taken" : world.error().detail;
}
std::string refused_thing(const std::string& members) {
  return refused(R"({"things":[{)" + members + "}]}");
}

TEST(WorldFile, TellsThingsInMetresAndCompassDegrees) {
  const auto world = read_world(R"({
    "name": "yard", "seed": 4,
    "ground": {"slope_deg": 5, "uphill_deg": 90, "grass_m": 0.1,
               "uneven": [{"height_m": 0.05, "patch_m": 0.7}],
               "bumps": [{"at": [1, 2], "radius_m": 1, "height_m": 0.3}],
               "drops": [{"points": [[5,0],[8,0],[8,3]], "depth_m": 0.6}]},
    "things": [
      {"kind": "box", "name": "crate", "at": [3, -1], "length_m": 2, "width_m": 1, "height_m": 0.8,
       "heading_deg": 0},
      {"kind": "person", "path": [[0, 5], [6, 5]], "speed_mps": 1.4, "motion": "loop"}]})");
  ASSERT_TRUE(world) << world.error().detail;
  EXPECT_EQ(world->name, "yard");
  EXPECT_EQ(world->seed, 4u);
  EXPECT_NEAR(world->ground.slope_rad, 0.0872665, 1e-7);
  EXPECT_NEAR(world->ground.uphill_rad, 0.0, 1e-12) << "east";
  EXPECT_EQ(world->ground.drops.at(0).points.size(), 3u);
  ASSERT_EQ(world->things.size(), 2u);
  EXPECT_EQ(world->things[0].points[0], (Vec2{3, -1}));
  EXPECT_NEAR(world->things[0].yaw_rad, 1.5707963, 1e-7) << "its length points north";
  EXPECT_EQ(world->things[1].motion, Motion::Loop);
  EXPECT_EQ(world->things[1].height_m, 1.75) << "its default";
  EXPECT_EQ(Scene(*world).name_of(0), "crate");
  EXPECT_EQ(Scene(*world).name_of(1), "person 1");
}

TEST(WorldFile, RefusesWithTheMembersName) {
  EXPECT_EQ(refused("{"), "a world must be JSON");
  EXPECT_EQ(refused("[]"), "the world must be an object");
  EXPECT_EQ(refused(R"({"thing":[]})"), "/thing is unknown");
  EXPECT_EQ(refused(R"({"things":{}})"), "/things must be a list");
  EXPECT_EQ(refused(R"({"seed":1.5})"), "/seed must be a whole number");
  EXPECT_EQ(refused(R"({"ground":{"slope_deg":80}})"), "/ground/slope_deg must lie in 0.0 .. 45.0");
  EXPECT_EQ(refused(R"({"ground":{"drops":[{"points":[[0,0],[1,0]],"depth_m":1}]}})"),
            "/ground/drops/0/points must have at least 3");
  EXPECT_EQ(refused_thing(R"("kind":"tree")"),
            "/things/0/kind must be wall, bar, pole, box, cone, bush, row, person, animal or tag");
  EXPECT_EQ(refused_thing(R"("kind":"pole")"), "/things/0/at is missing");
  EXPECT_EQ(refused_thing(R"("kind":"pole","at":[1,2,3])"),
            "/things/0/at must be [east_m, north_m]");
  EXPECT_EQ(refused_thing(R"("kind":"pole","at":[1,9999])"),
            "/things/0/at/1 must lie in -2000.0 .. 2000.0");
  EXPECT_EQ(refused_thing(R"("kind":"pole","at":[1,2],"height_m":"tall")"),
            "/things/0/height_m must be a number");
  EXPECT_EQ(refused_thing(R"("kind":"pole","at":[1,2],"length_m":1)"),
            "/things/0/length_m is unknown");
  EXPECT_EQ(refused_thing(R"("kind":"wall","points":[[0,0]])"),
            "/things/0/points must have at least 2");
  EXPECT_EQ(refused_thing(R"("kind":"person","path":[[0,0]],"motion":"jump")"),
            "/things/0/motion must be once, loop or back");
  EXPECT_EQ(
      refused_thing(R"("kind":"row","points":[[-2000,0],[2000,0],[-2000,1]],"spacing_m":0.02)"),
      "/things/0 makes it more than 200000 plants");
}

TEST(WorldFile, WrittenAndReadAgainIsTheSame) {
  for (const RandomKind kind : {RandomKind::Static, RandomKind::Moving, RandomKind::Grass}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const World world = random_world(seed, kind);
      const std::string text = write_world(world);
      const auto again = read_world(text);
      ASSERT_TRUE(again) << again.error().detail;
      EXPECT_EQ(write_world(*again), text);
      EXPECT_EQ(again->things.size(), world.things.size());
    }
  }
}

TEST(RandomWorlds, AreTheSameForTheSameNumberAndLeaveTheStartFree) {
  EXPECT_EQ(random_world(7, RandomKind::Static), random_world(7, RandomKind::Static));
  EXPECT_NE(random_world(7, RandomKind::Static), random_world(8, RandomKind::Static));
  const Body body = Body::rectangle(0.8, 0.8, 1.0, 1.0, 0.03);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Scene scene(random_world(seed, RandomKind::Moving));
    const Contact c = contact(scene, scene.at(0.0), scene.terrain().stand({}, 1.0, 0.3, 0.3), body);
    EXPECT_GT(c.clearance_m, 0.5) << seed;
    EXPECT_TRUE(c.touches.empty()) << seed;
  }
  EXPECT_EQ(random_world(1, RandomKind::Crowded).things.size(), 10'000u);
}

TEST(RandomWorlds, HaveNames) {
  EXPECT_EQ(random_world_named("random:7"), random_world(7, RandomKind::Static));
  EXPECT_EQ(random_world_named("random:7:moving"), random_world(7, RandomKind::Moving));
  for (const char* no : {"random:", "random:x", "random:7:", "random:7:fast", "yard.json", ""}) {
    EXPECT_FALSE(random_world_named(no)) << no;
  }
}

TEST(WorldFile, EveryExampleIsTakenAndLeavesRoomAtItsStart) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(tests::in_source("config/worlds"))) {
    ++found;
    std::ifstream in(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    const auto world = read_world(text.str());
    ASSERT_TRUE(world) << entry.path() << ": " << world.error().detail;
    const Scene scene(*world);
    const Body body = Body::rectangle(0.6, 0.6, 0.8, 0.6, 0.03);
    const Contact c =
        contact(scene, scene.at(0.0), scene.terrain().stand({}, 0.87, 0.3, 0.3), body);
    EXPECT_TRUE(c.touches.empty()) << entry.path();
  }
  EXPECT_GE(found, 7);
}

}  // namespace
}  // namespace roverd::sim::world
