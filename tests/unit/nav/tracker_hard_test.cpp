// The tracker under what it cannot expect: delays, lags, wrong numbers, odd paths.

#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {
namespace {

/// A body with a pure delay and a first-order lag, and what its tracks do besides.
class Body {
 public:
  Body(double delay_s, double lag_s)
      : pipe_(static_cast<std::size_t>(std::lround(delay_s / 0.02))), lag_s_(lag_s) {}

  Vehicle vehicle;
  double turns_by_itself_radps = 0.0;  ///< while it moves
  double sticks_radps = 0.0;           ///< turns slower than this do not happen

  void step(const base::BodyTwist& command) {
    pipe_.push_back(command);
    base::BodyTwist t = pipe_.front();
    pipe_.pop_front();
    if (std::abs(t.angular_radps) < sticks_radps && t.linear_mps == 0.0) t.angular_radps = 0.0;
    const double share = lag_s_ > 0.0 ? 1.0 - std::exp(-0.02 / lag_s_) : 1.0;
    v_ += (t.linear_mps - v_) * share;
    w_ += (t.angular_radps - w_) * share;
    if (t.linear_mps == 0.0 && std::abs(v_) < 0.003) v_ = 0.0;
    if (t.angular_radps == 0.0 && std::abs(w_) < 0.005) w_ = 0.0;
    const double w = w_ + (std::abs(v_) > 0.05 ? turns_by_itself_radps : 0.0);
    vehicle.speed_mps = v_;
    vehicle.yaw_rate_radps = w;
    vehicle.at.east_m += v_ * 0.02 * std::cos(vehicle.yaw_rad + 0.01 * w);
    vehicle.at.north_m += v_ * 0.02 * std::sin(vehicle.yaw_rad + 0.01 * w);
    vehicle.yaw_rad = base::wrap_rad(vehicle.yaw_rad + w * 0.02);
  }

 private:
  std::deque<base::BodyTwist> pipe_;
  double lag_s_;
  double v_ = 0.0;
  double w_ = 0.0;
};

Path way(const std::vector<EnuPoint>& points, mission::Turn turn = mission::Turn::Auto,
         const PathParams& params = {}) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) v.push_back({p, 1.0, false, false, turn, 0.1});
  return build_path(v, params);
}

struct Driven {
  double most_m = 0.0;     ///< |e| while following
  double least_e_m = 0.0;  ///< most to the right
  double late_m = 0.0;     ///< |e| in the last quarter of the way
  bool done = false;
};

/// Drives all legs. @param profile_s the delay that the tracker is told.
Driven drive(const Path& path, Body& body, PathParams params, double limit_s = 200.0) {
  Tracker tracker(params);
  Driven c;
  double t = 0.0;
  for (std::size_t leg = 0; leg < path.legs.size(); ++leg) {
    tracker.begin(path, leg, path.legs[leg].start_m);
    while (tracker.phase() != TrackPhase::Done) {
      const auto out = tracker.step(body.vehicle, 10.0, 0.02);
      EXPECT_TRUE(std::isfinite(out.command.linear_mps));
      EXPECT_TRUE(std::isfinite(out.command.angular_radps));
      body.step(out.command);
      if (tracker.phase() == TrackPhase::Track) {
        const double e = tracker.cross_track_m();
        c.most_m = std::max(c.most_m, std::abs(e));
        c.least_e_m = std::min(c.least_e_m, e);
        if (tracker.s_m() > 0.75 * path.length_m()) c.late_m = std::max(c.late_m, std::abs(e));
      }
      t += 0.02;
      if (t > limit_s) return c;
    }
  }
  c.done = true;
  return c;
}

