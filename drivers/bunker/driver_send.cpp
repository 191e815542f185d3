// What the Bunker driver says. send() and what it calls run on the control thread and touch their
// own members, the atomics and the gate, nothing else; lights and error clearing are the device
// thread's.

#include "bunker/driver.hpp"
#include "gate/command_box.hpp"

namespace roverd::bunker {

using base::ControlMode;

namespace {

/// Largest growth of a command from one frame to the next; below the gate's own step, so that a
/// sudden wish becomes a few steps instead of a refusal. Five frames reach full speed.
constexpr double kMaxStep = 0.2;
/// After a longer pause the next command begins at zero, as the base's does.
constexpr double kPause_s = 0.3;

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
  if (mode == ControlMode::Standby) ask(now);
  if (mode != ControlMode::Standby) asked_since_.store(0, std::memory_order_relaxed);
  if (mode != ControlMode::Can) {
    last_motion_.reset();
    return;
  }
  if (!last_motion_ || base::seconds(now - *last_motion_) > kPause_s) last_twist_ = {};
  MotionCommand m = limited(twist, params_.max_linear_mps, params_.max_angular_radps);
  m.linear_mps = gate::eased(last_twist_.linear_mps, m.linear_mps, kMaxStep);
  m.angular_radps = gate::eased(last_twist_.angular_radps, m.angular_radps, kMaxStep);
  last_motion_ = now;
  if (transmit(motion_frame(m), now) == Outcome::Refused) {
    last_twist_ = {};
    transmit(motion_frame({}), now);
  } else {  // also without room: the base still holds the command before, which was nearly this one
    last_twist_ = {.linear_mps = m.linear_mps, .angular_radps = m.angular_radps};
  }
}

void Driver::ask(Time now) noexcept {
  const bool due =
      !last_request_ || base::seconds(now - *last_request_) >= params_.mode_request_period_s;
  if (!due || transmit(mode_frame(RequestedMode::Can), now) != Outcome::Sent) return;
  last_request_ = now;
  Time::rep none = 0;
  asked_since_.compare_exchange_strong(none, now.time_since_epoch().count());
}

void Driver::leave(ControlMode mode, Time now) noexcept {
  last_motion_.reset();
  asked_since_.store(0, std::memory_order_relaxed);
  if (!ours_.load(std::memory_order_relaxed)) return;
  // While the radio drives nothing is said; standby follows when it has given back.
  if (mode == ControlMode::Radio) return;
  if (zeros_left_ > 0) {
    --zeros_left_;
    transmit(zero_frame(mode), now);
    return;
  }
  if (transmit(mode_frame(RequestedMode::Standby), now) == Outcome::Sent) {
    ours_.store(false, std::memory_order_relaxed);
  }
}

CanFrame Driver::motion_frame(const MotionCommand& m) noexcept {
  if (!speaks_v1_.load(std::memory_order_acquire)) return encode(m);
  v1::Command c{.mode = v1::RequestedMode::Can};
  c.linear_pct = v1::percent(m.linear_mps, params_.v1_full_linear_mps, params_.max_linear_mps);
  c.angular_pct =
      v1::percent(m.angular_radps, params_.v1_full_angular_radps, params_.max_angular_radps);
  c.count = v1_count_.fetch_add(1, std::memory_order_relaxed);
  return encode(c);
}

CanFrame Driver::zero_frame(ControlMode mode) noexcept {
  const bool v1 = speaks_v1_.load(std::memory_order_acquire);
  return v1 && mode != ControlMode::Can ? mode_frame(RequestedMode::Standby) : motion_frame({});
}

CanFrame Driver::mode_frame(RequestedMode mode) noexcept {
  if (!speaks_v1_.load(std::memory_order_acquire)) return encode(ControlModeCommand{mode});
  v1::Command c{.mode = static_cast<v1::RequestedMode>(mode)};
  c.count = v1_count_.fetch_add(1, std::memory_order_relaxed);
  return encode(c);
}

bool Driver::set_lights(const base::LightState& l, Time now) noexcept {
  const auto in_range = [](int value, int most) { return value >= 0 && value <= most; };
  if (!up_.load(std::memory_order_acquire) || !in_range(l.front_mode, 3) ||
      !in_range(l.rear_mode, 3) || !in_range(l.front_pct, 100) || !in_range(l.rear_pct, 100)) {
    return false;
  }
  const Light wanted{.enabled = l.commanded,
                     .front_mode = static_cast<LightMode>(l.front_mode),
                     .front_value = static_cast<std::uint8_t>(l.front_pct),
                     .rear_mode = static_cast<LightMode>(l.rear_mode),
                     .rear_value = static_cast<std::uint8_t>(l.rear_pct),
                     .count = light_count_};
  const bool v1 = speaks_v1_.load(std::memory_order_acquire);
  const CanFrame f = v1 ? encode(v1::LightCommand{wanted}) : encode(LightCommand{wanted});
  if (transmit(f, now) != Outcome::Sent) return false;
  ++light_count_;
  return true;
}

bool Driver::clear_errors(int motor, Time now) noexcept {
  if (!up_.load(std::memory_order_acquire) || motor < 0 || motor > 2) return false;
  if (!speaks_v1_.load(std::memory_order_acquire)) {
    return transmit(encode(ClearErrors{static_cast<std::uint8_t>(motor)}), now) == Outcome::Sent;
  }
  clear_next_ = motor == 0 ? 1 : static_cast<std::uint8_t>(v1::kClearMotor1 + motor - 1);
  clear_all_ = motor == 0;
  return clear_next(now);
}

bool Driver::clear_next(Time now) noexcept {
  const bool in_can = mode_.load(std::memory_order_acquire) == ControlMode::Can;
  v1::Command c{.mode = in_can ? v1::RequestedMode::Can : v1::RequestedMode::Radio};
  c.clear = clear_next_;
  c.count = v1_count_.fetch_add(1, std::memory_order_relaxed);
  clear_at_ = now;
  const bool more = clear_all_ && clear_next_ < v1::kClearLast;
  clear_next_ = more ? static_cast<std::uint8_t>(clear_next_ + 1) : std::uint8_t{0};
  return transmit(encode(c), now) == Outcome::Sent;
}

void Driver::ask_firmware(Time now) noexcept {
  if (!up_.load(std::memory_order_acquire) || speaks_v1_.load(std::memory_order_acquire)) return;
  if (!params_.ask_firmware || firmware_asks_ == kFirmwareAsks || !interpreter_.firmware().empty())
    return;
  if (now - firmware_at_ < kFirmwarePause) return;
  const bool as_text = firmware_asks_ % 2 == 0;
  transmit(encode(VersionRequest{as_text}), now);
  ++firmware_asks_;
  firmware_at_ = now;
}

Driver::Outcome Driver::transmit(const CanFrame& frame, Time now) noexcept {
  if (!gate_.allows(frame, now)) return Outcome::Refused;
  link::FrameLink* link = link_.load(std::memory_order_acquire);
  if (link == nullptr || link->send(frame) != link::SendResult::Sent) return Outcome::NoRoom;
  sent_.fetch_add(1, std::memory_order_relaxed);
  return Outcome::Sent;
}

}  // namespace roverd::bunker
