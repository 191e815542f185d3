#include "nav/track/tracker.hpp"

#include <cmath>
#include <deque>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

/// A perfect robot with a delay: what is commanded happens `delay` ticks later.
class Toy {
 public:
  explicit Toy(std::size_t delay_ticks = 7) : pipe_(delay_ticks) {}

  Vehicle vehicle;

  void step(const base::BodyTwist& command) {
    pipe_.push_back(command);
    const base::BodyTwist t = pipe_.front();
    pipe_.pop_front();
    const double v = t.linear_mps * vehicle.odometry_scale;
    const double w = t.angular_radps * vehicle.yaw_scale + vehicle.pull_1pm * t.linear_mps;
    vehicle.speed_mps = v;
    vehicle.yaw_rate_radps = w;
    vehicle.at.east_m += v * 0.02 * std::cos(vehicle.yaw_rad + 0.01 * w);
    vehicle.at.north_m += v * 0.02 * std::sin(vehicle.yaw_rad + 0.01 * w);
    vehicle.yaw_rad = base::wrap_rad(vehicle.yaw_rad + w * 0.02);
  }

 private:
  std::deque<base::BodyTwist> pipe_;
};

Path line(std::vector<EnuPoint> points, bool reverse = false) {
  std::vector<Vertex> v;
  for (const EnuPoint& p : points) {
    v.push_back({p, 0.8, reverse, false, mission::Turn::Auto, 0.1});
  }
  return build_path(v, {});
}

struct TrackedDrive {
  PathParams params;
  Tracker tracker{params};
  Toy toy;
  double left_most_m = 0.0;
  double right_most_m = 0.0;
  bool pivoted = false;
  int ticks = 0;

  bool run(const Path& path, double seconds, std::size_t leg = 0) {
    tracker.begin(path, leg, path.legs.at(leg).start_m);
    for (int i = 0; i < seconds * 50.0; ++i, ++ticks) {
      toy.step(tracker.step(toy.vehicle, 10.0, 0.02).command);
      if (tracker.phase() == TrackPhase::Pivot) pivoted = true;
      if (tracker.phase() == TrackPhase::Track) {
        left_most_m = std::max(left_most_m, tracker.cross_track_m());
        right_most_m = std::min(right_most_m, tracker.cross_track_m());
      }
      if (tracker.phase() == TrackPhase::Done) return true;
    }
    return false;
  }
};

TEST(Tracker, DrivesALineToItsEndAndStopsThere) {
  TrackedDrive d;
  const Path path = line({{0, 0}, {8, 0}});
  ASSERT_TRUE(d.run(path, 40.0));
  EXPECT_NEAR(d.toy.vehicle.at.east_m, 8.0, 0.06);
  EXPECT_NEAR(d.toy.vehicle.at.north_m, 0.0, 0.02);
  EXPECT_DOUBLE_EQ(d.toy.vehicle.speed_mps, 0.0);
}

//  start 1 m left of the line ─╲
//  ─────────────────────────────╲────────▶ less than 0.1 m to the other side
TEST(Tracker, AStepOfOneMetreIsTakenWithHardlyAnyOvershoot) {
  for (const std::size_t delay : {0u, 5u, 7u, 12u}) {
    TrackedDrive d;
    d.toy = Toy(delay);
    d.params.track.delay_s = 0.02 * static_cast<double>(delay);
    d.tracker = Tracker(d.params);
    d.toy.vehicle.at.north_m = 1.0;
    const Path path = line({{0, 0}, {20, 0}});
    ASSERT_TRUE(d.run(path, 60.0));
    EXPECT_GT(d.right_most_m, -0.1) << delay;
    EXPECT_NEAR(d.toy.vehicle.at.north_m, 0.0, 0.05) << delay;
  }
}

TEST(Tracker, TheAccountedSlipAndPullDoNotShowOnTheGround) {
  TrackedDrive d;
  d.toy.vehicle.odometry_scale = 0.8;
  d.toy.vehicle.yaw_scale = 0.6;
  d.toy.vehicle.pull_1pm = 0.05;
  ASSERT_TRUE(d.run(line({{0, 0}, {15, 0}}), 60.0));
  EXPECT_LT(d.left_most_m, 0.03);
  EXPECT_GT(d.right_most_m, -0.03);
}

TEST(Tracker, PivotsFirstWhenItPointsAwayMoreThanThirtyDegrees) {
  for (const auto& [deg, pivots] : {std::pair{29.0, false}, {31.0, true}, {180.0, true}}) {
    TrackedDrive d;
    d.toy.vehicle.yaw_rad = base::rad_from_deg(deg);
    ASSERT_TRUE(d.run(line({{0, 0}, {6, 0}}), 60.0)) << deg;
    EXPECT_EQ(d.pivoted, pivots) << deg;
    EXPECT_NEAR(d.toy.vehicle.at.east_m, 6.0, 0.06);
    EXPECT_LT(std::max(d.left_most_m, -d.right_most_m), 0.35);
  }
}

