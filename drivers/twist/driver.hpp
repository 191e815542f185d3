#pragma once
// A microcontroller that speaks our twist protocol (twist/messages.hpp) over serial, UDP or TCP.
//
//   Down ─start─▶ Opening ─feedback heard─▶ Up ─silent─▶ Faulty ─heard again─▶ Up
//                    ▲  └── open refused, closed ──────────▶ │
//                    └───────────── back-off over ───────────┘
//   any ─stop─▶ Down: three times stop
//
// A command leaves at every second tick (50 Hz), enabled only while the robot wants it, feedback is
// fresh and the gate agrees. A feedback whose sequence stands still proves nothing.
// Measurements: BaseMotion, WheelTravel, BaseStatus, DriverStatus.
//
// Threads: send() belongs to the control thread, everything else to the device thread.

#include <optional>
#include <string>

#include "base/drive_command.hpp"
#include "gate/command_box.hpp"
#include "gate/gate.hpp"
#include "link/port.hpp"
#include "twist/binary.hpp"
#include "twist/params.hpp"
#include "twist/text.hpp"

namespace roverd::twist {

using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  /// @param params valid (validate).
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  void start(Time now) { port_.start(now); }
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);
  /// Control thread. Never waits.
  void send(const base::DriveCommand& command, Time now) noexcept { box_.put(command, now); }
  base::DriverStatus status(Time now) const { return port_.status(now); }

 private:
  void on_bytes(base::Bytes bytes, Time stamp);
  void on_feedback(const Feedback& feedback, Time stamp);
  void travel(const Feedback& feedback, Time stamp);
  void tell(const Feedback& feedback, Time stamp);
  void forget();
  void drive(Time now);
  bool transmit(Command command, Time now);

  const Params params_;
  const bool binary_;
  const OnMeasurement on_measurement_;
  gate::CommandBox box_;
  gate::Gate gate_;
  TextDecoder text_;
  BinaryDecoder frames_;
  std::uint64_t damaged_ = 0;
  std::uint8_t seq_ = 0;
  Command last_;
  std::optional<Time> last_sent_;
  std::optional<Feedback> heard_;
  Time heard_at_{};
  Time next_status_{};
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::twist
