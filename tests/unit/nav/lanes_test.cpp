// Neighbouring lanes 0.13 m apart, driven to and fro: whatever makes the robot swerve, its progress
// stays on the lane it drives.
//
//   ▷ 1 ─────────────────────────── 2
//   4 ─────────────────────────── 3    0.13 m
//   5 ─────────────────────────── 6
//   …

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

constexpr double kApart_m = 0.13;
constexpr double kLong_m = 8.0;
constexpr int kLanes = 5;
// Up to the side step that ends the lane, where that is nearer; the next lane is farther on.
constexpr double kMostJump_m = 0.45;
constexpr double kMostSet_m = 0.25;

mission::Plan lanes(mission::Turn turn) {
  std::vector<mission::Item> items;
  for (int lane = 0; lane < kLanes; ++lane) {
    for (const bool end : {false, true}) {
      mission::Waypoint w = at(end == (lane % 2 == 0) ? kLong_m : 0.0, lane * kApart_m);
      w.turn = turn;
      items.emplace_back(w);
    }
  }
  return plan(std::move(items));
}

std::vector<int> all_items() {
  std::vector<int> all;
  for (int i = 1; i <= 2 * kLanes; ++i) all.push_back(i);
  return all;
}

/// Rides on and sees that the way that is left shrinks only as fast as it drives.
struct Watched {
  Ride ride;
  double jumped_m = 0.0;  ///< most in a tick, beyond what was driven
  std::optional<double> left_m{};

  bool run(double seconds, const std::function<void(Watched&)>& each = {}) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (each) each(*this);
      ride.tick();
      const auto now = ride.executor.progress(ride.vehicle.at).distance_left_m;
      const double drove_m = std::abs(ride.vehicle.speed_mps) * 0.02;
      if (left_m && now) jumped_m = std::max(jumped_m, *left_m - *now - drove_m);
      left_m = now;
      if (!ride.executor.running()) return true;
    }
    return false;
  }
  double east() const { return ride.vehicle.at.east_m; }
};

std::vector<int> told(const Ride& r) {
  std::vector<int> all = r.reached;
  all.insert(all.end(), r.missed.begin(), r.missed.end());
  std::sort(all.begin(), all.end());
  return all;
}

const char* const kTurns[] = {"auto", "pivot", "arc"};
mission::Turn turn_of(int i) {
  return i == 0 ? mission::Turn::Auto : i == 1 ? mission::Turn::Pivot : mission::Turn::Arc;
}

TEST(Lanes, AreDrivenOneAfterTheOther) {
  for (int t = 0; t < 3; ++t) {
    SCOPED_TRACE(kTurns[t]);
    Watched w;
    w.ride.load(lanes(turn_of(t)));
    w.ride.start();
    ASSERT_TRUE(w.run(300.0));
    EXPECT_EQ(w.ride.executor.state(), ExecutionState::Finished) << w.ride.executor.reason();
    EXPECT_EQ(w.ride.reached, all_items());
    EXPECT_TRUE(w.ride.missed.empty());
    EXPECT_LT(w.jumped_m, 0.2);
  }
}

// Pushed 0.5 m to either side, anywhere on the lanes: over the neighbours, and back by itself.
TEST(Lanes, APushBesideThemMovesNoProgress) {
  for (int t = 0; t < 3; ++t) {
    for (const double side_m : {0.5, -0.5, 0.13, -0.13}) {
      for (const double where_m : {1.0, 4.0, 7.0, 7.4, 7.6, 7.8, 7.9}) {
        SCOPED_TRACE(std::string(kTurns[t]) + " " + std::to_string(side_m) + " at " +
                     std::to_string(where_m));
        Watched w;
        w.ride.load(lanes(turn_of(t)));
        w.ride.start();
        bool pushed = false;
        w.run(300.0, [&](Watched& now) {
          if (pushed || now.east() < where_m) return;
          pushed = true;
          now.ride.vehicle.at.north_m += side_m;
        });
        EXPECT_TRUE(pushed);
        EXPECT_EQ(w.ride.executor.state(), ExecutionState::Finished) << w.ride.executor.reason();
        EXPECT_LT(w.jumped_m, kMostJump_m);
        EXPECT_EQ(told(w.ride), all_items());
      }
    }
  }
}