//   0.5 m left of the line ─╲____   an overshoot of 16 % is a damping of 0.5
TEST(HardTracker, DampingIsOverOneHalfForEveryDelayThatTheProfileKnows) {
  const Path path = way({{0, 0}, {25, 0}});
  for (const double delay_s : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    for (const double lag_s : {0.0, 0.1}) {
      if (delay_s + lag_s > 0.41) continue;
      Body body(delay_s, lag_s);
      body.vehicle.at.north_m = 0.5;
      PathParams p;
      p.track.delay_s = delay_s + lag_s;
      const Driven c = drive(path, body, p);
      EXPECT_TRUE(c.done);
      EXPECT_GT(c.least_e_m, -0.16 * 0.5) << delay_s << " " << lag_s;
      EXPECT_LT(c.late_m, 0.01) << delay_s << " " << lag_s;
    }
  }
}

TEST(HardTracker, ADelayWrongByATenthOfASecondIsStable) {
  const Path path = way({{0, 0}, {30, 0}});
  for (const double delay_s : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    for (const double wrong_s : {-0.1, 0.1}) {
      if (delay_s + wrong_s < -1e-9) continue;
      Body body(delay_s, 0.0);
      body.vehicle.at.north_m = 0.5;
      PathParams p;
      p.track.delay_s = delay_s + wrong_s;
      const Driven c = drive(path, body, p);
      EXPECT_TRUE(c.done);
      EXPECT_LT(c.late_m, 0.05) << delay_s << " " << wrong_s;
    }
  }
}

//   ────╮     at 5 m/s the predicted place is 2 m ahead
TEST(HardTracker, ABendIsFollowedWhereItIsDrivenFast) {
  std::vector<Vertex> circle;
  for (double s = 0.0; s < 100.0; s += 1.0) {
    Vertex v;
    v.at = {30.0 * std::sin(s / 30.0), 30.0 * (1.0 - std::cos(s / 30.0))};
    v.speed_mps = 5.0;
    v.dense = true;
    circle.push_back(v);
  }
  PathParams p;
  p.speed.max_mps = 5.0;
  p.speed.lateral_mps2 = 1.0;
  p.track.settle_time_s = 1.2;
  p.track.delay_s = 0.4;
  Body body(0.4, 0.0);
  const Driven c = drive(build_path(circle, p), body, p);
  EXPECT_TRUE(c.done);
  EXPECT_LT(c.most_m, 0.1);
}

TEST(HardTracker, EveryLawTakesAStepOfHalfAMetre) {
  for (const std::string law : {"path_frame", "pure_pursuit", "stanley"}) {
    Body body(0.1, 0.05);
    body.vehicle.at.north_m = 0.5;
    PathParams p;
    p.track.law = law;
    const Driven c = drive(way({{0, 0}, {25, 0}}), body, p);
    EXPECT_TRUE(c.done) << law;
    EXPECT_GT(c.least_e_m, -0.1) << law;
    EXPECT_LT(c.late_m, 0.02) << law;
  }
}

TEST(HardTracker, ATrackThatPullsIsLearned) {
  Body body(0.1, 0.05);
  body.turns_by_itself_radps = 0.08;
  const Driven c = drive(way({{0, 0}, {30, 0}}), body, {});
  EXPECT_TRUE(c.done);
  EXPECT_LT(c.most_m, 0.08);
  EXPECT_LT(c.late_m, 0.01);
}

TEST(HardTracker, OutAndBackLanesAndCrossingsAreDrivenInOrder) {
  for (const auto& points : {std::vector<EnuPoint>{{0, 0}, {8, 0}, {0, 0}, {8, 0}},
                             {{0, 0}, {8, 0}, {8, 1.5}, {0, 1.5}, {0, 3}, {8, 3}},
                             {{0, 0}, {8, 0}, {8, 4}, {4, 4}, {4, -4}},
                             {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}}}) {
    Body body(0.1, 0.05);
    const Driven c = drive(way(points), body, {});
    EXPECT_TRUE(c.done);
    EXPECT_LT(c.most_m, 0.1);
    EXPECT_LT(base::distance_m(body.vehicle.at, points.back()), 0.06);
  }
}

