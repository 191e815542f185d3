#include "sim/machine.hpp"

#include <algorithm>

namespace roverd::sim {
namespace {

using base::ControlMode;
using base::Switch;
using base::VehicleState;

constexpr base::Duration kFlicker = std::chrono::milliseconds(150);

base::BodyTwist cut(base::BodyTwist twist, double linear_mps, double angular_radps) {
  return {std::clamp(twist.linear_mps, -linear_mps, linear_mps),
          std::clamp(twist.angular_radps, -angular_radps, angular_radps)};
}

base::BodyTwist from_sticks(const RadioParams& p, const Radio& radio) {
  const double drive = p.linear_stick == "left_ud" ? radio.left_ud : radio.right_ud;
  const double turn = p.turn_stick == "right_lr" ? radio.right_lr : radio.left_lr;
  return {drive * p.max_linear_mps, -turn * p.max_angular_radps};
}

}  // namespace

void Machine::request_mode(std::uint8_t mode, int fight_limit, Time now) {
  if (mode > 2) return;
  if (mode_ == ControlMode::Radio) {
    if (mode == 0) return;
    flicker_until_ = now + kFlicker;
    if (fight_limit > 0 && ++fights_ >= fight_limit) exception_ = true;
    return;
  }
  mode_ = mode == 0 ? ControlMode::Standby : mode == 1 ? ControlMode::Can : ControlMode::Uart;
}

void Machine::command(base::BodyTwist twist, Time now) {
  command_ = twist;
  commanded_ = now;
}

void Machine::follow_radio(const MachineInput& in) {
  if (in.radio_heard) {
    heard_once_ = true;
    if (in.radio.swb != Switch::Unknown) swb_ = in.radio.swb;
  }
  radio_lost_ = heard_once_ && !in.radio_heard;
  const bool sticks = in.radio_heard && (swb_ == Switch::Middle || swb_ == Switch::Down);
  if (sticks) {
    mode_ = ControlMode::Radio;
  } else if (mode_ == ControlMode::Radio) {
    mode_ = ControlMode::Standby;
    fights_ = 0;
  }
}

Wanted Machine::step(const Params& p, const MachineInput& in, Time now) {
  follow_radio(in);
  state_ = exception_ || in.motor_fault ? VehicleState::Exception
           : in.estop                   ? VehicleState::Estop
                                        : VehicleState::Normal;
  const bool fresh =
      commanded_ && now - *commanded_ <= base::from_seconds(p.drive.command_timeout_s);
  if (mode_ == ControlMode::Can && commanded_ && !fresh && p.drive.timeout_leaves_can) {
    mode_ = ControlMode::Standby;
    commanded_.reset();
  }
  if (state_ != VehicleState::Normal) return {{}, true};
  if (in.battery_fault) return {};
  base::BodyTwist twist{};
  if (mode_ == ControlMode::Radio) twist = from_sticks(p.radio, in.radio);
  if (mode_ == ControlMode::Can && fresh) twist = command_;
  return {cut(twist, p.drive.max_linear_mps, p.drive.max_angular_radps), false};
}

ControlMode Machine::shown_mode(Time now) const noexcept {
  return mode_ == ControlMode::Radio && now < flicker_until_ ? ControlMode::Can : mode_;
}

void Machine::power_cycle() {
  *this = Machine{};
}

}  // namespace roverd::sim
