// Satellites and a map as sources of one estimate: who leads, what is learned of the other, and
// that nothing jumps when the lead changes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

using base::PlacePhase;
using std::chrono::milliseconds;

/// A robot that also has a map, told ten times a second, 60 ms late.
class Mapped {
 public:
  Mapped() { d.gyro = true; }

  Drive d;
  bool map = true;
  PlacePhase phase = PlacePhase::Known;
  bool denied = false;
  double off_north_m = 0.0;
  double off_east_m = 0.0;  ///< of the map's anchor, or of a wrong place in it
  double sigma_m = 0.02;
  double along_m = 0.0;  ///< > 0: a corridor to the north, so uncertain along it
  double anchor_sigma_m = 0.5;
  double askew_rad = 0.0;  ///< the map lies turned by so much
  double anchor_yaw_sigma_rad = 0.0;
  bool north_said = false;
  std::uint32_t found = 0;
  double fastest_mps = 0.0;  ///< the estimate beside the odometry, since forget()

  void forget() { fastest_mps = 0.0; }
  void run(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds * 50.0));
    for (int i = 0; i < ticks; ++i) tick();
  }
  double north_sigma_m() const { return std::sqrt(d.estimator.belief().P(kNorth, kNorth)); }
  double east_sigma_m() const { return std::sqrt(d.estimator.belief().P(kEast, kEast)); }

 private:
  void tick() {
    const auto before = d.pose();
    d.tick();
    seen_.push_back({d.now(), d.east_m, d.north_m, d.yaw_rad});
    if (++count_ % 5 == 0 && seen_.size() > 3) tell(seen_[seen_.size() - 4]);
    // Over a second, so that steps from fix to fix count as what they are: a speed.
    const auto now = d.pose();
    if (!before || !now) return;
    off_.push_back({now->at.east_m - d.east_m, now->at.north_m - d.north_m});
    if (off_.size() > 51) off_.pop_front();
    if (off_.size() == 51) {
      const double way_m = base::distance_m(off_.front(), off_.back());
      fastest_mps = std::max(fastest_mps, way_m / 1.0);
    }
  }
  struct Was {
    Time stamp;
    double east_m, north_m, yaw_rad;
  };
  void tell(const Was& was) {
    base::PlaceState s;
    s.stamp = was.stamp;
    s.phase = phase;
    s.map = "shed";
    s.denied = denied;
    if (map && phase == PlacePhase::Known) {
      base::PlaceFix f;
      f.at = frame_.to_global({was.east_m + off_east_m, was.north_m + off_north_m});
      f.yaw_rad = was.yaw_rad + askew_rad;
      const double north_m = along_m > 0.0 ? along_m : sigma_m;
      f.covariance = {sigma_m * sigma_m, 0.0, north_m * north_m, 0.0, 0.0, 1e-4};
      f.map = 1;
      f.found = found;
      f.anchor = kOrigin;
      f.anchor_sigma_m = anchor_sigma_m;
      f.anchor_yaw_sigma_rad = anchor_yaw_sigma_rad;
      f.north_said = north_said;
      s.fix = f;
    }
    if (map) d.estimator.take(s, d.now());
  }

  base::LocalFrame frame_{7, kOrigin};
  std::deque<Was> seen_;
  std::deque<base::EnuPoint> off_;
  int count_ = 0;
};

TEST(EstimatorPlace, BeginsByTheMapAloneWithoutAnySatellites) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.d.yaw_rad = 0.7;
  m.run(1.0);
  ASSERT_TRUE(m.d.pose());
  EXPECT_EQ(m.d.estimator.frame()->origin(), kOrigin);  // the map's anchor
  m.d.speed_mps = 1.0;
  m.d.rate_radps = 0.1;
  m.run(40.0);
  EXPECT_LT(m.d.position_error_m(), 0.02);
  EXPECT_LT(std::abs(m.d.yaw_error_deg()), 0.5);
  EXPECT_EQ(m.d.pose()->source, "map+odometry");
  EXPECT_LT(m.d.now() - *m.d.estimator.last_position(), milliseconds(200));
  EXPECT_GE(m.d.pose()->horizontal_sigma_m, 0.015) << "no number of matches makes a map finer";
  EXPECT_LT(m.d.pose()->horizontal_sigma_m, 0.05);
}

