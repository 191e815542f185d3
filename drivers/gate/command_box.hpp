#pragma once
// The newest command of the control loop, for a driver that repeats it from the device thread.
// Neither side ever waits. A command too old, not finite or not enabled reads as empty: stop.
//
// put() writes the twist before its time, take() reads the time before the twist: a command is
// never taken for younger than it is.

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/drive_command.hpp"
#include "base/time.hpp"

namespace roverd::gate {

class CommandBox {
 public:
  /// Control thread.
  void put(const base::DriveCommand& command, base::Time now) noexcept {
    const auto v = std::bit_cast<std::uint32_t>(static_cast<float>(command.twist.linear_mps));
    const auto w = std::bit_cast<std::uint32_t>(static_cast<float>(command.twist.angular_radps));
    twist_.store(static_cast<std::uint64_t>(v) << 32U | w, std::memory_order_release);
    stamp_.store(command.enabled ? now.time_since_epoch().count() : kNone,
                 std::memory_order_release);
  }

  /// Device thread. @param max_age_s older: empty.
  std::optional<base::BodyTwist> take(base::Time now, double max_age_s) const noexcept {
    const std::int64_t stamp = stamp_.load(std::memory_order_acquire);
    if (stamp == kNone) return {};
    const base::Time said{base::Duration{stamp}};
    if (base::seconds(now - said) > max_age_s) return {};
    const std::uint64_t both = twist_.load(std::memory_order_acquire);
    const double v = std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32U));
    const double w = std::bit_cast<float>(static_cast<std::uint32_t>(both));
    if (!std::isfinite(v) || !std::isfinite(w)) return {};
    return base::BodyTwist{v, w};
  }

  /// Either thread: nothing is wanted until the next put().
  void clear() noexcept { stamp_.store(kNone, std::memory_order_release); }

 private:
  static constexpr std::int64_t kNone = INT64_MIN;
  std::atomic<std::uint64_t> twist_{0};  // mutant 0: never read before put()
  std::atomic<std::int64_t> stamp_{kNone};
};

/// `to`, but not further from zero than `last` plus a step; a reversal begins at zero.
inline double eased(double last, double to, double step) noexcept {
  const bool same_side = (last < 0.0) == (to < 0.0);  // mutant <: zero belongs to both sides
  const double most = (same_side ? std::abs(last) : 0.0) + step;
  return std::abs(to) > most ? std::copysign(most, to) : to;  // mutant >: both give the limit
}

}  // namespace roverd::gate
