// Which samples of a drive become points, and what mission they make.

#include "mission/edit/teach.hpp"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"

namespace roverd::mission {
namespace {

/// A vehicle that is driven by hand, sampled 20 times a second.
class TaughtDrive {
 public:
  explicit TaughtDrive(TeachSettings settings = {}) : settings_(settings), sampler_(settings) {}

  /// @param speed_mps backwards negative
  void go(double seconds, double speed_mps, double yaw_rate_radps = 0.0, bool trusted = true) {
    const auto count = static_cast<int>(std::lround(seconds * 20.0));
    for (int i = 0; i < count; ++i) {
      yaw_ += yaw_rate_radps * 0.05;
      x_ += speed_mps * std::cos(yaw_) * 0.05;
      y_ += speed_mps * std::sin(yaw_) * 0.05;
      now_ += std::chrono::milliseconds(50);
      TeachSample s;
      s.stamp = now_;
      s.at = plane_.to_global({x_, y_});
      s.yaw_rad = yaw_;
      s.speed_mps = speed_mps;
      s.trusted = trusted;
      keep(sampler_.take(s));
    }
  }
  void jump(double metres) { x_ += metres; }
  void pause() {
    keep(sampler_.finish());
    sampler_.interrupt();
  }
  void stop() { keep(sampler_.finish()); }

  base::EnuPoint local(LatLon at) const { return plane_.to_local(at); }
  base::EnuPoint local(std::size_t i) const { return local(points.at(i).at); }
  Plan plan() const { return *mission_of(points, "taught", settings_.tolerance_m); }

  std::vector<TaughtPoint> points;

 private:
  void keep(const std::vector<TaughtPoint>& more) {
    points.insert(points.end(), more.begin(), more.end());
  }