TEST(EstimatorPlace, IsUncertainAlongACorridorAndNotAcross) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.run(1.0);
  m.along_m = 2.0;
  m.d.speed_mps = 1.0;
  m.run(60.0);
  EXPECT_LT(m.east_sigma_m(), 0.03);
  EXPECT_GT(m.north_sigma_m(), 2.0 * m.east_sigma_m());
}

TEST(EstimatorPlace, FixedSatellitesLeadAndShowByHowMuchTheAnchorIsOff) {
  Mapped m;
  m.d.speed_mps = 1.0;
  m.map = false;
  m.run(20.0);
  m.map = true;
  m.off_east_m = 0.4;
  m.run(10.0);
  EXPECT_EQ(m.d.pose()->source, "gnss+odometry");
  EXPECT_LT(m.d.position_error_m(), 0.03);
  EXPECT_NEAR(m.d.estimator.health().map_offset.east_m, -0.4, 0.03);
  // Into the shed: the map leads as the satellites have left it, and nothing moves.
  m.forget();
  m.d.gnss = false;
  m.run(60.0);
  EXPECT_EQ(m.d.pose()->source, "map+odometry");
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_LT(m.fastest_mps, 0.1);
  // And out again.
  m.forget();
  m.d.gnss = true;
  m.run(30.0);
  EXPECT_EQ(m.d.pose()->source, "gnss+odometry");
  EXPECT_LT(m.fastest_mps, 0.1);
  EXPECT_EQ(m.d.estimator.health().resets, 0u);
}

TEST(EstimatorPlace, LearnsNothingOfTheAnchorAlongABareCorridor) {
  Mapped m;
  m.d.speed_mps = 1.0;
  m.map = false;
  m.run(20.0);
  m.map = true;
  m.off_east_m = 0.4;
  m.off_north_m = 0.7;  // the matcher slides along the corridor
  m.along_m = 5.0;
  m.run(10.0);
  EXPECT_NEAR(m.d.estimator.health().map_offset.east_m, -0.4, 0.03);
  EXPECT_NEAR(m.d.estimator.health().map_offset.north_m, 0.0, 0.1);
}

TEST(EstimatorPlace, TakesNoHeadingFromAPlaceThatIsNotItsOwn) {
  Mapped m;
  m.d.compass = false;
  m.map = false;
  m.run(5.0);
  ASSERT_TRUE(m.d.pose());
  ASSERT_FALSE(m.d.estimator.heading_known());
  m.map = true;
  m.off_east_m = 20.0;
  m.askew_rad = 2.0;
  m.run(5.0);
  EXPECT_FALSE(m.d.estimator.heading_known());
  m.off_east_m = m.askew_rad = 0.0;
  m.run(1.0);
  EXPECT_TRUE(m.d.estimator.heading_known());
  EXPECT_LT(std::abs(m.d.yaw_error_deg()), 1.0);
}

TEST(EstimatorPlace, BringsTheFirstPlaceForwardToNow) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.d.yaw_rad = 0.7;
  m.d.speed_mps = 2.0;
  while (!m.d.pose()) m.run(0.02);
  EXPECT_LT(m.d.position_error_m(), 0.05) << "60 ms late: 0.12 m";
}

TEST(EstimatorPlace, GoesToSatellitesThatComeBackSlowly) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.off_east_m = 0.6;  // the map's anchor is off, and nobody knows yet
  m.run(1.0);
  m.d.speed_mps = 1.0;
  m.run(20.0);
  EXPECT_NEAR(m.d.position_error_m(), 0.6, 0.05);
  m.forget();
  m.d.gnss = true;
  m.run(5.0);
  EXPECT_GT(m.d.position_error_m(), 0.2) << "not at once";
  EXPECT_GT(m.d.pose()->horizontal_sigma_m, 0.7 * m.d.position_error_m()) << "and it says so";
  m.run(20.0);
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_LT(m.fastest_mps, 0.1);
  EXPECT_EQ(m.d.pose()->source, "gnss+odometry");
}

