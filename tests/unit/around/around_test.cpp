// Ways around what stands on the route.
#include "nav/around/around.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "scene.hpp"

namespace roverd::nav::around {
namespace {

using sense::Known;
using sense::Pose2;
using tests::along_x;
using tests::objection;
using tests::Scene;

Answer ask(const Scene& scene, const Question& q, double start_m = 0.0) {
  Planner planner;
  Answer a;
  const auto ok = planner.plan(scene.patch, q, a);
  EXPECT_TRUE(ok.has_value()) << (ok ? "" : ok.error().fields.at(0).pointer);
  EXPECT_EQ(objection(scene.patch, q, a, start_m), "");
  return a;
}

Question car(double half_m = 8.0) {
  Question q = along_x(half_m);
  q.kinematics = {4.0, false, true};
  q.body = sense::Footprint::box(2.4, 1.2, 0.4);
  return q;
}

TEST(AroundTest, AFreeRouteNeedsNoWay) {
  const Answer a = ask(Scene(), along_x());
  EXPECT_EQ(a.found, Found::Clear);
  EXPECT_TRUE(a.path.empty());
}

//        ▓▓
//  ═▭════▓▓════    the lower side is the shorter
//        ▓▓
//        ▓▓  ← reaches farther to the left
TEST(AroundTest, ABoxIsPassedOnItsShorterSide) {
  Scene s;
  s.box(4.0, -0.4, 5.0, 1.2);
  const Answer a = ask(s, along_x());
  ASSERT_EQ(a.found, Found::Way);
  EXPECT_EQ(a.side, Side::Right);
  // The front bumper keeps 12 cm: the origin half a metre more.
  EXPECT_NEAR(a.blocked_from_m, 2.0 + 4.0 - 0.62, 0.15);
  EXPECT_NEAR(a.blocked_to_m, 2.0 + 5.0 + 0.62, 0.15);
  EXPECT_GT(a.leave_m, 2.0);
  EXPECT_LT(a.leave_m, a.blocked_from_m);
  EXPECT_GT(a.rejoin_m, a.blocked_to_m);
  EXPECT_LT(a.length_m, 1.15 * (a.rejoin_m - 2.0));
}

TEST(AroundTest, AWallIsPassedThroughItsGap) {
  Scene s;
  s.box(5.0, -10.0, 5.3, 1.5);
  s.box(5.0, 3.0, 5.3, 10.0);
  const Answer a = ask(s, along_x());
  ASSERT_EQ(a.found, Found::Way);
  EXPECT_EQ(a.side, Side::Left);
}

TEST(AroundTest, AGapThatIsTooNarrowIsNone) {
  Scene s;
  s.box(5.0, -10.0, 5.3, 1.5);
  s.box(5.0, 2.4, 5.3, 10.0);  // 0.9 m for 0.8 m of body and twice 0.12
  const Answer a = ask(s, along_x());
  EXPECT_EQ(a.found, Found::None);
  EXPECT_EQ(a.why, Why::Gap);
}

//   The corridor is wider than what is looked at: behind the wall's end there may be a way.
TEST(AroundTest, AWallThatGoesOnBeyondTheWindowIsNamed) {
  Scene s;
  s.box(5.0, -10.0, 5.3, 10.0);
  EXPECT_EQ(ask(s, along_x(12.0)).why, Why::Reach);
  EXPECT_EQ(ask(s, along_x(5.0)).why, Why::Gap);
}

TEST(AroundTest, ACorridorThatIsTooNarrowIsNamed) {
  Scene s;
  s.box(4.0, -0.5, 5.0, 0.5);
  const Answer a = ask(s, along_x(1.2));
  EXPECT_EQ(a.found, Found::None);
  EXPECT_EQ(a.why, Why::Corridor);
  EXPECT_EQ(ask(s, along_x(1.8)).found, Found::Way);
  Question lopsided = along_x(1.2);
  lopsided.left_m = 2.0;
  EXPECT_EQ(ask(s, lopsided).side, Side::Left);
}

TEST(AroundTest, AFenceThatLeavesNoWayIsNamed) {
  Scene s;
  s.box(4.0, -0.5, 5.0, 0.5);
  Question q = along_x();
  q.keep_in = {{{-3, -1}, {20, -1}, {20, 1}, {-3, 1}}};
  const Answer a = ask(s, q);
  EXPECT_EQ(a.found, Found::None);
  EXPECT_EQ(a.why, Why::Fence);
  q.keep_in = {{{-3, -1}, {20, -1}, {20, 3}, {-3, 3}}};
  EXPECT_EQ(ask(s, q).side, Side::Left);
  q.keep_in.clear();
  q.keep_out = {{{3, 0.6}, {6, 0.6}, {6, 3}, {3, 3}}};
  EXPECT_EQ(ask(s, q).side, Side::Right);
}

//   ▓▓▓▓▓▓▓▓
//  ═▭══════▓    the robot stands in it; it may turn round, or back out
//   ▓▓▓▓▓▓▓▓
TEST(AroundTest, ATrapIsLeftBackwardsOrByTurning) {
  Scene s;
  s.box(-1.0, 1.2, 4.0, 1.5);
  s.box(-1.0, -1.5, 4.0, -1.2);
  s.box(4.0, -1.5, 4.3, 1.5);
  Question q = along_x();
  q.route.front() = {-6.0, 0.0};
  q.here_m = 6.0;
  EXPECT_EQ(ask(s, q).found, Found::Way);
  q.kinematics.may_reverse = true;
  EXPECT_EQ(ask(s, q).found, Found::Way);
  q.left_m = q.right_m = 1.4;
  EXPECT_EQ(ask(s, q).why, Why::Corridor);
}

TEST(AroundTest, ACarTakesTheRoomThatItsRadiusNeeds) {
  Scene s;
  s.box(5.5, -0.5, 6.0, 0.5);
  const Answer a = ask(s, car());
  ASSERT_NE(a.found, Found::None) << sentence(a.why);
  for (const Place& p : a.path) EXPECT_FALSE(p.pivot);
}

TEST(AroundTest, ACarThatStandsTooNearBacksOffFirst) {
  Scene s;
  s.box(2.6, -0.6, 3.0, 0.6);
  Question q = car();
  q.route.front() = {-8.0, 0.0};
  q.here_m = 8.0;
  const Answer a = ask(s, q);
  ASSERT_NE(a.found, Found::None) << sentence(a.why);
  EXPECT_TRUE(std::any_of(a.path.begin(), a.path.end(), [](const Place& p) { return p.reverse; }));
  q.kinematics.may_reverse = false;
  const Answer stays = ask(s, q);
  EXPECT_EQ(stays.found, Found::None);
  EXPECT_EQ(stays.why, Why::Turning);
}

TEST(AroundTest, WhoStandsNearerThanTheLeastMayLeave) {
  Scene s;
  s.box(0.55, -0.5, 1.0, 0.5);  // 5 cm before the bumper
  Question q = along_x();
  q.kinematics.may_reverse = true;
  const Answer a = ask(s, q, 1.5);
  ASSERT_EQ(a.found, Found::Way) << sentence(a.why);
  EXPECT_TRUE(a.path[1].reverse) << "turning on the spot would touch";
}

//  ▓▓▓▓▓▓▓▓▓▓▓▓▓ ← so near that a turn needs what is kept besides the least: 2.4 cm, for the cells
//       ▭           ▮
//  ▓▓▓▓▓▓▓▓▓▓▓▓▓    ▮ ← further on the body passes between two posts, or does not
Scene between_walls(double wall_m, double post_m) {
  Scene s(Known::Free, 0.02, 8.0);
  s.box(wall_m, -2.0, wall_m + 0.1, 2.0);
  s.box(-wall_m - 0.1, -2.0, -wall_m, 2.0);
  for (const double y : {-0.84, 0.8}) {
    s.box(post_m, y, wall_m, y + 0.04);
    s.box(-wall_m, y, -post_m, y + 0.04);
  }
  return s;
}

TEST(AroundTest, ATurnOnTheSpotMayComeNearerThanWhatIsDriven) {
  // Given a body whose corners are 64.7 cm from its middle between walls whose cells' middles are
  // 77 cm from there: 2.1 cm less than what is driven keeps, and 3 are allowed,
  const Scene s = between_walls(0.76, 0.56);
  Question q = along_x();
  q.body = sense::Footprint::box(1.016, 0.8, 0.5);
  Planner planner;
  Answer a;
  ASSERT_TRUE(planner.plan(s.patch, q, a));
  // when it turns to drive out along them, then it comes as near as that,
  ASSERT_EQ(a.found, Found::Way) << sentence(a.why);
  EXPECT_TRUE(a.path[1].pivot);
  double turning = 1.0;
  double driving = 1.0;
  for (const Place& p : a.path) {
    double& nearest = p.pivot ? turning : driving;
    nearest = std::min(nearest, tests::clearance_of(s.patch, q.body, p.pose));
  }
  EXPECT_LT(turning, 0.12);
  EXPECT_GT(turning, 0.10);
  // and nowhere else.
  EXPECT_GE(driving, 0.12);
}

TEST(AroundTest, WhatIsDrivenAfterTheTurnKeepsItsLeast) {
  // 13 cm on both sides to the middles of what stands there, which may lie a cell's half nearer.
  const Answer a = ask(between_walls(0.76, 0.52), along_x());
  EXPECT_EQ(a.found, Found::None);
}

TEST(AroundTest, ATurnThatWouldComeNearerByMoreIsNone) {  // by 3.5 cm
  EXPECT_EQ(ask(between_walls(0.74, 0.6), along_x()).found, Found::None);
}

TEST(AroundTest, WhoStandsInSomethingIsToldSo) {
  Scene s;
  s.pole(0.2, 0.1, 0.1);
  EXPECT_EQ(ask(s, along_x()).why, Why::Touching);
}

TEST(AroundTest, DropsAreGoneAroundAsWell) {
  Scene s;
  s.box(4.0, -0.5, 5.0, 0.5, Known::Drop);
  EXPECT_EQ(ask(s, along_x()).found, Found::Way);
}

TEST(AroundTest, WhatIsUnseenEndsAPartOrIsDriven) {
  Scene s;
  s.box(4.0, -0.5, 4.3, 0.5);
  s.box(5.0, -10.0, 10.0, 10.0, Known::Unknown);
  Question q = along_x();
  const Answer part = ask(s, q);
  ASSERT_EQ(part.found, Found::Part);
  EXPECT_EQ(part.why, Why::Unseen);
  EXPECT_GT(part.length_m, 3.0);
  for (const Place& p : part.path) EXPECT_LT(p.pose.x_m + 0.5 * std::cos(p.pose.yaw_rad), 5.05);
  q.through_unknown = true;
  const Answer whole = ask(s, q);
  EXPECT_EQ(whole.found, Found::Way);
  EXPECT_TRUE(whole.unseen);
}

//   ░░▓▓▓▓▓
//   ░░   ▭▓    it can only back out, over what nobody has seen
//   ░░▓▓▓▓▓
TEST(AroundTest, BackwardsIntoWhatIsUnseenOnlyWhereThatMayBeDriven) {
  Scene s;
  s.box(-10.0, -10.0, -1.3, 10.0, Known::Unknown);
  s.box(-1.6, 0.6, 1.2, 0.8);
  s.box(-1.6, -0.8, 1.2, -0.6);
  s.box(1.0, -0.8, 1.2, 0.8);
  Question q = along_x();
  q.kinematics.may_reverse = true;
  q.through_unknown = true;
  q.back_through_unknown = true;
  const auto back_m = [](const Answer& a) {
    double least = 0.0;
    for (const Place& p : a.path) {
      if (p.reverse) least = std::min(least, p.pose.x_m - 0.5);
    }
    return least;
  };
  const Answer whole = ask(s, q);
  ASSERT_EQ(whole.found, Found::Way) << sentence(whole.why);
  EXPECT_TRUE(whole.unseen);
  EXPECT_LT(back_m(whole), -1.5);
  q.back_through_unknown = false;
  const Answer cut = ask(s, q);
  EXPECT_NE(cut.found, Found::Way);
  EXPECT_EQ(cut.why, Why::Unseen);
  EXPECT_FALSE(cut.unseen);
  EXPECT_GT(back_m(cut), -1.35);
}

TEST(AroundTest, BlindFromTheStartIsNone) {
  Scene s(Known::Unknown);
  s.box(4.0, -0.5, 4.3, 0.5);
  const Answer a = ask(s, along_x());
  EXPECT_EQ(a.found, Found::None);
  EXPECT_EQ(a.why, Why::Unseen);
}

TEST(AroundTest, AWallAlongTheRouteIsFollowedAsFarAsTheWindowGoes) {
  Scene s;
  s.box(3.0, -0.3, 10.0, 0.3);
  const Answer a = ask(s, along_x());
  ASSERT_EQ(a.found, Found::Part);
  EXPECT_GT(a.path.back().pose.x_m, 8.0);
}

TEST(AroundTest, AnEndThatIsBlockedIsTold) {
  Scene s;
  s.box(5.5, -0.5, 7.0, 0.5);
  Question q = along_x();
  q.route = {{-2.0, 0.0}, {6.0, 0.0}};
  q.at_end = true;
  EXPECT_EQ(ask(s, q).why, Why::Target);
}

TEST(AroundTest, BesideAClearRouteItLeadsBack) {
  Scene s;
  Question q = along_x();
  q.pose = {0.0, 1.0, 0.3};
  const Answer a = ask(s, q);
  EXPECT_EQ(a.found, Found::Way);
  EXPECT_LT(a.length_m, 4.0);
}

TEST(AroundTest, ACurvedRouteIsLeftAndJoinedToo) {
  Scene s;
  s.pole(4.24, 1.76, 0.4);  // on a quarter of a circle of 6 m about (0, 6)
  Question q = along_x(3.0);
  q.route = {{-2.0, 0.0}};
  for (int i = 0; i <= 30; ++i) {
    const double t = base::kPi / 60.0 * i;
    q.route.push_back({6.0 * std::sin(t), 6.0 - 6.0 * std::cos(t)});
  }
  EXPECT_EQ(ask(s, q).found, Found::Way);
}

/// What is seen from a place of a world, added to what was seen before.
void look(const Scene& world, const Pose2& from, Scene& known) {
  for (int i = 0; i < 1440; ++i) {
    const double angle = base::kPi / 720.0 * i;
    for (double r = 0.0; r < 8.0; r += 0.025) {
      const std::int32_t x = known.cell(from.x_m + r * std::cos(angle));
      const std::int32_t y = known.cell(from.y_m + r * std::sin(angle));
      const Known k = world.patch.at(x, y).known;
      known.set(x, y, k);
      if (k != Known::Free) break;
    }
  }
}

/// Drives at 0.5 m/s, looks and asks five times a second. @return how often the side changed
int drive(const Scene& world, const Question& first, double to_x_m) {
  Planner planner;
  Scene known(Known::Unknown);
  Question q = first;
  Answer a;
  Side side = Side::None;
  int changes = 0;
  for (int tick = 0; tick < 200 && q.pose.x_m < to_x_m; ++tick) {
    look(world, q.pose, known);
    q.here_m = std::max(0.0, q.pose.x_m - q.route.front().x);
    EXPECT_TRUE(planner.plan(known.patch, q, a));
    EXPECT_EQ(objection(known.patch, q, a), "") << "tick " << tick;
    if (a.found == Found::None) {
      ADD_FAILURE() << sentence(a.why) << " at tick " << tick;
      return changes;
    }
    EXPECT_GT(tests::clearance_of(world.patch, q.body, q.pose), 0.05) << "tick " << tick;
    if (a.found == Found::Clear) {
      q.pose.x_m += 0.1;
      q.before.clear();
      continue;
    }
    if (side != Side::None && a.side != Side::None && a.side != side) ++changes;
    if (a.side != Side::None) side = a.side;
    double way = 0.0;
    std::size_t i = 0;
    while (i + 1 < a.path.size() && way < 0.1) {
      ++i;
      way += a.path[i].pivot ? 0.03
                             : std::hypot(a.path[i].pose.x_m - a.path[i - 1].pose.x_m,
                                          a.path[i].pose.y_m - a.path[i - 1].pose.y_m);
    }
    q.pose = a.path[i].pose;
    q.before = a.path;
  }
  EXPECT_GE(q.pose.x_m, to_x_m) << "it did not arrive";
  return changes;
}

TEST(AroundTest, BeforeAPoleItDoesNotHesitate) {
  Scene world;
  world.pole(2.0, 0.0, 0.3);
  Question q = along_x(3.0);
  q.pose = {-4.0, 0.0, 0.0};
  q.route = {{-4.0, 0.0}, {9.0, 0.0}};
  EXPECT_EQ(drive(world, q, 4.0), 0);
}

TEST(AroundTest, AsTheViewGrowsItFindsItsWayBetweenBoxes) {
  Scene world;
  world.box(0.0, -1.0, 0.5, 0.8);
  world.box(2.8, -0.6, 3.2, 3.0);
  Question q = along_x(4.0);
  q.pose = {-4.0, 0.0, 0.0};
  q.route = {{-4.0, 0.0}, {9.0, 0.0}};
  EXPECT_LE(drive(world, q, 5.0), 1) << "left of one, right of the other";
}

TEST(AroundTest, EqualQuestionsHaveEqualAnswers) {
  Scene s;
  s.pole(4.0, 0.0, 0.4);
  Planner planner;
  Answer a;
  Answer b;
  ASSERT_TRUE(planner.plan(s.patch, along_x(), a));
  ASSERT_TRUE(planner.plan(s.patch, car(), b));
  ASSERT_TRUE(planner.plan(s.patch, along_x(), b));
  ASSERT_EQ(a.path.size(), b.path.size());
  for (std::size_t i = 0; i < a.path.size(); ++i) {
    EXPECT_EQ(a.path[i].pose.x_m, b.path[i].pose.x_m);
    EXPECT_EQ(a.path[i].pose.y_m, b.path[i].pose.y_m);
  }
}

TEST(AroundTest, QuestionsThatAreNoneAreRefusedByField) {
  Planner planner;
  Answer a;
  const auto refused = [&](auto&& change) {
    Scene s;
    Question q = along_x();
    change(s.patch, q);
    const auto r = planner.plan(s.patch, q, a);
    return r ? std::string("accepted") : r.error().fields.at(0).pointer;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using P = sense::Patch;
  EXPECT_EQ(refused([&](P&, Question& q) { q.pose.x_m = nan; }), "/pose");
  EXPECT_EQ(refused([&](P&, Question& q) { q.pose.x_m = 50.0; }), "/pose");
  EXPECT_EQ(refused([&](P&, Question& q) { q.route = {{1, 1}}; }), "/route");
  EXPECT_EQ(refused([&](P&, Question& q) { q.route[1].y = nan; }), "/route");
  EXPECT_EQ(refused([&](P&, Question& q) { q.here_m = 99.0; }), "/here_m");
  EXPECT_EQ(refused([&](P&, Question& q) { q.left_m = -1.0; }), "/left_m");
  EXPECT_EQ(refused([&](P&, Question& q) { q.keep_in = {{{0, 0}, {1, 1}}}; }), "/keep_in");
  EXPECT_EQ(refused([&](P&, Question& q) {
              q.kinematics = {0.0, false, false};
            }),
            "/kinematics/min_radius_m");
  EXPECT_EQ(refused([&](P& p, Question&) { p.cells.pop_back(); }), "/patch/cells");
  EXPECT_EQ(refused([&](P& p, Question&) { p.cell_m = 0.0; }), "/patch/cell_m");
}

TEST(AroundTest, WordsAreStable) {
  EXPECT_EQ(to_string(Why::Corridor), "corridor");
  EXPECT_EQ(to_string(Found::Part), "part");
  EXPECT_EQ(to_string(Side::Right), "right");
}

}  // namespace
}  // namespace roverd::nav::around
