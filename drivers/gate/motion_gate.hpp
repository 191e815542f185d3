#pragma once
// The last door of the drivers that speak messages of their own instead of CAN frames. The driver
// encodes its message, decodes those very bytes again, and asks with what came out: a fault of the
// limits above or of the encoder stays inside.
//
// Default silent. A message that moves leaves only while all of this holds: permit(true) was
// called, feedback is fresh (where the vehicle gives any), both values are finite and in their
// limit, and neither has stepped by more than its step since the last message. A stop (speed zero,
// not driving, turn in its limit) always leaves.
//
// Device thread only. noexcept, no allocation, no clock: time is an argument.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "gate/gate.hpp"

namespace roverd::gate {

/// What the bytes say. `turn` is the message's second value, whatever it is: turn rate, wheel
/// angle, ratio.
struct Motion {
  double speed = 0.0;
  double turn = 0.0;
  bool drives = false;  ///< the mode or enable field asks the vehicle to move
};

struct MotionLimits {
  double max_speed = 0.0;
  double max_turn = 0.0;
  double max_speed_step = 0.0;  ///< growth away from zero; to slow down is always allowed
  double max_turn_step = 0.0;
  bool turn_holds = false;          ///< a wheel angle: each change is a step, also back to zero
  double feedback_max_age_s = 0.0;  ///< 0: this vehicle tells nothing
};

class MotionGate {
 public:
  explicit MotionGate(const MotionLimits& limits) noexcept : limits_(limits) {}

  void permit(bool on) noexcept {
    permitted_ = on;
    if (!on) fed_.reset();
  }
  /// From now on fresh feedback is needed (or not any more).
  void need_feedback(double max_age_s) noexcept { limits_.feedback_max_age_s = max_age_s; }
  /// Intact feedback arrived.
  void saw(Time now) noexcept { fed_ = now; }

  /// @param decoded what the bytes say that are about to leave; empty: they do not decode.
  Refusal check(const std::optional<Motion>& decoded, Time now) noexcept {
    const Refusal refusal = judge(decoded, now);
    if (refusal != Refusal::None) {
      ++refused_[static_cast<std::size_t>(refusal)];
      return refusal;
    }
    last_ = *decoded;
    last_at_ = now;
    begun_ = true;
    return refusal;
  }
  bool allows(const std::optional<Motion>& decoded, Time now) noexcept {
    return check(decoded, now) == Refusal::None;
  }

  /// By Refusal.
  const std::array<std::uint64_t, kRefusals>& refused() const noexcept { return refused_; }
  std::uint64_t refused_total() const noexcept {
    std::uint64_t sum = 0;
    for (const std::uint64_t n : refused_) sum += n;
    return sum;
  }

 private:
  /// After so long a silence the vehicle has stopped: steps count from zero.
  static constexpr double kForgotten_s = 0.6;

  Refusal judge(const std::optional<Motion>& m, Time now) const noexcept {
    if (!m || !std::isfinite(m->speed) || !std::isfinite(m->turn)) return Refusal::WrongContent;
    if (std::abs(m->turn) > limits_.max_turn) return Refusal::TooLarge;
    const bool turns = m->turn != 0.0 && !limits_.turn_holds;
    if (!m->drives) {
      return m->speed == 0.0 && !turns ? Refusal::None : Refusal::WrongContent;
    }
    if (!permitted_) return Refusal::NotPermitted;
    if (!fresh(now)) return Refusal::Stale;
    if (std::abs(m->speed) > limits_.max_speed) return Refusal::TooLarge;
    const bool running = begun_ && base::seconds(now - last_at_) < kForgotten_s;
    const Motion from = running ? last_ : Motion{0.0, limits_.turn_holds ? last_.turn : 0.0, false};
    if (growth(from.speed, m->speed) > limits_.max_speed_step) return Refusal::TooSudden;
    const double turn_step =
        limits_.turn_holds ? std::abs(m->turn - from.turn) : growth(from.turn, m->turn);
    return turn_step > limits_.max_turn_step ? Refusal::TooSudden : Refusal::None;
  }

  bool fresh(Time now) const noexcept {
    return limits_.feedback_max_age_s <= 0.0 ||
           (fed_ && base::seconds(now - *fed_) <= limits_.feedback_max_age_s);
  }

  /// How far `to` lies beyond `from`, away from zero. A change of sign counts from zero.
  static double growth(double from, double to) noexcept {
    const bool same_side = (from < 0.0) == (to < 0.0);  // mutant <: zero belongs to both sides
    return std::abs(to) - (same_side ? std::abs(from) : 0.0);
  }

  MotionLimits limits_;
  bool permitted_ = false;
  std::optional<Time> fed_;
  Motion last_{};
  bool begun_ = false;  ///< last_at_ means something; GCC 12 misreads an optional here
  Time last_at_{};
  std::array<std::uint64_t, kRefusals> refused_{};
};

}  // namespace roverd::gate
