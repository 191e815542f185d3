// The rolling grid and the polar picture of it, fed by cast rays.
#include "nav/sense/grid.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "nav/sense/ground.hpp"
#include "nav/sense/polar.hpp"
#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kHull = Footprint::box(1.0, 0.8, 0.5);
const base::Mount kFront{.x_m = 0.45, .z_m = 0.3};

/// A robot with one sensor and a grid. The world's z is the body's.
struct Robot {
  Grid grid;
  Reducer reducer{{}, kHull};
  Reduced seen;
  Sectors sectors;
  Ground ground{{}, 8.0, kHull};
  std::mt19937 random{1};
  base::Mount mount = kFront;
  SightedParams sighted{.planar = true};
  Rays rays = planar();

  explicit Robot(GridParams p = {}) : grid(p) {}

  void scan(const Scene& scene, double t, const Pose2& pose = {}, double range_m = 30.0,
            const Lie3& lie = {}) {
    const auto way = [pose](double) { return pose; };
    const auto body = standing(pose, lie.z_m, -lie.pitch_rad);
    const auto sight = look(scene, rays, mount, t, body, random, range_m);
    const auto history = driven(t + 0.11, way, [lie](double) { return lie; });
    ASSERT_TRUE(reducer.reduce(sight, mount, history, seen).has_value());
    if (!sighted.planar) ground.judge(seen.voxels);
    sight_sectors(seen, sight.half_step_rad, sighted, sectors);
    grid.take(seen, sectors, 7);
  }
  Known at(double x, double y, double t = 1.0) const { return grid.at(x, y, sense::at(t)); }
};

Scene wall() {
  Scene s;
  s.blocks.push_back({3.0, 3.2, -2.0, 2.0, 0.0, 1.0});
  return s;
}

//   ▭──────▌????   free before the wall, occupied at it, unknown behind it and behind the robot
TEST(GridTest, BeforeTheWallIsFreeBehindItIsUnknown) {
  Robot r;
  EXPECT_EQ(r.at(1.0, 0.0), Known::Unknown);
  r.scan(wall(), 1.0);
  EXPECT_EQ(r.at(1.5, 0.0), Known::Free);
  EXPECT_EQ(r.at(2.8, 0.3), Known::Free);
  EXPECT_EQ(r.at(3.02, 0.3), Known::Occupied);
  EXPECT_EQ(r.at(3.3, 0.3), Known::Unknown);
  EXPECT_EQ(r.at(-2.0, 0.0), Known::Unknown) << "no beam goes there";
}

TEST(GridTest, BlindDirectionsStayUnknown) {
  Robot r;
  Scene nothing;
  nothing.ground = [](double, double) { return -90.0; };
  r.scan(nothing, 1.0);  // no echo at all: Echo::Unknown
  EXPECT_EQ(r.at(1.5, 0.0), Known::Unknown);
}

TEST(GridTest, NearerThanTheSensorSeesIsUnknown) {
  Robot r;
  r.sighted.blind_m = 0.5;
  r.scan(wall(), 1.0);
  EXPECT_EQ(r.at(0.80, 0.0), Known::Unknown);
  EXPECT_EQ(r.at(1.15, 0.0), Known::Free);
}

TEST(GridTest, CellsStayInTheirPlaceWhileTheRobotDrivesAndTurns) {
  Robot r;
  // Every 10 cm a scan, forty metres long: the window moves along.
  Scene hall;
  hall.blocks.push_back({-5.0, 60.0, 2.0, 2.2, 0.0, 1.0});
  hall.blocks.push_back({-5.0, 60.0, -2.2, -2.0, 0.0, 1.0});
  double t = 1.0;
  for (double x = 0.0; x < 40.0; x += 0.1, t += 0.05) r.scan(hall, t, {x, 0.0, 0.2 * std::sin(x)});
  EXPECT_EQ(r.at(38.0, 2.02, t), Known::Occupied);
  EXPECT_EQ(r.at(38.0, 1.5, t), Known::Free);
  EXPECT_EQ(r.at(38.0, 2.5, t), Known::Unknown);
  EXPECT_EQ(r.at(5.0, 0.0, t), Known::Unknown) << "out of the window";
}

TEST(GridTest, ANearbyBoxIsRememberedBesideTheRobotWhereNoBeamSeesItAndFadesInTime) {
  GridParams p;
  p.keep_hit_s = 5.0;
  p.keep_free_s = 2.0;
  Robot r(p);
  r.scan(wall(), 1.0);
  EXPECT_EQ(r.at(3.02, 0.3, 5.9), Known::Occupied);
  EXPECT_EQ(r.at(1.5, 0.0, 3.2), Known::Unknown) << "what was free fades sooner";
  EXPECT_EQ(r.at(3.02, 0.3, 6.2), Known::Unknown) << "and never to free";
}

