// What sensors saw, and how the body moved, become the surroundings: which sight waits for whom.

#include "robot/guard/lookout.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
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

Lookout lookout(double front_hz = 50.0, nav::sense::ChainParams params = {}) {
  std::vector<nav::sense::SensorSetup> eyes(2);
  eyes[0].name = "front";
  eyes[1].name = "rear";
  for (auto& eye : eyes) {
    eye.mount.z_m = 0.3;
    eye.planar = true;
    eye.health.rate_hz = 50.0;
  }
  eyes[0].health.rate_hz = front_hz;
  eyes[0].health.silent_s = std::max(0.3, 2.5 / front_hz);
  eyes[1].mount.yaw_rad = base::kPi;
  auto chain = nav::sense::Chain::of(params, eyes, footprint_of({}), at(0.0));
  EXPECT_TRUE(chain);
  return {std::move(*chain), {"sick", "sick"}, 6.0};
}

void stand(Lookout& l, double from_s, double to_s) {
  for (double t = from_s; t < to_s; t += 0.02) l.moved({.stamp = at(t), .pose = {}});
}

Known ahead(const Surroundings& s, double x_m) {
  return s.patch.at(static_cast<std::int32_t>(std::floor(x_m / s.patch.cell_m)), 0).known;
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

TEST(Lookout, ASightFromWithinTheTickThatRunsWaitsForNothingAndIsPlacedAlongTheTwist) {
  Lookout l = lookout();
  // Given a robot that drives at 5 m/s, and was 1.4 m from its begin when it last told,
  for (int i = 0; i <= 14; ++i) {
    l.moved({.stamp = at(0.02 * i), .pose = {0.1 * i, 0.0, 0.0}, .v_mps = 5.0});
  }
  // when a wall two metres ahead is seen one tick later, and it has not told again,
  l.see(wall("front", 0.30, 0), at(0.30));
  // then it stands two metres before where the robot is by then, not before where it was.
  const auto s = l.picture(at(0.30));
  ASSERT_NE(s, nullptr);
  EXPECT_EQ((*s->sensors)[0].seen, at(0.30));
  EXPECT_EQ(ahead(*s, 3.52), Known::Occupied);
  EXPECT_NE(ahead(*s, 3.42), Known::Occupied);
  // One that is farther ahead waits.
  l.see(wall("front", 0.32, 1), at(0.32));
  EXPECT_EQ((*l.picture(at(0.42))->sensors)[0].seen, at(0.30));
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

/// A slow sensor that looks ahead and a fast one that looks back, from 0 s on.
class SlowAndFast : public ::testing::Test {
 protected:
  /// @param front it still tells. @param good what it tells is of use
  void run(double to_s, bool front, bool good = true) {
    for (; t_s < to_s; t_s += 0.02) {
      l.moved({.stamp = at(t_s), .pose = {}});
      l.see(wall("rear", t_s, rear++), at(t_s));
      if (!front || t_s < next_s) continue;
      next_s += 0.5;
      auto sight = std::make_shared<base::Sight>(*wall("front", t_s, ahead_count++));
      // Dazzled: it tells of no direction anything.
      for (auto& p : sight->points) p.echo = good ? p.echo : base::Echo::Unknown;
      l.see(std::move(sight), at(t_s));
    }
  }

  Lookout l = lookout(2.0);
  double t_s = 0.0;
  double next_s = 0.0;
  std::uint64_t rear = 0;
  std::uint64_t ahead_count = 0;
};

TEST_F(SlowAndFast, WhatTheDeadOneSawFreeIsBelievedForItsOwnPeriodsOnly) {
  // Given both, and then the rear one alone: between two pieces of the slow one nothing changes,
  run(5.4, true);
  EXPECT_EQ(ahead(*l.picture(at(t_s)), 1.2), Known::Free);
  run(6.0, false);
  EXPECT_EQ(ahead(*l.picture(at(t_s)), 1.2), Known::Free);
  // when it should have told three times,
  run(7.5, false);
  // then nobody knows any more what is before it, though the other one is as fresh as ever;
  const auto s = l.picture(at(t_s));
  EXPECT_EQ((*s->sensors)[0].health, SensorHealth::Silent);
  EXPECT_EQ((*s->sensors)[1].health, SensorHealth::Good);
  EXPECT_EQ(ahead(*s, 1.2), Known::Unknown);
  EXPECT_EQ(ahead(*s, 2.02), Known::Occupied) << "what stood there still does";
  EXPECT_EQ(ahead(*s, -1.2), Known::Free) << "the other one sees";
  // and the guard lets it creep there, no faster, and drive back as it will.
  Guard guard;
  guard.set({}, {}, true);
  (void)guard.move({}, at(t_s));
  (void)guard.take(s);
  EXPECT_FALSE(guard.too_old(at(t_s)));
  EXPECT_NEAR(guard.judge({0.4, 0.0}, true, at(t_s)).linear_mps, 0.25, 1e-9);
  EXPECT_EQ(guard.obstacle().what, "unseen");
  EXPECT_NEAR(guard.judge({-0.4, 0.0}, true, at(t_s)).linear_mps, -0.4, 1e-9);
}

/// A scanner's piece: so many beams of a degree, from that one on to the left, are met at that
/// range.
std::shared_ptr<const base::Sight> beams(double s, std::uint64_t count, int met, double range_m,
                                         double from_deg = -2.0) {
  auto sight = std::make_shared<base::Sight>();
  sight->sensor = "front";
  sight->stamp = at(s);
  sight->count = count;
  sight->half_step_rad = 0.009F;
  sight->clear_to_m = 8.0F;
  for (int i = -90; i <= 90; ++i) {
    const double bearing = base::rad_from_deg(i);
    const bool hit = i >= from_deg && i < from_deg + met;
    const double r = hit ? range_m : 8.0;
    sight->points.push_back({float(r * std::cos(bearing)), float(r * std::sin(bearing)), 0.0F, 0.0F,
                             0, 0, hit ? base::Echo::Hit : base::Echo::Clear});
  }
  return sight;
}

/// What the rays say of five pieces alike of a scanner at the front of the body.
std::optional<RaysStop> rays_said(int met, double range_m, double from_deg = -2.0,
                                  bool enabled = true) {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 50.0;
  nav::sense::ChainParams chain;
  chain.reduce.voxel_m = 0.01;  // a beam a voxel
  nav::sense::RaysParams rays;
  rays.enabled = enabled;
  Lookout l(*nav::sense::Chain::of(chain, {eye}, footprint_of({}), at(0.0)), {"sick"}, 6.0, rays);
  stand(l, 0.0, 0.2);
  for (int i = 0; i < 5; ++i) {
    l.see(beams(0.02 * i, std::uint64_t(i), met, range_m, from_deg), at(0.1));
  }
  return l.picture(at(0.1))->rays;
}

TEST(CountedRays, FiveShortOnesStopAndFourDoNot) {
  EXPECT_FALSE(rays_said(4, 0.69));
  const auto five = rays_said(5, 0.69);
  ASSERT_TRUE(five);
  EXPECT_EQ(five->rays, 5);
  EXPECT_EQ(five->sensor, 0);
  EXPECT_EQ(five->seen, at(0.08));
  EXPECT_NEAR(std::hypot(five->at.x - 0.6, five->at.y), 0.69, 0.001) << "from the sensor";
  EXPECT_FALSE(rays_said(5, 0.71));
  EXPECT_FALSE(rays_said(30, 0.71));
  EXPECT_TRUE(rays_said(60, 0.3, -30.0)) << "nearer, too";
}

TEST(CountedRays, OnlyThoseWithinTheStoppingFanCount) {
  // 12 to 15 degrees are four within 15.94, and 16 on are outside of it.
  EXPECT_FALSE(rays_said(20, 0.65, 12.0));
  EXPECT_TRUE(rays_said(20, 0.65, 11.0));
  EXPECT_FALSE(rays_said(20, 0.65, -31.0)) << "-31 to -12: the same on the right";
  EXPECT_FALSE(rays_said(5, 0.5, -2.0, false)) << "unless it is enabled";
}

TEST(CountedRays, ASensorThatFallsBlindTakesNothingBack) {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 50.0;
  nav::sense::RaysParams rays;
  rays.enabled = true;
  Lookout l(*nav::sense::Chain::of({}, {eye}, footprint_of({}), at(0.0)), {"sick"}, 6.0, rays);
  stand(l, 0.0, 2.0);
  std::uint64_t n = 0;
  double t = 0.0;
  for (; t < 0.4; t += 0.02) l.see(beams(t, n++, 30, 0.6, -15.0), at(t));
  EXPECT_TRUE(l.picture(at(t))->rays);
  for (; t < 0.8; t += 0.02) {
    auto dazzled = std::make_shared<base::Sight>(*beams(t, n++, 0, 0.6));
    for (auto& p : dazzled->points) p.echo = base::Echo::Unknown;
    l.see(std::move(dazzled), at(t));
  }
  EXPECT_TRUE(l.picture(at(t))->rays);
  EXPECT_TRUE(l.picture(at(t + 1.0))->rays) << "silent";
  // So does not what came so near that its cubes are fewer than five rays.
  for (; t < 1.0; t += 0.02) l.see(beams(t, n++, 30, 0.2, -15.0), at(t));
  EXPECT_TRUE(l.picture(at(t))->rays);
  // One that sees again, and nothing there, does.
  for (; t < 1.4; t += 0.02) l.see(beams(t, n++, 0, 0.6), at(t));
  EXPECT_FALSE(l.picture(at(t))->rays);
}

/// Two scanners at the front, 50 pieces a second; the first one need not see.
Lookout two_scanners() {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 50.0;
  eye.needed = false;
  nav::sense::SensorSetup other = eye;
  other.name = "other";
  other.needed = true;
  nav::sense::RaysParams rays;
  rays.enabled = true;
  return {*nav::sense::Chain::of({}, {eye, other}, footprint_of({}), at(0.0)),
          {"sick", "sick"},
          6.0,
          rays};
}

TEST(CountedRays, ASensorThatNeedNotSeeAndDiesSaysStopForTheUnseenOnly) {
  Lookout l = two_scanners();
  stand(l, 0.0, 1.2);
  const auto see = [&l](const char* who, double t, std::uint64_t n, int met) {
    auto sight = std::make_shared<base::Sight>(*beams(t, n, met, 0.6, -15.0));
    sight->sensor = who;
    l.see(std::move(sight), at(t));
  };
  std::uint64_t n = 0;
  double t = 0.0;
  for (; t < 0.4; t += 0.02, ++n) {
    see("front", t, n, 30);
    see("other", t, n, 0);
  }
  auto s = l.picture(at(t));
  ASSERT_TRUE(s->rays);
  EXPECT_FALSE(s->rays->lost);
  // Silent since, but for the other: at first its word holds,
  for (; t < 0.6; t += 0.02, ++n) see("other", t, n, 0);
  s = l.picture(at(t));
  ASSERT_TRUE(s->rays);
  EXPECT_FALSE(s->rays->lost);
  // then it is as good as nothing seen,
  for (; t < 1.2; t += 0.02, ++n) see("other", t, n, 0);
  s = l.picture(at(t));
  ASSERT_TRUE(s->rays);
  EXPECT_TRUE(s->rays->lost);
  // While it lies behind a turn on the spot it holds nobody,
  const auto moved = [&l](double t_s, nav::sense::Pose2 pose) {
    nav::sense::Odometry o;
    o.stamp = at(t_s);
    o.pose = pose;
    l.moved(o);
  };
  const auto drives_on = [&](double until_s, nav::sense::Pose2 pose) {
    for (; t < until_s; t += 0.02, ++n) {
      moved(t, pose);
      see("other", t, n, 0);
    }
    return l.picture(at(t));
  };
  s = drives_on(1.3, {0.0, 0.0, base::kPi});
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->rays);
  // but it is there again when that is turned back;
  s = drives_on(1.5, {0.0, 0.0, 0.0});
  ASSERT_TRUE(s && s->rays);
  EXPECT_TRUE(s->rays->lost);
  // and far behind the robot nothing at all, whichever way it turns then.
  s = drives_on(1.7, {6.0, 0.0, 0.0});
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->rays);
  s = drives_on(1.9, {0.0, 0.0, 0.0});
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->rays);
}

