// From lane to lane by the shipped vehicles: where the true body points into the next one.

#include "mission/rows/headland.hpp"
#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

using mission::LaneChange;
using mission::RowTurn;

/// North along a lane of 10 m, and into the one to the right.
template <class AnyRig>
mission::Plan into_the_next_lane(const AnyRig& rig, const LaneChange& change,
                                 const mission::TurningVehicle& vehicle) {
  mission::Plan plan = rig.plan_of({{4, 0}, {10, 0}}, 0.6);
  mission::change_lane(change, mission::kind_of(change, vehicle), plan.items);
  return plan;
}

/// The lane's own metres: along it, and to its right. Rigs begin looking along x.
void expect_in_lane(RigBase& rig, double aside_m, double along_m, double off_m, double askew_deg) {
  const auto truth = rig.truth();
  EXPECT_LT(rig.distance_to_m({along_m, -aside_m}), off_m);
  const double back_rad = std::abs(base::angle_diff_rad(truth.yaw_rad, base::kPi));
  EXPECT_LT(base::deg_from_rad(back_rad), askew_deg);
}

TEST(LaneChange, ACarShuntsAndSwingsIntoALaneThatIsTooNear) {
  for (const char* vehicle : {"uku", "imiev"}) {
    const double narrowest_m = settings_of(vehicle).robot.narrowest_turn_m();
    for (const RowTurn kind : {RowTurn::Auto, RowTurn::Omega}) {
      SCOPED_TRACE(std::string(vehicle) + ' ' + std::string(to_string(kind)));
      CartRig rig({.vehicle = vehicle, .heading_deg = 90.0});
      const LaneChange change{
          .aside_m = 2.5, .out_m = 1.5, .kind = kind, .radius_m = 1.1 * narrowest_m};
      rig.arm_and_start(into_the_next_lane(rig, change, {narrowest_m, false}));
      ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
      expect_in_lane(rig, 2.5, 11.5, 0.4, 5.0);
    }
  }
}

// Lanes about two radii apart: the way between the arcs, back or forth, is shorter than a car is
// sent round for a place.
TEST(LaneChange, ACarDrivesAlsoTheLittleWayBetweenTwoArcs) {
  for (const double aside_m : {3.5, 4.0, 4.2}) {
    SCOPED_TRACE(aside_m);
    const double narrowest_m = settings_of("uku").robot.narrowest_turn_m();
    CartRig rig({.vehicle = "uku", .heading_deg = 90.0});
    const LaneChange change{
        .aside_m = aside_m, .out_m = 1.5, .kind = RowTurn::Auto, .radius_m = 1.9};
    rig.arm_and_start(into_the_next_lane(rig, change, {narrowest_m, false}));
    ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
    expect_in_lane(rig, aside_m, 11.5, 0.15, 3.0);
  }
}

TEST(LaneChange, ATrackedVehicleDrivesTheArcsThatItIsAskedFor) {
  for (const RowTurn kind : {RowTurn::Auto, RowTurn::Arc, RowTurn::Omega, RowTurn::Shunt}) {
    SCOPED_TRACE(to_string(kind));
    Rig rig(
        {.heading_deg = 90.0, .plant = plant_of("bunker"), .robot = settings_of("bunker").robot});
    const double radius_m = kind == RowTurn::Arc ? 1.25 : 1.8;
    const LaneChange change{.aside_m = 2.5, .out_m = 1.5, .kind = kind, .radius_m = radius_m};
    rig.arm_and_start(into_the_next_lane(rig, change, {}));
    ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
    expect_in_lane(rig, 2.5, 11.5, 0.15, 3.0);
  }
}

}  // namespace
}  // namespace roverd::loop
