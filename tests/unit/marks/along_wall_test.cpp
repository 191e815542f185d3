// A mission's wall where more than one thing tells it, or something else leads for a while: by
// whose word it is driven along, and how landmarks that stand along it are passed first.

#include "nav/behave/along_wall.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "nav/marks/by_source.hpp"
#include "yard.hpp"

namespace roverd::nav {
namespace {

using marks::By;
using marks::Marks;
using marks::Rover;
using marks::Scanner;
using marks::Side;
using marks::Source;
using marks::Vec2;
using marks::Yard;

constexpr double kWall_m = 0.9;  ///< beside where it begins, and from where it is to drive

/// A wall on the left, along x, as the scanner sees it; and a vision program that may see it
/// elsewhere.
struct Aisle {
  Yard yard{{{{-5.0, kWall_m}, {40.0, kWall_m}}}, {}};
  Rover rover;
  Scanner scanner;
  bool scans = true;
  std::optional<double> plane_y_m;  ///< where the vision program says that the wall is
  base::Setting<PathParams> path{PathParams{}};
  MarkSettings settings{};
  marks::BySource marks;
  marks::View view;
  AlongWall item{path, path, settings};
  std::string led;          ///< who led, each change: w wall, l landmarks
  double nearest_m = 1e9;   ///< to the poles' middles
  double farthest_y_m = 0;  ///< of the robot, from where it began

