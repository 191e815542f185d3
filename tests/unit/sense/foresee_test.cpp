// Whoever crosses is waited for before his way, or passed in time; nobody else costs anything.
#include "nav/sense/foresee.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/sweep.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kBody = Footprint::box(1.0, 0.8, 0.5);

Mover walker(Vec2 from, Vec2 v) {
  return {from, v, 0.25, 0.05, 3, at(0.0)};
}

/// It drives as it is let, every 20 ms, with the brakes that it has.
struct Drove {
  double nearest_m = 1e9;  ///< while it moved
  double way_m = 0.0;
  double slowest_mps = 1e9;
};
Drove drive(const Mover& who, double speed_mps, const ProtectParams& p, double lasts_s = 8.0) {
  Drove out;
  Odometry now;
  now.v_mps = speed_mps;
  for (double t = 0.0; t < lasts_s; t += 0.02) {
    now.stamp = at(t);
    Mover seen = who;
    seen.seen = at(t);
    seen.at = who.at + t * who.v_mps;
    const Foreseen f = foresee(std::vector{seen}, now, kBody, {speed_mps, 0.0}, p);
    const double to = f.part * speed_mps;
    now.v_mps = to < now.v_mps ? std::max(to, now.v_mps - 0.02 * p.decel_mps2)
                               : std::min(to, now.v_mps + 0.02);
    now.pose.x_m += 0.02 * now.v_mps;
    const Vec2 off{seen.at.x - now.pose.x_m, seen.at.y};
    if (now.v_mps > 0.0) out.nearest_m = std::min(out.nearest_m, kBody.distance_m(off) - 0.25);
    out.slowest_mps = std::min(out.slowest_mps, now.v_mps);
  }
  out.way_m = now.pose.x_m;
  return out;
}

TEST(Foresee, WhoeverCrossesIsNotTouchedAtAnySpeedAndMoment) {
  ProtectParams p;
  for (const double speed : {0.5, 1.0, 1.3}) {
    for (const double his : {0.5, 1.0, 2.0}) {
      for (double meets_s = 2.5; meets_s < 5.0; meets_s += 0.25) {
        const double x = 0.5 + speed * 3.5;
        const Drove d = drive(walker({x, -his * meets_s}, {0.0, his}), speed, p);
        EXPECT_GT(d.nearest_m, 0.0) << speed << " " << his << " " << meets_s;
        EXPECT_GT(d.way_m, 2.0) << "it went on: " << speed << " " << his << " " << meets_s;
      }
    }
  }
}

TEST(Foresee, WhoPassesFarOffOrWalksAwayCostsNothing) {
  const ProtectParams p;
  EXPECT_EQ(drive(walker({12.0, -3.0}, {0.0, 1.5}), 1.0, p, 3.0).slowest_mps, 1.0);
  EXPECT_EQ(drive(walker({2.0, 1.5}, {1.0, 0.0}), 1.0, p).slowest_mps, 1.0);
  EXPECT_EQ(drive(walker({2.0, 1.0}, {0.0, 1.0}), 1.0, p).slowest_mps, 1.0);
  // From behind: to stand would help nobody.
  EXPECT_EQ(drive(walker({-2.0, 0.0}, {1.5, 0.0}), 1.0, p, 2.0).slowest_mps, 1.0);
}

