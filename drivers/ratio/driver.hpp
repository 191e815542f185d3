#pragma once
// The indoor robot behind TCP (ratio/codec.hpp).
//
//   Down ─start─▶ Opening ─a line was taken─▶ Up ─closed, or takes no lines─▶ Faulty
//                    ▲                                                          │
//                    └──────────────────── back-off over ───────────────────────┘
//
// A line leaves every 200 ms, the stop at once. A command older than 0.25 s is a stop. After a
// short write the next line begins with a line end, so that the robot never joins two halves.
// In a recording, what was sent then stands for what would be sent now.
// Measurements: BaseMotion (assumed, unless the robot sends lines back), BaseStatus at 10 Hz.
//
// Threads: send() belongs to the control thread, everything else to the device thread.

#include <optional>
#include <string>

#include "base/drive_command.hpp"
#include "gate/command_box.hpp"
#include "gate/gate.hpp"
#include "link/port.hpp"
#include "ratio/codec.hpp"
#include "ratio/params.hpp"

namespace roverd::ratio {

using base::Time;

class Driver {
 public:
  using MakeLink = link::BytePort::MakeLink;
  using OnMeasurement = link::BytePort::OnMeasurement;

  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

  void start(Time now);
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);
  /// Control thread. Never waits.
  void send(const base::DriveCommand& command, Time now) noexcept { box_.put(command, now); }
  base::DriverStatus status(Time now) const { return port_.status(now); }

 private:
  void on_bytes(base::Bytes bytes, Time stamp);
  void on_sent(base::Bytes bytes, Time stamp);
  void forget();
  Message wanted(Time now);
  void transmit(const Message& message, Time now);
  void tell(Time now);

  const Params params_;
  const OnMeasurement on_measurement_;
  gate::CommandBox box_;
  gate::Gate gate_;
  Decoder decoder_;
  Decoder sent_;          ///< of a recording
  bool replays_ = false;  ///< a recording tells what was sent
  std::uint64_t damaged_ = 0;
  bool driving_ = false;  ///< the last line moved, or could have
  bool torn_ = false;     ///< the last line may have left in part
  int untaken_ = 0;       ///< lines in a row that found no room
  Message last_;          ///< that left
  std::optional<Time> last_sent_;
  std::optional<Time> measured_;
  Time next_status_{};
  link::BytePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::ratio
