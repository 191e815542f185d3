// A drive around a block of rooms with a bad odometry, and the map of it.

#include "nav/mapping/mapper.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "rooms.hpp"

namespace roverd::nav::mapping {
namespace {

/// Along the middle of the ring, with rounded corners, a lap and a bit: a pose every 0.25 m.
std::vector<Pose2> lap_and_a_bit() {
  std::vector<Pose2> out;
  Pose2 pose{0.0, 0.0, 0.0};
  const auto drive = [&](double metres, double turn_rad) {
    const int steps = static_cast<int>(std::ceil(metres / 0.25));
    for (int i = 0; i < steps; ++i) {
      pose = pose * Pose2{metres / steps, 0.0, turn_rad / steps};
      out.push_back(pose);
    }
  };
  out.push_back(pose);
  const double quarter = std::numbers::pi / 2.0;
  for (const double side_m : {20.0, 10.0, 20.0, 10.0, 20.0}) {
    drive(side_m, 0.0);
    drive(2.0, quarter);
  }
  return out;
}

struct Drive {
  std::vector<Pose2> truth = lap_and_a_bit();
  Mapper mapper;
  std::vector<double> error_m;

  explicit Drive(const MapperParams& params) : mapper(params) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    const Plan plan = block_of_rooms();
    Pose2 odometry = truth[0];
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (i > 0) {
        // 2 degrees of heading and 3 cm a step, and a pull to one side.
        odometry = odometry * (inverse(truth[i - 1]) * truth[i]) *
                   Pose2{0.03 * noise(random), 0.01 * noise(random), 0.004 + 0.03 * noise(random)};
      }
      EXPECT_TRUE(mapper.add(look(plan, truth[i], random), odometry));
    }
    mapper.finish();
    const auto path = mapper.path();
    EXPECT_EQ(path.size(), truth.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      error_m.push_back(std::hypot(path[i].x_m - truth[i].x_m, path[i].y_m - truth[i].y_m));
    }
  }
  double worst_m() const { return *std::max_element(error_m.begin(), error_m.end()); }
};

TEST(Mapper, ClosesTheLoopAndDrawsTheWalls) {
  const Drive drive{MapperParams{}};
  const auto counts = drive.mapper.counts();
  EXPECT_EQ(counts.scans, drive.truth.size());
  EXPECT_GT(counts.loops, 2U);
  EXPECT_EQ(counts.unfit, 0U);
  // 0.3 % of the way of 90 m
  EXPECT_LT(drive.worst_m(), 0.27);
  // Then what is a wall is occupied, what was driven is free, and what nobody saw is unknown.
  const auto map = drive.mapper.draw();
  ASSERT_TRUE(map) << map.error().detail;
  int walls = 0;
  int seen = 0;
  for (double x = 3.0; x < 12.0; x += 0.1) {
    // The block's lower wall, to 20 cm.
    ++walls;
    for (double y = 1.8; y < 2.2; y += 0.05) {
      if (map->at(*map->cell_of(x, y)) >= chart::kSurelyOccupied) {
        ++seen;
        break;
      }
    }
  }
  EXPECT_GT(seen, walls * 9 / 10);
  for (const Pose2& p : drive.truth) {
    EXPECT_LE(map->at(*map->cell_of(p.x_m, p.y_m)), chart::kSurelyFree);
    EXPECT_GE(map->at(*map->cell_of(p.x_m, p.y_m)), 0);
  }
  EXPECT_EQ(map->at(*map->cell_of(11.0, 6.0)), chart::kUnknown);  // within the block
}

TEST(Mapper, WithoutLoopsItDrifts) {
  MapperParams params;
  params.loops = false;
  const Drive drive(params);
  EXPECT_EQ(drive.mapper.counts().loops, 0U);
  EXPECT_LT(drive.worst_m(), 1.5);
}

TEST(Mapper, ScansThatShowNothingFollowTheOdometry) {
  Mapper mapper;
  chart::Scan blind;
  blind.beams.push_back({20.0F, 0.0F, false});
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(mapper.add(blind, {0.5 * i, 0.0, 0.0}));
  mapper.finish();
  EXPECT_NEAR(mapper.pose().x_m, 14.5, 1e-6);
  EXPECT_EQ(mapper.counts().unfit, 29U);
  const auto map = mapper.draw();
  ASSERT_TRUE(map);
  EXPECT_EQ(map->at(*map->cell_of(5.0, 0.0)), chart::kFree);
}

/// The program ends while it is drawn: no loops are looked for, and there is no half map.
TEST(Mapper, GivesUpWhenTold) {
  Mapper mapper;
  chart::Scan scan;
  scan.beams.push_back({3.0F, 0.0F, true});
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(mapper.add(scan, {0.5 * i, 0.0, 0.0}));
  const auto ends = [] { return true; };
  mapper.finish(ends);
  EXPECT_EQ(mapper.draw({.give_up = ends}).error().code, base::Code::Unavailable);
  EXPECT_TRUE(mapper.draw()) << "what was laid together is there still";
}

TEST(Mapper, RefusesWhatIsNoNumberAndAMapOfNothing) {
  Mapper mapper;
  EXPECT_EQ(mapper.draw().error().detail, "nothing was seen of which a map could be drawn");
  mapper.finish();
  EXPECT_TRUE(mapper.path().empty());
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mapper.add({}, {none, 0, 0}).error().code, base::Code::Invalid);
  ASSERT_TRUE(mapper.add({}, {0, 0, 0}));
  ASSERT_TRUE(mapper.add({}, {1e9, 0, 0}));  // an odometry that jumps to the moon
  EXPECT_EQ(mapper.counts().nodes, 2U);
  chart::Scan far;
  far.beams.push_back({1.0F, 0.0F, true});
  ASSERT_TRUE(mapper.add(far, {0, 0, 0}));
  ASSERT_TRUE(mapper.add(far, {1e9, 0, 0}));
  EXPECT_EQ(mapper.draw().error().code, base::Code::TooLarge);
}

}  // namespace
}  // namespace roverd::nav::mapping
