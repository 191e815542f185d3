// Moves: straight on from where the robot stands.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

// Nobody asks where that is.
TEST(Moves, AreDrivenHoweverShortByACarAndWhereThePlaceIsVague) {
  PathParams car;
  car.vehicle.kinematics = "ackermann";
  car.vehicle.wheelbase_m = 1.3;
  for (const bool steered : {true, false}) {
    for (const double by_m : {-0.3, 0.2, 0.4}) {
      SCOPED_TRACE(std::to_string(by_m) + (steered ? " car" : " vague"));
      Ride r;
      if (steered) r.path.adopt(std::make_shared<const PathParams>(car));
      r.vehicle.sigma_m = steered ? 0.02 : 0.6;
      r.load(plan({mission::Move{by_m}}));
      r.start();
      ASSERT_TRUE(r.run(60.0));
      EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
      EXPECT_EQ(r.reached, std::vector<int>{1});
      EXPECT_NEAR(r.vehicle.at.east_m, by_m, 0.05);
    }
  }
}

}  // namespace
}  // namespace roverd::nav
