// What sensors see: geometry, motion within a scan, and the statistics of their errors.

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/world/random.hpp"
#include "sim/world/sensor.hpp"
#include "world_scene.hpp"

namespace roverd::sim::world {
namespace {

SensorParams ideal(std::string_view kind) {
  SensorParams p = usual(kind);
  p.x_m = 0.0;
  p.sigma_m = p.sigma_share = p.dropout = p.beam_mrad = 0.0;
  return p;
}
Pose still(double) {
  return {};
}
Sweep one(const Scene& scene, const SensorParams& p, const SensorFaults& f = {},
          const PoseAt& pose = still, std::uint64_t seed = 1) {
  Sweep out;
  Sensor(p, seed).sweep(scene, pose, f, out);
  return out;
}
/// A wall 4 m to the east, from south to north.
Scene before_a_wall() {
  Thing wall = thing(Kind::Wall, {{4.1, -200}, {4.1, 200}});
  wall.height_m = 50.0;
  return Scene(world_of({wall}));
}
std::size_t count(const Sweep& sweep, Cause cause) {
  return static_cast<std::size_t>(
      std::ranges::count(sweep.shots, cause, [](const Shot& s) { return s.cause; }));
}

TEST(Scanner, Has541BeamsOver270DegreesAndMeasuresAWallByTheCosine) {
  const SensorParams p = ideal("lms");
  const Sweep scan = one(before_a_wall(), p);
  ASSERT_EQ(scan.shots.size(), 541u);
  EXPECT_NEAR(scan.shots.front().bearing_rad, -0.75 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(scan.shots[270].range_m, 4.0, 1e-6);
  EXPECT_NEAR(scan.shots[390].range_m, 8.0, 1e-5) << "60 degrees aside";
  EXPECT_EQ(scan.shots[0].range_m, 0.0F) << "nothing behind";
  // The head turns once in 40 ms.
  EXPECT_NEAR(scan.shots[540].after_s, 0.75 * 0.04, 1e-6);
}

TEST(Scanner, IsWhereItsMountSaysAndTurnsWithTheBody) {
  SensorParams p = ideal("lms");
  p.x_m = 0.5;
  p.y_m = 0.2;
  p.yaw_deg = 30.0;
  const Sweep scan = one(before_a_wall(), p);
  EXPECT_NEAR(scan.shots[270 - 60].range_m, 3.5, 1e-5) << "30 degrees right of its own ahead";
  const auto turned = [](double) { return Pose{0, 0, 0, 0, 0, std::numbers::pi / 2}; };
  // Body to the north, sensor 0.2 m to the west of its middle line.
  EXPECT_NEAR(one(before_a_wall(), p, {}, turned).shots[270 - 240].range_m, 4.2, 1e-5);
}

TEST(Scanner, TiltedDownMeetsTheGroundAtItsHeightOverTheTangent) {
  SensorParams p = ideal("lms");
  p.z_m = 0.7;
  p.pitch_deg = 10.0;  // nose down
  const Sweep scan = one(Scene{}, p);
  EXPECT_NEAR(scan.shots[270].range_m, 0.7 / std::sin(10.0 * std::numbers::pi / 180.0), 1e-4);
  EXPECT_EQ(scan.shots[270].cause, Cause::Ground);
}

// While the head turns by 135 degrees, 15 ms, the robot has come 15 mm nearer at 1 m/s.
TEST(Scanner, EachBeamIsCastFromWhereTheRobotIsThen) {
  const auto driving = [](double at_s) { return Pose{10.0 * at_s, 0, 0, 0, 0, 0}; };
  const Sweep scan = one(before_a_wall(), ideal("lms"), {}, driving);
  EXPECT_NEAR(scan.shots[270].range_m, 4.0 - 10.0 * 0.015, 1e-5);
  EXPECT_NEAR(scan.shots[390].range_m, 2.0 * (4.0 - 10.0 * 0.015 * 195 / 135), 1e-5);
}

TEST(Lidar, FiresItsRingsInTurnWithTheirElevations) {
  Sweep packet;
  Sensor lidar(ideal("vlp16"), 1);
  lidar.sweep(before_a_wall(), still, {}, packet);
  ASSERT_EQ(packet.shots.size(), 384u);
  EXPECT_NEAR(packet.shots[0].elevation_rad, -15.0 * std::numbers::pi / 180, 1e-6);
  EXPECT_NEAR(packet.shots[1].elevation_rad, 1.0 * std::numbers::pi / 180, 1e-6);
  EXPECT_EQ(packet.shots[1].ring, 8);
  EXPECT_NEAR(packet.shots[17].after_s, 55.296e-6 + 2.304e-6, 1e-9);
  EXPECT_LT(packet.shots[100].bearing_rad, 0.0F) << "clockwise";
  // Ring 8 dead ahead: 4 m over the cosine.
  EXPECT_NEAR(packet.shots[1].range_m, 4.0 / std::cos(std::numbers::pi / 180), 1e-4);
  EXPECT_NEAR(lidar.next_s(), 2 * 24 * 55.296e-6, 1e-12);
  // Packets join without a gap: 10 turns a second.
  double azimuth = 0.0;
  Sweep next;
  for (int i = 0; i < 76; ++i) {
    lidar.sweep(before_a_wall(), still, {}, next);
    const double expected = 2.0 * std::numbers::pi * 10.0 * next.at_s;
    EXPECT_NEAR(std::remainder(-static_cast<double>(next.shots[0].bearing_rad) - expected,
                               2 * std::numbers::pi),
                0.0, 1e-5);
    azimuth = expected;
  }
  EXPECT_GT(azimuth, 2.0 * std::numbers::pi);
}

TEST(DepthCamera, SeesAPlaneAsRangesOverTheCosine) {
  SensorParams p = ideal("depth");
  p.columns = 5;
  p.rows = 3;
  const Sweep image = one(before_a_wall(), p);
  ASSERT_EQ(image.shots.size(), 15u);
  for (const Shot& s : image.shots) {
    const double ahead =
        static_cast<double>(s.range_m) * std::cos(s.bearing_rad) * std::cos(s.elevation_rad);
    if (s.cause == Cause::Ground) continue;
    EXPECT_NEAR(ahead, 4.0, 1e-5);
  }
  EXPECT_GT(image.shots[0].elevation_rad, 0.0F) << "first row above";
  EXPECT_GT(image.shots[0].bearing_rad, 0.0F) << "first column left";
}

TEST(RangeSensor, TellsTheNearestInItsCone) {
  SensorParams p = ideal("range");
  p.z_m = 0.5;
  EXPECT_NEAR(one(Scene(world_of({pole({2, 0.3}, 0.05)})), p).shots.at(0).range_m, 2.0, 0.05);
  EXPECT_EQ(one(Scene(world_of({pole({2, 0.5}, 0.05)})), p).shots.at(0).cause, Cause::Ground);
}

TEST(Noise, HasTheMeanAndSigmaThatWereSet) {
  SensorParams p = ideal("lms");
  p.sigma_m = 0.02;
  p.dropout = 0.1;
  Sensor sensor(p, 5);
  const Scene scene = before_a_wall();
  double sum = 0.0;
  double squares = 0.0;
  int hits = 0;
  int all = 0;
  Sweep scan;
  for (int i = 0; i < 200; ++i) {
    sensor.sweep(scene, still, {}, scan);
    for (std::size_t k = 200; k < 340; ++k) {
      ++all;
      if (scan.shots[k].cause == Cause::Dropout) continue;
      const double error = static_cast<double>(scan.shots[k].range_m) *
                               std::cos(static_cast<double>(scan.shots[k].bearing_rad)) -
                           4.0;
      const double scaled = error / std::cos(static_cast<double>(scan.shots[k].bearing_rad));
      sum += scaled;
      squares += scaled * scaled;
      ++hits;
    }
  }
  const double mean = sum / hits;
  EXPECT_NEAR(mean, 0.0, 4 * 0.02 / std::sqrt(hits));
  EXPECT_NEAR(std::sqrt(squares / hits), 0.02, 0.0005);
  EXPECT_NEAR(1.0 - static_cast<double>(hits) / all, 0.1, 0.008);
}

// A beam 4 m long meets no drop with e^(−rate·length), counted from where it begins to measure.
TEST(Rain, ReturnsAsOftenAsItsRateSays) {
  const Scene scene = before_a_wall();
  SensorParams p = ideal("lms");
  p.fov_from_deg = -10;
  p.fov_to_deg = 10;
  p.step_deg = 0.1;
  SensorFaults f;
  f.rain_per_m = 0.02;
  Sensor sensor(p, 3);
  std::size_t drops = 0;
  std::size_t all = 0;
  double sum_m = 0.0;
  Sweep scan;
  for (int i = 0; i < 300; ++i) {
    sensor.sweep(scene, still, f, scan);
    all += scan.shots.size();
    for (const Shot& s : scan.shots) {
      if (s.cause != Cause::Rain) continue;
      ++drops;
      sum_m += static_cast<double>(s.range_m);
      EXPECT_GT(s.second_m, 3.9F) << "the wall is behind it";
    }
  }
  const double expected = 1.0 - std::exp(-0.02 * (4.02 - 0.05));
  EXPECT_NEAR(static_cast<double>(drops) / static_cast<double>(all), expected, 0.003);
  EXPECT_NEAR(sum_m / static_cast<double>(drops), 2.0, 0.1) << "evenly along the beam";
}

TEST(Dust, ComesInClouds) {
  SensorFaults f;
  f.dust_per_m = 0.2;
  const Sweep scan = one(before_a_wall(), ideal("lms"), f);
  // Neighbouring windows of 10 degrees differ far more than chance would have it.
  std::vector<int> windows;
  for (std::size_t i = 0; i + 20 <= scan.shots.size(); i += 20) {
    windows.push_back(
        static_cast<int>(std::count_if(scan.shots.begin() + static_cast<std::ptrdiff_t>(i),
                                       scan.shots.begin() + static_cast<std::ptrdiff_t>(i) + 20,
                                       [](const Shot& s) { return s.cause == Cause::Dust; })));
  }
  EXPECT_GE(std::ranges::max(windows) - std::ranges::min(windows), 8);
  EXPECT_GT(count(scan, Cause::Dust), 20u);
}

TEST(Sun, BlindsTheBeamsAroundItAndNoOthers) {
  SensorFaults f;
  f.sun_heading_deg = 90.0;  // east: ahead
  f.sun_elevation_deg = 0.0;
  f.sun_width_deg = 20.0;
  const Sweep scan = one(before_a_wall(), ideal("lms"), f);
  for (const Shot& s : scan.shots) {
    const double off_deg = std::abs(static_cast<double>(s.bearing_rad)) * 180 / std::numbers::pi;
    EXPECT_EQ(s.cause == Cause::Sun, off_deg < 10.0 - 1e-4) << off_deg;
    if (s.cause == Cause::Sun) {
      EXPECT_EQ(s.range_m, 0.0F);
    }
  }
}

TEST(Window, ACoveredSectorSeesNothingBehindTheGlass) {
  SensorFaults f;
  f.dirt_from_deg = -30.0;
  f.dirt_to_deg = 0.0;
  f.dirt_share = 1.0;
  const Sweep scan = one(before_a_wall(), ideal("lms"), f);
  EXPECT_TRUE(scan.blocked);
  EXPECT_NEAR(scan.dirty, 30.0 / 360.0, 1e-6);
  for (std::size_t i = 211; i < 270; ++i) {
    EXPECT_EQ(scan.shots[i].cause, Cause::Window);
    EXPECT_LT(scan.shots[i].range_m, 0.2F);
  }
  EXPECT_NEAR(scan.shots[280].range_m, 4.0 / std::cos(5 * std::numbers::pi / 180), 1e-4);
  // Half as dirty it sees through, but not as far, and sometimes the glass.
  f.dirt_share = 0.5;
  const Sweep half = one(before_a_wall(), ideal("lms"), f);
  EXPECT_FALSE(half.blocked);
  EXPECT_GT(count(half, Cause::Window), 2u);
  EXPECT_LT(count(half, Cause::Window), 30u);
}

TEST(Darkness, ABlackThingIsSeenLessFar) {
  SensorParams p = ideal("lms");
  Thing black = box({10, 0}, 0.5, 8, 2);
  black.reflect = 0.02;
  EXPECT_EQ(one(Scene(world_of({black})), p).shots[270].range_m, 0.0F) << "18 m · sqrt(0.2) = 8 m";
  black.points = {{7, 0}};
  EXPECT_NEAR(one(Scene(world_of({black})), p).shots[270].range_m, 6.75, 1e-5);
}

//   beam ═══╡ edge of the near box        ═══╡ wall behind it
TEST(Edges, GiveTwoEchoesOrOneBetweenThem) {
  SensorParams p = ideal("lms");
  p.beam_mrad = 15.0;
  // Its right edge lies just beside the beam ahead: 1.5 cm of a footprint of ±1.5 cm.
  Scene far(world_of({box({2.005, 0.505}, 0.01, 1, 2), box({5, 0}, 0.2, 20, 2)}));
  int two = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Shot s = one(far, p, {}, still, seed).shots[270];
    if (s.second_m <= 0.0F) continue;
    ++two;
    EXPECT_NEAR(s.range_m, 2.0, 0.011);
    EXPECT_NEAR(s.second_m, 4.9, 1e-2);
  }
  EXPECT_GT(two, 60);
  // With only 12 cm between them they are measured as one, where nothing is.
  Scene close(world_of({box({2.005, 0.505}, 0.01, 1, 2), box({2.22, 0}, 0.2, 20, 2)}));
  int mixed = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Shot s = one(close, p, {}, still, seed).shots[270];
    if (s.cause != Cause::Mixed) continue;
    ++mixed;
    EXPECT_GT(s.range_m, 2.01F);
    EXPECT_LT(s.range_m, 2.11F);
  }
  EXPECT_GT(mixed, 60);
}

TEST(Seeds, RepeatASweepAndNamesTellSensorsApart) {
  const Scene scene(random_world(4, RandomKind::Moving));
  SensorParams p = usual("lms");
  const auto ranges = [&](const SensorParams& params, std::uint64_t seed) {
    std::vector<float> out;
    for (const Shot& s : one(scene, params, {}, still, seed).shots) out.push_back(s.range_m);
    return out;
  };
  EXPECT_EQ(ranges(p, 9), ranges(p, 9));
  EXPECT_NE(ranges(p, 9), ranges(p, 10));
  SensorParams other = p;
  other.name = "rear";
  EXPECT_NE(ranges(p, 9), ranges(other, 9));
}

TEST(Faults, OfOneSensorLeaveTheOthersTheWeather) {
  SensorFaults f;
  f.sensor = "front";
  f.sensor_silent = true;
  f.dirt_share = 1.0;
  f.rain_per_m = 0.1;
  EXPECT_TRUE(faults_of(f, "front").sensor_silent);
  EXPECT_FALSE(faults_of(f, "rear").sensor_silent);
  EXPECT_EQ(faults_of(f, "rear").dirt_share, 0.0);
  EXPECT_EQ(faults_of(f, "rear").rain_per_m, 0.1);
}

TEST(SensorParams, AreCheckedByName) {
  SensorParams p = usual("lms");
  EXPECT_TRUE(check(p));
  p.kind = "sonar";
  EXPECT_EQ(check(p).error().detail, "kind must be lms, vlp16, depth, range, vision or picture");
  p = usual("lms");
  p.fov_to_deg = p.fov_from_deg;
  EXPECT_EQ(check(p).error().detail,
            "fov_to_deg must lie at least one step_deg beyond fov_from_deg");
  p = usual("vlp16");
  p.rate_hz = 25.0;
  EXPECT_EQ(check(p).error().detail, "rate_hz must lie in 5 .. 20 for a vlp16");
}

}  // namespace
}  // namespace roverd::sim::world
