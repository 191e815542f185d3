// Whoever crosses is waited for before his way, or passed in time; beside whoever might turn it
// goes no faster than it stands by then.
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
        EXPECT_GT(d.way_m, 1.8) << "it went on: " << speed << " " << his << " " << meets_s;
      }
    }
  }
}

TEST(Foresee, WhoPassesFarOffOrWalksAwayCostsNothing) {
  ProtectParams p;
  p.turn_part = 0.0;  // nobody turns
  EXPECT_EQ(drive(walker({12.0, -3.0}, {0.0, 1.5}), 1.0, p, 3.0).slowest_mps, 1.0);
  EXPECT_EQ(drive(walker({2.0, 1.5}, {1.0, 0.0}), 1.0, p).slowest_mps, 1.0);
  EXPECT_EQ(drive(walker({2.0, 1.0}, {0.0, 1.0}), 1.0, p).slowest_mps, 1.0);
  // From behind: to stand would help nobody.
  EXPECT_EQ(drive(walker({-2.0, 0.0}, {1.5, 0.0}), 1.0, p, 2.0).slowest_mps, 1.0);
}

/// Somebody walks along, past or away, and turns straight towards the robot once he is so far
/// ahead of it. That is told as late as it is seen, and what is commanded is done as late
/// as the robot does it.
struct Turns {
  double ahead_m;
  double beside_m;  ///< at about that time
  Vec2 v;
};
/// @return the robot's speed when he is there; empty: he does not come to it, or would have turned
/// back for it, or comes from behind.
std::optional<double> speed_when_met(const Turns& turns, double speed_mps, const ProtectParams& p) {
  constexpr double kStep_s = 0.02;
  constexpr int kDelay = 10;
  constexpr double kTold_s = 0.3;
  constexpr double kBefore_s = 4.0;
  Odometry now;
  now.v_mps = speed_mps;
  Vec2 v = turns.v;
  Vec2 him{turns.ahead_m + kBefore_s * (speed_mps - v.x), turns.beside_m - kBefore_s * v.y};
  std::vector<double> commanded(kDelay, speed_mps);
  const double pace = std::hypot(v.x, v.y);
  const bool overtakes = v.x >= speed_mps;
  std::optional<double> turned_s;
  for (double t = 0.0; t < 12.0; t += kStep_s) {
    const Vec2 to{now.pose.x_m - him.x, -him.y};
    const bool there = overtakes ? -to.x >= turns.ahead_m - 1e-9 : -to.x <= turns.ahead_m;
    if (!turned_s && t > 0.5 * kBefore_s && there) {
      if (dot(v, to) < 0.0) return std::nullopt;
      turned_s = t;
    }
    if (turned_s) v = pace / std::hypot(to.x, to.y) * to;
    him = him + kStep_s * v;
    now.stamp = at(t);
    Mover told = walker(him, turned_s && t >= *turned_s + kTold_s ? v : turns.v);
    told.seen = at(t);
    commanded.push_back(speed_mps * foresee({&told, 1}, now, kBody, {speed_mps, 0.0}, p).part);
    const double goal = commanded[commanded.size() - kDelay];
    now.v_mps = goal < now.v_mps ? std::max(goal, now.v_mps - kStep_s * p.decel_mps2)
                                 : std::min(goal, now.v_mps + kStep_s * 0.5);
    now.pose.x_m += kStep_s * now.v_mps;
    const Vec2 off{him.x - now.pose.x_m, him.y};
    if (turned_s && off.x < -0.5) return std::nullopt;
    if (turned_s && kBody.distance_m(off) <= told.radius_m) return now.v_mps;
  }
  return std::nullopt;
}

TEST(Foresee, ItStandsByThenWhoeverTurnsTowardsIt) {
  const ProtectParams p;
  ProtectParams blunt;
  blunt.turn_part = 0.0;
  for (const double speed : {0.5, 1.0, 1.3}) {
    int met = 0;
    int met_driving = 0;
    for (const double his : {0.5, 0.8, 1.2, 1.7, 2.0}) {
      for (const double beside_m : {1.1, 1.4, 1.8, 2.4, 3.2}) {
        for (const double ahead_m : {0.3, 1.1, 2.0, 4.0}) {
          for (const Vec2 way : {Vec2{-1.0, 0.0}, Vec2{-0.8, 0.6}, Vec2{0.0, 1.0}, Vec2{0.8, 0.6},
                                 Vec2{0.8, -0.6}, Vec2{1.0, 0.0}}) {
            const Turns turns{ahead_m, beside_m, his * way};
            const auto kept = speed_when_met(turns, speed, p);
            const auto not_kept = speed_when_met(turns, speed, blunt);
            met += kept ? 1 : 0;
            met_driving += not_kept && *not_kept > 0.02 ? 1 : 0;
            // Who overtakes at a run turns as soon as he is not behind any more.
            EXPECT_LE(kept.value_or(0.0), way.x * his > speed ? 0.1 : 0.02)
                << speed << " m/s, he " << his << " m/s to " << way.x << " " << way.y << ", "
                << ahead_m << " m ahead, " << beside_m << " m beside";
          }
        }
      }
    }
    EXPECT_GT(met, 50) << speed;
    EXPECT_GT(met_driving, 20) << speed << ": without the rule they are met";
  }
}

