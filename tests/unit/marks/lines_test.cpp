// Lines, posts and walls against their truth.

#include "nav/marks/lines.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "nav/marks/posts.hpp"
#include "nav/marks/walls.hpp"
#include "yard.hpp"

namespace roverd::nav::marks {
namespace {

using namespace std::chrono_literals;

struct Looking {
  Yard yard;
  Rover rover;
  Scanner scanner;
  Looking() { rover.step({}); }
  PlanarScan scan() {
    rover.step({});
    return scan_of(scanner.look(yard, rover.truth, rover.now), rover);
  }
};

//  ─────────┐
//           │     ▶
TEST(MarksLines, ACornerIsTwoLinesWithTheirDistances) {
  Looking l;
  l.yard.slabs = {{{-3.0, 1.5}, {4.0, 1.5}}, {{4.0, 1.5}, {4.0, -3.0}}};
  const auto lines = lines_of(l.scan(), {});
  ASSERT_EQ(lines.size(), 2U);
  const Line& front = lines[0];  // from right to left
  const Line& left = lines[1];
  EXPECT_NEAR(front.distance_m({0, 0}), 4.0, 0.01);
  EXPECT_NEAR(left.distance_m({0, 0}), 1.5, 0.01);
  EXPECT_NEAR(std::atan2(left.normal.y, left.normal.x), -base::kPi / 2.0, 0.01);
  EXPECT_NEAR(left.length_m(), 5.5, 0.1);
  EXPECT_GT(left.points, 200U);
}

TEST(MarksLines, TheCertaintyIsThatOfTheErrors) {
  // 200 scans of one wall: errors of place and direction over what was claimed.
  Looking l;
  l.yard.slabs = {{{-4.0, 2.0}, {4.0, 2.0}}};
  double place = 0.0;
  double turn = 0.0;
  int n = 0;
  for (int i = 0; i < 200; ++i) {
    const auto lines = lines_of(l.scan(), {});
    if (lines.size() != 1) continue;
    const Fit fit = fit_of(lines[0].moments);
    place += std::pow((fit.centre.y - 2.0) / lines[0].sigma_m, 2);
    turn += std::pow(std::atan2(fit.along.y, fit.along.x) / lines[0].sigma_rad, 2);
    ++n;
  }
  ASSERT_GT(n, 190);
  EXPECT_NEAR(std::sqrt(place / n), 1.0, 0.35);
  EXPECT_NEAR(std::sqrt(turn / n), 1.0, 0.35);
}

//       ▶     the last beam, 135° to the left, meets it behind: there it may go on
//  ══════════════╡
TEST(MarksLines, AnEndIsOneOnlyWhereTheScannerLookedBeyondIt) {
  Looking l;
  l.yard.slabs = {{{-9.0, 0.9}, {5.0, 0.9}}};
  auto scan = l.scan();
  while (!scan.beams.back().hit) scan = l.scan();
  const auto lines = lines_of(scan, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_FALSE(lines[0].from_open);
  EXPECT_NEAR(lines[0].from.x, 5.0, 0.3);
  EXPECT_TRUE(lines[0].to_open);
  EXPECT_NEAR(lines[0].to.x, -0.9, 0.1);
}

TEST(MarksLines, ClutterIsNoWall) {
  Looking l;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  for (int i = 0; i < 60; ++i) l.yard.poles.push_back({{place(random), place(random)}, 0.1});
  std::erase_if(l.yard.poles, [](const Pole& p) { return std::hypot(p.at.x, p.at.y) < 0.5; });
  for (const Line& line : lines_of(l.scan(), {})) EXPECT_LT(line.length_m(), 0.5);
}

TEST(MarksLines, UglyScansAreTakenWithoutHarm) {
  PlanarScan scan;
  EXPECT_TRUE(lines_of(scan, {}).empty());
  scan.beams.assign(1000, {{1.0, 1.0}, 1.4, true});  // all in one place
  EXPECT_TRUE(lines_of(scan, {}).empty());
  scan.beams.assign(5, {{1.0, 1.0}, 1.4, false});
  EXPECT_TRUE(posts_of(scan, {}).empty());
}

//        o       o  0.08
//     o      0.15          ═══════ wall behind
TEST(MarksPosts, PolesStandWhereTheyStandAndAWallIsNone) {
  Looking l;
  l.yard.slabs = {{{-4.0, 5.0}, {6.0, 5.0}}};
  l.yard.poles = {{{2.0, 0.5}, 0.08}, {{3.0, -1.0}, 0.15}, {{1.5, -2.0}, 0.04}};
  const auto posts = posts_of(l.scan(), {});
  ASSERT_EQ(posts.size(), 3U);
  for (const Pole& truth : l.yard.poles) {
    const bool found = std::ranges::any_of(posts, [&](const Post& p) {
      return std::hypot(p.at.x - truth.at.x, p.at.y - truth.at.y) < 0.03 &&
             std::abs(p.radius_m - truth.radius_m) < 0.03;
    });
    EXPECT_TRUE(found) << truth.at.x << " " << truth.at.y;
  }
}

TEST(MarksPosts, APostAtAWallATreeAndABoxAreNone) {
  Looking l;
  l.yard.slabs = {{{-4.0, 2.0}, {6.0, 2.0}}, {{2.0, -2.0}, {2.0, -1.0}}};
  l.yard.poles = {{{2.0, 1.85}, 0.1}, {{4.0, 0.0}, 0.5}};
  EXPECT_TRUE(posts_of(l.scan(), {}).empty());
}

TEST(MarksWalls, OneWallStaysTheSameWallPastADoorAndAPerson) {
  Looking l;
  l.yard.slabs = {{{-3.0, 1.0}, {1.0, 1.0}}, {{2.2, 1.0}, {6.0, 1.0}}};
  Walls walls;
  for (int i = 0; i < 3; ++i) walls.take(l.scan(), {});
  ASSERT_EQ(walls.all().size(), 1U);
  const std::uint32_t id = walls.all()[0].id;
  EXPECT_TRUE(walls.all()[0].believed);
  ASSERT_EQ(walls.all()[0].seen.size(), 2U) << "the door is a gap";
  l.yard.poles = {{{0.5, 0.5}, 0.25}};  // somebody stands before it
  for (int i = 0; i < 10; ++i) walls.take(l.scan(), {});
  ASSERT_EQ(walls.all().size(), 1U);
  EXPECT_EQ(walls.all()[0].id, id);
  EXPECT_NEAR(std::abs(walls.all()[0].distance_m({0, 0})), 1.0, 0.01);
}

TEST(MarksWalls, AWallThatIsTakenAwayIsForgottenSoon) {
  Looking l;
  l.yard.slabs = {{{-3.0, 1.0}, {6.0, 1.0}}, {{-6.0, 4.0}, {9.0, 4.0}}};
  Walls walls;
  for (int i = 0; i < 5; ++i) walls.take(l.scan(), {});
  l.yard.slabs.erase(l.yard.slabs.begin());
  for (int i = 0; i < 6; ++i) walls.take(l.scan(), {});
  ASSERT_EQ(walls.all().size(), 1U);
  EXPECT_NEAR(walls.all()[0].distance_m({0, 0}), 4.0, 0.02);
}

//  camera looking 90° to the left, 0.1 m left of the origin: a plane 0.8 m before it
TEST(MarksPlanes, TheLargestUprightPlaneAheadIsTheWall) {
  base::Vision v;
  v.planes = {{{0.8, 0.3, 0.0}, {-1.0, 0.0, 0.0}, 5000.0},
              {{-2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 90000.0},  // negative depth: false
              {{1.5, 0.0, -0.4}, {0.0, 0.0, 1.0}, 80000.0},  // the floor
              {{3.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 3999.0}};   // too small
  const base::Mount mount{0.0, 0.1, 0.5, 0.0, 0.0, base::kPi / 2.0};
  const auto wall = wall_of(v, mount, {});
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->distance_m, 0.9, 1e-9) << "of the body's origin";
  EXPECT_NEAR(wall->normal.y, -1.0, 1e-9) << "towards it";
  EXPECT_NEAR(wall->centre.x, -0.3, 1e-9);
  v.planes.resize(0);
  EXPECT_FALSE(wall_of(v, mount, {}));
}

TEST(MarksPlanes, AWallStandsWhereTheCamerasPlanesSayIt) {
  Walls walls;
  base::Time now{std::chrono::hours(1)};
  for (int i = 0; i < 5; ++i) {
    now += std::chrono::milliseconds(100);
    walls.take(PlaneWall{{1.4, 0.9}, {0.0, -1.0}, 0.9, 5000.0}, {}, now, {});
  }
  const auto all = walls.all();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(all[0].believed);
  EXPECT_NEAR(std::abs(all[0].distance_m({0.0, 0.0})), 0.9, 1e-9);
  EXPECT_NEAR(std::abs(all[0].normal.y), 1.0, 1e-9);
}

}  // namespace
}  // namespace roverd::nav::marks
