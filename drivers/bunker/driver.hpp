#pragma once
// The Bunker on a CAN bus: commands in, measurements out.
//
//   Down ─start─▶ Opening ─feedback heard─▶ Up ─0.5 s of silence─▶ Faulty ─heard again─▶ Up
//                    ▲  └── open refused, closed, V1 and V2 at once (Up too) ─▶ │
//                    └──────────── back-off over, if the bus is closed ────────┘
//   any ─stop─▶ Down: zeros and standby are sent first
//
// Feedback is 0x211 or 0x221 (protocol V2), 0x131 or 0x151 (V1). Which protocol the base speaks is
// known from what arrives: 0x221 or 0x241 is V2, an intact 0x151 is V1. Both on one bus: the driver
// refuses; afterwards a base must speak one of them alone for a second before it is Up.
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
// In V1 one frame (0x130) says mode and speeds, in whole percent. That protocol has no standby and
// no radio frame: mode 0 is told as standby, but as the radio's for kRadioPause after it took the
// base from us.
//
// The firmware's version is asked for while Up, at most kFirmwareAsks times (V2 only; in turn with
// the new and the old form).
//
// Every frame passes the gate. If it refuses a motion frame, a zero goes in its place.
//
// Measurements, stamped with the arrival of their frame: BaseStatus (0x211, 0x151), BaseMotion
// (0x221, 0x131), RadioState (0x241), WheelTravel (0x311), BatteryState (0x361, 0x362), MotorState
// (0x251.. 0x261.., 0x200..), LightState (0x231, 0x141), DriverStatus (on change and twice a
// second, with its DriverDetail: counts by cause, rates, facts, hazards).
//
// Not believed, counted by cause: remote, error, extended, unknown, short frames, wrong checksums,
// values no Bunker can have, commands of somebody else. Hazards:
//
//   somebody else commands motion   for kForeignHold after the last one
//   left and right are swapped      odometer and motion state turn opposite ways (TurnWatch)
//   a state that repeats itself     its counter counted, and stands still (CountWatch)
//
// The link must not give our own frames back (record and socketcan do not).
//
// Threads: send() belongs to the control thread, everything else to the device thread. The two
// share atomics and the gate, so send() never waits. It may be called in any phase.

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "bunker/codec.hpp"
#include "bunker/interpreter.hpp"
#include "bunker/odometry.hpp"
#include "bunker/params.hpp"
#include "bunker/tally.hpp"
#include "bunker/v1.hpp"
#include "bunker/watch.hpp"
#include "gate/gate.hpp"
#include "link/port.hpp"

namespace roverd::bunker {

using base::Time;

class Driver {
 public:
  using MakeLink = link::FramePort::MakeLink;
  using OnMeasurement = link::FramePort::OnMeasurement;

  /// @param params valid (validate). @param on_measurement called on the device thread.
  Driver(std::string name, const Params& params, MakeLink make_link, OnMeasurement on_measurement);

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

  /// Device thread. @param lights its stamp is not used. @return false if a value is out of range
  /// or nothing could be sent.
  bool set_lights(const base::LightState& lights, Time now) noexcept;
  /// Device thread. Asks the base to clear latched errors. @param motor 1 or 2; 0: every error (V1
  /// has no such request: its eight kinds follow each other, half a second apart).
  /// @return false if the (first) request could not be sent.
  bool clear_errors(int motor, Time now) noexcept;

  /// Device thread.
  base::DriverStatus status(Time now) const { return port_.status(now); }
  gate::Gate::Counts gate_counts() const noexcept { return gate_.counts(); }

 private:
  static constexpr base::Duration kForeignHold = std::chrono::seconds(1);
  static constexpr base::Duration kRadioPause = std::chrono::seconds(2);
  static constexpr base::Duration kRefusedAfter = std::chrono::seconds(2);
  static constexpr base::Duration kOneVoice = std::chrono::seconds(1);
  static constexpr base::Duration kClearPause = std::chrono::milliseconds(500);
  static constexpr base::Duration kFirmwarePause = std::chrono::seconds(1);
  static constexpr int kFirmwareAsks = 4;

  void begin(link::FrameLink& bus, Time now);
  /// The base is not there: nothing but its own voice brings it back.
  void forget() noexcept;
  void check_silence(Time now);

