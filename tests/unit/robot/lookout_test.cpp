// What sensors saw, and how the body moved, become the surroundings: which sight waits for whom.

#include "robot/guard/lookout.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "robot/guard/guard.hpp"

namespace roverd::robot {
namespace {

using base::SensorHealth;
using nav::sense::Known;

base::Time at(double s) {
  return base::Time{} + base::from_seconds(100.0 + s);
}

/// A scanner's piece: a wall two metres ahead, and nothing else as far as 8 m.
std::shared_ptr<const base::Sight> wall(const std::string& sensor, double s, std::uint64_t count) {
  auto sight = std::make_shared<base::Sight>();
  sight->sensor = sensor;
  sight->stamp = at(s);
  sight->count = count;
  sight->half_step_rad = 0.004F;
  sight->clear_to_m = 8.0F;
  for (int i = -90; i <= 90; ++i) {
    const double bearing = i * 0.0087;
    const double hit_m = 2.0 / std::cos(bearing);
    sight->points.push_back({float(hit_m * std::cos(bearing)), float(hit_m * std::sin(bearing)),
                             0.0F, 0.0F, 0, 0, base::Echo::Hit});
  }
  return sight;
}

Lookout lookout() {
  std::vector<nav::sense::SensorSetup> eyes(2);
  eyes[0].name = "front";
  eyes[1].name = "rear";
  for (auto& eye : eyes) {
    eye.mount.z_m = 0.3;
    eye.planar = true;
    eye.health.rate_hz = 50.0;
  }
  auto chain = nav::sense::Chain::of({}, eyes, footprint_of({}), at(0.0));
  EXPECT_TRUE(chain);
  return {std::move(*chain), {"sick", "sick"}, 6.0};
}

void stand(Lookout& l, double from_s, double to_s) {
  for (double t = from_s; t < to_s; t += 0.02) l.moved({.stamp = at(t), .pose = {}});
}

Known ahead(const Surroundings& s, double x_m) {
  return s.patch.at(static_cast<std::int32_t>(x_m / s.patch.cell_m), 0).known;
}

TEST(Lookout, TellsWhatStandsThereAndWhoSawItWhen) {
  Lookout l = lookout();
  stand(l, 0.0, 0.5);
  for (int i = 0; i < 5; ++i) l.see(wall("front", 0.1 * i, std::uint64_t(i)), at(0.5));
  const auto s = l.picture(at(0.5));
  ASSERT_NE(s, nullptr);
  EXPECT_EQ(ahead(*s, 2.02), Known::Occupied);
  EXPECT_EQ(ahead(*s, 1.2), Known::Free);
  EXPECT_EQ(ahead(*s, 3.0), Known::Unknown);
  EXPECT_EQ(*s->seen, at(0.4));
  EXPECT_EQ((*s->sensors)[0].name, "front");
  EXPECT_EQ((*s->sensors)[0].points, 181u);
  EXPECT_EQ((*s->sensors)[1].health, SensorHealth::Silent) << "the rear one said nothing";
}

TEST(Lookout, ASightThatWaitsForTheOdometryKeepsNoOtherWaiting) {
  Lookout l = lookout();
  stand(l, 0.0, 0.3);
  // Given one sensor's piece from a moment that the odometry has not told of yet,
  l.see(wall("front", 0.4, 0), at(0.4));
  // when another one's comes, of a moment that it has,
  l.see(wall("rear", 0.2, 0), at(0.4));
  // then this one is used.
  const auto s = l.picture(at(0.4));
  ASSERT_NE(s, nullptr);
  EXPECT_FALSE((*s->sensors)[0].seen);
  EXPECT_EQ((*s->sensors)[1].seen, at(0.2));
  // And the first, as soon as it is known where the robot was.
  stand(l, 0.3, 0.5);
  EXPECT_EQ((*l.picture(at(0.5))->sensors)[0].seen, at(0.4));
}

TEST(Lookout, ASensorThatFallsSilentIsToldSoAndWhatItSawGrowsOld) {
  Lookout l = lookout();
  stand(l, 0.0, 2.0);
  for (int i = 0; i < 50; ++i) l.see(wall("front", 0.02 * i, std::uint64_t(i)), at(0.02 * i));
  const auto early = l.picture(at(1.0));
  EXPECT_EQ((*early->sensors)[0].health, SensorHealth::Good) << (*early->sensors)[0].reason;
  const auto late = l.picture(at(2.0));
  EXPECT_EQ((*late->sensors)[0].health, SensorHealth::Silent);
  // The picture is new, what was seen is not: the guard does not believe it.
  Guard guard;
  guard.set({}, {}, true);
  (void)guard.take(late);
  EXPECT_TRUE(guard.too_old(at(2.0)));
  (void)guard.take(early);
  EXPECT_FALSE(guard.too_old(at(1.0)));
}

TEST(Lookout, TheNumberOfWaitingSightsIsBounded) {
  Lookout l = lookout();
  for (int i = 0; i < 10'000; ++i) l.see(wall("front", 0.001 * i, std::uint64_t(i)), at(0.0));
  EXPECT_EQ(l.picture(at(0.0)), nullptr) << "nobody told where the robot is";
}

TEST(Lookout, ASightOfNobodysIsLeft) {
  Lookout l = lookout();
  stand(l, 0.0, 0.3);
  l.see(wall("stranger", 0.1, 0), at(0.3));
  EXPECT_FALSE(l.picture(at(0.3))->seen);
}

}  // namespace
}  // namespace roverd::robot
