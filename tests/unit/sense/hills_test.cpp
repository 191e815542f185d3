// A scanner's plane meets every hill: where a lidar has seen the ground, that is told from what
// stands there.
#include "nav/sense/hills.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/chain.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/reduce.hpp"
#include "nav/sense/sectors.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

//                  ___●lidar           ___---    rises by 6 deg from x = 3 m on: it meets the
//                 ▭scanner──────▶___---          scanner's plane at 5.9 m
//   ══════════════════════════════
constexpr double kRises = 0.105;

Scene hill() {
  Scene s;
  s.ground = [](double x, double) { return x > 3.0 ? kRises * (x - 3.0) : 0.0; };
  return s;
}

SensorSetup plane_ahead(double z_m = 0.3) {
  SensorSetup s;
  s.name = "front";
  s.mount = {.x_m = 0.45, .z_m = z_m};
  s.planar = true;
  s.thin = true;
  s.health.rate_hz = 50.0;
  return s;
}

SensorSetup rings_above(double z_m = 0.8) {
  SensorSetup s;
  s.name = "top";
  s.mount = {.z_m = z_m};
  s.health.max_unknown_part = 0.9;  // half of what it looks at is the sky
  return s;
}

struct Going {
  double mps = 0.5;
  bool told = true;                             ///< something tells how the body leans
  base::Window window = base::Window::Unknown;  ///< of the lidar
};

/// Ahead over level ground, both look ten times a second.
class Climb {
 public:
  explicit Climb(std::vector<SensorSetup> eyes, Going going = {})
      : eyes_(eyes), going_(going), chain_(chain_of(std::move(eyes))) {
    for (const SensorSetup& eye : eyes_) {
      if (eye.planar) ahead_.push_back(eye);
    }
  }

  void drive(const Scene& scene, double from_s, double to_s) {
    const auto way = [this](double t) { return Pose2{going_.mps * (t - 1.0), 0.0, 0.0}; };
    const auto lie = [this](double) { return Lie3{.told = going_.told}; };
    for (double t = from_s; t < to_s; t += 0.1) {
      for (const SensorSetup& eye : eyes_) {
        const Rays rays = eye.planar ? planar() : sixteen_rings(300);
        base::Sight sight = look(
            scene, rays, eye.mount, t, [&](double when) { return planar_pose(way(when)); }, random_,
            20.0);
        sight.sensor = eye.name;
        if (!eye.planar) sight.window = going_.window;
        ASSERT_TRUE(chain_.take(sight, driven(t + 0.12, way, lie), at(t + 0.1)).has_value());
      }
      now_s_ = t;
    }
  }
  /// The plane alone, a few times.
  void look_by_planes(const Scene& scene, double t_s) {
    std::swap(eyes_, ahead_);
    drive(scene, t_s, t_s + 0.45);
    std::swap(eyes_, ahead_);
  }
  /// Along y = 0, that is taken.
  std::vector<double> taken(double from_m, double to_m) const {
    std::vector<double> out;
    for (double x = from_m; x < to_m; x += 0.05) {
      if (chain_.grid().at(x, 0.0, at(now_s_)) == Known::Occupied) out.push_back(x);
    }
    return out;
  }

 private:
  static Chain chain_of(std::vector<SensorSetup> eyes) {
    auto chain = Chain::of({}, std::move(eyes), Footprint::box(1.0, 0.8, 0.5), at(0.0));
    return std::move(chain.value());
  }
  std::vector<SensorSetup> eyes_;
  std::vector<SensorSetup> ahead_;  ///< of them, the planes
  Going going_;
  Chain chain_;
  std::mt19937 random_{1};
  double now_s_ = 0.0;
};

