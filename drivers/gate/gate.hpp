#pragma once
// The last door before whatever moves. It reads the raw bytes of every message that wants to leave,
// and trusts nobody: not the tracker, not the limits above it, not the codec that made the bytes.
// One core for every vehicle; what differs stands in tables (gate/table.hpp, gate/vehicles.hpp):
//
//   may leave      id, length, what each byte may hold, which of them are speeds, how far a speed
//                  may step, how often a request
//   must arrive    id, length, and how old it may be while the vehicle moves
//
// Default silent: what is not listed stays inside. Motion (any speed but zero) leaves only while
// all of this holds: permit(true) was called, all that must arrive is fresh, the vehicle says,
// where it says such things, that it is normal and drives by our commands, no other protocol is
// heard, every value is in its limit and has not grown by more than its step since the last motion
// message that left. Always allowed, whatever else is wrong: zero motion, and standby.
//
// Threads: allows() may be called by the control loop, the others by the device thread. One mutex
// guards everything; it is a leaf (nothing is locked or called while it is held) and held for about
// a microsecond. noexcept, no allocation, no clock: time is an argument. The constructor allocates.

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "base/bytes.hpp"
#include "base/time.hpp"
#include "gate/reading.hpp"
#include "gate/table.hpp"
#include "gate/vehicles.hpp"

namespace roverd::gate {

using base::CanFrame;
using base::Duration;
using base::Time;

/// Why a message stayed inside.
enum class Refusal {
  None,
  NotListed,     ///< unknown id, or not a plain 11-bit data frame
  WrongLength,   ///< exactly the table's length leaves
  WrongContent,  ///< a byte, number or checksum that the table does not have; half a stop
  NotPermitted,  ///< permit(false), or never permitted
  Stale,         ///< feedback is too old
  NotReady,      ///< motion: not normal or not driven by us; a request to drive: not in standby
  TooLarge,      ///< beyond the limit
  TooSudden,     ///< beyond the step
  TooOften,
  TwoProtocols,  ///< two are heard: whose vehicle is it?
};
inline constexpr std::size_t kRefusals = 11;

class Gate {
 public:
  /// @param tables the protocols of one vehicle. Negative limits: nothing moves.
  explicit Gate(const std::vector<Table>& tables);

  /// A frame arrived. Remote, error, extended, short and damaged frames prove nothing.
  void saw(const CanFrame& frame, Time now) noexcept;
  /// The feedback without an id arrived intact: the driver vouches for it.
  void saw(Time now) noexcept;
  /// May this leave now? What may is taken for sent.
  bool allows(const CanFrame& frame, Time now) noexcept;
  bool allows(base::Bytes message, Time now) noexcept;
  /// Motion and requests leave only between permit(true) and permit(false). permit(false) also
  /// forgets all feedback: permission begins with fresh messages.
  void permit(bool on) noexcept;
  /// A new start: feedback that is needed once it was heard was not heard yet.
  void renew() noexcept;
  /// Is a message with this id in the tables of what may leave?
  bool lists(std::uint32_t id) const noexcept;

  struct Counts {
    std::uint64_t allowed = 0;
    std::array<std::uint64_t, kRefusals> refused{};  ///< by Refusal
    std::uint64_t refused_total() const noexcept;
  };
  Counts counts() const noexcept;

 private:
  /// A row of the table, and when it last came true.
  struct Heard {
    Feedback rule;
    std::optional<Time> at = {};
    bool once = false;  ///< since renew()
  };
  struct Asked {
    Request rule;
    std::optional<Time> at = {};
  };
  struct Told {
    std::uint8_t vehicle_state;
    std::uint8_t control_mode;
  };
  /// One protocol, and what it has told.
  struct Side {
    explicit Side(const Table& table);
    bool drives() const noexcept { return told && told->control_mode == state->drives; }
    bool stands_by() const noexcept { return told && told->control_mode == state->standby; }
    bool is_normal() const noexcept { return told && told->vehicle_state == state->normal; }

    Motion motion;
    Asked asked;  ///< by motion messages
    std::vector<Asked> requests;
    std::vector<Heard> heard;
    std::optional<State> state;  ///< of the feedback that tells one
    std::optional<Told> told;
  };

  static void take(Side& side, const Wire& wire, Time now) noexcept;
  bool judged(Refusal refusal) noexcept;
  Refusal check(const Wire& wire, Time now) noexcept;
  Refusal check_motion(Side& side, const Wire& wire, Time now) noexcept;
  Refusal check_request(const Side& side, Asked& asked, const Wire& wire, Time now) noexcept;
  /// May a request leave? Permission, standby where it is to drive, not too often.
  Refusal check_asking(const Side& side, Asked& asked, bool to_drive, Time now) noexcept;
  /// Everything that motion needs, and its values.
  Refusal check_speeds(const Side& side, const Said& said, Time now) const noexcept;
  /// @param same_side the last motion message was of this protocol.
  Refusal check_steps(const Motion& motion, bool same_side, const Said& said,
                      Time now) const noexcept;

  mutable std::mutex mutex_;  // guards all below
  bool permitted_ = false;
  std::vector<Side> sides_;
  const Side* last_side_ = nullptr;  ///< of the last motion message that left, if one did
  Time last_at_{};
  std::array<double, 2> last_values_{};
  Counts counts_{};
};

}  // namespace roverd::gate