TEST(CountedRays, BeforeTheyStopTheyTellTheWayThatIsLeft) {
  Lookout l = two_scanners();
  stand(l, 0.0, 1.0);
  for (std::uint64_t n = 0; n < 5; ++n) {
    const double t = 0.02 * static_cast<double>(n);
    l.see(beams(t, n, 30, 1.2, -15.0), at(t));
  }
  const auto s = l.picture(at(0.1));
  EXPECT_FALSE(s->rays);
  ASSERT_TRUE(s->rays_ahead);
  EXPECT_NEAR(s->rays_ahead->way_m, 0.5, 0.05) << "1.2 m less the 0.7";
  EXPECT_GE(s->rays_ahead->rays, 5);
}

TEST_F(SlowAndFast, WhatABlindOneSawIsNotBelievedEither) {
  run(5.0, true);
  run(7.5, true, false);
  const auto s = l.picture(at(t_s));
  EXPECT_EQ((*s->sensors)[0].health, SensorHealth::Blind);
  EXPECT_EQ(ahead(*s, 1.2), Known::Unknown);
  EXPECT_EQ(ahead(*s, 2.02), Known::Occupied);
  // And when it sees again, it is.
  run(8.1, true);
  EXPECT_EQ(ahead(*l.picture(at(t_s)), 1.2), Known::Free);
}