TEST(Tracker, ReversesWithItsTailAhead) {
  TrackedDrive d;
  d.toy.vehicle.yaw_rad = base::kPi;
  d.toy.vehicle.at.north_m = 0.3;
  ASSERT_TRUE(d.run(line({{0, 0}, {6, 0}}, true), 60.0));
  EXPECT_FALSE(d.pivoted);
  EXPECT_NEAR(d.toy.vehicle.at.east_m, 6.0, 0.06);
  EXPECT_NEAR(d.toy.vehicle.at.north_m, 0.0, 0.05);
}

TEST(Tracker, OutAndBackOnTheSameLineIsNotTakenForOneWay) {
  TrackedDrive d;
  const Path path = line({{0, 0}, {6, 0}, {0, 0.001}});
  ASSERT_EQ(path.legs.size(), 2u);
  ASSERT_TRUE(d.run(path, 40.0, 0));
  EXPECT_NEAR(d.toy.vehicle.at.east_m, 6.0, 0.06);
  ASSERT_TRUE(d.run(path, 60.0, 1));
  EXPECT_NEAR(d.toy.vehicle.at.east_m, 0.0, 0.06);
}

// The path crosses itself at (5, 0): progress must not jump to the other branch.
TEST(Tracker, ACrossingDoesNotShortenTheWay) {
  std::vector<Vertex> v;
  for (const EnuPoint p : {EnuPoint{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, -5}}) {
    v.push_back({p, 0.8, false, false, mission::Turn::Arc, 0.1});
  }
  const Path path = build_path(v, {});
  TrackedDrive d;
  double last = 0.0;
  d.tracker.begin(path, 0, 0.0);
  for (int i = 0; i < 4000 && d.tracker.phase() != TrackPhase::Done; ++i) {
    d.toy.step(d.tracker.step(d.toy.vehicle, 10.0, 0.02).command);
    EXPECT_GE(d.tracker.s_m(), last);
    EXPECT_LT(d.tracker.s_m() - last, 0.5);
    last = d.tracker.s_m();
  }
  EXPECT_EQ(d.tracker.phase(), TrackPhase::Done);
  EXPECT_NEAR(d.toy.vehicle.at.north_m, -5.0, 0.06);
}

TEST(Tracker, AWayShorterThanTheLookaheadIsDrivenToo) {
  TrackedDrive d;
  ASSERT_TRUE(d.run(line({{0, 0}, {0.3, 0}}), 20.0));
  EXPECT_NEAR(d.toy.vehicle.at.east_m, 0.3, 0.06);
}

TEST(Tracker, CreepsWhileTheHeadingIsUncertainAndSaysSo) {
  TrackedDrive d;
  const Path path = line({{0, 0}, {20, 0}});
  d.toy.vehicle.yaw_sigma_rad = 0.3;
  d.tracker.begin(path, 0, 0.0);
  TrackOutput out;
  for (int i = 0; i < 250; ++i) {
    out = d.tracker.step(d.toy.vehicle, 10.0, 0.02);
    d.toy.step(out.command);
  }
  EXPECT_NEAR(out.command.linear_mps, d.params.speed.creep_mps, 1e-6);
  EXPECT_EQ(to_string(out.reason), "heading_uncertain");
}

TEST(Tracker, ALimitThatComesSuddenlyIsBrakedFor) {
  TrackedDrive d;
  const Path path = line({{0, 0}, {20, 0}});
  d.tracker.begin(path, 0, 0.0);
  for (int i = 0; i < 250; ++i) d.toy.step(d.tracker.step(d.toy.vehicle, 10.0, 0.02).command);
  double last = d.toy.vehicle.speed_mps;
  EXPECT_NEAR(last, 0.8, 0.01);
  for (int i = 0; i < 100; ++i) {
    const auto out = d.tracker.step(d.toy.vehicle, 0.3, 0.02);
    d.toy.step(out.command);
    EXPECT_GE(out.command.linear_mps, last - d.params.speed.hold_decel_mps2 * 0.02 - 1e-9);
    last = out.command.linear_mps;
  }
  EXPECT_NEAR(last, 0.3, 1e-6);
}

TEST(Tracker, NeverCommandsMoreTurnThanAllowed) {
  TrackedDrive d;
  d.toy.vehicle.yaw_rad = 1.0;
  d.toy.vehicle.yaw_scale = 0.5;
  const Path path = line({{0, 0}, {3, 0}, {3, 3}, {0, 3}});
  for (std::size_t leg = 0; leg < path.legs.size(); ++leg) {
    d.tracker.begin(path, leg, path.legs[leg].start_m);
    for (int i = 0; i < 3000 && d.tracker.phase() != TrackPhase::Done; ++i) {
      const auto out = d.tracker.step(d.toy.vehicle, 10.0, 0.02);
      ASSERT_LE(std::abs(out.command.angular_radps), d.params.speed.max_yaw_rate_radps + 1e-9);
      ASSERT_TRUE(std::isfinite(out.command.linear_mps));
      d.toy.step(out.command);
    }
    EXPECT_EQ(d.tracker.phase(), TrackPhase::Done);
  }
}

}  // namespace
}  // namespace roverd::nav
