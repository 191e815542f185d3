#pragma once
// The times of a tick, and how well the loop keeps them. Control thread.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

#include "base/snapshot.hpp"

namespace roverd::robot {

class LoopClock {
 public:
  /// A tick begins. @param now never goes backwards. @param lateness of its wake-up
  void begin(base::Time now, base::WallTime wall, base::Duration lateness) noexcept {
    now_ = now;
    wall_ = wall;
    dt_s_ = last_ ? std::clamp(base::seconds(now - *last_), 0.001, 0.1) : 0.02;
    last_ = now;
    ++health_.ticks;
    health_.last_lateness_s = base::seconds(lateness);
    if (lateness > std::chrono::milliseconds(20)) ++health_.late_ticks;
    const auto us = std::max<std::int64_t>(0, lateness.count() / 1000);
    const auto bin = static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(us)));
    ++health_.lateness_log2_us[std::min(bin, health_.lateness_log2_us.size() - 1)];
  }
  /// An exception ended the tick. @return whether it is to be told: the last one was long ago.
  bool fault() noexcept {
    ++health_.faults;
    if (told_ && now_ - *told_ < std::chrono::seconds(10)) return false;
    told_ = now_;
    return true;
  }

  base::Time now() const noexcept { return now_; }
  base::WallTime wall() const noexcept { return wall_; }
  /// Since the tick before; 0.02 at the first, never more than 0.1.
  double dt_s() const noexcept { return dt_s_; }
  const base::LoopHealth& health() const noexcept { return health_; }

 private:
  base::Time now_{};
  base::WallTime wall_{};
  std::optional<base::Time> last_;
  double dt_s_ = 0.02;
  base::LoopHealth health_;
  std::optional<base::Time> told_;
};

}  // namespace roverd::robot
