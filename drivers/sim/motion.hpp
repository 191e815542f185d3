#pragma once
// Words and small machines of moving things.

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/geo.hpp"

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
    const T oldest = pipe_.empty() ? T{} : pipe_.front();
    while (pipe_.size() < length) pipe_.push_front(oldest);
    pipe_.push_back(in);
    T out = in;
    while (pipe_.size() > length) {
      out = pipe_.front();
      pipe_.pop_front();
    }
    return out;
  }
  void clear() noexcept { pipe_.clear(); }

 private:
  std::deque<T> pipe_;  ///< on their way, oldest first
};

}  // namespace roverd::sim