//        ●lidar                 Its rings do not see the foot of what is near: they lay a slope
//       ▭scanner──▶▒            through its face, which is no ground that the scanner may believe.
//   ═══════════════▒══
TEST(HillsTest, WhoComesFromTheSideAndHidesTheGroundFromTheLidarIsAnObstacle) {
  for (const auto& [high_m, x] : {std::pair{0.35, 1.2}, {0.35, 1.7}, {0.4, 1.4}, {0.45, 1.3}}) {
    Climb stands({plane_ahead(), rings_above(0.7)}, {.mps = 0.0});
    stands.drive({}, 1.0, 1.05);
    Scene scene;
    scene.blocks = {{x, x + 0.4, -0.2, 0.2, 0.0, high_m}};
    stands.drive(scene, 1.1, 1.35);
    ASSERT_FALSE(stands.taken(x - 0.06, x + 0.1).empty()) << high_m << " m high at " << x;
  }
}

//   It lies there when the robot starts; the lowest ring never saw its foot, or two rings have it
//   between them, and the robot drives on.
//         ●lidar      Its lowest ring meets the thing 0.34 m over the ground, and nothing below:
//   ▭═══════ ═▟▙══    a slope of 15 deg from the body on would do as well. But there the ground
//                     was seen.
TEST(HillsTest, WhoLiesWhereTheLidarSawLevelGroundBeforeIsNotLaidAsGround) {
  Scene level;
  level.ground = [](double, double) { return 0.0; };
  for (const double high_m : {0.36, 0.39}) {
    Climb drives({rings_above()});
    drives.drive(level, 1.0, 7.0);  // to x = 3 m
    EXPECT_TRUE(drives.taken(3.5, 6.0).empty());
    Scene lies = level;
    lies.blocks.push_back({4.8, 5.4, -0.3, 0.3, -0.1, high_m});
    drives.drive(lies, 7.0, 7.45);
    const auto taken = drives.taken(4.6, 5.6);
    ASSERT_FALSE(taken.empty()) << high_m;
    EXPECT_NEAR(taken.front(), 4.8, 0.11) << high_m;
  }
}

TEST(HillsTest, WhatLiesAheadLowAndFarOffStaysAnObstacleOnTheWayThere) {
  struct Case {
    double lidar_m, scanner_m, high_m, x;
  };
  for (const Case& c :
       {Case{0.7, 0.2, 0.3, 2.0}, Case{0.7, 0.15, 0.25, 2.0}, Case{0.8, 0.25, 0.3, 2.3},
        Case{1.2, 0.3, 0.35, 3.5}, Case{1.5, 0.3, 0.36, 4.4}, Case{0.7, 0.2, 0.3, 6.3}}) {
    Climb drives({plane_ahead(c.scanner_m), rings_above(c.lidar_m)});
    Scene scene;
    scene.blocks = {{c.x, c.x + 0.4, -0.2, 0.2, 0.0, c.high_m}};
    drives.drive(scene, 1.0, 1.25);
    for (double t = 1.3; 0.5 * (t - 1.0) < std::min(c.x - 0.9, 2.5); t += 0.3) {
      drives.drive(scene, t, t + 0.05);
      ASSERT_FALSE(drives.taken(c.x - 0.06, c.x + 0.1).empty())
          << c.high_m << " m high at " << c.x << ", lidar " << c.lidar_m << ", after " << t << " s";
    }
  }
}

TEST(HillsTest, AHillThatTheLidarSeesIsGroundToTheScannerAsWell) {
  Climb both({plane_ahead(), rings_above()});
  both.drive(hill(), 1.0, 5.0);
  EXPECT_TRUE(both.taken(2.5, 7.5).empty()) << both.taken(2.5, 7.5).front();
}

TEST(HillsTest, WhereNobodySawTheGroundItIsAnObstacle) {
  Climb alone({plane_ahead()});
  alone.drive(hill(), 1.0, 5.0);
  ASSERT_FALSE(alone.taken(2.5, 7.5).empty());
  EXPECT_NEAR(alone.taken(2.5, 7.5).front(), 3.0 + 0.3 / kRises, 0.15);
}

TEST(HillsTest, ABoxOnTheHillStaysWhoeverSeesIt) {
  Scene scene = hill();
  scene.blocks.push_back({5.0, 5.3, -0.2, 0.2, 0.0, kRises * 2.0 + 0.25});
  Climb both({plane_ahead(), rings_above()});
  both.drive(scene, 1.0, 5.0);
  ASSERT_FALSE(both.taken(2.5, 7.5).empty());
  EXPECT_NEAR(both.taken(2.5, 7.5).front(), 5.0, 0.1);
}

