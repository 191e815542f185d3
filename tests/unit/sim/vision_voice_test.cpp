// What a simulated camera's program says, read by the codec that hears it.

#include "sim/vision_voice.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "vision/codec.hpp"

namespace roverd::sim {
namespace {

/// A cone 2 m ahead and 0.5 m to the right, a wall 1 m to the left, a box straight ahead at 4 m.
struct View {
  world::World world;
  world::Scene scene{yard()};
  world::SensorParams params = world::usual("vision");
  world::Sweep sweep;

  static world::World yard() {
    world::World w;
    world::Thing cone;
    cone.kind = world::Kind::Cone;
    cone.points = {{2.0, -0.5}};
    cone.radius_m = 0.15;
    cone.height_m = 0.6;
    world::Thing wall;
    wall.kind = world::Kind::Wall;
    wall.points = {{1.5, 1.1}, {6.0, 1.1}};
    wall.height_m = 2.0;
    world::Thing box;
    box.kind = world::Kind::Box;
    box.points = {{4.0, 0.0}};
    box.length_m = box.width_m = 0.4;
    w.things = {cone, wall, box};
    return w;
  }
  /// The image of that number.
  vision::Decoded see(std::uint64_t count, double malformed = 0.0) {
    world::Sensor sensor(params, count, 0.0);
    sensor.sweep(
        scene, [](double) { return world::Pose{}; }, {}, sweep);
    sweep.count = count;
    const auto bytes = vision_datagram(sweep, scene.world(), malformed);
    return vision::decode(bytes);
  }
};

TEST(SimulatedVision, TellsTheConeByNameTheWallAsAPlaneAndTheBoxAsAnObstacle) {
  View v;
  int cones = 0, walls = 0, boxes = 0, named = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto seen = v.see(i);
    ASSERT_EQ(seen.fault, vision::Fault::None) << describe(seen);
    for (const auto& l : seen.datagram.landmarks) {
      if (std::abs(l.at.x_m - 0.5) > 0.15 || std::abs(l.at.z_m - 2.0) > 0.15) continue;
      ++cones;
      named += seen.datagram.names[l.name] == "cone" ? 1 : 0;
    }
    for (const auto& p : seen.datagram.planes) {
      if (p.centre.z_m < 0.0) continue;
      EXPECT_NEAR(p.centre.x_m, -1.0, 0.05) << "to its left, its near face";
      EXPECT_NEAR(std::abs(p.normal.x_m), 1.0, 0.01);
      EXPECT_GT(p.size, 4000.0);
      ++walls;
    }
    for (const auto& o : seen.datagram.obstacles) {
      EXPECT_NEAR(o.z_m, 3.7, 0.1)
          << "its face is at 3.8 m; the nearest of many shots counts, that "
             "scatter by 4 cm";
      ++boxes;
    }
  }
  EXPECT_GT(cones, 85) << "some are missed";
  EXPECT_LT(cones, 100);
  EXPECT_GT(named, 80);
  EXPECT_GT(walls, 90);
  EXPECT_GT(boxes, 90);
}

TEST(SimulatedVision, SomeImagesShowWhatIsNotThere) {
  View v;
  int false_ones = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto d = v.see(i).datagram;
    for (const auto& p : d.planes) false_ones += p.centre.z_m < 0.0 ? 1 : 0;
  }
  EXPECT_GT(false_ones, 2);
  EXPECT_LT(false_ones, 30);
}

TEST(SimulatedVision, MalformedOnesAreRefusedEachByItsFault) {
  View v;
  for (std::uint64_t i = 0; i < 50; ++i) EXPECT_NE(v.see(i, 1.0).fault, vision::Fault::None) << i;
}

}  // namespace
}  // namespace roverd::sim