TEST(EstimatorPlace, GoesToTheMapFromCoarseSatellitesSlowly) {
  Mapped m;
  m.d.fix = base::FixType::Single;
  m.d.offset_east_m = 0.8;
  m.map = false;
  m.d.speed_mps = 1.0;
  m.run(30.0);
  m.forget();
  m.map = true;
  m.run(30.0);
  EXPECT_EQ(m.d.pose()->source, "map+odometry");
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_LT(m.fastest_mps, 0.1);
  // What the satellites are off by is known by now: without the map nothing moves either.
  m.forget();
  m.map = false;
  m.run(15.0);
  EXPECT_EQ(m.d.pose()->source, "gnss+odometry");
  EXPECT_LT(m.fastest_mps, 0.1);
  EXPECT_LT(m.d.position_error_m(), 0.4);
}

TEST(EstimatorPlace, IsNoSurerOfTheHeadingThanTheMapOfItsOwn) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.askew_rad = 0.06;
  m.anchor_yaw_sigma_rad = 0.05;
  m.run(30.0);
  ASSERT_TRUE(m.d.pose());
  EXPECT_GE(m.d.pose()->yaw_sigma_rad, 0.05) << "however often it was matched";
}

TEST(EstimatorPlace, NorthByAWordCountsUntilSatellitesCouldTellIt) {
  // Given: indoors, by a map whose north a person said, 10 degrees off.
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.askew_rad = 0.17;
  m.anchor_yaw_sigma_rad = 0.17;
  m.north_said = true;
  m.run(20.0);
  ASSERT_TRUE(m.d.pose());
  EXPECT_LT(m.d.pose()->yaw_sigma_rad, 0.02) << "every way there is counted by the map's north";
  // When: satellites are heard beside it.
  m.d.gnss = true;
  m.d.fix = base::FixType::RtkFloat;
  m.run(2.0);
  // Then: nobody claims the heading any more, also when they are gone again.
  EXPECT_GE(m.d.pose()->yaw_sigma_rad, 0.17);
  m.d.gnss = false;
  m.run(10.0);
  EXPECT_GE(m.d.pose()->yaw_sigma_rad, 0.17);
  // And: what they say on the way is believed.
  m.d.gnss = true;
  m.d.fix = base::FixType::RtkFixed;
  m.map = false;
  m.d.speed_mps = 1.0;
  m.run(60.0);
  EXPECT_LT(std::abs(m.d.yaw_error_deg()), 3.5) << "the rest may be a crab as well";
}

TEST(EstimatorPlace, NorthByAWordIsNoSurerOnceSatellitesLead) {
  for (const double without_map_s : {0.0, 3.0}) {
    // Given: a word as sure as a person's arrow, and farther off; floating satellites beside it.
    Mapped m;
    m.d.gnss = m.d.compass = false;
    m.askew_rad = 0.17;
    m.anchor_yaw_sigma_rad = 0.052;
    m.north_said = true;
    m.run(20.0);
    m.d.gnss = true;
    m.d.fix = base::FixType::RtkFloat;
    m.run(30.0);
    // When: they are fixed, and lead; the robot stands.
    m.d.fix = base::FixType::RtkFixed;
    m.map = without_map_s <= 0.0;
    m.run(6.0);
    // Then: a hundred matches of the same error have not made the heading sure.
    ASSERT_EQ(m.d.pose()->source.substr(0, 4), "gnss");
    EXPECT_GE(m.d.pose()->yaw_sigma_rad, 0.05) << without_map_s;
  }
}

TEST(EstimatorPlace, NorthByAWordIsAskedWhereSatellitesLedBefore) {
  Mapped m;
  m.d.compass = false;
  m.d.speed_mps = 1.0;
  m.anchor_yaw_sigma_rad = 0.17;
  m.north_said = true;
  m.run(20.0);
  m.d.gnss = false;
  m.run(10.0);
  EXPECT_GE(m.d.pose()->yaw_sigma_rad, 0.17);
}