//   Blades stand on the hill: the plane meets them up to twice rough_m and min_height_m over the
//   lowest ground, but no higher than half of the plane's own height over level ground.
TEST(HillsTest, GrassOnTheHillIsGroundToAPlaneThatIsMountedHighEnough) {
  const auto taken_at = [](double scanner_m, double blades_m) {
    Scene scene = hill();
    Scene grass = hill();
    grass.ground = [blades_m](double x, double) {
      return x > 3.0 ? kRises * (x - 3.0) + blades_m : 0.0;
    };
    Climb both({plane_ahead(scanner_m), rings_above()});
    both.drive(scene, 1.0, 3.0);
    both.look_by_planes(grass, 3.0);
    return both.taken(3.0, 7.5).size();
  };
  EXPECT_EQ(taken_at(0.3, 0.13), 0U);
  EXPECT_GT(taken_at(0.3, 0.19), 0U);
  EXPECT_GT(taken_at(0.18, 0.13), 0U) << "mounted so low it may be a thing";
}

//   A lidar whose window is blocked is not believed to see ground, and heights over a body of
//   which nothing tells how it leans are none in O.
TEST(HillsTest, OnlyWhoSeesAndHeightsThatAreToldMakeItGround) {
  Climb blocked({plane_ahead(), rings_above()}, {.window = base::Window::Blocked});
  blocked.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(blocked.taken(2.5, 7.5).empty());
  Climb untold({plane_ahead(), rings_above()}, {.told = false});
  untold.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(untold.taken(2.5, 7.5).empty());
}

//   The echo of a cone tells no height: it may lie anywhere across it.
TEST(HillsTest, WhatARangeSensorMeetsStaysAnObstacle) {
  SensorSetup cone = plane_ahead();
  cone.thin = false;
  Climb both({cone, rings_above()});
  both.drive(hill(), 1.0, 5.0);
  EXPECT_FALSE(both.taken(2.5, 7.5).empty());
}

Reduced piece(double t, std::vector<Voxel> voxels) {
  Reduced out;
  out.stamp = at(t);
  out.lie.told = true;
  out.voxels = std::move(voxels);
  return out;
}

/// Ground that rises straight from the body, through this place and on.
Reduced ground_through(double t, const std::vector<Voxel>& places) {
  Reduced out = piece(t, {});
  for (const Voxel& v : places) {
    for (const float part : {0.25F, 0.5F, 0.75F, 1.0F, 1.2F}) {
      out.voxels.push_back({part * v.x_m, part * v.y_m, part * v.z_m, 1, Kind::Ground});
    }
  }
  return out;
}

TEST(HillsTest, WhatThePlaneMetBeforeIsGroundOnceTheGroundIsSeen) {
  Hills hills(8.0, 0.08);
  Sectors sectors;
  sectors.planar = sectors.thin = true;
  Grid grid({});
  grid.take(piece(1.0, {{5.9F, 0.0F, 0.3F, 1}, {5.9F, 0.4F, 0.6F, 1}}), sectors, 0, &hills);
  ASSERT_EQ(grid.at(5.9, 0.0, at(1.0)), Known::Occupied);
  const Reduced cloud = ground_through(1.5, {{5.88F, 0.02F, 0.27F}, {5.9F, 0.4F, 0.27F}});
  hills.learn(cloud);
  sectors.planar = sectors.thin = false;
  grid.take(cloud, sectors, 1, &hills);
  EXPECT_EQ(grid.at(5.9, 0.0, at(1.5)), Known::Unknown) << "a ray must say that it is free";
  EXPECT_EQ(grid.at(5.9, 0.4, at(1.5)), Known::Occupied) << "that stands 0.3 m over the ground";
}

