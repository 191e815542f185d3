// A mission's wall by a camera's planes alone, in a closed loop: a camera that looks ahead sees the
// wall from some metres on, never beside the robot.

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "nav/behave/wall_drive.hpp"
#include "yard.hpp"

namespace roverd::nav {
namespace {

using namespace std::chrono_literals;
using marks::Pose2;
using marks::Rover;
using marks::Side;
using marks::Vec2;
using marks::Yard;

constexpr base::Mount kCamera{0.4, 0.0, 0.4, 0.0, 0.0, 0.0};
constexpr double kHalfView_rad = 0.5;

/// The plane of all that the camera meets within its reach, as a program tells it: the middle of
/// its points, and what is square to them.
base::Vision image(const Yard& yard, const Pose2& truth, base::Time stamp) {
  base::Vision out;
  out.stamp = stamp;
  const Vec2 eye = marks::placed(truth, {kCamera.x_m, kCamera.y_m});
  marks::Moments m;
  for (double bearing_rad = -kHalfView_rad; bearing_rad <= kHalfView_rad; bearing_rad += 0.01) {
    const double far_m = yard.cast(eye, truth.yaw_rad + bearing_rad);
    if (far_m > 8.0) continue;
    m.add(Vec2{far_m * std::cos(bearing_rad), far_m * std::sin(bearing_rad)});
  }
  if (m.n < 3.0) return out;
  const marks::Fit fit = marks::fit_of(m);
  const base::VisionPoint centre{fit.centre.x, fit.centre.y, 0.0};
  out.planes = {{centre, {-fit.along.y, fit.along.x, 0.0}, 1000.0 * m.n}};
  return out;
}

struct PlanesItem {
  Yard yard;
  Rover rover;
  PathParams path;
  marks::WallParams params;
  marks::Walls walls;
  marks::View view;
  WallDrive drive{base::Setting<PathParams>(path), {}};
  double sum = 0.0;  ///< of the squares of the true way off, wherever it drives
  int judged = 0;
  double worst_m = 0.0;
  double told_m = 0.0;  ///< the largest cross-track error that it told

  void run(double seconds, double wanted_m) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (i % 5 == 0) look();
      const MarkSight seen{&view, rover.now, rover.odometry};
      rover.step(drive.step(seen, rover.vehicle(), 10.0, 0.02).command);
      if (drive.state() != WallDrive::State::Driving) continue;
      const double off_m = yard.wall_m({rover.truth.x_m, rover.truth.y_m}) - wanted_m;
      sum += off_m * off_m;
      ++judged;
      worst_m = std::max(worst_m, std::abs(off_m));
      told_m = std::max(told_m, std::abs(drive.cross_track_m()));
    }
  }
  void look() {
    const auto pose = rover.history.at(rover.now);
    if (!pose) return;
    const auto wall = wall_of(image(yard, rover.truth, rover.now), kCamera, params);
    if (wall) walls.take(*wall, *pose, rover.now, params);
    view = {.stamp = rover.now, .walls = walls.all()};
  }
  double rms_m() const { return std::sqrt(sum / std::max(1, judged)); }
};

//       camera's view ╱
//   ─▶──────────────╱───
//   ════════════════════════════   beside the robot, too
TEST(WallByPlanes, AWallThatIsSeenAheadOnlyIsTheWallBesideTheRobot) {
  for (const Side side : {Side::Left, Side::Right}) {
    PlanesItem w;
    const double y_m = side == Side::Left ? 0.95 : -0.95;
    w.yard.slabs = {{{-5.0, y_m}, {30.0, y_m}}};
    w.drive.begin({.side = side, .distance_m = 0.9, .length_m = 8.0});
    w.run(25.0, 0.9);
    EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
    EXPECT_LT(w.rms_m(), 0.03);
    EXPECT_LT(w.worst_m, 0.08);
    EXPECT_LT(w.told_m, 0.08) << "it began 5 cm off";
    EXPECT_NEAR(w.rover.odometry.x_m, 8.0, 0.2);
  }
}

//  ╲ ─▶      it stands farther off, and askew
TEST(WallByPlanes, ItComesToTheWallFromAsideWithoutGoingAroundAnything) {
  for (const double yaw_rad : {-0.2, 0.0, 0.2}) {
    PlanesItem w;
    w.yard.slabs = {{{-5.0, 1.4}, {30.0, 1.4}}};
    w.rover.truth.yaw_rad = yaw_rad;
    w.drive.begin({.side = Side::Left, .distance_m = 0.9, .length_m = 12.0});
    w.run(35.0, 0.9);
    EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
    EXPECT_LT(w.worst_m, 0.65) << yaw_rad;
    EXPECT_NEAR(w.yard.wall_m({w.rover.truth.x_m, w.rover.truth.y_m}), 0.9, 0.03);
  }
}

}  // namespace
}  // namespace roverd::nav
