#pragma once
// A car with steered front wheels behind a controller that listens to UDP (ackermann/codec.hpp).
//
//   Down ─start─▶ Opening ─sent, or heard where required─▶ Up ─silent─▶ Faulty ─heard again─▶ Up
//                    ▲  └─────── open refused, closed ──────────────────▶ │
//                    └──────────────── back-off over ─────────────────────┘
//   any ─stop─▶ Down: three times park
//
// Every tick (100 Hz) one datagram leaves, whether anything changed or not:
//   command fresh and enabled   speed and wheel angle, autonomous
//   otherwise                   speed 0, the wheel stays; remote if the car says that a person
//                               drives it from there, else park
//
// A controller that has once sent the layout back must go on doing so: its silence stops the car.
// One that never did is believed to do what it is told, so much later as it takes
// (BaseMotion::assumed), and the base counts as normal while the link is open.
//
// In a recording, what was sent then stands for what would be sent now: where nothing comes back,
// it is all that is known of the motion.
//
// Measurements: BaseMotion, SteeringState (with feedback), BaseStatus at 10 Hz, DriverStatus.
//
// Threads: send() belongs to the control thread, everything else to the device thread.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ackermann/codec.hpp"
#include "ackermann/params.hpp"
#include "ackermann/zero.hpp"
#include "base/drive_command.hpp"
#include "gate/command_box.hpp"
#include "gate/gate.hpp"
#include "link/port.hpp"

namespace roverd::ackermann {

using base::Bytes;
using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate). @param on_measurement called on the device thread.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  void start(Time now);
  /// 100 times a second.
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);

  /// Control thread, every 20 ms. Never waits.
  void send(const base::DriveCommand& command, Time now) noexcept { box_.put(command, now); }

  base::DriverStatus status(Time now) const { return port_.status(now); }
  double learned_zero_rad() const noexcept { return zero_.zero_rad(); }

 private:
  void on_bytes(Bytes bytes, Time stamp);
  void on_feedback(const Message& message, Time stamp);
  void on_sent(Bytes bytes, Time stamp);
  void forget();
  void check_silence(Time now);
  void drive(Time now);
  Message wanted(Time now, double dt_s);
  bool transmit(const Message& message, Time now);
  void tell(Time now);
  base::BodyTwist assumed_now();
  double zero_rad() const noexcept { return params_.zero_rad + zero_.at_rad(wheel_rad_); }

  const Params params_;
  const OnMeasurement on_measurement_;
  gate::CommandBox box_;
  gate::Gate gate_;
  SteeringZero zero_;
  bool spoken_ = false;  ///< feedback was heard since the start
  std::optional<Message> heard_;
  Time heard_at_{};
  double speed_mps_ = 0.0;  ///< of the last command that left
  double wheel_rad_ = 0.0;  ///< the same, without the zero
  DriveMode mode_ = DriveMode::Park;
  /// What was told lately, one every kMotionPeriod, for a car that tells nothing.
  std::array<base::BodyTwist, 64> told_{};
  std::size_t told_at_ = 0;
  bool replays_ = false;  ///< a recording tells what was sent
  std::optional<Time> last_sent_;
  Time next_motion_{};
  Time next_status_{};
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::ackermann
