#pragma once
// Turns on the spot: by an angle, or to a heading.
//
//   Idle ──to, by──▶ Brake ──stands──▶ Turn ──aligned for 0.2 s──▶ Done
//                                       └──three times its time is over──▶ Failed
//
// The angle that is left is counted from the driven yaw, without wrapping: 270 degrees to the left
// stay 270 degrees to the left, and a heading half a turn away keeps the side once chosen. The yaw
// is predicted over the actuation delay with the rates already sent.
// Control thread; no allocation.

#include <array>
#include <cstddef>

#include "nav/behave/ground.hpp"

namespace roverd::nav {

class RotateInPlace {
 public:
  enum class State { Idle, Brake, Turn, Done, Failed };

  /// The shorter way to a heading. @param rate_radps at most, over ground
  void to(double yaw_rad, double rate_radps) noexcept;
  /// @param angle_rad left positive, any size
  void by(double angle_rad, double rate_radps) noexcept;
  void reset() noexcept { *this = RotateInPlace{}; }

  TrackOutput step(const Vehicle& v, const PathParams& p, double dt_s) noexcept;

  State state() const noexcept { return state_; }
  /// Left to turn, left positive.
  double left_rad() const noexcept { return left_rad_; }

 private:
  void begin(double rate_radps) noexcept;
  void count(const Vehicle& v) noexcept;

  State state_ = State::Idle;
  bool absolute_ = false;
  bool counting_ = false;  ///< yaw_rad_ is known
  double goal_rad_ = 0.0;
  double left_rad_ = 0.0;
  double yaw_rad_ = 0.0;
  double most_radps_ = 0.0;
  double rate_radps_ = 0.0;  ///< last told
  double still_s_ = 0.0;
  double time_s_ = 0.0;
  double limit_s_ = 0.0;
  std::array<double, 64> sent_{};
  std::size_t sent_at_ = 0;
};

}  // namespace roverd::nav