TEST(GridTest, WhatStoodThereStaysUntilItWasSeenThroughHoweverLongAgoThatWas) {
  Robot r;
  r.scan(wall(), 1.0);
  EXPECT_EQ(r.at(3.02, 0.3, 1.0 + 3600.0), Known::Occupied);
}

//   A person walks across before a wall: two scans later where they were is free.
TEST(GridTest, AWalkingPersonLeavesNoTrail) {
  Robot r;
  double t = 1.0;
  for (double y = -1.5; y < 1.5; y += 0.05, t += 0.05) {
    Scene s;
    s.blocks.push_back({3.0, 3.2, -6.0, 6.0, 0.0, 1.0});
    s.blocks.push_back({1.82, 2.1, y, y + 0.4, 0.0, 1.8});
    r.scan(s, t);
  }
  // The last stood at y 1.45 to 1.85. Three steps (15 cm) back nothing may be left.
  for (double y = -1.4; y < 1.25; y += 0.05) {
    EXPECT_NE(r.at(1.83, y, t), Known::Occupied) << y;
  }
  EXPECT_EQ(r.at(1.83, 1.6, t), Known::Occupied);
  EXPECT_EQ(r.at(1.5, 0.0, t), Known::Free);
}

//   A low box is seen from afar by rays that go down to it; near, the rays pass above it. It stays.
TEST(GridTest, ALowBoxIsNotClearedByRaysThatPassAboveIt) {
  Robot r;
  r.mount = {.x_m = 0.0, .z_m = 0.7};
  r.rays = sixteen_rings();
  r.sighted = {};
  Scene s;
  s.blocks.push_back({4.0, 4.3, -0.3, 0.3, 0.0, 0.15});
  double t = 1.0;
  for (double x = 0.0; x < 3.2; x += 0.1, t += 0.1) r.scan(s, t, {x, 0.0, 0.0});
  int left = 0;
  for (double y = -0.28; y < 0.3; y += 0.05) {
    for (double x = 3.97; x < 4.2; x += 0.05) left += r.at(x, y, t) == Known::Occupied;
  }
  EXPECT_GE(left, 8);
  EXPECT_EQ(r.at(4.15, 1.0, t), Known::Free) << "beside it the ground was seen";
}

/// Columns of 5 cm between two x and y of ± half_m that have something.
int columns_of(const Robot& r, double t, double x0, double x1, double half_m) {
  int out = 0;
  for (double y = 0.025 - half_m; y < half_m; y += 0.05) {
    bool there = false;
    for (double x = x0; x < x1; x += 0.05) there |= r.at(x, y, t) == Known::Occupied;
    out += there ? 1 : 0;
  }
  return out;
}
/// Of a bar at x 5.00 to 5.10.
int columns_of_bar(const Robot& r, double t) {
  return columns_of(r, t, 4.975, 5.15, 1.0);
}
/// Of what stands at x 2.0 to 2.3.
int columns_of_box(const Robot& r, double t) {
  return columns_of(r, t, 1.975, 2.35, 0.5);
}

Scene bar(double bottom_m, double top_m) {
  Scene s;
  s.blocks.push_back({5.0, 5.1, -1.0, 1.0, bottom_m, top_m});
  return s;
}

//   ●──___         A bar in the air. Rays pass below it to the ground behind, and when the robot
//       ══ ‾‾──__  is near all of them pass above it: it stays from 3.5 m on.
TEST(GridTest, ABarInTheAirIsNotClearedByRaysThatPassBelowOrAboveIt) {
  for (const double speed_mps : {0.4, 1.3}) {
    for (const double bottom_m : {0.20, 0.50}) {
      Robot r;
      r.mount = {.x_m = 0.0, .z_m = 0.8};
      r.rays = sixteen_rings(240);
      r.sighted = {};
      const Scene s = bar(bottom_m, bottom_m + 0.1);
      double t = 1.0;
      double x = speed_mps < 1.0 ? 1.5 : 0.0;
      int most = 0;
      for (; x < 4.4; x += 0.1 * speed_mps, t += 0.1) {
        r.scan(s, t, {x, 0.0, 0.0});
        if (5.0 - x > 3.5) continue;  // met by few rays yet, it may be rain
        const int now = columns_of_bar(r, t);
        EXPECT_GE(now, most - 2) << bottom_m << " m high, " << 5.0 - x << " m away";
        most = std::max(most, now);
      }
      EXPECT_GE(most, 36) << bottom_m;
    }
  }
}