TEST(Foresee, BesideWhoeverWalksAlongItKeepsOneSpeed) {
  const ProtectParams p;
  constexpr double kWanted_mps = 1.3;
  Odometry now;
  now.v_mps = kWanted_mps;
  double before = 1.0;
  int jumps = 0;
  double least_mps = 1e9;
  double most_mps = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.02) {
    now.stamp = at(t);
    // He swings as people do.
    Mover him = walker({1.2 * t, 1.9}, {1.2 + 0.1 * std::sin(7.0 * t), 0.1 * std::sin(5.0 * t)});
    him.seen = at(t);
    const double part = foresee({&him, 1}, now, kBody, {kWanted_mps, 0.0}, p).part;
    jumps += std::abs(part - before) > 0.2 ? 1 : 0;
    before = part;
    const double to = part * kWanted_mps;
    now.v_mps = to < now.v_mps ? std::max(to, now.v_mps - 0.02 * p.decel_mps2)
                               : std::min(to, now.v_mps + 0.01);
    now.pose.x_m += 0.02 * now.v_mps;
    if (t < 8.0) continue;
    least_mps = std::min(least_mps, now.v_mps);
    most_mps = std::max(most_mps, now.v_mps);
  }
  EXPECT_LE(jumps, 1);
  EXPECT_LT(most_mps - least_mps, 0.35) << "it comes up to him by and by";
  EXPECT_NEAR(most_mps, 1.2, 0.1) << "as fast as he walks";
}

/// One look at one who walks, from a robot that moves as it is commanded.
Foreseen look_at(Vec2 his_place, Vec2 v, const base::BodyTwist& twist, const ProtectParams& p = {},
                 const Footprint* whole = nullptr) {
  const Odometry now{at(0.0), {}, twist.linear_mps, twist.angular_radps, {}};
  return foresee(std::vector{walker(his_place, v)}, now, kBody, twist, p, whole);
}

TEST(Foresee, InReverseItSlowsAsAhead) {
  const Foreseen ahead = look_at({1.5, 2.0}, {-1.2, 0.0}, {1.0, 0.0});
  const Foreseen back = look_at({-1.5, 2.0}, {1.2, 0.0}, {-1.0, 0.0});
  ASSERT_TRUE(ahead.may_turn);
  EXPECT_LT(ahead.part, 0.9);
  EXPECT_NEAR(back.part, ahead.part, 1e-6);
}

TEST(Foresee, HisPartOfTheSpeedCountsByItself) {
  ProtectParams p;
  p.turn_part = 0.5;
  // 1.0 m from edge to edge: 0.6 (0.55 + λ 0.7 / 0.6) = 1.0 - 0.08
  EXPECT_NEAR(look_at({0.0, 1.65}, {1.2, 0.0}, {0.7, 0.0}, p).part, (0.92 / 0.6 - 0.55) * 0.6 / 0.7,
              2e-3);
}

TEST(Foresee, ATurnOnTheSpotIsBrakedAsTurnsAre) {
  const Foreseen f = look_at({0.0, 2.0}, {1.5, 0.0}, {0.0, 0.8});
  ASSERT_TRUE(f.may_turn);
  // 0.8 rad/s at 0.42 rad/s²: 1.9 s. The sides that swing come nearer by some of it.
  EXPECT_LT(f.part, (1.27 / 1.5 - 0.55) * 0.42 / 0.8 + 1e-6);
  EXPECT_GT(f.part, 0.0);
  // A corner leaves him now; before it stands the next one comes round.
  // 1.45 m from edge to edge: 0.8 (0.55 + λ 1.2 / 0.42) = 1.45 - 0.08
  EXPECT_NEAR(look_at({0.57, -2.1}, {0.8, 0.0}, {0.0, 1.2}).part, 0.41, 0.02);
}

