// What is driven by sight ends beside a place, where the position is known well enough to say so.

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

//   map: the row leads east, a place 4 m ahead and 1 m aside; O lies turned by a quarter
TEST(Executor, ARowEndsBesideAPlaceWhereThePositionIsKnown) {
  for (const double sigma_m : {0.05, 3.0}) {
    Ride r;
    mission::Row row;
    const base::LatLon until = kFrame.to_global({4.0, -1.0});
    row.until = {until.lat, until.lon, std::nullopt};
    row.distance_m = 7.0;
    r.load(plan({row}));
    r.start();
    r.vehicle.sigma_m = sigma_m;
    rows::RowView view;
    view.line = {5.0, 5.0, base::kPi / 2.0};
    view.covariance[0] = 1e-4;
    view.width_m = 2.5;
    rows::Pose2 body = view.line;
    for (int i = 0; i < 3000 && r.executor.running(); ++i) {
      view.stamp = base::Time(std::chrono::milliseconds(20 * i));
      RowSight sight;
      sight.view = &view;
      sight.body = body;
      r.executor.see_row(sight);
      r.tick();
      body = body * sense::along(r.vehicle.speed_mps, r.vehicle.yaw_rate_radps, 0.02);
    }
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
    // Too vague, it ends nothing: the row's own distance does.
    EXPECT_NEAR(body.y_m - 5.0, sigma_m < 1.0 ? 4.0 : 7.0, 0.15);
  }
}

}  // namespace
}  // namespace roverd::nav