TEST(HardTracker, ACuspIsAStopAndTheWayBackIsDrivenBackwards) {
  std::vector<Vertex> v(3);
  v[1].at = {6, 0};
  v[2].at = {2, 0};
  v[2].reverse = true;
  Body body(0.1, 0.05);
  const Path path = build_path(v, {});
  ASSERT_EQ(path.legs.size(), 2u);
  EXPECT_TRUE(drive(path, body, {}).done);
  EXPECT_NEAR(body.vehicle.at.east_m, 2.0, 0.06);
  EXPECT_NEAR(body.vehicle.yaw_rad, 0.0, 0.1);
}

TEST(HardTracker, LegsOfAMillimetreAndOfNineKilometres) {
  Body small(0.1, 0.05);
  EXPECT_TRUE(
      drive(way({{0, 0}, {0.0015, 0}, {0.0015, 0.002}, {0, 0.002}, {1, 0.002}}), small, {}).done);
  EXPECT_NEAR(small.vehicle.at.east_m, 1.0, 0.06);

  const Path far = way({{0, 0}, {9000, 0}});
  Body body(0.1, 0.05);
  body.vehicle.at = {8990, 0.3};
  Tracker tracker{PathParams{}};
  tracker.begin(far, 0, 8989.0);
  for (int i = 0; i < 3000 && tracker.phase() != TrackPhase::Done; ++i) {
    body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
  }
  EXPECT_EQ(tracker.phase(), TrackPhase::Done);
  EXPECT_NEAR(body.vehicle.at.east_m, 9000.0, 0.06);
}

TEST(HardTracker, AnArrivalIsLatchedAgainstNoise) {
  Body body(0.1, 0.05);
  const Path path = way({{0, 0}, {4, 0}});
  Tracker tracker{PathParams{}};
  tracker.begin(path, 0, 0.0);
  for (int i = 0; i < 1500 && tracker.phase() != TrackPhase::Done; ++i) {
    body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
  }
  ASSERT_EQ(tracker.phase(), TrackPhase::Done);
  for (int i = 0; i < 100; ++i) {
    body.vehicle.at.east_m = 4.0 + (i % 2 == 0 ? 1.0 : -1.0);
    const auto out = tracker.step(body.vehicle, 10.0, 0.02);
    EXPECT_EQ(out.command.linear_mps, 0.0);
    EXPECT_EQ(tracker.phase(), TrackPhase::Done);
  }
}

TEST(HardTracker, AHeadingAtTheEndIsTurnedToOnTheSpot) {
  std::vector<Vertex> v(2);
  v[1].at = {4, 0};
  v[1].yaw_rad = base::rad_from_deg(-120.0);
  Body body(0.1, 0.05);
  EXPECT_TRUE(drive(build_path(v, {}), body, {}).done);
  EXPECT_NEAR(base::deg_from_rad(body.vehicle.yaw_rad), -120.0, 2.5);
  EXPECT_NEAR(body.vehicle.at.east_m, 4.0, 0.06);
}

TEST(HardTracker, TurnsOnTheSpotWithoutAPathAndDoesNotSwingOver) {
  for (const double deg : {5.0, 29.9, 30.1, 90.0, 179.9, -170.0}) {
    Body body(0.15, 0.1);
    PathParams p;
    p.track.delay_s = 0.25;
    Tracker tracker(p);
    tracker.begin_turn(base::rad_from_deg(deg));
    double most = 0.0;
    for (int i = 0; i < 1500 && tracker.phase() != TrackPhase::Done; ++i) {
      const auto out = tracker.step(body.vehicle, 10.0, 0.02);
      EXPECT_EQ(out.command.linear_mps, 0.0);
      body.step(out.command);
      most = std::max(most, std::abs(base::deg_from_rad(body.vehicle.yaw_rad)));
    }
    EXPECT_EQ(tracker.phase(), TrackPhase::Done) << deg;
    EXPECT_NEAR(base::deg_from_rad(body.vehicle.yaw_rad), deg, 2.5);
    EXPECT_LT(most, std::abs(deg) + 4.0);
  }
}