TEST(EstimatorPlace, AMapThatLiesAskewDoesNotReplaceTheTrueHeading) {
  Mapped m;
  m.d.antennas = true;
  m.d.speed_mps = 1.0;
  m.run(20.0);
  m.d.fix = base::FixType::RtkFloat;  // and two antennas, that are honest
  m.askew_rad = 0.15;
  m.anchor_yaw_sigma_rad = 0.1;
  m.run(20.0);
  EXPECT_LT(std::abs(m.d.yaw_error_deg()), 1.5);
}

/// Driven by the map, with satellites beside it that are right but not fixed.
void drive_by_both(Mapped& m) {
  m.d.fix = base::FixType::RtkFloat;
  m.d.speed_mps = 0.5;
  m.run(30.0);
  ASSERT_EQ(m.d.pose()->source, "map+odometry");
}

TEST(EstimatorPlace, AWrongPlaceFoundAnewIsRefusedWhileSatellitesSayThatItIsNot) {
  Mapped m;
  drive_by_both(m);
  m.off_east_m = 8.0;  // a hall that looks alike
  ++m.found;
  m.run(10.0);
  EXPECT_LT(m.d.position_error_m(), 1.0);
  EXPECT_EQ(m.d.estimator.health().resets, 1u) << "that of the first heading";
}

TEST(EstimatorPlace, NorAfterItWasLost) {
  Mapped m;
  drive_by_both(m);
  m.phase = PlacePhase::Lost;
  m.run(0.5);
  m.phase = PlacePhase::Known;
  m.off_east_m = 8.0;
  ++m.found;
  m.run(10.0);
  EXPECT_LT(m.d.position_error_m(), 1.0);
}

TEST(EstimatorPlace, SatellitesThatMeanTheNewPlaceAsWellDoNotObject) {
  Mapped m;
  drive_by_both(m);
  m.d.east_m += 8.0;  // carried
  ++m.found;
  m.run(3.0);
  EXPECT_LT(m.d.position_error_m(), 0.1);
  EXPECT_EQ(m.d.estimator.health().last_reset->what, "map");
}

TEST(EstimatorPlace, RefusalsLongAgoDoNotCount) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.run(5.0);
  for (int i = 0; i < 8; ++i) {  // now and then one scan that fits elsewhere
    m.map = false;
    m.run(1.3);
    m.map = true;
    m.off_east_m = 5.0;
    m.run(0.1);
  }
  EXPECT_LT(m.d.position_error_m(), 0.1);
}

TEST(EstimatorPlace, WrongSatellitesInTheHallAreNotBelieved) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.run(1.0);
  m.d.speed_mps = 0.5;
  m.run(10.0);
  m.d.gnss = true;
  m.d.offset_east_m = 6.0;  // fixed, they say
  m.forget();
  m.run(30.0);
  EXPECT_EQ(m.d.pose()->source, "map+odometry");
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_LT(m.fastest_mps, 0.1);
}

//   The satellites were there a second ago; then a person says where it stands, 0.3 m off. What
//   the map says beside that is no word of theirs about its anchor.
TEST(EstimatorPlace, ATapAfterTheLastSatelliteTeachesNothingOfTheAnchor) {
  Mapped m;
  m.d.speed_mps = 1.0;
  m.map = false;
  m.run(20.0);
  m.d.speed_mps = 0.0;
  m.run(2.0);
  m.d.gnss = false;
  m.run(0.5);
  const auto& frame = *m.d.estimator.frame();
  const base::EnuPoint at = frame.to_local(m.d.pose()->global);
  m.d.estimator.place(base::EnuPoint{at.east_m - 0.22, at.north_m + 0.2}, std::nullopt);
  m.map = true;
  m.run(5.0);
  EXPECT_LT(m.d.position_error_m(), 0.03);
  EXPECT_EQ(m.d.pose()->source, "map+odometry");
  EXPECT_EQ(m.d.estimator.health().map_offset.east_m, 0.0);
}

TEST(EstimatorPlace, AWrongPlaceInTheMapIsRefusedWhileSatellitesLead) {
  Mapped m;
  m.d.speed_mps = 1.0;
  m.run(20.0);
  m.off_east_m = 5.0;  // a hall that looks alike
  m.run(10.0);
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_GT(m.d.estimator.health().place.rejected, 50u);
}