//   What a lidar believed, a plane's echo keeps, and what it takes for ground takes nothing away.
TEST(HillsTest, WhatTheCloudMetBeforeStays) {
  Hills hills(8.0, 0.08);
  Sectors sectors;
  Grid grid({});
  grid.take(piece(1.0, {{5.9F, 0.0F, 0.3F, 1}}), sectors, 1, &hills);
  hills.learn(ground_through(1.1, {{5.88F, 0.02F, 0.27F}}));
  Reduced plane = piece(1.2, {{5.9F, 0.0F, 0.3F, 1}});
  ASSERT_EQ(hills.judge(plane), 1U);
  sectors.planar = sectors.thin = true;
  grid.take(plane, sectors, 0, &hills);
  EXPECT_EQ(grid.at(5.9, 0.0, at(1.2)), Known::Occupied);
}

/// A plane's echo 0.3 m high at 4 m, where the ground was seen before.
std::size_t judged(float ground_m, double later_s) {
  Hills hills(8.0, 0.3);
  Reduced cloud = ground_through(1.0, {{4.0F, 0.0F, ground_m - 0.5F}});
  cloud.lie.z_m = 0.5;
  hills.learn(cloud);
  Reduced plane = piece(1.0 + later_s, {{2.05F, 0.05F, 0.3F, 1}});
  plane.pose = {2.0, 0.0, 0.0};  // it came down by 0.3 m on the way
  plane.lie.z_m = 0.2;
  return hills.judge(plane);
}

//   Heights must agree, and be of these seconds, however tall the grass may be by the settings.
TEST(HillsTest, GroundOfLongAgoAndGroundFarAboveSayNothing) {
  EXPECT_EQ(judged(0.5F, 2.0), 1U);
  EXPECT_EQ(judged(0.33F, 2.0), 1U);
  EXPECT_EQ(judged(0.31F, 2.0), 0U) << "0.19 m over the ground";
  EXPECT_EQ(judged(0.64F, 2.0), 1U);
  EXPECT_EQ(judged(0.66F, 2.0), 0U) << "0.16 m within it";
  EXPECT_EQ(judged(0.5F, 14.9), 1U);
  EXPECT_EQ(judged(0.5F, 30.1), 0U);
}

//   Ground at 4 m; then the robot drives on and comes back, or stands as long.
TEST(HillsTest, TheFartherTheRobotDrivesTheSoonerGroundIsForgotten) {
  const auto known_after = [](double way_m, double time_s) {
    Hills hills(8.0, 0.08);
    hills.learn(ground_through(0.0, {{4.0F, 0.0F, 0.3F}}));
    for (int i = 1; i <= 100; ++i) {
      Reduced away = ground_through(0.01 * i * time_s, {{4.0F, 7.0F, 0.0F}});
      away.pose.x_m = 0.5 * way_m * (1.0 - std::abs(0.02 * i - 1.0));
      hills.learn(away);
    }
    return hills.is_ground(4.0, 0.0, 0.3F, at(time_s));
  };
  EXPECT_TRUE(known_after(0.0, 14.9)) << "as long as it stands: 15 s at least, 30 s at most";
  EXPECT_FALSE(known_after(0.0, 30.1));
  EXPECT_TRUE(known_after(4.9, 0.1)) << "on the way: 5 m at least, 10 m at most";
  EXPECT_FALSE(known_after(10.1, 0.1));
  EXPECT_TRUE(known_after(2.4, 7.5)) << "half of each";
  EXPECT_FALSE(known_after(6.0, 15.0));
}

//   Two that tell ground, one of them 0.2 s late, at 1 m/s: the way is driven once.
TEST(HillsTest, TheWayIsCountedOnceHoweverManyTellTheGround) {
  Hills hills(8.0, 0.08);
  hills.learn(ground_through(0.0, {{4.0F, 0.0F, 0.3F}}));
  for (int i = 1; i <= 35; ++i) {
    for (const double late_s : {0.0, 0.2}) {
      const double at_s = 0.1 * i - late_s;
      Reduced away = ground_through(at_s, {{4.0F, 7.0F, 0.0F}});
      away.pose.x_m = at_s;
      hills.learn(away);
    }
  }
  EXPECT_TRUE(hills.is_ground(4.0, 0.0, 0.3F, at(3.5))) << "3.5 m, 3.5 s";
}

