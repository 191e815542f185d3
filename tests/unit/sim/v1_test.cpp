// The simulated base with older firmware, and its answers about its version.

#include "bunker/v1.hpp"

#include <gtest/gtest.h>

#include "plant.hpp"

namespace roverd::sim {
namespace {

namespace v1 = bunker::v1;

Params old_base() {
  Params p = ideal();
  p.base.protocol = "v1";
  return p;
}

CanFrame v1_drive(int linear_pct, int angular_pct) {
  return v1::encode(v1::Command{.mode = v1::RequestedMode::Can,
                                .linear_pct = static_cast<std::int8_t>(linear_pct),
                                .angular_pct = static_cast<std::int8_t>(angular_pct)});
}

void drive_v1(Plant& plant, int linear_pct, int angular_pct, base::Duration d) {
  for (base::Duration t{}; t < d; t += 20ms) {
    plant.bunker.receive(v1_drive(linear_pct, angular_pct));
    plant.wait(20ms);
  }
}

TEST(OldFirmware, TellsOnlyIntactFramesOfV1InTheirPeriods) {
  Plant plant(old_base());
  plant.wait(10s);
  for (const std::uint32_t id : {0x131u, 0x200u, 0x201u}) {
    EXPECT_EQ(plant.of(id).size(), 500u) << std::hex << id;
  }
  EXPECT_EQ(plant.of(0x151).size(), 100u);
  EXPECT_EQ(plant.frames.size(), 1600u) << "and nothing else";
  for (const CanFrame& f : plant.frames) {
    EXPECT_EQ(v1::decode(f).verdict, bunker::Verdict::Decoded);
  }
}

TEST(OldFirmware, DrivesWithPercentOfItsFullSpeed) {
  Plant plant(old_base());
  drive_v1(plant, 20, 0, 3s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 0.6, 1e-3);
  const auto motion = std::get<v1::MotionState>(v1::decode(plant.last(0x131)).message);
  EXPECT_NEAR(motion.linear_mps, 0.6, 1e-3);
  const auto state = std::get<v1::SystemState>(v1::decode(plant.last(0x151)).message);
  EXPECT_EQ(state.control_mode(), base::ControlMode::Can);
  plant.wait(2s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 0.0, 1e-3) << "nobody commands any more";
}

TEST(OldFirmware, AnswersALightCommandWithItsLights) {
  Plant plant(old_base());
  bunker::Light wanted;
  wanted.enabled = true;
  wanted.front_mode = bunker::LightMode::Breathing;
  plant.bunker.receive(v1::encode(v1::LightCommand{wanted}));
  const auto told = std::get<v1::LightState>(v1::decode(plant.last(0x141)).message);
  EXPECT_TRUE(told.enabled);
  EXPECT_EQ(told.front_mode, bunker::LightMode::Breathing);
  EXPECT_EQ(told.rear_mode, bunker::LightMode::Off);
}

TEST(OldFirmware, IgnoresWrongChecksumsAndCommandsOfV2) {
  Plant plant(old_base());
  CanFrame broken = v1_drive(20, 0);
  broken.data[7] ^= 1U;
  for (int i = 0; i < 50; ++i) {
    plant.bunker.receive(broken);
    plant.bunker.receive(mode_frame(1));
    plant.bunker.receive(drive_frame(0.5, 0.0));
    plant.wait(20ms);
  }
  EXPECT_EQ(plant.truth().commands, 0u);
  EXPECT_EQ(plant.truth().control_mode, base::ControlMode::Standby);
}

TEST(OldFirmware, ClearsOneKindOfError) {
  Plant plant(old_base());
  set_fault(plant, [](Faults& f) { f.error_bits = 1 << 2 | 1 << 7; });
  plant.bunker.receive(v1::encode(v1::Command{.clear = v1::kClearMotor1}));
  EXPECT_EQ(plant.bunker.faults().error_bits, 1 << 7);
}

TEST(Firmware, ATextIsToldInTenFrames) {
  Plant plant;
  plant.bunker.receive(frame_of(0x4A1, {1}));
  const auto parts = plant.of(0x4A1);
  ASSERT_EQ(parts.size(), 10u);
  std::string text;
  for (const CanFrame& f : parts) text.append(f.data.begin(), f.data.end());
  EXPECT_EQ(text.c_str(), Params{}.base.firmware);
}

TEST(Firmware, TheOldFormIsFourNumbers) {
  Plant plant;
  plant.bunker.receive(frame_of(0x411, {1}));
  ASSERT_EQ(plant.of(0x41A).size(), 1u);
  EXPECT_EQ(plant.last(0x41A), frame_of(0x41A, {0, 2, 0, 0, 0, 1, 0, 0}));
}

TEST(Firmware, OtherFramesOfThoseIdsAreNoQuestion) {
  Plant plant;
  plant.bunker.receive(frame_of(0x4A1, {2}));
  plant.bunker.receive(frame_of(0x411, {1, 0}));
  EXPECT_TRUE(plant.frames.empty());
}

}  // namespace
}  // namespace roverd::sim
