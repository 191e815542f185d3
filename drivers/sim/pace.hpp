#pragma once
// The plant's time against the machine's clock.

#include "base/time.hpp"

namespace roverd::sim {

/// Plant time runs with the clock. After a short delay it catches up; after a long one (the machine
/// slept, a debugger held the program) the missed time is dropped, because a burst of old frames
/// would only make the next delay longer.
class Pace {
 public:
  static constexpr base::Duration kCatchUp = std::chrono::milliseconds(250);

  /// @param now the clock at which plant time begins, equal to it.
  explicit Pace(base::Time now) : plant_(now) {}

  /// @param now the clock, never going backwards. @return plant time, never going backwards.
  base::Time advance(base::Time now) {
    const base::Time wanted = now - dropped_;
    if (wanted - plant_ > kCatchUp) {
      const base::Time kept = plant_ + kCatchUp;
      dropped_ += wanted - kept;
      plant_ = kept;
    } else if (wanted > plant_) {
      plant_ = wanted;
    }
    return plant_;
  }

  base::Duration dropped() const noexcept { return dropped_; }

 private:
  base::Time plant_;
  base::Duration dropped_{};
};

}  // namespace roverd::sim