TEST(Foresee, BesideWhatItPullsHeIsAsNear) {
  const Footprint whole = Footprint::box(3.5, 0.8, 3.0);
  const Vec2 place{-2.0, 1.7};
  EXPECT_EQ(look_at(place, {0.9, 0.0}, {0.6, 0.0}).part, 1.0);
  const Foreseen f = look_at(place, {0.9, 0.0}, {0.6, 0.0}, {}, &whole);
  EXPECT_TRUE(f.may_turn);
  EXPECT_NEAR(f.room_m, 1.7 - 0.4 - 0.25, 1e-9);
  EXPECT_NEAR(f.meets_s, f.room_m / 0.9, 1e-3);
  // He goes along it the other way: off from the body, and no farther from what it pulls.
  EXPECT_LT(look_at({-2.5, 1.9}, {-0.9, 0.0}, {0.6, 0.0}, {}, &whole).part, 0.9);
}

TEST(Foresee, WhoComesAnyhowIsNotSaidToTurn) {
  ProtectParams blunt;
  blunt.turn_part = 0.0;
  const Foreseen comes = look_at({3.0, -2.5}, {0.0, 1.0}, {1.0, 0.0}, blunt);
  ASSERT_TRUE(comes.found);
  const Foreseen f = look_at({3.0, -2.5}, {0.0, 1.0}, {1.0, 0.0});
  EXPECT_LT(f.part, comes.part);
  EXPECT_FALSE(f.may_turn);
  EXPECT_EQ(f.meets_s, comes.meets_s);
}

TEST(Foresee, WhomItLeavesIsToldApart) {
  const Vec2 left{-0.8, 1.0};
  const Vec2 v{1.2, 0.0};
  const Foreseen leaves = look_at(left, v, {1.0, 0.0});
  EXPECT_EQ(leaves.part, 0.0);
  EXPECT_EQ(leaves.unless_left, 1.0);
  const Foreseen nears = look_at({0.9, 1.0}, {0.0, 1.5}, {1.0, 0.0});
  EXPECT_LT(nears.part, 1.0);
  EXPECT_EQ(nears.unless_left, nears.part);
  // With somebody ahead as well who comes, or might: those count on.
  const Odometry now{at(0.0), {}, 1.0, 0.0, {}};
  for (const Mover& ahead : {walker({1.2, -1.0}, {0.0, 0.7}), walker({1.6, -1.6}, {-1.0, 0.0})}) {
    const double alone = foresee(std::vector{ahead}, now, kBody, {1.0, 0.0}, {}).part;
    ASSERT_LT(alone, 1.0);
    const Foreseen both = foresee(std::vector{walker(left, v), ahead}, now, kBody, {1.0, 0.0}, {});
    EXPECT_EQ(both.part, 0.0);
    EXPECT_EQ(both.unless_left, alone);
  }
}

TEST(Foresee, WhoWalksAlongBesideItSlowsItAndDoesNotStopIt) {
  const auto part = [&](Vec2 his_place, Vec2 v, double speed) {
    return look_at(his_place, v, {speed, 0.0});
  };
  const Foreseen abreast = part({0.0, 1.9}, {0.7, 0.0}, 0.7);
  EXPECT_TRUE(abreast.may_turn);
  EXPECT_NEAR(abreast.at.y, 1.9, 1e-9);
  // 1.25 m from edge to edge: 0.7 (0.35 + 0.2 + λ 0.7 / 0.6) = 1.25 - 0.08
  EXPECT_NEAR(abreast.part, (1.17 / 0.7 - 0.55) * 0.6 / 0.7, 1e-6);
  // Slower, he is far from it; and who leads the way goes off.
  EXPECT_EQ(part({0.0, 1.9}, {0.4, 0.0}, 0.7).part, 1.0);
  EXPECT_GT(part({2.5, 0.3}, {1.0, 0.0}, 1.0).part, 0.95);
  // Who overtakes it beside may turn into its flank; who walks up straight behind it, runs into it.
  EXPECT_TRUE(part({-1.3, 1.3}, {1.9, 0.0}, 0.5).may_turn);
  EXPECT_FALSE(part({-1.3, 0.3}, {1.9, 0.0}, 0.5).found);
  EXPECT_TRUE(part({-1.3, 1.05}, {1.9, 0.0}, 0.5).may_turn);
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
  // Nor do those who follow it, however near.
  std::vector<Mover> behind(16, walker({-0.95, 0.0}, {0.9, 0.0}));
  behind.push_back(near);
  EXPECT_EQ(foresee(behind, now, kBody, {1.0, 0.0}, p).part, alone);
}

}  // namespace
}  // namespace roverd::nav::sense