TEST(HillsTest, TheWayIsCountedWhileNobodyTellsTheGround) {
  const auto known_after = [](double way_m) {
    Hills hills(8.0, 0.08);
    hills.learn(ground_through(0.0, {{4.0F, 0.0F, 0.3F}}));
    for (int i = 1; i <= 100; ++i) {  // a scanner's pieces
      Reduced plane = piece(0.1 * i, {});
      plane.pose.x_m = 0.01 * i * way_m;
      hills.drive(plane);
    }
    return hills.is_ground(4.0, 0.0, 0.3F, at(10.0));
  };
  EXPECT_TRUE(known_after(1.5));
  EXPECT_FALSE(known_after(8.0));
}

TEST(HillsTest, TheLowestGroundOfTheseSecondsCounts) {
  Hills hills(8.0, 0.08);
  hills.learn(ground_through(1.0, {{4.0F, 0.0F, 0.0F}}));
  hills.learn(ground_through(1.2, {{4.0F, 0.0F, 0.3F}}));
  EXPECT_FALSE(hills.is_ground(4.0, 0.0, 0.3F, at(1.3))) << "something came to stand there";
  EXPECT_TRUE(hills.is_ground(4.0, 0.0, 0.05F, at(1.3)));
  //   Seen so for long, it is the ground: the lean was wrong before.
  for (double t = 1.5; t < 32.0; t += 0.5) {
    hills.learn(ground_through(t, {{4.0F, 0.0F, 0.3F}}));
  }
  EXPECT_TRUE(hills.is_ground(4.0, 0.0, 0.3F, at(32.0)));
}

Voxel ground_at(float x_m, float z_m) {
  return {x_m, 0.0F, z_m, 1, Kind::Ground};
}

TEST(HillsTest, GroundIsLearnedFromTheBodyOutwards) {
  const auto learned = [](std::vector<Voxel> voxels, double x, float z) {
    Hills hills(8.0, 0.08);
    hills.learn(piece(1.0, std::move(voxels)));
    return hills.is_ground(x, 0.0, z, at(1.1));
  };
  EXPECT_TRUE(learned({ground_at(2.0F, 0.07F), ground_at(3.0F, 0.06F)}, 2.0, 0.1F));
  EXPECT_FALSE(learned({ground_at(2.0F, 0.09F), ground_at(3.0F, 0.1F)}, 2.0, 0.1F))
      << "the first: it may be a face whose foot is hidden";
  EXPECT_FALSE(
      learned({ground_at(2.0F, 0.0F), ground_at(3.0F, 0.22F), ground_at(4.0F, 0.3F)}, 3.0, 0.25F))
      << "0.22 m in a metre";
  EXPECT_TRUE(
      learned({ground_at(2.0F, 0.0F), ground_at(3.0F, 0.12F), ground_at(4.0F, 0.24F)}, 3.0, 0.15F));
  EXPECT_FALSE(
      learned({ground_at(2.0F, 0.0F), ground_at(3.0F, 0.12F), ground_at(4.0F, 0.0F)}, 3.0, 0.15F))
      << "behind it the ground lies as low as before";
  EXPECT_FALSE(
      learned({ground_at(2.0F, 0.0F), ground_at(3.0F, 0.12F), ground_at(3.1F, 0.13F)}, 3.0, 0.15F))
      << "nothing behind it";
}

//   ●turns ↺     ___▒▒   Once it was seen over ground that begins at the robot; from then on the
//   ▭════  ══───▔        first ring ahead meets it well above the robot's plane.
TEST(HillsTest, GroundThatIsSeenAgainAsHighAsItWasStaysKnown) {
  const auto known_after = [](float again_m, double until_s, float echo_m) {
    Hills hills(8.0, 0.08);
    hills.learn(ground_through(1.0, {{4.0F, 0.0F, 0.3F}}));
    for (double t = 1.1; t < until_s; t += 0.1) hills.learn(piece(t, {ground_at(4.0F, again_m)}));
    return hills.is_ground(4.0, 0.0, echo_m, at(until_s));
  };
  EXPECT_TRUE(known_after(0.3F, 100.0, 0.35F));
  EXPECT_TRUE(known_after(0.27F, 100.0, 0.33F)) << "a little lower: that height counts";
  EXPECT_FALSE(known_after(0.27F, 100.0, 0.37F));
  EXPECT_FALSE(known_after(0.34F, 100.0, 0.4F)) << "its height does not rise";
  EXPECT_FALSE(known_after(0.36F, 100.0, 0.35F)) << "that is something else, or the lean was wrong";
  EXPECT_FALSE(known_after(0.24F, 100.0, 0.25F)) << "likewise";
}

