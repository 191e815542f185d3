// What the sensors tell of a motion is compared: an honest one accuses nobody.

#include "nav/vote/votes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;

/// A vehicle on a slope that falls to the east: it slides downhill by a part of its speed.
class Slope {
 public:
  double slide = 0.0;
  double slip = 0.1;
  double gyro_extra_radps = 0.0;
  bool tracks_speak = true;
  base::EnuPoint drift_mps;  ///< of the positions, beside the truth
  double most_mps2 = 1e3;
  double lag_s = 0.0;          ///< of the velocity, behind it
  double velocity_mps = 0.03;  ///< the velocity's noise
  double no_course_below_mps = 0.0;
  int every = 10;  ///< of the steps of 20 ms the receiver speaks
  Votes votes;

  void step_aside(base::EnuPoint by) { astray_ = astray_ + by; }

  void drive(double speed_mps, double rate_radps, double for_s) {
    for (int i = 0; i < for_s * 50.0; ++i) step(speed_mps, rate_radps);
  }

 private:
  void step(double asked_mps, double rate_radps) {
    constexpr double kDt_s = 0.02;
    now_ += base::from_seconds(kDt_s);
    yaw_rad_ += rate_radps * kDt_s;
    const double most_mps = most_mps2 * kDt_s;
    speed_mps_ += std::clamp(asked_mps - speed_mps_, -most_mps, most_mps);
    const double speed_mps = speed_mps_;
    const double over_ground = (1.0 - slip) * speed_mps;
    const base::EnuPoint mps{over_ground * std::cos(yaw_rad_) + slide * std::abs(speed_mps),
                             over_ground * std::sin(yaw_rad_)};
    at_ = {at_.east_m + mps.east_m * kDt_s, at_.north_m + mps.north_m * kDt_s};
    astray_ = {astray_.east_m + drift_mps.east_m * kDt_s,
               astray_.north_m + drift_mps.north_m * kDt_s};
    const double part = lag_s > 0.0 ? -std::expm1(-kDt_s / lag_s) : 1.0;
    told_mps_ = {told_mps_.east_m + part * (mps.east_m - told_mps_.east_m),
                 told_mps_.north_m + part * (mps.north_m - told_mps_.north_m)};
    if (tracks_speak) votes.tracks(speed_mps * kDt_s, rate_radps * kDt_s / 0.7, now_);
    const double gyro = rate_radps + gyro_extra_radps + 0.002 * normal_(random_);
    votes.gyro(gyro, gyro, now_);
    if (++count_ % every == 0) {
      Spot spot;
      spot.t = now_;
      const base::EnuPoint shown = at_ + astray_;
      spot.at = {shown.east_m + 0.02 * normal_(random_), shown.north_m + 0.02 * normal_(random_)};
      spot.sigma_m = 0.02;
      votes.position(spot, 4, now_);
      const base::EnuPoint felt{told_mps_.east_m + velocity_mps * normal_(random_),
                                told_mps_.north_m + velocity_mps * normal_(random_)};
      const double fast_mps = std::hypot(felt.east_m, felt.north_m);
      if (fast_mps < no_course_below_mps) {
        votes.velocity({}, std::max(0.05, fast_mps), now_, now_, fast_mps);
      } else {
        votes.velocity(felt, 0.05, now_, now_);
      }
    }
    Belonging b;
    b.yaw_rad = yaw_rad_;
    b.yaw_sigma_rad = rad_from_deg(3.0);
    b.scale = 1.0 - slip;
    b.scale_sigma = 0.02;
    votes.step(b, 4.0, 10.0, now_);
  }

  Time now_{};
  int count_ = 0;
  double yaw_rad_ = 0.0;
  double speed_mps_ = 0.0;
  base::EnuPoint at_;
  base::EnuPoint astray_;
  base::EnuPoint told_mps_;
  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
};

/// Straight, bent either way, turned on the spot, and back.
void all_ways(Slope& slope, double speed_mps) {
  for (int i = 0; i < 6; ++i) {
    slope.drive(speed_mps, 0.0, 8.0);
    slope.drive(0.0, 0.5, base::kPi);  // a quarter
    slope.drive(speed_mps, 0.2, 6.0);
    slope.drive(speed_mps, -0.3, 6.0);
    slope.drive(0.0, 0.0, 2.0);
    slope.drive(-speed_mps, 0.1, 6.0);
    slope.drive(0.0, 0.0, 1.0);
  }
}

