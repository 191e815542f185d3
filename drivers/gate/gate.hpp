#pragma once
// The last door before the bus. It reads the raw bytes of every frame that wants to leave and of
// every frame that came in, and trusts nobody: not the tracker, not the limits above it, not the
// codec that made the bytes. Two tables say all it knows:
//
//   may leave      id, length, what its bytes may hold, how far a value may step, how often
//   must arrive    id, length, expected period, and how old it may be while the robot moves
//
// Default silent: an id that is not listed stays inside. Motion (0x111 with anything but zeros)
// leaves only while all of this holds: permit(true) was called, every frame of the second table is
// fresh, the base says vehicle state 0 (normal) and control mode 1 (CAN), every value is in its
// limit and has not grown by more than its step since the last motion frame that left.
// Always allowed, whatever else is wrong: zero motion and standby.
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
  WrongContent,  ///< a byte that must be zero is not, or a code outside its range
  NotPermitted,  ///< permit(false), or never permitted
  Stale,         ///< feedback is too old
  NotReady,      ///< motion: not normal state and CAN mode; CAN request: not in standby
  TooLarge,      ///< beyond the limit
  TooSudden,     ///< beyond the step
  TooOften,
};
inline constexpr std::size_t kRefusals = 10;

/// A big-endian i16 of a motion frame. Steps count only while a value grows away from zero: to slow
/// down is always allowed, to reverse counts from zero.
struct ValueRule {
  std::size_t at = 0;  ///< first byte
  int max = 0;         ///< largest magnitude, wire steps
  int max_step = 0;    ///< largest growth from one frame to the next
};

/// Motion: an all-zero frame is a stop. Code: byte 0 chooses, all others are zero.
enum class Payload { Motion, Code };

struct TxRule {
  std::uint32_t id = 0;
  std::uint8_t len = 8;
  Payload payload = Payload::Code;
  std::uint8_t max_code = 0;  ///< largest byte 0 of a Code
  bool zero_is_stop = false;  ///< code 0 always leaves
  double min_period_s = 0.0;  ///< between frames of this id, stops aside
};

struct RxRule {
  std::uint32_t id = 0;
  std::uint8_t len = 8;
  double period_s = 0.0;   ///< expected, for the reader of this table
  double max_age_s = 0.0;  ///< older: no motion
};

/// Wire steps are 0.001 m/s and 0.001 rad/s.
struct Limits {
  int max_linear = 1500;
  int max_angular = 786;
  int max_linear_step = 250;
  int max_angular_step = 250;
  double motion_max_age_s = 0.3;  ///< of 0x221
  double state_max_age_s = 0.7;   ///< of 0x211, which comes every 100 to 200 ms
};

inline constexpr std::array kMayLeave{
    TxRule{.id = 0x111, .len = 8, .payload = Payload::Motion},
    // 1 CAN; 2 (serial) is nobody's business. Only to a base that says standby.
    TxRule{.id = 0x421, .len = 8, .max_code = 1, .zero_is_stop = true, .min_period_s = 0.45},
    TxRule{.id = 0x441, .len = 8, .max_code = 2, .min_period_s = 0.1},
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
  Refusal check(const CanFrame& frame, Time now) noexcept;
  Refusal check_motion(const CanFrame& frame, Time now) noexcept;
  Refusal check_code(const TxRule& rule, const CanFrame& frame, Time now) noexcept;
  bool fresh(Time now) const noexcept;

  const std::array<RxRule, 2> must_arrive_;
  const std::array<ValueRule, 2> values_;

  mutable std::mutex mutex_;  // guards all below
  bool permitted_ = false;
  std::array<std::optional<Time>, 2> seen_{};  ///< by row of must_arrive_
  std::uint8_t vehicle_state_ = 0xFF;          ///< byte 0 of the last 0x211
  std::uint8_t control_mode_ = 0xFF;           ///< byte 1
  std::optional<Time> last_motion_;
  std::array<int, 2> last_values_{};
  std::array<std::optional<Time>, kMayLeave.size()> last_code_{};
  Counts counts_{};
};

}  // namespace roverd::gate
