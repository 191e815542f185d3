// Honest sensors are never accused, however the ground, the drive and the receiver are: slip that
// comes and goes, tracks that slip unlike each other, a base that obeys late, receivers for
// everybody that wander, outages.

#include "rig.hpp"

namespace roverd::loop {
namespace {

struct Plant {
  const char* name;
  void (*make)(RigOptions&);
  void (*trouble)(sim::Faults&) = nullptr;  ///< for five seconds out of fifteen
};

void PrintTo(const Plant& plant, std::ostream* out) {
  *out << plant.name;
}

void ruts(RigOptions& o) {
  o.plant.drive.slip_wander = 0.05;
  o.plant.drive.side_difference = 0.05;
}

void consumer(RigOptions& o) {
  o.plant.gnss.profile = "consumer";
}

const Plant kPlants[] = {
    {"no_slip", [](RigOptions& o) { o.plant.drive.slip = 0.0; }},
    {"mud", [](RigOptions& o) { o.plant.drive.slip = 0.4; }},
    {"ruts", ruts},
    {"one_side_slips", [](RigOptions& o) { o.plant.drive.side_difference = -0.1; }},
    {"crabs", [](RigOptions& o) { o.plant.drive.crab = 0.10; }},
    {"slope_of_10_deg",
     [](RigOptions& o) {
       o.plant.ground.slope_deg = 10.0;
       o.plant.ground.uphill_deg = 80.0;
     }},
    {"holds_unlike_everywhere", [](RigOptions& o) { o.plant.ground.slip_patches = 0.4; }},
    {"slides_unlike_everywhere", [](RigOptions& o) { o.plant.ground.crab_patches = 0.1; }},
    {"turns_about_its_front", [](RigOptions& o) { o.plant.drive.pivot_centre_m = 0.15; }},
    {"turns_about_its_back", [](RigOptions& o) { o.plant.drive.pivot_centre_m = -0.15; }},
    {"obeys_late", [](RigOptions& o) { o.plant.drive.delay_s = 0.4; }},
    {"sluggish", [](RigOptions& o) { o.plant.drive.lag_s = 0.5; }},
    {"antenna_ahead",
     [](RigOptions& o) {
       o.plant.gnss.antenna_forward_m = o.robot.estimate.antenna_forward_m = 0.6;
     }},
    {"late_receiver", [](RigOptions& o) { o.plant.gnss.latency_s = 0.3; }},
    {"velocity_lags", [](RigOptions& o) { o.plant.gnss.velocity_lag_s = 0.15; }},
    {"velocity_lags_more", [](RigOptions& o) { o.plant.gnss.velocity_lag_s = 0.2; }},
    {"slow_receiver", [](RigOptions& o) { o.plant.gnss.rate_hz = 1; }},
    {"float", [](RigOptions& o) { o.plant.gnss.profile = "float"; }},
    {"consumer", consumer},
    {"noisy_consumer",
     [](RigOptions& o) {
       consumer(o);
       o.plant.gnss.noise_scale = 2.0;
     }},
    {"consumer_in_ruts",
     [](RigOptions& o) {
       consumer(o);
       ruts(o);
     }},
    {"consumer_under_trees", consumer,
     [](sim::Faults& f) {
       f.gnss_drift_east_mps = 0.03;
       f.gnss_drift_north_mps = -0.02;
     }},
    {"outages", [](RigOptions&) {}, [](sim::Faults& f) { f.gnss_outage = true; }},
    {"biased_gyro", [](RigOptions& o) { o.plant.imu.gyro_bias_dps = 2.0; }},
    {"no_gyro",
     [](RigOptions& o) {
       o.plant.imu.fitted = false;
       ruts(o);
     }},
    {"compass_askew", [](RigOptions& o) { o.plant.compass.bias_deg = 60.0; }},
    {"two_antennas",
     [](RigOptions& o) {
       o.plant.gnss.antennas = true;
       o.plant.gnss.antennas_noise_deg = 1.5;
       o.gnss.heading_source = "dual_antenna";
     }},
};

class Honest : public testing::TestWithParam<Plant> {};
INSTANTIATE_TEST_SUITE_P(Loop, Honest, testing::ValuesIn(kPlants),
                         [](const auto& plant) { return std::string(plant.param.name); });

//   3 ◀── 2      pivots at the corners; the last leg is driven backwards
//   │     ▲
//   4 ──▶ 1
TEST_P(Honest, SensorsAreNeverAccused) {
  for (const std::uint64_t seed : {1ULL, 2ULL, 3ULL}) {
    RigOptions o;
    o.seed = seed;
    GetParam().make(o);
    Rig rig(o);
    auto plan = rig.plan_of({{8, 0}, {8, 8}, {0, 8}, {0, 1}, {4, 1}}, seed == 3 ? 1.0 : 0.6);
    std::get<mission::Waypoint>(plan.items[4]).reverse = true;
    rig.arm_and_start(plan);
    for (int s = 0; s < 75 && rig.execution() == ExecutionState::Running; ++s) {
      const bool now = GetParam().trouble != nullptr && s % 15 >= 10;
      rig.fault(now ? GetParam().trouble : [](sim::Faults&) {});
      rig.run(1.0);
    }
    EXPECT_EQ(rig.state()->estimator.votes.accusations, 0u) << seed;
    for (const auto& e : rig.events) {
      EXPECT_NE(e.kind, "sensor_left_out") << e.detail;
      EXPECT_NE(e.kind, "sensors_contradict") << e.detail;
    }
    EXPECT_GT(rig.truth().driven_m, 20.0) << rig.state()->mission.reason;
  }
}

}  // namespace
}  // namespace roverd::loop
