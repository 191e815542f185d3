// The whole robot along walls: its mission's items, its sense thread's work, its guard.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "source_folder.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

constexpr double kThick_m = 0.2;
constexpr double kBeside_m = 0.9;

struct WallPiece {
  base::EnuPoint a;
  base::EnuPoint b;
};

double to_piece_m(const WallPiece& w, base::EnuPoint p) {
  const base::EnuPoint along = w.b - w.a;
  const double square = along.east_m * along.east_m + along.north_m * along.north_m;
  const base::EnuPoint off = p - w.a;
  const double part =
      std::clamp((off.east_m * along.east_m + off.north_m * along.north_m) / square, 0.0, 1.0);
  return base::distance_m(p,
                          {w.a.east_m + part * along.east_m, w.a.north_m + part * along.north_m});
}

//   ════════╡  ╞══════╗        a door of 1.2 m, an inner corner, an outer one
//  ▭─▶                ║
//                     ╚═══════
struct Hall {
  std::vector<WallPiece> pieces{{{-4.0, 1.0}, {4.0, 1.0}},
                                {{5.2, 1.0}, {10.0, 1.0}},
                                {{10.0, 1.0}, {10.0, -6.0}},
                                {{10.0, -6.0}, {20.0, -6.0}}};
  /// To the face of the nearest wall; doors count as wall.
  double wall_m(base::EnuPoint p) const {
    double least_m = to_piece_m({{4.0, 1.0}, {5.2, 1.0}}, p);
    for (const WallPiece& w : pieces) least_m = std::min(least_m, to_piece_m(w, p));
    return least_m - 0.5 * kThick_m;
  }
  Scenario scenario(const mission::Wall& wall) const {
    Scenario s;
    s.kind = "walls";
    s.world.name = "walls";
    for (const WallPiece& w : pieces) {
      sim::world::Thing thing;
      thing.kind = sim::world::Kind::Wall;
      thing.points = {{w.a.east_m, w.a.north_m}, {w.b.east_m, w.b.north_m}};
      thing.thickness_m = kThick_m;
      thing.height_m = 2.0;
      s.world.things.push_back(thing);
    }
    s.course.name = "walls";
    s.course.points = {{0.0, 0.0}, {20.0, 0.0}};
    s.time_s = 150.0;
    s.plan.emplace();
    s.plan->name = "walls";
    s.plan->items = {wall};
    return s;
  }
};

Setup wall_setup() {
  Setup out;
  out.config = tests::in_source("config/robot.toml");
  out.vehicle = "bunker";
  return out;
}

mission::Wall wall_on_the_left(std::optional<double> length_m) {
  mission::Wall wall;
  wall.side = mission::Side::Left;
  wall.distance_m = kBeside_m;
  wall.speed_mps = 0.6;
  wall.length_m = length_m;
  return wall;
}

TEST(WallMission, DrivesPastADoorAndAroundCornersAtItsDistance) {
  const Hall hall;
  const auto run = run_world(wall_setup(), hall.scenario(wall_on_the_left(21.0)));
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_EQ(run->problem, "");
  EXPECT_TRUE(run->finished);
  EXPECT_TRUE(run->touches.empty());
  EXPECT_NEAR(run->driven_m, 21.0, 0.5);
  double sum = 0.0;
  int n = 0;
  for (const base::EnuPoint& at : run->track) {
    const double off_m = hall.wall_m(at) - kBeside_m;
    EXPECT_GT(off_m, -0.12) << at.east_m << " " << at.north_m;
    const bool corner = std::hypot(at.east_m - 9.0, at.north_m) < 1.2 ||
                        std::hypot(at.east_m - 10.0, at.north_m + 6.0) < 1.4;
    if (at.east_m < 1.0 || corner) continue;
    sum += off_m * off_m;
    ++n;
  }
  ASSERT_GT(n, 100);
  EXPECT_LT(std::sqrt(sum / n), 0.03);
  EXPECT_GT(run->track.back().east_m, 12.0) << "around both corners";
}

TEST(WallMission, IsBlockedWhereThereIsNoWall) {
  Hall hall;
  hall.pieces.clear();
  const auto run = run_world(wall_setup(), hall.scenario(wall_on_the_left({})));
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_FALSE(run->finished);
  EXPECT_NEAR(run->driven_m, 2.0, 0.4);
}

TEST(WallMission, AWallOfTheOtherSideIsNone) {
  Hall hall;
  hall.pieces = {{{-4.0, -1.0}, {20.0, -1.0}}};
  const auto run = run_world(wall_setup(), hall.scenario(wall_on_the_left({})));
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_FALSE(run->finished);
  EXPECT_LT(run->driven_m, 2.5);
}

}  // namespace
}  // namespace roverd::study