TEST(HillsTest, WhatIsSeenTooLateToBeKnownAnewIsNot) {
  Hills hills(8.0, 0.08);
  hills.learn(ground_through(1.0, {{4.0F, 0.0F, 0.3F}}));
  hills.learn(piece(31.1, {ground_at(4.0F, 0.3F)}));
  EXPECT_FALSE(hills.is_ground(4.0, 0.0, 0.3F, at(31.2)));
}

//   Lower ground 10 cm down the slope does not make a thing of a blade; below a face it does.
TEST(HillsTest, GroundRisesFromOnePlaceToTheNextNoMoreSteeplyThanGroundDoes) {
  const auto is_ground = [](float below_m) {
    Hills hills(8.0, 0.08);
    hills.learn(ground_through(1.0, {{3.95F, 0.05F, below_m}, {4.05F, 0.05F, 0.3F}}));
    return hills.is_ground(4.05, 0.05, 0.375F, at(1.1));
  };
  EXPECT_TRUE(is_ground(0.285F));
  EXPECT_FALSE(is_ground(0.27F));
}

//   Rings close to one another climb a bank by a few centimetres each: that is no leave to go on.
TEST(HillsTest, ASteepBankIsNotClimbedFromRingToRing) {
  Hills hills(8.0, 0.08);
  std::vector<Voxel> bank;
  for (int i = 0; i < 60; ++i) {
    const float x = 0.05F + 0.1F * static_cast<float>(i);
    bank.push_back(ground_at(x, std::clamp(0.4F * (x - 3.0F), 0.0F, 0.36F)));
  }
  hills.learn(piece(1.0, bank));
  EXPECT_TRUE(hills.is_ground(2.9, 0.0, 0.05F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(3.6, 0.0, 0.24F, at(1.1)));
}

TEST(HillsTest, BeyondWhereCellsAreCountedNothingIsGround) {
  for (const double x : {1e9, -1e300, std::nan("")}) {
    Hills hills(8.0, 0.08);
    Reduced cloud = ground_through(1.0, {{4.0F, 0.0F, 0.0F}});
    cloud.pose.x_m = x;
    hills.learn(cloud);
    EXPECT_FALSE(hills.is_ground(x + 4.0, 0.0, 0.0F, at(1.1)));
    Grid grid({});
    grid.take(cloud, Sectors{}, 0, &hills);
    EXPECT_EQ(grid.at(0.0, 0.0, at(1.1)), Known::Unknown);
  }
}

//   Behind it lay a hill: 256 cells of 0.1 m farther on nobody has seen the ground.
TEST(HillsTest, PlacesAWindowApartAreTwo) {
  Hills hills(8.0, 0.08);
  hills.learn(ground_through(1.0, {{4.0F, 0.0F, 0.3F}}));
  ASSERT_TRUE(hills.is_ground(4.0, 0.0, 0.3F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(29.6, 0.0, 0.3F, at(1.1)));
  EXPECT_FALSE(hills.is_ground(4.0, -25.6, 0.3F, at(1.1)));
}

TEST(HillsTest, AllOfItIsForgottenWhereNothingTellsTheLeanAnyMore) {
  Hills hills(8.0, 0.08);
  hills.learn(ground_through(1.0, {{4.0F, 0.0F, 0.3F}}));
  Reduced untold = ground_through(1.1, {{5.0F, 0.0F, 0.3F}});
  untold.lie.told = false;
  hills.learn(untold);
  EXPECT_FALSE(hills.is_ground(4.0, 0.0, 0.3F, at(1.2)));
  EXPECT_FALSE(hills.is_ground(5.0, 0.0, 0.3F, at(1.2)));
}

}  // namespace
}  // namespace roverd::nav::sense
