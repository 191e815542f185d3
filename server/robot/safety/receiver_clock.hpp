#pragma once
// Does a receiver's own time go on? One that restarts, plays a recording again and again or passes
// a week rollover steps back, and what it says meanwhile is not used.
//
//   times of two receivers in turn    10.0  9.6  10.2  9.8   none stepped: the newest goes on
//   a step                            10.0  7.0   7.2  7.4   three in a row below: back by 3.0 s
//
// Pure but for its memory; time is an argument.

#include <optional>

#include "base/time.hpp"

namespace roverd::robot {

class ReceiverClock {
 public:
  static constexpr int kInARow = 3;
  static constexpr double kStep_s = 0.5;  ///< less is the order of two receivers

  struct Step {
    base::Time stamp;  ///< arrival of the first one after it
    double back_s = 0.0;
  };

  /// Every fix. @param utc by the receiver; empty: it tells none. @param stamp arrival
  void take(const std::optional<base::WallTime>& utc, base::Time stamp) noexcept {
    if (!utc) return;
    if (!newest_ || *utc > *newest_) {
      newest_ = *utc;
      below_ = 0;
      return;
    }
    if (++below_ == 1) {
      first_ = {stamp, base::seconds(std::chrono::duration_cast<base::Duration>(*newest_ - *utc))};
    }
    if (below_ < kInARow) return;
    if (first_.back_s > kStep_s) step_ = first_;
    newest_ = *utc;
    below_ = 0;
  }

  /// The last one; empty: none yet.
  const std::optional<Step>& last_step() const noexcept { return step_; }

 private:
  std::optional<base::WallTime> newest_;
  Step first_;
  int below_ = 0;
  std::optional<Step> step_;
};

}  // namespace roverd::robot
