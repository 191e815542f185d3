#pragma once
// The inertial unit on the robot: an MTi on its wire, with the errors of a small one. It answers
// the requests that a driver makes, and measures what it is told to (at first what is stored in
// it: counters, status, orientation, acceleration, rate of turn and field at imu.rate_hz).
//
// Rates of turn and accelerations are means since the sample before, so their sums are exact up to
// noise and bias. The unit sits in the body's origin, its axes are the body's.

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "base/bytes.hpp"
#include "mti/data2_build.hpp"
#include "mti/rotation.hpp"
#include "mti/xbus.hpp"
#include "sim/noise.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"
#include "sim/receiver.hpp"

namespace roverd::sim {

class Imu {
 public:
  using Packets = std::vector<std::uint8_t>;

  explicit Imu(std::uint64_t seed);

  /// From the host. Answers leave with the next step.
  void receive(base::Bytes bytes);

  /// Once a step of 5 ms. @param motor_difference_a right minus left motor current. @return what
  /// leaves the unit during this step; mostly one message or nothing.
  Packets step(const Params& p, const Faults& faults, const BodyState& now,
               double motor_difference_a);
  /// As after power-up: stored configuration, measuring.
  void power_cycle();

 private:
  /// What the sensors show, in the unit's axes.
  struct Measured {
    mti::Vec3 rate{};
    mti::Vec3 accel{};
    mti::Vec3 field{};
    mti::Mat3 R_NS;  ///< orientation as the unit makes it out: with the compass's error
    bool clipped = false;
  };
  Measured measure(const Params& p, const Faults& faults, const BodyState& now, double dt_s);
  Packets data(const Measured& m, const Faults& faults, base::Duration since);
  void put(mti::Data2Builder& out, std::uint16_t xdi, const Measured& m, base::Duration since);
  void answer(const mti::Message& message);

  struct Pending {
    Time due;
    Packets bytes;
  };

  mti::Framer framer_;
  std::vector<mti::Output> outputs_;
  bool measuring_ = true;
  Packets answers_;
  Noise gyro_, accel_, compass_;
  Drift gyro_wander_;
  Kick kick_;
  std::optional<BodyState> last_;  ///< at the sample before
  std::optional<Time> last_step_;
  std::optional<Time> began_;
  std::int64_t steps_ = 0;
  std::uint64_t samples_ = 0;
  std::deque<Pending> pending_;
  Packets frozen_;  ///< the message that a frozen unit repeats
  double ramp_dps_ = 0.0;
  std::optional<mti::Vec3> rate_told_;       ///< what a frozen gyro repeats
  std::optional<double> compass_shown_deg_;  ///< what a frozen compass does
};

}  // namespace roverd::sim