TEST(Votes, AVehicleThatSlidesDownASlopeByATenthAccusesNobody) {
  for (const double slide : {0.0, 0.05, 0.1}) {
    for (const double speed_mps : {0.4, 0.8, 1.2}) {
      Slope slope;
      slope.slide = slide;
      all_ways(slope, speed_mps);
      EXPECT_EQ(slope.votes.told().accusations, 0u) << slide << " at " << speed_mps;
      EXPECT_TRUE(slope.votes.told()[Sense::Gyro].heard);
    }
  }
}

// Creeping, every sixth velocity is told without a course: summed up they are a tenth short.
TEST(Votes, AReceiverThatTellsNoCourseOfWhatIsSlowIsNotAccusedByACreepingRobot) {
  for (const double rate_radps : {0.0, 0.03}) {
    Slope slope;
    slope.velocity_mps = 0.04;
    slope.no_course_below_mps = 0.1;
    slope.drive(0.14, rate_radps, 60.0);
    EXPECT_EQ(slope.votes.told().accusations, 0u) << rate_radps;
    EXPECT_FALSE(slope.votes.told().undecided) << rate_radps;
  }
}

TEST(Votes, AGyroThatLiesThereIsNamedAllTheSame) {
  Slope slope;
  slope.slide = 0.1;
  all_ways(slope, 0.8);
  slope.gyro_extra_radps = rad_from_deg(6.0);
  slope.drive(0.8, 0.0, 9.0);
  EXPECT_TRUE(slope.votes.out(Sense::Gyro));
  EXPECT_EQ(slope.votes.told().accusations, 1u);
}

TEST(Votes, TracksThatWereSilentAreNotAccusedOfTheWayThatTheyDidNotTell) {
  Slope slope;
  slope.drive(0.8, 0.0, 10.0);
  slope.tracks_speak = false;
  slope.drive(0.8, 0.0, 3.0);
  slope.tracks_speak = true;
  slope.drive(0.8, 0.0, 12.0);
  EXPECT_EQ(slope.votes.told().accusations, 0u);
}

TEST(Votes, PositionsThatRunAwayAreFoundWithinSecondsRoundABendAndOnASlopeToo) {
  for (const double rate_radps : {0.0, 0.2}) {
    for (const double slide : {0.0, 0.1}) {
      Slope slope;
      slope.slide = slide;
      slope.drive(0.8, rate_radps, 20.0);
      EXPECT_LT(slope.votes.apart(), 1.0);
      slope.drift_mps = {-0.08, 0.06};
      slope.drive(0.8, rate_radps, 1.2);
      EXPECT_EQ(slope.votes.told().accusations, 0u);  // 12 cm: it could be noise yet
      slope.drive(0.8, rate_radps, 2.6);
      EXPECT_GT(slope.votes.apart(), 1.0);
      const auto& told = slope.votes.told();
      EXPECT_TRUE(told.undecided || told[Sense::Position].left_out) << rate_radps << " " << slide;
    }
  }
}

TEST(Votes, AVelocityThatLagsIsNoDriftAtStartsStopsAndCorners) {
  for (const double lag_s : {0.1, 0.15, 0.2}) {
    Slope slope;
    slope.lag_s = lag_s;
    slope.most_mps2 = 1.5;
    all_ways(slope, 1.0);
    EXPECT_EQ(slope.votes.told().accusations, 0u) << lag_s;
  }
}

TEST(Votes, AFixThatStepsOnceByTwelveCentimetresProvesNothing) {
  for (const double north_m : {-0.12, 0.12}) {
    Slope slope;
    slope.drive(0.8, 0.0, 20.0);
    slope.step_aside({0.0, north_m});
    slope.drive(0.8, 0.0, 20.0);
    EXPECT_EQ(slope.votes.told().accusations, 0u) << north_m;
  }
}

TEST(Votes, PositionsThatRunAwayAreFoundOfAReceiverThatSpeaksOnceOrThriceASecondToo) {
  for (const int every : {50, 17}) {
    Slope slope;
    slope.every = every;
    slope.drive(0.8, 0.0, 20.0);
    EXPECT_EQ(slope.votes.told().accusations, 0u);
    slope.drift_mps = {0.0, 0.12};
    slope.drive(0.8, 0.0, every == 50 ? 14.1 : 6.1);
    const auto& told = slope.votes.told();
    EXPECT_TRUE(told.undecided || told[Sense::Position].left_out) << every;
  }
}

TEST(Votes, APersonsWordAlsoForgetsWhatRanApart) {
  Slope slope;
  slope.drive(0.8, 0.0, 20.0);
  slope.drift_mps = {0.0, 0.1};
  slope.drive(0.8, 0.0, 4.0);
  ASSERT_GT(slope.votes.apart(), 0.5);
  slope.votes.acquit_all({});
  EXPECT_EQ(slope.votes.apart(), 0.0);
}

}  // namespace
}  // namespace roverd::nav
