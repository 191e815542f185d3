#pragma once
// Increments of the two track odometers. Pure state, no clock.

#include <cmath>
#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "bunker/codec.hpp"

namespace roverd::bunker {

/// from → to over the 32-bit wrap-around, mm.
constexpr std::int32_t odometer_step_mm(std::int32_t from, std::int32_t to) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) -
                                   static_cast<std::uint32_t>(from));
}

/// Turns readings into travel. A step longer than max_mps allows for its time plus a margin is
/// impossible: it is refused and counted. One wild reading costs nothing, for the next good one is
/// measured from the last good one; when two readings in a row agree on the far place (the base was
/// switched off and on), counting goes on from there.
class Odometry {
 public:
  static constexpr double kMargin_m = 0.1;

  struct Travel {
    double left_m = 0.0;
    double right_m = 0.0;
  };

  explicit Odometry(double max_mps) noexcept : max_mps_(max_mps) {}

  /// @return travel since the last accepted reading; empty for the first one and for a refused one.
  std::optional<Travel> add(const Odometer& reading, base::Time stamp) noexcept {
    const Reading now{reading, stamp};
    if (!last_) {
      last_ = now;
      return std::nullopt;
    }
    if (const auto travel = possible(*last_, now)) {
      last_ = now;
      doubtful_.reset();
      return travel;
    }
    ++refused_;
    if (doubtful_ && possible(*doubtful_, now)) {
      last_ = now;
      doubtful_.reset();
    } else {
      doubtful_ = now;
    }
    return std::nullopt;
  }

  /// After a gap of unknown length: the next reading is a first one.
  void forget() noexcept {
    last_.reset();
    doubtful_.reset();
  }

  std::uint64_t refused() const noexcept { return refused_; }

 private:
  struct Reading {
    Odometer value;
    base::Time stamp;
  };

  std::optional<Travel> possible(const Reading& from, const Reading& to) const noexcept {
    const Travel t{odometer_step_mm(from.value.left_mm, to.value.left_mm) / 1000.0,
                   odometer_step_mm(from.value.right_mm, to.value.right_mm) / 1000.0};
    const double reach_m = max_mps_ * std::abs(base::seconds(to.stamp - from.stamp)) + kMargin_m;
    if (std::abs(t.left_m) > reach_m || std::abs(t.right_m) > reach_m) return std::nullopt;
    return t;
  }

  const double max_mps_;
  std::optional<Reading> last_;
  std::optional<Reading> doubtful_;
  std::uint64_t refused_ = 0;
};

}  // namespace roverd::bunker