/// Somebody walks past, and turns straight towards the robot. That is told as late as it is seen,
/// and what is commanded is done as late as the robot does it.
struct Turns {
  Vec2 from;
  Vec2 v;
  double at_s = 1.0;
};
/// @return the robot's speed when he is there; empty: he is not, within 8 s, or turned back for it,
/// or came from behind.
std::optional<double> speed_when_met(const Turns& turns, double speed_mps, const ProtectParams& p) {
  constexpr double kStep_s = 0.02;
  constexpr int kDelay = 10;
  constexpr double kTold_s = 0.3;
  Odometry now;
  now.v_mps = speed_mps;
  Vec2 him = turns.from;
  Vec2 v = turns.v;
  std::vector<double> commanded(kDelay, speed_mps);
  const double pace = std::hypot(v.x, v.y);
  for (double t = 0.0; t < 8.0; t += kStep_s) {
    const Vec2 to{now.pose.x_m - him.x, -him.y};
    const bool walks_on = t < turns.at_s;
    if (!walks_on && dot(turns.v, to) < 0.0) return std::nullopt;
    if (!walks_on) v = pace / std::hypot(to.x, to.y) * to;
    him = him + kStep_s * v;
    now.stamp = at(t);
    Mover told = walker(him, t < turns.at_s + kTold_s ? turns.v : v);
    told.seen = at(t);
    commanded.push_back(speed_mps * foresee({&told, 1}, now, kBody, {speed_mps, 0.0}, p).part);
    const double goal = commanded[commanded.size() - kDelay];
    now.v_mps = goal < now.v_mps ? std::max(goal, now.v_mps - kStep_s * p.decel_mps2)
                                 : std::min(goal, now.v_mps + kStep_s * 0.5);
    now.pose.x_m += kStep_s * now.v_mps;
    const Vec2 off{him.x - now.pose.x_m, him.y};
    if (off.x < -0.5) return std::nullopt;
    if (kBody.distance_m(off) <= told.radius_m) return now.v_mps;
  }
  return std::nullopt;
}

