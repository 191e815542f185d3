#pragma once
// The last door before the bus. It reads the raw bytes of every frame that wants to leave and of
// every frame that came in, and trusts nobody: not the tracker, not the limits above it, not the
// codec that made the bytes. Two tables say all it knows, for both protocols of the base:
//
//   may leave      id, length, what its bytes may hold, how far a value may step, how often
//   must arrive    id, length, expected period, and how old it may be while the robot moves
//
// Default silent: an id that is not listed stays inside. Motion (0x111, in protocol V1 0x130, with
// any speed but zero) leaves only while all of this holds: permit(true) was called, both frames
// that must arrive in that protocol are fresh, the base says vehicle state 0 (normal) and control
// mode 1 (CAN) in it, the other protocol is not heard, every value is in its limit and has not
// grown by more than its step since the last motion frame that left.
// Always allowed, whatever else is wrong: zero motion and standby (V1: zeros in mode 0, and zeros
// in mode 1 to a base that is in it). Whatever V1 sends or hears has the right checksum.
//
// Threads: allows() is called by the control loop, saw() and permit() by the device thread. One
// mutex guards everything; it is a leaf (nothing is locked or called while it is held) and held for
// well under a microsecond. noexcept, no allocation, no clock: time is an argument.

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

#include "base/bytes.hpp"
#include "base/time.hpp"

namespace roverd::gate {

using base::CanFrame;
using base::Duration;
using base::Time;

/// Why a frame stayed inside.
enum class Refusal {
  None,
  NotListed,     ///< unknown id, or not a plain 11-bit data frame
  WrongLength,   ///< exactly the table's length leaves
  WrongContent,  ///< a byte that must be zero is not, a value outside its range, a wrong checksum
  NotPermitted,  ///< permit(false), or never permitted
  Stale,         ///< feedback is too old
  NotReady,      ///< motion: not normal state and CAN mode; CAN request: not in standby
  TooLarge,      ///< beyond the limit
  TooSudden,     ///< beyond the step
  TooOften,
  TwoProtocols,  ///< V1 and V2 are both heard: whose base is it?
};
inline constexpr std::size_t kRefusals = 11;

/// A speed inside a motion frame: a big-endian i16, in V1 an i8. Steps count only while a value
/// grows away from zero: to slow down is always allowed, to reverse counts from zero.
struct ValueRule {
  std::size_t at = 0;     ///< first byte
  std::size_t bytes = 2;  ///< 2 or 1
  int max = 0;            ///< largest magnitude, wire steps
  int max_step = 0;       ///< largest growth from one frame to the next
};

/// Motion: an all-zero frame is a stop. MotionV1: mode, error clear, speeds, checksum. Code: byte 0
/// chooses, all others are zero. Lights, LightsV1: switch, two modes, two brightnesses, a count.
enum class Payload { Motion, MotionV1, Code, Lights, LightsV1 };

struct TxRule {
  std::uint32_t id = 0;
  std::uint8_t len = 8;
  Payload payload = Payload::Code;
  std::uint8_t max_code = 0;  ///< largest byte 0
  bool zero_is_stop = false;  ///< code 0 always leaves
  double min_period_s = 0.0;  ///< between frames of this id (V1: between requests), stops aside
};

struct RxRule {
  std::uint32_t id = 0;
  std::uint8_t len = 8;
  double period_s = 0.0;   ///< expected, for the reader of this table
  double max_age_s = 0.0;  ///< older: no motion
};

/// Wire steps are 0.001 m/s and 0.001 rad/s; of V1, percent of the base's full speed.
struct Limits {
  int max_linear = 1500;
  int max_angular = 786;
  int max_linear_step = 250;
  int max_angular_step = 250;
  int max_linear_pct = 50;
  int max_angular_pct = 31;
  int max_linear_step_pct = 9;
  int max_angular_step_pct = 10;
  double motion_max_age_s = 0.3;  ///< of 0x221, 0x131
  double state_max_age_s = 0.7;   ///< of 0x211 and 0x151, which come every 100 to 200 ms
};

inline constexpr std::array kMayLeave{
    TxRule{.id = 0x111, .len = 8, .payload = Payload::Motion},
    // 1 CAN; 2 (serial) is nobody's business. Only to a base that says standby.
    TxRule{.id = 0x421, .len = 8, .max_code = 1, .zero_is_stop = true, .min_period_s = 0.45},
    TxRule{.id = 0x441, .len = 8, .max_code = 2, .min_period_s = 0.1},
    TxRule{.id = 0x121, .payload = Payload::Lights, .max_code = 1, .min_period_s = 0.015},
    // Asks for the firmware's version, in the two forms.
    TxRule{.id = 0x4A1, .len = 1, .max_code = 1, .min_period_s = 0.45},
    TxRule{.id = 0x411, .len = 1, .max_code = 1, .min_period_s = 0.45},
    TxRule{.id = 0x130, .payload = Payload::MotionV1, .max_code = 1, .min_period_s = 0.45},
    TxRule{.id = 0x140, .payload = Payload::LightsV1, .max_code = 1, .min_period_s = 0.015},
};

class Gate {
 public:
  /// @param limits negative values count as zero: nothing moves.
  explicit Gate(const Limits& limits) noexcept;