TEST(HardTracker, ATurnThatNeverArrivesIsTimedOut) {
  Body body(0.1, 0.05);
  body.sticks_radps = 5.0;
  Tracker tracker{PathParams{}};
  tracker.begin_turn(1.0);
  for (int i = 0; i < 50 * 29; ++i) body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
  EXPECT_FALSE(tracker.turn_timed_out());
  for (int i = 0; i < 50 * 2; ++i) body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
  EXPECT_TRUE(tracker.turn_timed_out());
}

TEST(HardTracker, APoseThatIsNotFiniteStops) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Path path = way({{0, 0}, {20, 0}});
  for (int which = 0; which < 6; ++which) {
    Body body(0.1, 0.05);
    Tracker tracker{PathParams{}};
    tracker.begin(path, 0, 0.0);
    for (int i = 0; i < 200; ++i) body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
    ASSERT_GT(body.vehicle.speed_mps, 0.5);
    Vehicle bad = body.vehicle;
    double* const parts[] = {&bad.at.east_m, &bad.at.north_m,     &bad.yaw_rad,
                             &bad.speed_mps, &bad.yaw_rate_radps, &bad.yaw_scale};
    *parts[which] = nan;
    const auto out = tracker.step(bad, 10.0, 0.02);
    EXPECT_EQ(out.command.linear_mps, 0.0);
    EXPECT_EQ(out.command.angular_radps, 0.0);
    // And it goes on when the pose is back.
    for (int i = 0; i < 100; ++i) body.step(tracker.step(body.vehicle, 10.0, 0.02).command);
    EXPECT_GT(body.vehicle.speed_mps, 0.2);
  }
}

/// Every parameter at an end of its range, by chance, while driving.
struct Extremes {
  std::mt19937& random;

  template <class N>
  void operator()(std::string_view name, N& field, double low, double high, std::string_view) {
    if (name == "max_mps" || name == "timeout_s") return;
    const int side = static_cast<int>(random() % 3);
    field = static_cast<N>(side == 0 ? low : side == 1 ? high : static_cast<double>(field));
  }
  void operator()(std::string_view, bool&, std::string_view) {}
  void operator()(std::string_view, std::string& word, std::string_view) {
    constexpr const char* kLaws[] = {"path_frame", "pure_pursuit", "stanley"};
    word = kLaws[random() % 3];
  }
};

TEST(HardTracker, ExtremeParametersWhileDrivingNeverMakeItRunAway) {
  const Path path = way({{0, 0}, {15, 0}, {15, 6}, {4, 6}});
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    Body body(0.1, 0.05);
    base::Setting<PathParams> params;
    Tracker tracker{params};
    std::size_t leg = 0;
    tracker.begin(path, 0, 0.0);
    for (int i = 0; i < 50 * 60; ++i) {
      if (i % 250 == 249) {
        PathParams p;
        Extremes extremes{random};
        fields(extremes, p.track);
        fields(extremes, p.speed);
        fields(extremes, p.pivot);
        p.speed.max_mps = 1.2;
        params.adopt(std::make_shared<const PathParams>(p));
      }
      const auto out = tracker.step(body.vehicle, 1.2, 0.02);
      ASSERT_TRUE(std::isfinite(out.command.linear_mps) &&
                  std::isfinite(out.command.angular_radps));
      ASSERT_LE(std::abs(out.command.linear_mps), 1.3);
      ASSERT_LE(std::abs(out.command.angular_radps), 5.0 + 1e-9);
      body.step(out.command);
      ASSERT_LT(std::abs(tracker.cross_track_m()), 4.0) << seed << " at " << i * 0.02 << " s";
      if (tracker.phase() == TrackPhase::Done && leg + 1 < path.legs.size()) {
        ++leg;
        tracker.begin(path, leg, path.legs[leg].start_m);
      }
    }
  }
}

}  // namespace
}  // namespace roverd::nav
