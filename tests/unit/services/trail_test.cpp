#include "services/trail.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::services {
namespace {

using namespace std::chrono_literals;

constexpr double kReach_m = 10.0;
const base::LocalFrame kField(1, {58.378, 26.729});

base::LatLon at(double east_m, double north_m) {
  return kField.to_global({east_m, north_m});
}
base::Time t(double s) {
  return base::Time(1h) + base::from_seconds(s);
}
base::EnuPoint local(const Track::Point& p) {
  return kField.to_local(p.at);
}

int pieces(const Track& track) {
  int count = 0;
  for (const auto& p : track.points()) count += p.begins ? 1 : 0;
  return count;
}

double longest_gap_m(const Track& track) {
  double longest = 0.0;
  const auto& p = track.points();
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (!p[i].begins) longest = std::max(longest, base::distance_m(local(p[i - 1]), local(p[i])));
  }
  return longest;
}

TEST(Track, KeepsAPointForEveryFifthOfAMetre) {
  // Given a drive of 100 m at 1.5 m/s, sampled 20 times a second,
  Track track;
  for (int i = 0; i * 0.075 <= 100.0; ++i) track.add(at(0.0, i * 0.075), t(i * 0.05), kReach_m);
  // then every third sample is kept (0.225 m), and both ends.
  EXPECT_EQ(track.points().size(), 445u);
  EXPECT_EQ(pieces(track), 1);
  EXPECT_NEAR(longest_gap_m(track), 0.225, 1e-6);
  EXPECT_NEAR(local(track.points().front()).north_m, 0.0, 1e-6);
  EXPECT_NEAR(local(track.points().back()).north_m, 99.9, 0.01);
}