  void begin(const AlongWall::Order& order) {
    item = AlongWall(path, path, settings);
    item.begin(order);
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (i % 5 == 0) look();
      const MarkSight seen{&view, rover.now, rover.odometry};
      rover.step(item.step(seen, rover.vehicle(), 10.0, 0.02).command);
      const char leads = item.passes() ? 'l' : 'w';
      if (led.empty() || led.back() != leads) led += leads;
      farthest_y_m = std::max(farthest_y_m, std::abs(rover.truth.y_m));
      for (const auto& pole : yard.poles) {
        nearest_m =
            std::min(nearest_m, marks::length(pole.at - Vec2{rover.truth.x_m, rover.truth.y_m}));
      }
    }
  }
  void look() {
    view = {.stamp = view.stamp, .looked_at = view.looked_at};
    view.looked_at.resize(2);
    if (scans) scan();
    if (plane_y_m) image();
    marks.tell(view);
  }
  void scan() {
    const auto scan = scan_of(scanner.look(yard, rover.truth, rover.now), rover);
    if (scan.beams.empty()) return;
    marks.take(Source::Scan, 0, [&](Marks& to) {
      to.walls.take(scan, *settings.walls);
      to.landmarks.take(scan, *settings.landmarks, 0);
    });
    view.stamp = view.looked_at[0] = scan.stamp;
  }
  void image() {
    const auto pose = rover.history.at(rover.now);
    if (!pose) return;
    const auto back = sense::inverse(rover.truth);
    const marks::PlaneWall plane{marks::placed(back, {rover.truth.x_m + 3.0, *plane_y_m}),
                                 {-std::sin(rover.truth.yaw_rad), -std::cos(rover.truth.yaw_rad)},
                                 0.5,
                                 9000.0};
    marks.take(Source::Vision, 1,
               [&](Marks& to) { to.walls.take(plane, *pose, rover.now, *settings.walls); });
    view.stamp = view.looked_at[1] = rover.now;
  }
};

AlongWall::Order along(double length_m) {
  return {{.side = Side::Left, .distance_m = kWall_m, .length_m = length_m}, false};
}

//   ═════════════════════   the scanner's
//   ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─   the camera's: false
TEST(AlongWall, WhoseWordCountsIsSet) {
  const auto driven_at_y_m = [](std::optional<By> by) {
    Aisle a;
    a.plane_y_m = 0.5;
    auto order = along(8.0);
    order.wall.by = by;
    a.begin(order);
    a.run(25.0);
    EXPECT_EQ(a.item.state(), AlongWall::State::Done) << a.item.reason();
    return a.rover.truth.y_m;
  };
  EXPECT_NEAR(driven_at_y_m(By::Scan), 0.0, 0.05);
  EXPECT_NEAR(driven_at_y_m(By::Vision), -0.4, 0.1);
  EXPECT_NEAR(driven_at_y_m({}), -0.4, 0.1) << "by all of them: the nearest";
}

TEST(AlongWall, TheParameterCountsWhereTheItemSaysNothingAndWhileItDrives) {
  Aisle a;
  a.plane_y_m = 0.5;
  marks::WallParams walls;
  walls.source = "scan";
  a.settings.walls = base::Setting<marks::WallParams>(walls);
  a.begin(along(30.0));
  a.run(8.0);
  EXPECT_EQ(a.item.by(), By::Scan);
  EXPECT_NEAR(a.rover.truth.y_m, 0.0, 0.05);
  EXPECT_TRUE(a.item.told_by(a.rover.now).scan);
  EXPECT_FALSE(a.item.told_by(a.rover.now).vision);
}

TEST(AlongWall, BothAreToldWhereBothSeeIt) {
  Aisle a;
  a.plane_y_m = kWall_m;
  a.begin(along(8.0));
  a.run(5.0);
  EXPECT_EQ(a.item.state(), AlongWall::State::Driving);
  EXPECT_TRUE(a.item.told_by(a.rover.now).scan);
  EXPECT_TRUE(a.item.told_by(a.rover.now).vision);
}

// The camera still sees a wall; but its word was not asked for.
TEST(AlongWall, StandsWhereTheOnlyOneWhoseWordCountsIsSilent) {
  Aisle a;
  a.plane_y_m = kWall_m;
  auto order = along(30.0);
  order.wall.by = By::Scan;
  a.begin(order);
  a.run(5.0);
  EXPECT_GT(a.rover.speed_mps, 0.4);
  a.scans = false;
  a.run(3.0);
  EXPECT_EQ(a.rover.speed_mps, 0.0);
  EXPECT_FALSE(a.item.told_by(a.rover.now).scan);
  a.run(SightParams{}.wait_s + 1.0);
  EXPECT_EQ(a.item.state(), AlongWall::State::Failed);
  EXPECT_EQ(a.item.reason(), "the wall on the left is not seen any more");
}

TEST(AlongWall, OneWhoNeverSaidAnythingLeadsNobody) {
  Aisle a;
  auto order = along(8.0);
  order.wall.by = By::Vision;
  a.begin(order);
  a.run(20.0);
  EXPECT_EQ(a.item.state(), AlongWall::State::Failed);
  EXPECT_EQ(a.item.reason(), "no wall is seen on the left within 2.0 m");
}

//   ═══════════════════════════
//   ─────╮   o   ╭─────────────
//        ╰───────╯
TEST(AlongWall, LandmarksThatStandInTheWayLeadFirst) {
  Aisle a;
  a.yard.poles = {{{5.0, 0.2}, 0.08}};
  auto order = along(12.0);
  order.landmarks_first = true;
  a.begin(order);
  a.run(30.0);
  EXPECT_EQ(a.led, "wlw");
  EXPECT_EQ(a.item.state(), AlongWall::State::Done) << a.item.reason();
  EXPECT_NEAR(a.nearest_m, marks::LandmarkParams{}.offset_m, 0.05);
  EXPECT_NEAR(a.rover.truth.y_m, 0.0, 0.05) << "along the wall again";
  EXPECT_NEAR(a.rover.truth.x_m, 12.0, 0.5) << "the way past them counts";
}

TEST(AlongWall, UnlessItIsAskedForLandmarksLeadNothing) {
  Aisle a;
  a.yard.poles = {{{5.0, 0.2}, 0.08}};
  a.begin(along(12.0));
  a.run(30.0);
  EXPECT_EQ(a.led, "w");
  EXPECT_LT(a.nearest_m, 0.3) << "whoever guards it stops it there";
}

// On the far side of the aisle they are another one's.
TEST(AlongWall, LandmarksFarOverOnTheOtherSideLeadNothing) {
  Aisle a;
  a.yard.poles = {{{5.0, -1.5}, 0.08}};
  auto order = along(12.0);
  order.landmarks_first = true;
  a.begin(order);
  a.run(30.0);
  EXPECT_EQ(a.led, "w");
  EXPECT_LT(a.farthest_y_m, 0.1);
}

// Cones in a row, all the way.
TEST(AlongWall, PastLandmarksItEndsAfterItsLengthToo) {
  for (const bool paused : {false, true}) {
    Aisle a;
    for (double x = 4.0; x < 20.0; x += 2.0) a.yard.poles.push_back({{x, 0.2}, 0.08});
    auto order = along(9.0);
    order.landmarks_first = true;
    a.begin(order);
    a.run(9.0);
    ASSERT_TRUE(a.item.passes()) << a.rover.truth.x_m;
    if (paused) a.item.interrupt();
    a.run(30.0);
    EXPECT_EQ(a.item.state(), AlongWall::State::Done) << a.item.reason();
    EXPECT_NEAR(a.rover.truth.x_m, 9.0, 0.5) << paused;
  }
}

TEST(AlongWall, PastLandmarksItEndsBesideItsPlaceToo) {
  Aisle a;
  for (double x = 4.0; x < 20.0; x += 2.0) a.yard.poles.push_back({{x, 0.2}, 0.08});
  auto order = along(30.0);
  order.landmarks_first = true;
  a.begin(order);
  a.item.end_beside({9.0, 2.0});
  a.run(30.0);
  EXPECT_EQ(a.item.state(), AlongWall::State::Done) << a.item.reason();
  EXPECT_NEAR(a.rover.truth.x_m, 9.0, 0.5);
}

TEST(AlongWall, ALandmarkThatOnlyTheOtherKindSeesLeadsNothing) {
  Aisle a;
  a.plane_y_m = kWall_m;
  a.yard.poles = {{{5.0, 0.2}, 0.08}};
  auto order = along(3.0);
  order.wall.by = By::Vision;
  order.landmarks_first = true;
  a.begin(order);
  a.run(10.0);
  EXPECT_EQ(a.led, "w");
}

TEST(AlongWall, InterruptedWhileItPassesOneItGoesOnPastIt) {
  Aisle a;
  a.yard.poles = {{{5.0, 0.2}, 0.08}};
  auto order = along(12.0);
  order.landmarks_first = true;
  a.begin(order);
  a.run(7.0);
  ASSERT_TRUE(a.item.passes()) << a.rover.truth.x_m;
  a.item.interrupt();
  a.run(25.0);
  EXPECT_EQ(a.item.state(), AlongWall::State::Done) << a.item.reason();
  EXPECT_GT(a.nearest_m, marks::LandmarkParams{}.offset_m - 0.1);
  EXPECT_NEAR(a.rover.truth.y_m, 0.0, 0.05);
}

}  // namespace
}  // namespace roverd::nav