TEST(EstimatorPlace, WhoWasCarriedIsUncertainAndFoundAnew) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.run(5.0);
  m.d.east_m += 4.0;  // carried
  m.phase = PlacePhase::Lost;
  m.d.speed_mps = 0.5;
  m.run(1.0);
  EXPECT_GT(m.d.pose()->horizontal_sigma_m, 4.0);
  m.phase = PlacePhase::Known;
  ++m.found;
  m.run(1.0);
  EXPECT_LT(m.d.position_error_m(), 0.05);
  EXPECT_LT(m.d.pose()->horizontal_sigma_m, 0.1);
  EXPECT_EQ(m.d.estimator.health().last_reset->what, "map");
}

//   Told a place by a person, in the map of another building.
TEST(EstimatorPlace, WhatAPersonSaysAndTheMapDeniesIsUncertain) {
  Mapped m;
  m.d.gnss = m.d.compass = false;
  m.phase = PlacePhase::Searching;
  m.d.estimator.use_frame({7, kOrigin});
  m.run(1.0);
  m.d.estimator.place(base::EnuPoint{9.0, 0.0}, 1.0);
  m.run(0.5);
  EXPECT_LT(m.d.pose()->horizontal_sigma_m, 0.2) << "nothing speaks against it yet";
  m.denied = true;
  m.run(0.5);
  EXPECT_GT(m.d.pose()->horizontal_sigma_m, 4.0);
  // when: it is told once more, wrongly again
  m.d.estimator.place(base::EnuPoint{6.0, 0.0}, 1.0);
  m.run(0.5);
  EXPECT_GT(m.d.pose()->horizontal_sigma_m, 4.0);
  // when: it is told rightly, and what is seen fits
  m.d.estimator.place(base::EnuPoint{0.0, 0.0}, base::kPi / 2.0);
  m.denied = false;
  m.phase = PlacePhase::Known;
  m.run(1.0);
  EXPECT_LT(m.d.pose()->horizontal_sigma_m, 0.1);
  EXPECT_LT(m.d.position_error_m(), 0.05);
}

TEST(EstimatorPlace, WhatSatellitesToldAMapThatDeniesItDoesNotMakeUncertain) {
  Mapped m;
  m.phase = PlacePhase::Lost;  // it left the shed
  m.denied = true;
  m.d.speed_mps = 0.5;
  m.run(5.0);
  m.d.gnss = false;  // under a tree
  m.run(5.0);
  EXPECT_LT(m.d.pose()->horizontal_sigma_m, 0.5);
}

TEST(EstimatorPlace, RefusesWhatIsNotFiniteTooOldOrTwice) {
  Mapped m;
  m.run(3.0);
  const auto told = [&](auto change) {
    const std::uint64_t before = m.d.estimator.health().place.rejected;
    base::PlaceState s;
    s.stamp = m.d.now();
    s.phase = PlacePhase::Known;
    base::PlaceFix f;
    f.at = f.anchor = kOrigin;
    f.covariance = {1e-4, 0.0, 1e-4, 0.0, 0.0, 1e-4};
    change(s, f);
    s.fix = f;
    m.d.estimator.take(s, m.d.now());
    m.d.tick();
    return m.d.estimator.health().place.rejected - before;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(told([&](auto&, auto& f) { f.yaw_rad = nan; }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.at.lat = nan; }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.covariance[1] = 1.0; }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.covariance[5] = 0.0; }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.anchor_sigma_m = -1.0; }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.anchor_yaw_sigma_rad = nan; }), 1u);
  EXPECT_EQ(told([&](auto& s, auto&) { s.stamp += std::chrono::seconds(1); }), 1u);
  EXPECT_EQ(told([&](auto& s, auto&) { s.stamp -= std::chrono::seconds(2); }), 1u);
  EXPECT_EQ(told([&](auto&, auto& f) { f.at.lat += 1.0; }), 1u);
  EXPECT_TRUE(std::isfinite(m.d.pose()->horizontal_sigma_m));
}

}  // namespace
}  // namespace roverd::nav