TEST(Track, StandingStillAddsNothing) {
  Track track;
  for (int i = 0; i < 10'000; ++i) track.add(at(0.0, 0.009 * (i % 2)), t(i * 0.05), kReach_m);
  EXPECT_EQ(track.points().size(), 1u);
}

TEST(Track, AReceiverThatHardlyMovesHasATrackOfOnePointASecond) {
  // Given an antenna that creeps along at 2 cm/s for half a minute,
  Track track;
  for (int i = 0; i <= 300; ++i) track.add(at(i * 0.002, 0.0), t(i * 0.1), kReach_m);
  EXPECT_EQ(track.points().size(), 31u);
  EXPECT_NEAR(longest_gap_m(track), 0.02, 1e-3);
}

TEST(Track, ACloudOfNoiseIsBoundedHoweverLongItStands) {
  // Given an RTK receiver on a post for ten hours, its noise within ±2.5 cm: places that are 1 cm
  // apart fill up, and no more come.
  Track track;
  for (int i = 0; i < 36'000; ++i) {
    track.add(at(0.025 * std::sin(i * 1.7), 0.025 * std::cos(i * 2.3)), t(i), kReach_m);
  }
  EXPECT_GT(track.points().size(), 10u);
  EXPECT_LT(track.points().size(), Track::kSeen);
}

TEST(Track, AJumpBeginsANewPiece) {
  //   x──x──x           x──x      set anew, 12 m aside: no line between
  Track track;
  for (int i = 0; i < 5; ++i) track.add(at(i, 0.0), t(i), kReach_m);
  for (int i = 0; i < 5; ++i) track.add(at(i, 12.0), t(5 + i), kReach_m);
  ASSERT_EQ(track.points().size(), 10u);
  EXPECT_EQ(pieces(track), 2);
  EXPECT_TRUE(track.points()[5].begins);
  // A smaller one is a correction, and drawn.
  track.add(at(4.0, 14.5), t(10), kReach_m);
  EXPECT_EQ(pieces(track), 2);
}

TEST(Track, IsBoundedAndThinnedWhereTheLineMissesLeast) {
  // Given a field of 100 rows, 60 m long and joined by half circles of 1 m radius, driven in 0.2 m
  // steps: 6.3 km, more than fits.
  //   ╭──────╮
  //   │  │   │   …
  //      ╰───
  Track track;
  int i = 0;
  const auto go = [&](double east_m, double north_m) {
    track.add(at(east_m, north_m), t(0.2 * i++), kReach_m);
    ASSERT_LE(track.points().size(), Track::kMost);
  };
  for (int row = 0; row < 100; ++row) {
    const bool up = row % 2 == 0;
    for (int k = 0; k < 290; ++k) go(2.0 * row, up ? k * 0.2001 : 58.0 - k * 0.2001);
    for (int k = 0; k <= 15; ++k) {
      const double a = base::kPi * k / 15;
      go(2.0 * row + 1.0 - std::cos(a), up ? 58.0 + std::sin(a) : -std::sin(a));
    }
  }
  ASSERT_GT(i, 30'000);
  const auto& p = track.points();
  EXPECT_GT(p.size(), Track::kMost / 2);
  // Then its first point is still there, it is one piece, in order,
  EXPECT_NEAR(local(p.front()).north_m, 0.0, 0.01);
  EXPECT_EQ(pieces(track), 1);
  EXPECT_TRUE(
      std::is_sorted(p.begin(), p.end(), [](auto& a, auto& b) { return a.stamp < b.stamp; }));
  // rows have no holes worth seeing, and every bend of the first rows goes as far out as it did.
  EXPECT_LT(longest_gap_m(track), 2.0);
  for (int row = 0; row < 10; row += 2) {
    double top_m = 0.0;
    for (const auto& point : p) {
      const base::EnuPoint here = local(point);
      if (std::abs(here.east_m - (2.0 * row + 1.0)) < 1.0) top_m = std::max(top_m, here.north_m);
    }
    EXPECT_NEAR(top_m, 59.0, 0.02) << row;
  }
}

TEST(Track, OfNothingButJumpsLosesTheOldest) {
  Track track;
  for (std::size_t i = 0; i < Track::kMost + 1; ++i) {
    track.add(at(i % 2 == 0 ? 0.0 : 50.0, static_cast<double>(i) * 0.01), t(static_cast<double>(i)),
              kReach_m);
  }
  EXPECT_LE(track.points().size(), Track::kMost);
  EXPECT_GT(track.points().size(), Track::kMost / 2);
  EXPECT_TRUE(track.points().front().begins);
  EXPECT_GT(track.points().front().stamp, t(100));
  EXPECT_EQ(track.points().back().stamp, t(static_cast<double>(Track::kMost)));
}

base::Snapshot snapshot(double s) {
  base::Snapshot out;
  out.now = t(s);
  out.wall = base::WallTime(1'700'000'000s) + base::from_seconds(s);
  return out;
}

TEST(Trail, TakesWhatTheRobotBelievesAndWhatItsReceiverSays) {
  Trail trail;
  // Nothing is known yet: nothing is drawn.
  base::Snapshot s = snapshot(0);
  trail.take(s);
  EXPECT_TRUE(trail.estimated().points().empty());
  EXPECT_TRUE(trail.received().points().empty());
  // A pose, and a receiver without a fix.
  s.pose.emplace();
  s.pose->stamp = t(0);
  s.pose->global = at(0, 0);
  s.gnss = base::GnssFix{};
  s.gnss->stamp = t(0);
  s.gnss->position = at(1, 0);
  trail.take(s);
  EXPECT_EQ(trail.estimated().points().size(), 1u);
  EXPECT_TRUE(trail.received().points().empty());
  // A fix; it is taken once, however long it is the newest one.
  s.gnss->fix = base::FixType::RtkFixed;
  s.gnss->stamp = t(1);
  for (int i = 0; i < 100; ++i) trail.take(s);
  EXPECT_EQ(trail.received().points().size(), 1u);
  // A pose that nobody renews is no place.
  s = snapshot(5);
  s.pose.emplace();
  s.pose->stamp = t(3);
  s.pose->global = at(5, 0);
  trail.take(s);
  EXPECT_EQ(trail.estimated().points().size(), 1u);
}

TEST(Trail, TheEstimateJumpsWhereItsSpeedDoesNotExplainTheWay) {
  Trail trail;
  double s = 0.0;
  const auto place = [&](double north_m, double speed_mps) {
    base::Snapshot snap = snapshot(s += 0.05);
    snap.pose = base::Pose{};
    snap.pose->stamp = snap.now;
    snap.pose->global = at(0, north_m);
    snap.pose->speed_mps = speed_mps;
    trail.take(snap);
  };
  // A standing robot is corrected by 1.5 m: drawn. By 3 m more: set anew.
  place(0.0, 0.0);
  place(1.5, 0.0);
  EXPECT_EQ(pieces(trail.estimated()), 1);
  place(4.5, 0.0);
  EXPECT_EQ(pieces(trail.estimated()), 2);
  // A car's recording played eight times as fast goes backwards, 5 m between two samples.
  for (int i = 0; i < 20; ++i) place(4.5 - 5.0 * i, -100.0);
  EXPECT_EQ(pieces(trail.estimated()), 2);
}

}  // namespace
}  // namespace roverd::services