//   The same robot, standing: the bar is taken away, and so are its cells.
TEST(GridTest, ABarThatIsTakenAwayIsSeenThrough) {
  Robot r;
  r.mount = {.x_m = 0.0, .z_m = 0.8};
  r.rays = sixteen_rings(900);
  r.sighted = {};
  double t = 1.0;
  for (; t < 1.5; t += 0.1) r.scan(bar(0.5, 0.6), t, {2.5, 0.0, 0.0});
  EXPECT_GE(columns_of_bar(r, t), 36);
  for (; t < 2.0; t += 0.1) r.scan({}, t, {2.5, 0.0, 0.0});
  EXPECT_EQ(columns_of_bar(r, t), 0);
}

//   A scanner of one plane meets a low wall; then the nose comes up by 4 degrees, and it looks
//   over it. The body's lean is told: the wall stays. A beam in its height would take it away.
TEST(GridTest, WhatALeaningBodyLooksOverStays) {
  Scene low;
  low.blocks.push_back({3.0, 3.2, -2.0, 2.0, 0.0, 0.35});
  Robot r;
  r.scan(low, 1.0);
  ASSERT_EQ(r.at(3.02, 0.3), Known::Occupied);
  const Lie3 nose_up{0.0, 0.0, base::rad_from_deg(4.0)};
  for (double t = 1.1; t < 3.0; t += 0.1) r.scan(low, t, {}, 30.0, nose_up);
  EXPECT_EQ(r.at(3.02, 0.3, 3.0), Known::Occupied);
  Scene behind;
  behind.blocks.push_back({6.0, 6.2, -4.0, 4.0, 0.0, 2.0});
  for (double t = 3.0; t < 3.3; t += 0.1) r.scan(behind, t);
  EXPECT_NE(r.at(3.02, 0.3, 3.3), Known::Occupied) << "it is gone, and the body level again";
}

Scene box(double top_m) {
  Scene s;
  s.blocks.push_back({6.0, 6.2, -4.0, 4.0, 0.0, 2.0});
  s.blocks.push_back({2.0, 2.3, -0.5, 0.5, 0.0, top_m});
  return s;
}

//   ●────  ▭   The plane rises slowly over a box that is a little lower than it: for a moment it
//       ‾‾‾‾   passes just above, in heights that are all but those of the box. It stays.
TEST(GridTest, APlaneThatRisesOverABoxDoesNotTakeItAway) {
  for (const double deg_per_s : {0.3, 0.7, 3.0}) {
    Robot r;
    const Scene s = box(0.29);
    double t = 1.0;
    for (double deg = -0.6; deg < 1.0; deg += 0.02 * deg_per_s, t += 0.02) {
      r.scan(s, t, {}, 30.0, {0.0, 0.0, base::rad_from_deg(deg)});
    }
    EXPECT_GE(columns_of_box(r, t), 17) << deg_per_s << " deg/s";
  }
}

//   Nobody looked while it was taken away. Its heights are remembered by an odometry that drifts:
//   that it left is believed after half a second, not at once, and then it is.
TEST(GridTest, WhatLeftUnseenIsSeenThroughForHalfASecond) {
  Robot r;
  double t = 1.0;
  for (; t < 1.5; t += 0.02) r.scan(box(0.39), t);
  ASSERT_GE(columns_of_box(r, t), 19);
  Scene behind;
  behind.blocks.push_back({6.0, 6.2, -4.0, 4.0, 0.0, 2.0});
  for (t = 10.0; t < 10.4; t += 0.02) r.scan(behind, t);
  EXPECT_GE(columns_of_box(r, t), 19);
  for (; t < 10.6; t += 0.02) r.scan(behind, t);
  EXPECT_EQ(columns_of_box(r, t), 0);
}

//   Up a slope: what was met from below is no longer in the plane's height above. It stays.
TEST(GridTest, HeightsAreThoseOfTheGroundThatWasDrivenNotOfTheBody) {
  Scene low;
  low.blocks.push_back({4.0, 4.2, -2.0, 2.0, 0.0, 0.35});
  Robot r;
  r.scan(low, 1.0);
  ASSERT_EQ(r.at(4.02, 0.3), Known::Occupied);
  for (double t = 1.1; t < 2.0; t += 0.1) {
    const double x = 2.0 * (t - 1.0);
    r.scan(low, t, {x, 0.0, 0.0}, 30.0, {0.1 * x, 0.0, 0.0});  // it climbs, and is level there
  }
  EXPECT_EQ(r.at(4.02, 0.3, 2.0), Known::Occupied);
}