TEST(Foresee, ItStandsByThenWhoeverTurnsTowardsIt) {
  const ProtectParams p;
  ProtectParams blunt;
  blunt.turn_part = 0.0;
  int met = 0;
  int met_driving = 0;
  for (const double speed : {0.5, 1.0, 1.3}) {
    for (const double his : {0.6, 1.2, 1.7, 2.0}) {
      for (const double beside_m : {1.0, 1.7, 2.4, 3.2}) {
        for (const double ahead_m : {2.0, 4.0, 6.0}) {
          // Towards it at first, and along beside.
          for (const Vec2 way : {his * Vec2{-1.0, 0.0}, his * Vec2{-0.8, 0.6}}) {
            for (double at_s = 0.3; at_s < 3.0; at_s += 0.3) {
              const Turns turns{{ahead_m, beside_m}, way, at_s};
              const auto kept = speed_when_met(turns, speed, p);
              const auto not_kept = speed_when_met(turns, speed, blunt);
              met += kept ? 1 : 0;
              met_driving += not_kept && *not_kept > 0.02 ? 1 : 0;
              // Who is nearer than brakes are quick at the very first look, cannot be stood before.
              if (at_s < 0.6 + speed / p.decel_mps2) continue;
              EXPECT_LE(kept.value_or(0.0), 0.02)
                  << speed << " " << his << " " << beside_m << " " << ahead_m << " " << at_s;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(met_driving, 50) << "without the rule they are met: that is what it is for";
}

TEST(Foresee, WhoWalksAlongBesideItSlowsItAndDoesNotStopIt) {
  const ProtectParams p;
  const auto part = [&](Vec2 his_place, Vec2 v, double speed) {
    const Odometry now{at(0.0), {}, speed, 0.0, {}};
    return foresee(std::vector{walker(his_place, v)}, now, kBody, {speed, 0.0}, p);
  };
  const Foreseen abreast = part({0.0, 1.9}, {0.7, 0.0}, 0.7);
  EXPECT_TRUE(abreast.may_turn);
  EXPECT_NEAR(abreast.at.y, 1.9, 1e-9);
  // 1.25 m from edge to edge: 0.7 (0.35 + 0.2 + λ 0.7 / 0.6) = 1.25 - 0.08
  EXPECT_NEAR(abreast.part, (1.17 / 0.7 - 0.55) * 0.6 / 0.7, 1e-6);
  // Slower, he is far from it; and who leads the way goes off.
  EXPECT_EQ(part({0.0, 1.9}, {0.4, 0.0}, 0.7).part, 1.0);
  EXPECT_EQ(part({2.5, 0.3}, {1.0, 0.0}, 1.0).part, 1.0);
  // Who overtakes it beside may turn into its flank; who walks up straight behind it, runs into it.
  EXPECT_TRUE(part({-1.3, 1.3}, {1.9, 0.0}, 0.5).may_turn);
  EXPECT_FALSE(part({-1.3, 0.3}, {1.9, 0.0}, 0.5).found);
  // So near that it would not stand in time at any speed, it stands.
  EXPECT_EQ(part({0.0, 1.2}, {1.2, 0.0}, 1.0).part, 0.0);
}

TEST(Foresee, WhoComesStraightAtItIsStoodBefore) {
  const Foreseen f = foresee(std::vector{walker({2.5, 0.0}, {-1.0, 0.0})},
                             Odometry{at(0.0), {}, 0.0, 0.0, {}}, kBody, {1.0, 0.0}, {});
  EXPECT_EQ(f.part, 0.0);
  EXPECT_TRUE(f.found);
  EXPECT_EQ(f.sensor, 3);
  EXPECT_NEAR(f.at.x, 2.5, 1e-9);
}

TEST(Foresee, ItIsToldHowFarAndHowNear) {
  ProtectParams p;
  const Odometry now{at(0.0), {}, 1.0, 0.0, {}};
  // He is in its way when it comes there.
  const std::vector late{walker({1.2, -1.0}, {0.0, 0.7})};
  EXPECT_LT(foresee(late, now, kBody, {1.0, 0.0}, p).part, 1.0);
  p.foresee_s = 0.0;  // not at all
  EXPECT_EQ(foresee(late, now, kBody, {1.0, 0.0}, p).part, 1.0);
}

TEST(Foresee, WithWeakBrakesItLooksAsFarAsBrakingLasts) {
  ProtectParams p;
  p.decel_mps2 = 0.25;  // 1.4 m/s: 5.8 s, 4.2 m
  const Odometry now{at(0.0), {}, 1.4, 0.0, {}};
  // He comes slowly towards it: within 3 s it still brakes before him, before it stands he is met.
  const std::vector him{walker({5.5, 0.0}, {-0.3, 0.0})};
  EXPECT_LT(foresee(him, now, kBody, {1.4, 0.0}, p).part, 1.0);
}

TEST(Foresee, AStickThatIsDrawnBackLeavesTheSpeedThatIsThere) {
  const ProtectParams p;
  // From 1.4 m/s to 0.3 m/s it takes 2 s, and comes 1.5 m farther than at 0.3 m/s at once.
  const std::vector him{walker({1.9, -2.0}, {0.0, 1.2})};
  const Odometry fast{at(0.0), {}, 1.4, 0.0, {}};
  const Odometry slow{at(0.0), {}, 0.3, 0.0, {}};
  EXPECT_FALSE(foresee(him, slow, kBody, {0.3, 0.0}, p).found);
  EXPECT_TRUE(foresee(him, fast, kBody, {0.3, 0.0}, p).found);
}

TEST(Foresee, WhatItPullsDoesNotPassBeforeHimEither) {
  ProtectParams p;
  p.turn_part = 0.0;
  const Footprint whole = Footprint::box(3.5, 0.8, 3.0);
  const Odometry now{at(0.0), {}, 1.0, 0.0, {}};
  // Two metres behind the body's end is where he comes to its way: onto the trailer.
  const std::vector him{walker({0.0, -2.2}, {0.0, 1.0})};
  EXPECT_FALSE(foresee(him, now, kBody, {1.0, 0.0}, p).found);
  EXPECT_TRUE(foresee(him, now, kBody, {1.0, 0.0}, p, &whole).found);
  // Beside the trailer he is behind the body, and not behind the trailer.
  const std::vector beside{walker({-1.5, -1.2}, {0.8, 0.8})};
  EXPECT_FALSE(foresee(beside, now, kBody, {1.0, 0.0}, p).found);
  EXPECT_TRUE(foresee(beside, now, kBody, {1.0, 0.0}, p, &whole).found);
}

TEST(Foresee, ACrowdFarOffHidesNobodyWhoIsNear) {
  const ProtectParams p;
  const Odometry now{at(0.0), {}, 1.0, 0.0, {}};
  std::vector<Mover> all(16, walker({6.0, 2.0}, {0.0, 0.5}));
  const Mover near = walker({1.2, -1.0}, {0.0, 0.7});
  const double alone = foresee(std::vector{near}, now, kBody, {1.0, 0.0}, p).part;
  ASSERT_LT(alone, 1.0);
  all.push_back(near);
  EXPECT_EQ(foresee(all, now, kBody, {1.0, 0.0}, p).part, alone);
}

}  // namespace
}  // namespace roverd::nav::sense
