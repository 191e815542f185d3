#pragma once
// Words and small machines of moving things.

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/geo.hpp"
#include "sim/noise.hpp"

namespace roverd::sim {

struct GroundMotion {
  base::BodyTwist twist;     ///< at the body's origin
  double lateral_mps = 0.0;  ///< left positive: the centre of rotation is not the origin
};

/// Below these a motor that is told to stand, stands: an exponential lag alone never ends.
inline constexpr double kStandLinear_mps = 0.003;
inline constexpr double kStandAngular_radps = 0.005;

/// Towards `target`, faster growing than falling or the other way round. Through zero it falls.
inline double slew(double now, double target, double grow_step, double fall_step) {
  const bool falling = now * target < 0.0 || std::abs(target) < std::abs(now);
  const double step = falling ? fall_step : grow_step;
  const double next = now + std::clamp(target - now, -step, step);
  return now * next < 0.0 ? 0.0 : next;
}

/// What part of the way to its target a first-order lag makes in one step.
inline double lag_share(double lag_s, double dt_s) {
  return lag_s > 0.0 ? 1.0 - std::exp(-dt_s / lag_s) : 1.0;
}

/// A standing wheel ignores a command too small to overcome friction.
inline double unstick(double now_mps, double target_mps, double stick_mps) {
  return now_mps == 0.0 && std::abs(target_mps) < stick_mps ? 0.0 : target_mps;
}

/// A pure delay of whole steps; before anything was put in, the default value comes out.
template <class T>
class Delay {
 public:
  T step(const T& in, double delay_s, double dt_s) {
    const auto length = static_cast<std::size_t>(std::lround(delay_s / dt_s));
    const T oldest = pipe_.empty() ? last_ : pipe_.front();
    while (pipe_.size() < length) pipe_.push_front(oldest);
    pipe_.push_back(in);
    T out = in;
    while (pipe_.size() > length) {
      out = pipe_.front();
      pipe_.pop_front();
    }
    last_ = out;
    return out;
  }
  void clear() noexcept {
    pipe_.clear();
    last_ = {};
  }

 private:
  T last_{};            ///< came out
  std::deque<T> pipe_;  ///< on their way, oldest first
};

/// What comes on top of a pure delay: uniform up to a most, drawn anew every now and then.
class Jitter {
 public:
  explicit Jitter(std::uint64_t seed) : draws_(seed, Stream::DelayJitter) {}

  /// Once a step. @return seconds, 0..most_s.
  double step(double most_s, double hold_s, double dt_s) {
    held_s_ -= dt_s;
    if (held_s_ <= 0.0) {
      share_ = draws_.uniform();
      held_s_ = hold_s;
    }
    return most_s * share_;
  }

 private:
  Noise draws_;
  double share_ = 0.0;
  double held_s_ = 0.0;
};

}  // namespace roverd::sim
