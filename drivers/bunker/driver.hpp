#pragma once
// The Bunker on a CAN bus: commands in, measurements out.
//
//   Down ─start─▶ Opening ─0x211 or 0x221 heard─▶ Up ─0.5 s of silence─▶ Faulty ─heard again─▶ Up
//                    ▲  └── open refused, closed, V1 seen (Up too) ────────▶ │
//                    └────────── back-off over, if the bus is closed ────────┘
//   any ─stop─▶ Down: zeros and standby are sent first
//
// Silence alone does not close the bus; it is opened again when it stays silent for
// silent_reopen_s.
//
// Control mode, at every send() while Up:
//
//   enabled   base in standby   0x421 = 1, at most every mode_request_period_s
//             base in CAN mode  0x111, cut to the limits
//             radio drives      nothing; once it gives back, standby is seen and asked again
//             serial host       nothing: somebody chose that on purpose
//   disabled  after enabled     stop_frames zeros, then 0x421 = 0 once (the radio driving: later)
//             otherwise         nothing
//
// Every frame passes the gate. If it refuses a motion frame, a zero goes in its place.
//
// Measurements, stamped with the arrival of their frame: BaseStatus (0x211), BaseMotion (0x221),
// RadioState (0x241; a lever between detents keeps its last good position), WheelTravel (0x311),
// BatteryState (0x361, where the base sends it), DriverStatus (on change and twice a second).
//
// Threads: send() belongs to the control thread, everything else to the device thread. The two
// share atomics and the gate, so send() never waits. It may be called in any phase.

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "bunker/codec.hpp"
#include "bunker/odometry.hpp"
#include "bunker/params.hpp"
#include "gate/gate.hpp"
#include "link/lifecycle.hpp"
#include "link/link.hpp"

namespace roverd::bunker {

using base::Time;

class Driver {
 public:
  /// Called until it succeeds; the link is then kept and opened and closed as needed.
  using MakeLink = std::function<base::Result<std::unique_ptr<link::FrameLink>>()>;
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  /// @param params valid (validate). @param on_measurement called on the device thread.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Device thread. Opens at once; a failure shows as Faulty and is tried again.
  void start(Time now);
  /// Device thread, 20 to 50 times a second: time-outs, back-off, status.
  void tick(Time now);
  /// Device thread. Sends zeros and standby if the base was ours, closes, and is Down. Idempotent.
  void stop(Time now);
  /// Device thread.
  void restart(Time now);

  /// Control thread, every 20 ms. Never waits. NaN in the twist: zero is sent.
  void send(const base::DriveCommand& command, Time now) noexcept;

  /// Any thread. Asks the base to clear every latched error. @return false if it could not be sent.
  bool clear_errors(Time now) noexcept;

  /// Device thread.
  base::DriverStatus status(Time now) const;
  gate::Gate::Counts gate_counts() const noexcept { return gate_.counts(); }

 private:
  void open(Time now);
  /// The base is not there: nothing but its own voice brings it back.
  void lose(const std::string& reason, Time now);
  /// As lose, and the bus is closed, to be opened again after the back-off.
  void fail(const std::string& reason, Time now);
  void check_silence(Time now);
  void report(Time now);
  void on_frame(const CanFrame& frame, Time stamp);
  /// @return true if the base speaks V1: the driver is then Faulty.
  bool refuse_v1(const CanFrame& frame, Time stamp);
  void feedback(Time stamp);
  void on_message(const Message& message, Time stamp);
  void on_system(const SystemState& s, Time stamp);
  void on_radio(const RadioFrame& r, Time stamp);
  void on_odometer(const Odometer& o, Time stamp);
  void on_battery(const Battery& b, Time stamp);

  void drive(base::BodyTwist twist, base::ControlMode mode, Time now) noexcept;
  void leave(base::ControlMode mode, Time now) noexcept;
  enum class Outcome { Sent, Refused, NoRoom };  ///< Refused: by the gate
  Outcome transmit(const CanFrame& frame, Time now) noexcept;

  const std::string name_;
  const Params params_;
  const LeftStick left_stick_;
  const ErrorTable& error_table_;
  const MakeLink make_link_;
  const OnMeasurement on_measurement_;
  std::unique_ptr<link::FrameLink> owned_link_;
  gate::Gate gate_;

  // Shared with the control thread.
  std::atomic<link::FrameLink*> link_{nullptr};  ///< set once, lives as long as the driver
  std::atomic<bool> up_{false};
  std::atomic<base::ControlMode> mode_{base::ControlMode::Unknown};
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<bool> ours_{false};  ///< commands were sent and standby was not yet

  // Control thread.
  int zeros_left_ = 0;
  std::optional<Time> last_request_;
  std::optional<Time> last_motion_;
  base::BodyTwist last_twist_;

  // Device thread.
  link::Lifecycle life_;
  Time now_{};  ///< of the last call, for callbacks that carry no time
  bool open_ = false;
  Time last_feedback_{};  ///< or the opening
  std::optional<Time> last_received_;
  bool v2_seen_ = false;
  Odometry odometry_;
  std::array<base::Switch, 4> switches_{};
  std::uint64_t received_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace roverd::bunker