  /// A frame arrived. Remote, error, extended and short frames prove nothing.
  void saw(const CanFrame& frame, Time now) noexcept;
  /// May this frame leave now? A frame that may is taken for sent.
  bool allows(const CanFrame& frame, Time now) noexcept;
  /// Motion and mode requests leave only between permit(true) and permit(false). permit(false)
  /// also forgets all feedback: permission begins with fresh frames.
  void permit(bool on) noexcept;

  struct Counts {
    std::uint64_t allowed = 0;
    std::array<std::uint64_t, kRefusals> refused{};  ///< by Refusal
    std::uint64_t refused_total() const noexcept;
  };
  Counts counts() const noexcept;

 private:
  /// What one protocol of the base has told.
  struct Heard {
    std::optional<Time> motion;
    std::optional<Time> state;
    std::uint8_t vehicle_state = 0xFF;  ///< bytes 0 and 1 of the last system state
    std::uint8_t control_mode = 0xFF;
  };
  struct Protocol {
    RxRule motion;
    RxRule state;
    std::array<ValueRule, 2> values;
  };

  Refusal check(const CanFrame& frame, Time now) noexcept;
  Refusal check_motion(const TxRule& rule, const CanFrame& frame, Time now) noexcept;
  Refusal check_v1(const TxRule& rule, const CanFrame& frame, Time now) noexcept;
  Refusal check_code(const TxRule& rule, const CanFrame& frame, Time now) noexcept;
  Refusal check_lights(const TxRule& rule, const CanFrame& frame, Time now) noexcept;
  /// Everything that motion in protocol `which` needs, and its values.
  Refusal check_speeds(std::size_t which, const CanFrame& frame, Time now) noexcept;
  Refusal check_period(const TxRule& rule, Time now) noexcept;
  void left(std::size_t which, const CanFrame& frame, Time now) noexcept;
  bool motion_fresh(std::size_t which, Time now) const noexcept;
  bool state_fresh(std::size_t which, Time now) const noexcept;

  const std::array<Protocol, 2> protocols_;  ///< V2, V1

  mutable std::mutex mutex_;  // guards all below
  bool permitted_ = false;
  std::array<Heard, 2> heard_{};
  std::optional<Time> last_motion_;
  std::size_t last_protocol_ = 0;  ///< of last_motion_
  std::array<int, 2> last_values_{};
  std::array<std::optional<Time>, kMayLeave.size()> last_code_{};
  Counts counts_{};
};

}  // namespace roverd::gate