// The position jumps by a lane's width and stays there; the robot stands on the next lane, it
// believes, and goes on with its own.
TEST(Lanes, APositionThatJumpsByALaneIsStillOnItsOwn) {
  for (int t = 0; t < 3; ++t) {
    for (const double where_m : {2.0, 7.3, 7.7}) {
      SCOPED_TRACE(std::string(kTurns[t]) + " at " + std::to_string(where_m));
      Watched w;
      w.ride.load(lanes(turn_of(t)));
      w.ride.start();
      int jumps = 0;
      w.run(300.0, [&](Watched& now) {
        if (jumps >= 3 || now.east() < where_m) return;
        now.ride.vehicle.at.north_m += jumps % 2 == 0 ? kApart_m : -kApart_m;
        ++jumps;
      });
      EXPECT_EQ(w.ride.executor.state(), ExecutionState::Finished) << w.ride.executor.reason();
      EXPECT_LT(w.jumped_m, kMostJump_m);
      EXPECT_EQ(told(w.ride), all_items());
    }
  }
}

// Paused on the first lane and set down on the second; resumed, or restarted there.
TEST(Lanes, AResumeOnTheNeighbourGoesOnWithTheOwnLane) {
  for (int t = 0; t < 3; ++t) {
    for (const bool restart : {false, true}) {
      for (const double where_m : {2.0, 5.0, 7.4, 7.75, 7.9}) {
        for (const double lane : {1.0, 2.0, -1.0}) {
          SCOPED_TRACE(std::string(kTurns[t]) + (restart ? " restart " : " pause ") +
                       std::to_string(where_m) + " lane " + std::to_string(lane));
          Watched w;
          w.ride.load(lanes(turn_of(t)));
          w.ride.start();
          while (w.east() < where_m) w.ride.tick();
          const double left_m = w.ride.executor.progress(w.ride.vehicle.at).distance_left_m.value();
          const auto place = w.ride.executor.place();
          w.ride.executor.pause("test");
          Watched later;
          Watched& on = restart ? later : w;
          on.ride.vehicle.at = {w.east(), lane * kApart_m};
          on.ride.vehicle.speed_mps = on.ride.vehicle.yaw_rate_radps = 0.0;
          if (restart) {
            ASSERT_TRUE(later.ride.executor.restore(later.ride.route_of(lanes(turn_of(t))), *place,
                                                    "restarted"));
          }
          ASSERT_TRUE(on.ride.executor.resume(on.ride.vehicle.at));
          on.ride.tick();
          EXPECT_NEAR(on.ride.executor.progress(on.ride.vehicle.at).distance_left_m.value(), left_m,
                      kMostSet_m);
          on.run(300.0);
          EXPECT_EQ(on.ride.executor.state(), ExecutionState::Finished)
              << on.ride.executor.reason();
          EXPECT_LT(on.jumped_m, kMostJump_m);
          std::vector<int> all = told(on.ride);
          EXPECT_EQ(all.back(), 2 * kLanes);
          EXPECT_EQ(static_cast<int>(all.size()), restart ? 2 * kLanes - 1 : 2 * kLanes);
        }
      }
    }
  }
}

// Wherever it begins, what follows comes in order, and none is left out.
TEST(Lanes, AStartAtTheNearestGoesOnInOrder) {
  for (int t = 0; t < 3; ++t) {
    for (const double east_m : {0.1, 3.0, 5.0, 7.9}) {
      for (const double north_m : {0.02, 0.11, 0.2, 0.3}) {
        SCOPED_TRACE(std::string(kTurns[t]) + " " + std::to_string(east_m) + ", " +
                     std::to_string(north_m));
        Watched w;
        w.ride.vehicle.at = {east_m, north_m};
        w.ride.load(lanes(turn_of(t)));
        w.ride.start({StartAt::From::Nearest, 1});
        ASSERT_TRUE(w.run(300.0));
        EXPECT_EQ(w.ride.executor.state(), ExecutionState::Finished) << w.ride.executor.reason();
        const std::vector<int> all = told(w.ride);
        ASSERT_FALSE(all.empty());
        for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i], all[i - 1] + 1);
        EXPECT_EQ(all.back(), 2 * kLanes);
        EXPECT_LT(w.jumped_m, kMostJump_m);
      }
    }
  }
}

}  // namespace
}  // namespace roverd::nav
