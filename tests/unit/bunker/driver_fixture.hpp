#pragma once
// A Bunker driver on a memory link, and the other end of it in the test's hands.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bunker/driver.hpp"
#include "link/memory.hpp"

namespace roverd::bunker {

using namespace std::chrono_literals;
using base::ControlMode;
using base::DriverPhase;
using base::Switch;
using base::VehicleState;

class BunkerDriverTest : public ::testing::Test {
 protected:
  BunkerDriverTest() { make(Params{}); }

  /// @param params the firmware is asked for where a test wants it (asks_firmware).
  void make(Params params) {
    params.ask_firmware = asks_firmware;
    driver.reset();
    seen.clear();
    wire = link::memory_frame_pair();
    ours = wire.a.get();
    ASSERT_TRUE(wire.b->open());
    wire.b->on_frame = [this](const CanFrame& f, Time) { commands.push_back(f); };
    driver = std::make_unique<Driver>(
        "bunker", params,
        [this]() -> base::Result<std::unique_ptr<link::FrameLink>> {
          if (!make_error.empty()) return base::fail(base::Code::NotFound, make_error);
          return std::move(wire.a);
        },
        [this](const base::Measurement& m) { seen.push_back(m); });
  }

  static CanFrame state(int vehicle, int mode, std::uint16_t errors = 0) {
    SystemState s;
    s.vehicle_state_raw = static_cast<std::uint8_t>(vehicle);
    s.control_mode_raw = static_cast<std::uint8_t>(mode);
    s.battery_v = 48.0;
    s.error_code = errors;
    return encode(s);
  }

  void hear(const CanFrame& f) {
    wire.b->send(f);
    ours->deliver(now);
  }

  /// Started, heard, Up; the base reports this mode from here on.
  void up(int mode) {
    driver->start(now);
    base_mode = mode;
    hear(encode(MotionState{}));
    hear(state(0, mode));
  }

  /// One 20 ms round: the base reports, the robot commands, the device thread ticks.
  void round(const base::DriveCommand& command) {
    now += 20ms;
    if (base_talks) {
      hear(encode(MotionState{}));
      hear(state(0, base_mode));
    }
    driver->send(command, now);
    driver->tick(now);
    wire.b->deliver(now);
  }
  void rounds(int n, const base::DriveCommand& command) {
    for (int i = 0; i < n; ++i) round(command);
  }

  std::vector<CanFrame> sent(std::uint32_t id) const {
    std::vector<CanFrame> out;
    for (const CanFrame& f : commands) {
      if (f.id == id) out.push_back(f);
    }
    return out;
  }
  double last_linear() const {
    const auto frames = sent(id::kMotionCommand);
    if (frames.empty()) return -99.0;
    return std::get<MotionCommand>(decode(frames.back()).message).linear_mps;
  }

  template <class M>
  std::vector<M> measured() const {
    std::vector<M> out;
    for (const auto& m : seen) {
      if (const M* value = std::get_if<M>(&m)) out.push_back(*value);
    }
    return out;
  }
  base::DriverStatus status() const { return driver->status(now); }

  static base::DriveCommand ahead(double linear_mps, double angular_radps = 0.0) {
    return {.twist = {.linear_mps = linear_mps, .angular_radps = angular_radps}, .enabled = true};
  }
  static base::DriveCommand off() { return {}; }

  Time now = Time{} + 1000s;
  link::MemoryFramePair wire;
  link::MemoryFrameLink* ours = nullptr;
  std::string make_error;
  std::unique_ptr<Driver> driver;
  std::vector<base::Measurement> seen;
  std::vector<CanFrame> commands;
  bool base_talks = true;
  bool asks_firmware = false;
  int base_mode = 0;
};

}  // namespace roverd::bunker
