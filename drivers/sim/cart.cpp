#include "sim/cart.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bumper/codec.hpp"

namespace roverd::sim {
namespace {

using base::ControlMode;

/// A bumper repeats itself ten times a second.
constexpr int kBumperSteps = 20;

/// Full stick to the right is full lock to the right.
Order by_sticks(const Params& p, const Radio& radio) {
  const double ahead = p.radio.linear_stick == "left_ud" ? radio.left_ud : radio.right_ud;
  const double right = p.radio.turn_stick == "right_lr" ? radio.right_lr : radio.left_lr;
  Order o;
  o.drive = true;
  o.speed_mps = ahead * p.radio.max_linear_mps;
  o.wheel_rad = -right * p.car.max_wheel_rad;
  o.twist = {o.speed_mps, -right * p.radio.max_angular_radps};
  return o;
}

double within(double value, double most) {
  return std::clamp(value, -most, most);
}

}  // namespace

Cart::Cart(const Params& params, std::uint64_t seed, const Start& start)
    : Vehicle(params, seed, start),
      wire_(make_wire(params.device.wire, params.drive.track_width_m)),
      steered_(params.device.wire == "ackermann"),
      tracks_(seed),
      to_base_(seed, Stream::LossToBase),
      from_base_(seed, Stream::LossFromBase) {}

void Cart::receive(Bytes bytes) {
  const bool lost = to_base_.uniform() < faults().loss_to_base;
  if (lost || faults().bus_off) return;
  const int count = wire_->receive(bytes);
  if (count == 0) return;
  commands_ += static_cast<std::uint64_t>(count);
  commanded_ = now();
}

/// Who drives, and whereto.
Order Cart::wanted() {
  const Params& p = params();
  const bool sticks =
      radio_heard() && (radio().swb == base::Switch::Middle || radio().swb == base::Switch::Down);
  const bool fresh =
      commanded_ && now() - *commanded_ <= base::from_seconds(p.drive.command_timeout_s);
  const bool obeys = fresh && wire_->order().drive;
  mode_ = sticks ? ControlMode::Radio : obeys ? ControlMode::Can : ControlMode::Standby;
  Order o;
  if (sticks) o = by_sticks(p, radio());
  if (!sticks && obeys) o = wire_->order();
  if (battery().fault(p.battery)) o = {};
  o.speed_mps = within(o.speed_mps, p.drive.max_linear_mps);
  o.twist = {within(o.twist.linear_mps, p.drive.max_linear_mps),
             within(o.twist.angular_radps, p.drive.max_angular_radps)};
  return o;
}

Vehicle::Moved Cart::drive(double dt_s) {
  const Order order = wanted();
  state_ = faults().error_bits != 0 ? base::VehicleState::Exception
           : faults().estop         ? base::VehicleState::Estop
                                    : base::VehicleState::Normal;
  return roll(order, state_ != base::VehicleState::Normal, dt_s);
}

Vehicle::Moved Cart::roll(const Order& order, bool brake, double dt_s) {
  const Params& p = params();
  const ForeignState* foreign =
      foreign_moved({0.0, brake, steered_ ? order.speed_mps : order.twist.linear_mps,
                     steered_ ? 0.0 : order.twist.angular_radps, order.wheel_rad});
  if (steered_) {
    if (foreign != nullptr) {
      car_.follow(foreign->left_mps, foreign->wheel_rad);
    } else {
      car_.step(drive_now(), p.car, {order.speed_mps * reach(), order.wheel_rad}, brake, dt_s);
    }
    car_travel_m_ += car_.wheel_speed_mps() * dt_s;
    odometer_.step(faults(), car_travel_m_, car_travel_m_, {car_.wheel_speed_mps(), 0.0},
                   p.drive.track_width_m);
    return {car_.ground(), car_.power_w(), 0.0, std::abs(car_.wheel_speed_mps())};
  }
  const base::BodyTwist reached{order.twist.linear_mps * reach(),
                                order.twist.angular_radps * reach()};
  if (foreign != nullptr) {
    tracks_.follow(p.drive, foreign->left_mps, foreign->right_mps, dt_s);
  } else {
    tracks_.step(drive_now(), reached, brake, dt_s);
  }
  const MotorState& left = tracks_.left();
  const MotorState& right = tracks_.right();
  odometer_.step(faults(), left.travel_m, right.travel_m, tracks_.measured(),
                 p.drive.track_width_m);
  return {tracks_.ground(), left.power_w + right.power_w, right.current_a - left.current_a,
          tracks_.travel_mps()};
}

Condition Cart::condition() const {
  const Params& p = params();
  Condition c;
  if (steered_) {
    const double told_mps = odometer_.twist().linear_mps;
    c.twist = {told_mps, told_mps * std::tan(car_.seen_rad()) / p.car.wheelbase_m};
    c.left_m = odometer_.left_m();
    c.right_m = odometer_.right_m();
  } else {
    c.twist = odometer_.twist();
    c.left_m = odometer_.left_m();
    c.right_m = odometer_.right_m();
  }
  c.wheel_rad = car_.seen_rad();
  c.battery_v = battery().voltage_v();
  c.by_hand = mode_ == ControlMode::Radio;
  c.obeying = mode_ == ControlMode::Can && state_ == base::VehicleState::Normal;
  c.watchdog = !commanded_ || now() - *commanded_ > base::from_seconds(p.drive.command_timeout_s);
  c.motor_fault = state_ == base::VehicleState::Exception;
  c.low_battery = battery().fault(p.battery);
  c.estop = faults().estop;
  return c;
}

void Cart::report() {
  const double hz = params().device.feedback_hz;
  if (hz > 0.0 && every(std::max(1, static_cast<int>(std::lround(200.0 / hz))), 0)) {
    const auto bytes = wire_->report(condition());
    const bool lost = from_base_.uniform() < faults().loss_from_base;
    if (!lost && !faults().bus_off && on_drive) on_drive(bytes, now());
  }
  if (params().device.bumper) say_bumper();
}

/// At every change, and again and again.
void Cart::say_bumper() {
  if (faults().bumper_silent || (said_bumper_ == faults().bumper && !every(kBumperSteps, 3))) {
    return;
  }
  said_bumper_ = faults().bumper;
  const std::string line = bumper::encode(static_cast<std::uint8_t>(faults().bumper));
  if (on_bumper)
    on_bumper({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, now());
}

void Cart::describe(Truth& t) const {
  t.left_track_mps = steered_ ? car_.wheel_speed_mps() : tracks_.left().track_mps;
  t.right_track_mps = steered_ ? car_.wheel_speed_mps() : tracks_.right().track_mps;
  t.wheel_rad = car_.wheel_rad();
  t.control_mode = mode_;
  t.vehicle_state = state_;
  t.commands = commands_;
}

void Cart::halt() {
  tracks_.halt();
  car_.halt();
}

void Cart::restart() {
  wire_->forget();
  commanded_.reset();
  tracks_.zero_odometer();
  car_travel_m_ = 0.0;
  odometer_ = {};
}

}  // namespace roverd::sim
