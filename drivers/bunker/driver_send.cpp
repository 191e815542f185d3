// The half of the Bunker driver that runs on the control thread: it touches its own members, the
// atomics and the gate, nothing else.

#include <cmath>

#include "bunker/driver.hpp"

namespace roverd::bunker {

using base::ControlMode;

namespace {

/// Largest growth of a command from one frame to the next; below the gate's own step, so that a
/// sudden wish becomes a few steps instead of a refusal. Five frames reach full speed.
constexpr double kMaxStep = 0.2;
/// After a longer pause the next command begins at zero, as the base's does.
constexpr double kPause_s = 0.3;

/// `to`, but not further from zero than the last value plus a step; a reversal begins at zero.
double eased(double last, double to) noexcept {
  const double from = (last < 0.0) == (to < 0.0) ? std::abs(last) : 0.0;
  const double most = from + kMaxStep;
  return std::abs(to) > most ? std::copysign(most, to) : to;
}

}  // namespace

void Driver::send(const base::DriveCommand& command, Time now) noexcept {
  if (!up_.load(std::memory_order_acquire)) return;
  const ControlMode mode = mode_.load(std::memory_order_acquire);
  if (command.enabled) {
    drive(command.twist, mode, now);
  } else {
    leave(mode, now);
  }
}

void Driver::drive(base::BodyTwist twist, ControlMode mode, Time now) noexcept {
  ours_.store(true, std::memory_order_relaxed);
  zeros_left_ = params_.stop_frames;
  if (mode == ControlMode::Standby) {
    const bool due =
        !last_request_ || base::seconds(now - *last_request_) >= params_.mode_request_period_s;
    const CanFrame request = encode(ControlModeCommand{RequestedMode::Can});
    if (due && transmit(request, now) == Outcome::Sent) last_request_ = now;
  }
  if (mode != ControlMode::Can) {
    last_motion_.reset();
    return;
  }
  if (!last_motion_ || base::seconds(now - *last_motion_) > kPause_s) last_twist_ = {};
  MotionCommand m = limited(twist, params_.max_linear_mps, params_.max_angular_radps);
  m.linear_mps = eased(last_twist_.linear_mps, m.linear_mps);
  m.angular_radps = eased(last_twist_.angular_radps, m.angular_radps);
  last_motion_ = now;
  if (transmit(encode(m), now) == Outcome::Refused) {
    last_twist_ = {};
    transmit(encode(MotionCommand{}), now);
  } else {  // also without room: the base still holds the command before, which was nearly this one
    last_twist_ = {.linear_mps = m.linear_mps, .angular_radps = m.angular_radps};
  }
}

void Driver::leave(ControlMode mode, Time now) noexcept {
  last_motion_.reset();
  if (!ours_.load(std::memory_order_relaxed)) return;
  // While the radio drives nothing is said; standby follows when it has given back.
  if (mode == ControlMode::Radio) return;
  if (zeros_left_ > 0) {
    --zeros_left_;
    transmit(encode(MotionCommand{}), now);
    return;
  }
  if (transmit(encode(ControlModeCommand{RequestedMode::Standby}), now) == Outcome::Sent) {
    ours_.store(false, std::memory_order_relaxed);
  }
}

bool Driver::clear_errors(Time now) noexcept {
  return up_.load(std::memory_order_acquire) &&
         transmit(encode(ClearErrors{}), now) == Outcome::Sent;
}

Driver::Outcome Driver::transmit(const CanFrame& frame, Time now) noexcept {
  if (!gate_.allows(frame, now)) return Outcome::Refused;
  link::FrameLink* link = link_.load(std::memory_order_acquire);
  if (link == nullptr || link->send(frame) != link::SendResult::Sent) return Outcome::NoRoom;
  sent_.fetch_add(1, std::memory_order_relaxed);
  return Outcome::Sent;
}

}  // namespace roverd::bunker
