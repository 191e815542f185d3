// The simulated inertial unit: its bytes through the real driver against the plant's truth.

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "mti/driver.hpp"
#include "plant.hpp"

namespace roverd::sim {
namespace {

Params with_imu() {
  Params p = ideal();
  p.imu.fitted = true;
  p.imu.gyro_bias_dps = p.imu.gyro_wander_dps = p.imu.gyro_noise_dps = 0.0;
  p.imu.accel_bias_mps2 = p.imu.accel_noise_mps2 = 0.0;
  return p;
}

/// The plant, and the driver that listens to its unit.
struct Listening {
  explicit Listening(const Params& p = with_imu(), const mti::Params& how = {})
      : plant(p),
        wire(link::memory_byte_pair()),
        driver(
            "mti", how,
            [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
            [this](const base::Measurement& m) { take(m); }) {
    wire.a->set_immediate([this] { return at; });
    wire.b->set_immediate([this] { return at; });
    wire.b->on_bytes = [this](Bytes b, Time) { plant.bunker.receive_imu(b); };
    EXPECT_TRUE(wire.b->open());
    plant.bunker.on_imu = [this](Bytes b, Time t) {
      at = t;
      wire.b->write(b);
    };
    driver.start(at);
  }

  void take(const base::Measurement& m) {
    if (const auto* inertial = std::get_if<base::Inertial>(&m)) samples.push_back(*inertial);
    if (const auto* heading = std::get_if<base::Heading>(&m)) headings.push_back(*heading);
    if (const auto* lean = std::get_if<base::Attitude>(&m)) attitude = *lean;
  }
  void wait(base::Duration d) {
    for (base::Duration t{}; t < d; t += 20ms) {
      plant.wait(20ms);
      driver.tick(plant.now);
    }
  }
  std::string fact(const std::string& key) const {
    const auto status = driver.status(plant.now);
    const auto found = status.detail->facts.find(key);
    return found == status.detail->facts.end() ? "" : found->second;
  }

  Plant plant;
  Time at{};
  std::vector<base::Inertial> samples;
  std::vector<base::Heading> headings;
  std::optional<base::Attitude> attitude;
  link::MemoryBytePair wire;
  mti::Driver driver;
};

TEST(SimImu, AHundredSamplesASecondThatShowGravity) {
  Listening l;
  l.wait(1s);
  EXPECT_NEAR(static_cast<double>(l.samples.size()), 100.0, 1.0);
  EXPECT_NEAR(l.samples.back().accel_mps2->up, 9.81, 1e-5);
  EXPECT_NEAR(l.samples.back().rate_radps->up, 0.0, 1e-7);
}

//  uphill north; the robot looks east, then turns to the north: roll becomes pitch
TEST(SimImu, ASlopeShowsInAttitudeAndAccelerometers) {
  Params p = with_imu();
  p.ground.slope_deg = 10.0;
  p.ground.uphill_deg = 0.0;
  Listening l(p);
  l.wait(1s);
  EXPECT_NEAR(l.attitude->roll_rad, base::rad_from_deg(10.0), 1e-3);
  EXPECT_NEAR(l.attitude->pitch_rad, 0.0, 1e-3);
  EXPECT_NEAR(l.samples.back().accel_mps2->left, 9.81 * std::sin(base::rad_from_deg(10.0)), 1e-3);
  EXPECT_NEAR(l.samples.back().accel_mps2->up, 9.81 * std::cos(base::rad_from_deg(10.0)), 1e-3);

  l.plant.bunker.place(l.plant.truth().at, 0.0);
  l.wait(1s);
  EXPECT_NEAR(l.attitude->roll_rad, 0.0, 1e-3);
  EXPECT_NEAR(l.attitude->pitch_rad, base::rad_from_deg(10.0), 1e-3);
  EXPECT_NEAR(l.samples.back().accel_mps2->forward, 9.81 * std::sin(base::rad_from_deg(10.0)),
              1e-3);
}

TEST(SimImu, TheTurnsSumIsTheTrueTurn) {
  Listening l;
  l.plant.enter_can();
  l.plant.drive(0.5, 0.4, 3s);
  const double before = l.plant.truth().yaw_rad;
  l.wait(10ms);
  double sum = 0.0;
  for (const auto& m : l.samples) sum += m.rate_radps->up * 0.01;
  EXPECT_NEAR(base::wrap_rad(sum), l.plant.truth().yaw_rad, 0.01);
  EXPECT_GT(std::abs(before), 0.5);
}

TEST(SimImu, SpeedingUpIsFeltForwardAndATurnToTheSide) {
  Listening l;
  l.plant.enter_can();
  l.plant.drive(1.0, 0.0, 600ms);
  double most = 0.0;
  for (const auto& m : l.samples) most = std::max(most, m.accel_mps2->forward);
  EXPECT_NEAR(most, 1.0, 0.15);  // drive.accel_mps2
  l.plant.drive(1.0, 0.4, 3s);
  EXPECT_NEAR(l.samples.back().accel_mps2->left, 0.4, 0.02);  // v · ω
}

TEST(SimImu, BiasOfTheGyroIsSeenAndAFaultAddsToIt) {
  Params p = with_imu();
  p.imu.gyro_bias_dps = 0.3;
  Listening l(p);
  l.wait(100ms);
  EXPECT_NEAR(base::deg_from_rad(l.samples.back().rate_radps->up), 0.3, 1e-5);
  set_fault(l.plant, [](Faults& f) { f.imu_gyro_extra_dps = 2.0; });
  l.wait(100ms);
  EXPECT_NEAR(base::deg_from_rad(l.samples.back().rate_radps->up), 2.3, 1e-5);
}

TEST(SimImu, TheCompassIsInItAndNotBesideTheReceiver) {
  Params p = with_imu();
  p.compass.bias_deg = 20.0;
  p.compass.declination_deg = 10.0;
  Listening l(p, {.declination_deg = 10.0});
  l.wait(2s);
  EXPECT_TRUE(l.plant.lines("HDT").empty());
  ASSERT_GE(l.headings.size(), 19u);
  EXPECT_LE(l.headings.size(), 21u);
  EXPECT_NEAR(base::heading_from_yaw(l.headings.back().yaw_rad), 110.0, 1e-3);  // 90 + 20
}

TEST(SimImu, TheGroundLeansIt) {
  Params p = with_imu();
  p.imu.roll_deg = 5.0;
  p.imu.pitch_deg = -3.0;
  Listening l(p);
  l.wait(500ms);
  ASSERT_TRUE(l.attitude);
  EXPECT_NEAR(base::deg_from_rad(l.attitude->roll_rad), 5.0, 1e-4);
  EXPECT_NEAR(base::deg_from_rad(l.attitude->pitch_rad), -3.0, 1e-4);
  EXPECT_NEAR(base::heading_from_yaw(l.headings.back().yaw_rad), 90.0, 1e-3);
}

TEST(SimImu, SilenceAndARepeatedMessageAreSeenByTheDriver) {
  Listening l;
  l.wait(500ms);
  set_fault(l.plant, [](Faults& f) { f.imu_silent = true; });
  l.wait(1s);
  EXPECT_EQ(l.driver.status(l.plant.now).reason, "no sample: the port is silent");
  set_fault(l.plant, [](Faults& f) { f.imu_silent = false; });
  l.wait(200ms);
  EXPECT_EQ(l.driver.status(l.plant.now).phase, base::DriverPhase::Up);
  set_fault(l.plant, [](Faults& f) { f.imu_freeze = true; });
  l.wait(1s);
  EXPECT_EQ(l.driver.status(l.plant.now).reason,
            "the unit repeats itself: its sample time stands still");
}

TEST(SimImu, ItObeysTheHandshakeAndMeasuresWhatItIsTold) {
  Listening l(with_imu(), {.configure = true, .rate_hz = 50.0});
  l.wait(500ms);
  EXPECT_EQ(l.fact("configuration"), "accepted");
  EXPECT_EQ(l.fact("product"), "MTi-SIM-2A8G4");
  EXPECT_EQ(l.driver.status(l.plant.now).phase, base::DriverPhase::Up);
  Listening gnss(with_imu(), {.configure = true, .position = "filter"});
  gnss.wait(500ms);
  EXPECT_EQ(gnss.fact("configuration"),
            "utc_time not offered, lat_lon not offered, altitude not offered, velocity not "
            "offered, gnss_pvt not offered, gnss_satellites not offered");
}

TEST(SimImu, EqualSeedsRepeatItsBytes) {
  const auto bytes = [](std::uint64_t seed) {
    Params p;
    Plant plant(p, seed);
    std::vector<std::uint8_t> all;
    plant.bunker.on_imu = [&](Bytes b, Time) { all.insert(all.end(), b.begin(), b.end()); };
    plant.wait(1s);
    return all;
  };
  EXPECT_EQ(bytes(3), bytes(3));
  EXPECT_NE(bytes(3), bytes(4));
}

}  // namespace
}  // namespace roverd::sim