  TeachSettings settings_;
  Sampler sampler_;
  base::TangentPlane plane_{LatLon{58.378, 26.729}};
  base::Time now_{};
  double x_ = 0.0;
  double y_ = 0.0;
  double yaw_ = 0.0;
};

TEST(Teach, AStraightWayHasAPointEveryMetreWithItsSpeed) {
  TaughtDrive drive;
  drive.go(2.0, 0.0);
  drive.go(10.0, 0.5);
  drive.stop();
  ASSERT_EQ(drive.points.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(drive.local(i).east_m, static_cast<double>(i), 0.06);
    EXPECT_NEAR(drive.points[i].heading_deg, 90.0, 0.01);
    EXPECT_FALSE(drive.points[i].reverse);
  }
  EXPECT_NEAR(drive.points[3].speed_mps, 0.5, 0.01);
  EXPECT_NEAR(taught_length_m(drive.points), 5.0, 0.01);
  // All of it in one leg.
  const Plan plan = drive.plan();
  ASSERT_EQ(plan.items.size(), 2u);
  EXPECT_EQ(std::get<Waypoint>(plan.items[1]).speed_mps, 0.5);
}

TEST(Teach, ABendHasAPointAtEachChangeOfHeading) {
  TaughtDrive drive;
  drive.go(4.0, 0.5);
  drive.go(base::kPi / 2.0 / 0.5, 0.5, 0.5);  // a quarter with a radius of 1 m
  drive.stop();
  // 90° by points every 10°, as far apart as 0.1 m at least.
  EXPECT_GE(drive.points.size(), 2u + 9u);
  EXPECT_LE(drive.points.size(), 2u + 11u);
}

TEST(Teach, ATurnOnTheSpotIsOneCorner) {
  TaughtDrive drive;
  drive.go(8.0, 0.5);
  drive.go(base::kPi / 2.0 / 0.5, 0.0, 0.5);
  drive.go(8.0, 0.5);
  drive.stop();
  const Plan plan = drive.plan();
  ASSERT_EQ(plan.items.size(), 3u);
  const auto corner = drive.local(std::get<Waypoint>(plan.items[1]).at);
  EXPECT_NEAR(corner.east_m, 4.0, 0.05);
  EXPECT_NEAR(corner.north_m, 0.0, 0.05);
}

TEST(Teach, BackingOutIsALegOfItsOwn) {
  TaughtDrive drive;
  drive.go(6.0, 0.5);
  drive.go(1.0, 0.0);
  drive.go(5.0, -0.3);
  drive.go(1.0, 0.0);
  drive.go(4.0, 0.5);
  drive.stop();
  const Plan plan = drive.plan();
  ASSERT_EQ(plan.items.size(), 4u);
  const auto at = [&](std::size_t i) { return std::get<Waypoint>(plan.items[i]); };
  EXPECT_NEAR(drive.local(at(1).at).east_m, 3.0, 0.05);
  EXPECT_NEAR(drive.local(at(2).at).east_m, 1.5, 0.05);
  EXPECT_NEAR(drive.local(at(3).at).east_m, 3.5, 0.05);
  EXPECT_FALSE(at(1).reverse);
  EXPECT_TRUE(at(2).reverse);
  EXPECT_FALSE(at(3).reverse);
  EXPECT_NEAR(*at(2).speed_mps, 0.3, 0.051);
}

TEST(Teach, SpeedsAreThoseOfTheirPlaces) {
  TaughtDrive drive;
  drive.go(10.0, 1.0);
  drive.go(20.0, 0.3);
  drive.go(10.0, 1.0);
  drive.stop();
  std::vector<double> speeds;
  for (const Item& item : drive.plan().items) {
    speeds.push_back(*std::get<Waypoint>(item).speed_mps);
  }
  ASSERT_GE(speeds.size(), 4u);
  EXPECT_LE(speeds.size(), 8u);
  EXPECT_EQ(speeds.front(), 1.0);
  EXPECT_EQ(speeds.back(), 1.0);
  EXPECT_EQ(*std::min_element(speeds.begin(), speeds.end()), 0.3);
}

TEST(Teach, NothingIsRecordedOfWhatIsNotTrusted) {
  TaughtDrive drive;
  drive.go(1.0, 0.5, 0.0, false);
  EXPECT_TRUE(drive.points.empty());
  drive.go(6.0, 0.5);
  drive.go(10.0, 0.5, 0.0, false);
  drive.go(6.0, 0.5);
  drive.stop();
  int gaps = 0;
  for (const TaughtPoint& p : drive.points) gaps += p.gap ? 1 : 0;
  EXPECT_EQ(gaps, 1);
  EXPECT_NEAR(taught_length_m(drive.points), 6.0, 0.1);  // 5 m were not seen
}

TEST(Teach, AJumpAndAPauseAreGaps) {
  TaughtDrive drive;
  drive.go(4.0, 0.5);
  drive.jump(3.0);
  drive.go(4.0, 0.5);
  drive.pause();
  drive.jump(0.7);
  drive.go(4.0, 0.5);
  drive.stop();
  std::vector<double> after_gaps;
  for (std::size_t i = 0; i < drive.points.size(); ++i) {
    if (drive.points[i].gap) after_gaps.push_back(drive.local(i).east_m);
  }
  ASSERT_EQ(after_gaps.size(), 2u);
  EXPECT_NEAR(after_gaps[0], 5.0, 0.1);
  EXPECT_NEAR(after_gaps[1], 7.7, 0.1);
}

TEST(Teach, StandingMakesNoMission) {
  TaughtDrive drive;
  EXPECT_EQ(mission_of(drive.points, "x", 0.1).error().code, base::Code::Conflict);
  drive.go(5.0, 0.0);
  drive.stop();
  EXPECT_EQ(drive.points.size(), 1u);
  EXPECT_EQ(mission_of(drive.points, "x", 0.1).error().code, base::Code::Conflict);
}

TEST(Teach, WithoutToleranceAllPointsStay) {
  TeachSettings settings;
  settings.tolerance_m = 0.0;
  settings.step_m = 0.25;
  TaughtDrive drive(settings);
  drive.go(10.0, 0.5);
  drive.stop();
  EXPECT_EQ(drive.plan().items.size(), drive.points.size());
  EXPECT_NEAR(static_cast<double>(drive.points.size()), 21.0, 4.0);
}

}  // namespace
}  // namespace roverd::mission