TEST(GridTest, RunLengthsGiveThePatchBack) {
  Robot r;
  r.scan(wall(), 1.0);
  Patch patch;
  r.grid.patch({}, 5.0, at(1.0), patch);
  ASSERT_EQ(patch.side, 200);
  const auto runs = run_lengths(patch);
  std::size_t i = 0;
  for (const std::uint8_t byte : runs) {
    for (unsigned n = 0; n < (byte & 63U) + 1U; ++n) {
      ASSERT_LT(i, patch.cells.size());
      ASSERT_EQ(static_cast<unsigned>(patch.cells[i++].known), byte >> 6U);
    }
  }
  EXPECT_EQ(i, patch.cells.size());
  EXPECT_LT(runs.size(), 6000U) << "of 40,000 cells";
}

/// By trying all cells.
double clearance_at(const Patch& patch, int x, int y, bool unknown_too, double max_m) {
  double best_m = max_m;
  for (int v = 0; v < patch.side; ++v) {
    for (int u = 0; u < patch.side; ++u) {
      const Known k = patch.at(u, v).known;
      if (k == Known::Free || (k == Known::Unknown && !unknown_too)) continue;
      best_m = std::min(best_m, patch.cell_m * std::hypot(u - x, v - y));
    }
  }
  return best_m;
}

TEST(GridTest, ClearanceIsTheDistanceThatTryingAllCellsGives) {
  // Given nothing at all, few things, many things and everything taken,
  for (const int things : {0, 1, 12, 300, 1600}) {
    Patch patch;
    patch.cell_m = 0.1;
    patch.side = 40;
    patch.cells.resize(1600);
    std::mt19937 random(5);
    for (auto& c : patch.cells) c.known = things == 1600 ? Known::Occupied : Known::Free;
    for (int i = 0; i < things % 1600; ++i) {
      constexpr std::array<Known, 3> kKinds{Known::Occupied, Known::Drop, Known::Unknown};
      patch.cells[random() % 1600].known = kKinds[static_cast<std::size_t>(i) % 3];
    }
    // when it is asked for near and far, then each cell has its own.
    std::vector<float> far;
    for (const double max_m : {0.25, 1.0, 100.0}) {
      for (const bool unknown_too : {false, true}) {
        clearance(patch, unknown_too, static_cast<float>(max_m), far);
        for (int i = 0; i < 1600; ++i) {
          ASSERT_NEAR(static_cast<double>(far[static_cast<std::size_t>(i)]),
                      clearance_at(patch, i % 40, i / 40, unknown_too, max_m), 1e-5)
              << things << " things, cell " << i << ", " << max_m << " m";
        }
      }
    }
  }
}

TEST(PolarTest, TheWallIsAtItsDistanceInEveryDirectionThatMeetsIt) {
  Robot r;
  const Pose2 pose{10.0, 20.0, 1.0};
  Scene s;  // the same wall, as the body sees it, needs turned blocks: a ring of posts in a room
  for (int i = 0; i < 12; ++i) {
    const double a = i * base::kPi / 6.0;
    const double x = 10.0 + 4.0 * std::cos(a);
    const double y = 20.0 + 4.0 * std::sin(a);
    s.blocks.push_back({x - 0.1, x + 0.1, y - 0.1, y + 0.1, 0.0, 1.0});
  }
  s.blocks.push_back({2.0, 18.0, 26.0, 26.2, 0.0, 1.0});
  s.blocks.push_back({2.0, 18.0, 13.8, 14.0, 0.0, 1.0});
  s.blocks.push_back({16.0, 16.2, 12.0, 28.0, 0.0, 1.0});
  s.blocks.push_back({3.8, 4.0, 12.0, 28.0, 0.0, 1.0});
  r.scan(s, 1.0, pose);
  Patch patch;
  r.grid.patch(pose, 8.0, at(1.2), patch);
  Polar polar;
  polar_of(patch, pose, kHull, 8.0, polar);
  for (int i = 0; i < 12; ++i) {
    const double bearing = base::wrap_rad(i * base::kPi / 6.0 - 1.0);
    if (std::abs(bearing) > 2.0) continue;
    const auto bin = static_cast<std::size_t>((bearing + base::kPi) * 360.0 / base::kPi);
    const Bearing& b = polar.of[bin % 720];
    EXPECT_NEAR(static_cast<double>(b.hit_m), 3.9, 0.12) << bearing;
    EXPECT_GT(b.free_m, 3.5F);
    EXPECT_EQ(b.sensor, 7);
    EXPECT_EQ(b.age_ds, 1);
  }
  const Bearing& behind = polar.of[0];
  EXPECT_EQ(behind.hit_m, 0.0F);
  EXPECT_EQ(behind.free_m, 0.0F) << "blind is not free";
}

}  // namespace
}  // namespace roverd::nav::sense