  /// Tells hazards that came or went, at once.
  void tell_news(Time now);
  void refresh_detail(Time now);
  void complete(base::DriverStatus& status) const;
  std::shared_ptr<const base::DriverDetail> make_detail(Time now);
  std::map<std::string, std::string> facts(Time now) const;
  std::string control_words(Time now) const;
  struct Hazards {
    bool foreign_motion = false;
    bool swapped = false;
    bool frozen = false;
    friend bool operator==(const Hazards&, const Hazards&) = default;
  };
  Hazards hazards(Time now) const noexcept;

  // driver_receive.cpp
  /// What this driver reads or sends, of both protocols.
  std::vector<std::uint32_t> own_ids() const;
  void on_frame(const CanFrame& frame, Time stamp);
  void on_v2(const CanFrame& frame, Time stamp);
  void on_v1(const CanFrame& frame, Time stamp);
  /// Counts a frame that is not to be used. @return true if it is one.
  template <class Decoded>
  bool refuse(const CanFrame& frame, const Decoded& decoded);
  void foreign_command(std::uint32_t frame_id, Time stamp);
  void heard(const CanFrame& frame, Time stamp);
  /// Notes the protocol. @return true if both are spoken: the driver is then Faulty.
  bool two_protocols(bool v1, Time stamp);
  void feedback(Time stamp);
  void watch(const Message& message, Time stamp);
  base::ControlMode v1_mode(const v1::SystemState& s, Time stamp) noexcept;

  // driver_send.cpp
  void drive(base::BodyTwist twist, base::ControlMode mode, Time now) noexcept;
  void leave(base::ControlMode mode, Time now) noexcept;
  void ask(Time now) noexcept;
  CanFrame motion_frame(const MotionCommand& m) noexcept;
  /// Zero that any base takes in any mode, and that does not ask for CAN mode.
  CanFrame zero_frame(base::ControlMode mode) noexcept;
  CanFrame mode_frame(RequestedMode mode) noexcept;
  bool clear_next(Time now) noexcept;
  void ask_firmware(Time now) noexcept;
  enum class Outcome { Sent, Refused, NoRoom };  ///< Refused: by the gate
  Outcome transmit(const CanFrame& frame, Time now) noexcept;

  const Params params_;
  const LeftStick left_stick_;
  const OnMeasurement on_measurement_;
  gate::Gate gate_;

  // Shared with the control thread.
  std::atomic<link::FrameLink*> link_{nullptr};  ///< set once, lives as long as the driver
  std::atomic<bool> up_{false};
  std::atomic<bool> speaks_v1_{false};
  std::atomic<base::ControlMode> mode_{base::ControlMode::Unknown};
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint8_t> v1_count_{0};
  std::atomic<bool> ours_{false};          ///< commands were sent and standby was not yet
  std::atomic<Time::rep> asked_since_{0};  ///< for CAN mode, in vain; 0: not asking

  // Control thread.
  int zeros_left_ = 0;
  std::optional<Time> last_request_;
  std::optional<Time> last_motion_;
  base::BodyTwist last_twist_;

  // Device thread.
  Interpreter interpreter_;
  bool v1_seen_ = false;
  bool v2_seen_ = false;
  std::optional<Time> up_from_;  ///< after both protocols were heard: not before
  std::uint8_t v1_mode_raw_ = 0xFF;
  std::optional<Time> radio_took_;  ///< V1 only
  Odometry odometry_;
  TurnWatch turn_;
  CountWatch state_count_;
  CountWatch radio_count_;
  std::optional<Time> foreign_motion_;
  Tally tally_;
  Rates rates_;
  std::shared_ptr<const base::DriverDetail> detail_;
  Hazards told_;  ///< in detail_
  Time detail_at_{};
  std::uint8_t light_count_ = 0;
  std::uint8_t clear_next_ = 0;  ///< V1: the kind to clear next; 0: none
  bool clear_all_ = false;
  Time clear_at_{};
  int firmware_asks_ = 0;  ///< since the bus was opened
  Time firmware_at_{};
  std::uint64_t refused_ = 0;
  std::uint64_t restarts_ = 0;
  link::FramePort port_;  ///< last: its callbacks use all above
};

}  // namespace roverd::bunker
