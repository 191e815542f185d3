#pragma once
// Two small watchmen over what the base tells. Pure state, no clock.

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/time.hpp"

namespace roverd::bunker {

/// A counter that should go up with every frame. Some bases keep it at one value for ever, which
/// proves nothing; one that was seen counting and then stands still is a frame that repeats itself.
class CountWatch {
 public:
  static constexpr double kFrozenAfter_s = 1.0;
  static constexpr int kAlive = 3;  ///< changes that make it a counter

  /// @return true if it stands still.
  bool add(std::uint8_t count, base::Time stamp) noexcept {
    if (!last_ || count != *last_) {
      if (last_) changes_ = std::min(changes_ + 1, kAlive);
      last_ = count;
      changed_ = stamp;
      frozen_ = false;
    } else {
      frozen_ = changes_ == kAlive && base::seconds(stamp - changed_) > kFrozenAfter_s;
    }
    return frozen_;
  }
  bool frozen() const noexcept { return frozen_; }

 private:
  std::optional<std::uint8_t> last_;
  base::Time changed_{};
  int changes_ = 0;
  bool frozen_ = false;
};

/// Do odometer and motion state turn the same way? Swapped cables or a wrong set-up show as tracks
/// that travel against the reported turn. Told after kSustained_s of turning in contradiction, and
/// taken back after as long in agreement.
class TurnWatch {
 public:
  static constexpr double kSustained_s = 2.0;
  static constexpr double kTurning_radps = 0.1;      ///< slower is no evidence
  static constexpr double kDifference_mps = 0.03;    ///< between the tracks, likewise
  static constexpr double kFresh_s = 0.2;            ///< of the motion state
  static constexpr double kLongestInterval_s = 0.1;  ///< what one reading may weigh

  void motion(double angular_radps, base::Time stamp) noexcept {
    angular_radps_ = angular_radps;
    heard_ = stamp;
  }

  /// Travel of both tracks since the reading before.
  void travel(double left_m, double right_m, base::Time stamp) noexcept {
    const double dt_s = last_ ? base::seconds(stamp - *last_) : 0.0;
    last_ = stamp;
    if (!heard_ || base::seconds(stamp - *heard_) > kFresh_s || dt_s <= 0.0) return;
    const double difference_m = right_m - left_m;
    const double turn_radps = angular_radps_;
    if (std::max(turn_radps, -turn_radps) < kTurning_radps ||
        std::max(difference_m, -difference_m) < kDifference_mps * dt_s) {
      return;
    }
    const double weight_s = std::min(dt_s, kLongestInterval_s);
    const bool agree = (difference_m > 0.0) == (turn_radps > 0.0);
    agreed_s_ = agree ? agreed_s_ + weight_s : 0.0;
    against_s_ = agree ? 0.0 : against_s_ + weight_s;
    if (against_s_ > kSustained_s) swapped_ = true;
    if (agreed_s_ > kSustained_s) swapped_ = false;
  }

  bool swapped() const noexcept { return swapped_; }

 private:
  double angular_radps_ = 0.0;
  std::optional<base::Time> heard_;
  std::optional<base::Time> last_;
  double agreed_s_ = 0.0;
  double against_s_ = 0.0;
  bool swapped_ = false;
};

}  // namespace roverd::bunker