TEST_F(SlowAndFast, APictureThatNobodyMadeAnewIsNotBelievedAsLongAsTheSlowOneMayTake) {
  run(5.0, true);
  Guard guard;
  guard.set({}, {}, true);
  (void)guard.take(l.picture(at(t_s)));
  EXPECT_FALSE(guard.too_old(at(t_s + 0.3)));
  EXPECT_TRUE(guard.too_old(at(t_s + 0.7))) << "whoever makes the pictures stands still";
}

TEST(Lookout, ATrailerIsNothingInTheWay) {
  // Given something 2 m behind, wider than a trailer's sector,
  nav::sense::ChainParams with;
  nav::ToolParams tool;
  tool.hitch_m = 0.5;
  tool.trailer_m = 1.5;
  with.pulled = pulled_of(tool, {1.2, 0.9});
  for (const bool pulls : {false, true}) {
    Lookout l = lookout(50.0, pulls ? with : nav::sense::ChainParams{});
    stand(l, 0.0, 0.5);
    for (int i = 0; i < 5; ++i) l.see(wall("rear", 0.1 * i, std::uint64_t(i)), at(0.5));
    const auto s = l.picture(at(0.5));
    const auto beside = [&](std::int32_t iy) {
      bool any = false;
      for (std::int32_t ix = -42; ix < -38; ++ix)
        any |= s->patch.at(ix, iy).known == Known::Occupied;
      return any;
    };
    // then what may be the trailer is not seen, and what lies beside that is.
    EXPECT_EQ(beside(0), !pulls);
    EXPECT_TRUE(beside(37));
  }
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

OutlookParams shown() {
  return {.body = footprint_of({}), .side_m = 0.08, .horizon_s = 6.0, .range_m = 8.0};
}

TEST(Lookout, ShowsPeopleTheWallAsOneThingAsRaysAsPointsAndAsCells) {
  Lookout l = lookout();
  EXPECT_EQ(l.outlook(shown(), at(0.0)), nullptr) << "the body's place is not known yet";
  stand(l, 0.0, 0.5);
  for (int i = 0; i < 5; ++i) l.see(wall("front", 0.1 * i, std::uint64_t(i)), at(0.5));
  const auto o = l.outlook(shown(), at(0.5));
  ASSERT_NE(o, nullptr);
  EXPECT_EQ(*o->seen, at(0.4));
  // It is 4 m wide as far as it is seen, and begins 2 m ahead.
  ASSERT_EQ(o->things.size(), 1u);
  const Outlook::Thing& thing = o->things[0];
  EXPECT_FALSE(thing.drop);
  EXPECT_NEAR(thing.ahead_m, 2.0, 0.06);
  EXPECT_NEAR(thing.clearance_m, 2.0 - 0.5 * nav::VehicleParams{}.length_m, 0.06);
  EXPECT_NEAR(thing.size_m, 4.0, 0.2);
  EXPECT_EQ(thing.sensor, "front");
  EXPECT_FALSE(thing.on_way) << "it stands";
  EXPECT_NEAR(o->rays[180].hit_m, 2.0, 0.06);
  EXPECT_NEAR(o->rays[180].free_m, 1.95, 0.06);
  EXPECT_NEAR(o->rays[180 + 30].hit_m, 2.0 / std::cos(0.5236), 0.1);
  EXPECT_EQ(o->rays[0].hit_m, 0.0F) << "nobody looks behind";
  ASSERT_EQ(o->scans.size(), 1u) << "the rear one has said nothing";
  EXPECT_EQ(o->scans[0].sensor, "front");
  EXPECT_GT(o->scans[0].spots.size(), 50u);
  for (const auto& spot : o->scans[0].spots) EXPECT_NEAR(spot.ahead_m, 2.0F, 0.03F);
  // Two by two cells are one; the square is whole and bounded.
  EXPECT_DOUBLE_EQ(o->grid.cell_m, 0.1);
  EXPECT_NEAR(o->grid.side, 160, 2);
  EXPECT_LE(o->grid.runs.size(), 200u * 200u);
  std::size_t cells = 0;
  for (const std::uint8_t run : o->grid.runs) cells += (run & 63U) + 1;
  EXPECT_EQ(cells, static_cast<std::size_t>(o->grid.side) * static_cast<std::size_t>(o->grid.side));
}

TEST(Lookout, ShowsWhatWasSeenFromTheBodyAsItStandsNowAndWhatItDrivesAgainst) {
  Lookout l = lookout();
  stand(l, 0.0, 0.5);
  for (int i = 0; i < 5; ++i) l.see(wall("front", 0.1 * i, std::uint64_t(i)), at(0.5));
  // Half a metre on, at half a metre a second.
  for (double t = 0.5; t < 1.5; t += 0.02) {
    l.moved({.stamp = at(t), .pose = {0.5 * (t - 0.5), 0.0, 0.0}, .v_mps = 0.5});
  }
  const auto o = l.outlook(shown(), at(1.5));
  ASSERT_EQ(o->things.size(), 1u);
  EXPECT_NEAR(o->things[0].ahead_m, 1.51, 0.06);
  EXPECT_TRUE(o->things[0].on_way);
  EXPECT_NEAR(o->scans[0].spots[0].ahead_m, 1.51F, 0.06F);
}

TEST(KeptScan, IsBoundedHoweverMuchWasSeen) {
  nav::sense::Reduced in;
  in.voxels.assign(100'000, {.x_m = 1.0F, .kind = nav::sense::Kind::Obstacle});
  in.voxels.resize(150'000, {.kind = nav::sense::Kind::Ground});
  KeptScan kept;
  kept.keep(in, at(0.0));
  EXPECT_LE(kept.voxels.size(), Outlook::kMostDots);
  EXPECT_GT(kept.voxels.size(), Outlook::kMostDots / 2);
}

//   camera ─▶  a cone by name, a wall beside it; no ranging sensor at all
TEST(Lookout, WhatACameraRecognisesIsKnownWithoutAnySensorThatLooksAround) {
  auto chain = nav::sense::Chain::of({}, {}, footprint_of({}), at(0.0));
  ASSERT_TRUE(chain);
  Lookout l(std::move(*chain), {}, 6.0);
  l.watch_by({Camera{"camera", {.x_m = 0.4}, 0.5}});
  stand(l, 0.0, 1.0);
  const auto image = [](const std::string& sensor, double s) {
    auto v = std::make_shared<base::Vision>();
    v->sensor = sensor;
    v->stamp = at(s);
    v->landmarks = {{"cone", {2.0, 0.5, 0.0}}};
    v->obstacles = {{3.0, 0.0, 0.0}};
    v->planes = {{{1.0, 0.9, 0.0}, {0.0, -1.0, 0.0}, 5000.0},
                 {{-1.0, 0.3, 0.0}, {0.0, -1.0, 0.0}, 9000.0}};
    return v;
  };
  for (int i = 0; i < 5; ++i) l.recognise(image("camera", 0.1 + 0.1 * i));
  l.recognise(image("camera", 50.0));   // of a time of which the odometry knows nothing
  l.recognise(image("stranger", 0.9));  // nobody's
  const auto s = l.picture(at(1.0));
  ASSERT_NE(s, nullptr);
  EXPECT_TRUE(s->sensors->empty());
  ASSERT_NE(s->beside, nullptr);
  EXPECT_EQ(s->beside->stamp, at(0.5));
  ASSERT_EQ(s->beside->landmarks.size(), 1u);
  EXPECT_EQ(s->beside->landmarks[0].name, "cone");
  EXPECT_TRUE(s->beside->landmarks[0].believed);
  EXPECT_NEAR(s->beside->landmarks[0].at.x, 2.4, 1e-6);
  ASSERT_EQ(s->beside->walls.size(), 1u) << "the one behind the camera is a false one";
  EXPECT_NEAR(std::abs(s->beside->walls[0].distance_m({0.0, 0.0})), 0.9, 1e-6);
  const auto shown = l.outlook({.body = footprint_of({})}, at(1.0));
  ASSERT_NE(shown, nullptr);
  ASSERT_EQ(shown->landmarks.size(), 1u);
  EXPECT_NEAR(shown->landmarks[0].ahead_m, 2.4, 1e-6);
  EXPECT_TRUE(shown->landmarks[0].by_vision);
  EXPECT_EQ(shown->walls.size(), 1u);
  ASSERT_EQ(shown->spots.size(), 1u);
  EXPECT_NEAR(shown->spots[0].ahead_m, 3.4, 1e-6);
  EXPECT_EQ(shown->planes.size(), 2u) << "the table shows what was told";
}

TEST(Lookout, OneCamerasImagesSayNothingOfHowOldAnothersWordIs) {
  auto chain = nav::sense::Chain::of({}, {}, footprint_of({}), at(0.0));
  ASSERT_TRUE(chain);
  Lookout l(std::move(*chain), {}, 6.0);
  l.watch_by({Camera{"ahead", {.x_m = 0.4}, 0.5},
              Camera{"behind", {.x_m = -0.4, .yaw_rad = base::kPi}, 0.5}});
  stand(l, 0.0, 2.0);
  const auto image = [](const std::string& sensor, double s, bool cone) {
    auto v = std::make_shared<base::Vision>();
    v->sensor = sensor;
    v->stamp = at(s);
    if (cone) v->landmarks = {{"cone", {2.0, 0.5, 0.0}}};
    return v;
  };
  // Given a cone that the camera ahead told until it died at 0.5 s,
  for (int i = 1; i <= 5; ++i) {
    l.recognise(image("ahead", 0.1 * i, true));
    l.recognise(image("behind", 0.1 * i, false));
  }
  // when the one behind goes on,
  for (int i = 6; i <= 15; ++i) l.recognise(image("behind", 0.1 * i, false));
  // then the view is as new as that, and nobody who told the cone has looked since.
  const auto beside = l.picture(at(1.5))->beside;
  ASSERT_EQ(beside->landmarks.size(), 1u);
  const nav::marks::Eyes eyes = beside->landmarks[0].eyes;
  EXPECT_TRUE(beside->looked_since(at(1.5), 0));
  EXPECT_TRUE(beside->looked_since(at(0.5), eyes));
  EXPECT_FALSE(beside->looked_since(at(0.6), eyes));
}

}  // namespace
}  // namespace roverd::robot
