#include "sim/bunker.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "bunker/v1.hpp"
#include "sim/base_v1.hpp"
#include "sim/reports.hpp"

namespace roverd::sim {
namespace {

constexpr std::uint16_t kBatteryFaultBit = 1u << 0;
constexpr std::uint16_t kBatteryWarningBit = 1u << 1;
constexpr std::uint16_t kRadioLostBit = 1u << 2;
constexpr std::uint16_t kMotorBits = 1u << 3 | 1u << 4 | 1u << 8;
constexpr std::uint16_t kSeenWithEstopBit = 1u << 7;
constexpr std::uint16_t kV1BatteryWarningBit = 1u << 11;
constexpr std::uint16_t kV1RadioLostBit = 1u << 12;
constexpr double kAmbient_c = 25.0;

/// A motor's heat follows the square of its current within minutes.
double warmed(double heat_c, double current_a, double dt_s) {
  return heat_c + (0.3 * current_a * current_a - heat_c) * dt_s / 300.0;
}

}  // namespace

Bunker::Bunker(const Params& params, std::uint64_t seed, const Start& start)
    : Vehicle(params, seed, start),
      tracks_(seed),
      to_base_(seed, Stream::LossToBase),
      from_base_(seed, Stream::LossFromBase) {}

std::uint16_t Bunker::error_code() const noexcept {
  unsigned code = static_cast<unsigned>(faults().error_bits);
  if (battery().fault(params().battery)) code |= kBatteryFaultBit;
  if (battery().warning(params().battery)) code |= kBatteryWarningBit;
  if (machine_.radio_lost() && !faults().radio_loss_unflagged) code |= kRadioLostBit;
  if (machine_.state() == base::VehicleState::Estop) code |= kSeenWithEstopBit;
  return static_cast<std::uint16_t>(code);
}

Vehicle::Moved Bunker::drive(double dt_s) {
  const Wanted wanted =
      machine_.step(params(),
                    {.radio = radio(),
                     .radio_heard = radio_heard(),
                     .estop = faults().estop,
                     .battery_fault = battery().fault(params().battery),
                     .motor_fault = (static_cast<unsigned>(faults().error_bits) & kMotorBits) != 0},
                    now());
  const base::BodyTwist reached{wanted.twist.linear_mps * reach(),
                                wanted.twist.angular_radps * reach()};
  const ForeignState* foreign = foreign_moved(
      {0.0, wanted.brake, wanted.twist.linear_mps, wanted.twist.angular_radps, std::nullopt});
  if (foreign != nullptr) {
    tracks_.follow(params().drive, foreign->left_mps, foreign->right_mps, dt_s);
  } else {
    tracks_.step(drive_now(), reached, wanted.brake, dt_s);
  }
  const MotorState& left = tracks_.left();
  const MotorState& right = tracks_.right();
  odometer_.step(faults(), left.travel_m, right.travel_m, tracks_.measured(),
                 params().drive.track_width_m);
  left_heat_c_ = warmed(left_heat_c_, left.current_a, dt_s);
  right_heat_c_ = warmed(right_heat_c_, right.current_a, dt_s);
  return {tracks_.ground(), left.power_w + right.power_w, right.current_a - left.current_a,
          tracks_.travel_mps()};
}

/// The periods of the real base; the phases spread the load over the bus.
void Bunker::report() {
  if (every(20, 13)) report_lights();
  if (speaks_v1()) return report_v1();
  if (every(4, 0)) {
    const base::BodyTwist t = odometer_.twist();
    send(bunker::encode(bunker::MotionState{{t.linear_mps, t.angular_radps, 0.0, 0.0}}));
    send(bunker::encode(
        bunker::Odometer{wrapped_mm(odometer_.left_m()), wrapped_mm(odometer_.right_m())}));
  }
  if (every(4, 1)) report_radio();
  if (every(4, 2)) report_motors(false);
  if (every(20, 3)) {
    send(bunker::encode(bunker::SystemState{raw(machine_.state()), raw(machine_.shown_mode(now())),
                                            battery().voltage_v(), error_code(), state_count_++}));
  }
  if (every(20, 7)) report_motors(true);
  if (every(100, 11)) {
    const auto charge = static_cast<std::uint8_t>(std::lround(battery().charge_pct()));
    send(bunker::encode(
        bunker::Battery{charge, 100, battery().voltage_v(), battery().current_a(), kAmbient_c}));
  }
}

void Bunker::report_v1() {
  unsigned code = static_cast<unsigned>(faults().error_bits);
  if (battery().fault(params().battery)) code |= kBatteryFaultBit;
  if (battery().warning(params().battery)) code |= kV1BatteryWarningBit;
  if (machine_.radio_lost() && !faults().radio_loss_unflagged) code |= kV1RadioLostBit;
  const auto motor = [this](const MotorState& m, double heat_c) {
    return V1Facts::Motor{m.current_a, m.track_mps * params().drive.motor_rev_per_m * 60.0,
                          kAmbient_c + heat_c};
  };
  const V1Facts facts{.vehicle_state = machine_.state(),
                      .control_mode = machine_.shown_mode(now()),
                      .battery_v = battery().voltage_v(),
                      .error_code = static_cast<std::uint16_t>(code),
                      .measured = odometer_.twist(),
                      .right = motor(tracks_.right(), right_heat_c_),
                      .left = motor(tracks_.left(), left_heat_c_)};
  for (const CanFrame& f : v1_voice_.at(steps(), facts)) send(f);
}

void Bunker::report_radio() {
  if (radio_heard()) {
    last_radio_ = bunker::encode(radio_report(radio(), radio_count_++));
  } else if (!faults().radio_freeze || !last_radio_) {
    return;
  }
  send(*last_radio_);
}

/// Motor 1 drives the right track, motor 2 the left one; so do 3 and 4, where they are.
void Bunker::report_motors(bool slow) {
  const auto one = [&](std::uint8_t motor, const MotorState& m, double heat_c) {
    if (slow) {  // the driver sits on the motor's heat sink
      const std::int16_t warm_c = whole(kAmbient_c + heat_c);
      return bunker::encode(
          bunker::ActuatorSlow{motor, battery().voltage_v(), warm_c,
                               static_cast<std::int8_t>(std::min<int>(warm_c, 127)), 0});
    }
    const double per_m = params().drive.motor_rev_per_m;
    return bunker::encode(bunker::ActuatorFast{motor, whole(m.track_mps * per_m * 60.0),
                                               m.current_a, wrapped_pulses(m.travel_m * per_m)});
  };
  for (int motor = 1; motor <= params().base.motors; ++motor) {
    const bool right = motor % 2 == 1;
    send(one(static_cast<std::uint8_t>(motor), right ? tracks_.right() : tracks_.left(),
             right ? right_heat_c_ : left_heat_c_));
  }
}

void Bunker::report_lights() {
  if (!lights_) return;
  bunker::Light told = *lights_;
  told.count = light_count_++;
  send(speaks_v1() ? bunker::v1::encode(bunker::v1::LightState{told})
                   : bunker::encode(bunker::LightState{told}));
}

/// Without the host's command the lights are the base's own business: it switches them off.
void Bunker::light(const bunker::Light& wanted) {
  lights_ = wanted.enabled ? wanted : bunker::Light{};
  report_lights();
}

void Bunker::send(const CanFrame& f) {
  const bool lost = from_base_.uniform() < faults().loss_from_base;
  if (lost || faults().bus_off || !on_frame) return;
  on_frame(f, now());
}

void Bunker::receive(const CanFrame& f) {
  const bool lost = to_base_.uniform() < faults().loss_to_base;
  if (lost || faults().bus_off) return;
  if (speaks_v1()) {
    if (const auto order = v1_order(f, params().base)) obey(*order);
    const auto decoded = bunker::v1::decode(f);
    if (const auto* l = std::get_if<bunker::v1::LightCommand>(&decoded.message)) light(*l);
    return;
  }
  for (const CanFrame& part : version_answer(f, params().base.firmware)) send(part);
  const bunker::Decoded decoded = bunker::decode(f);
  if (decoded.verdict == bunker::Verdict::Decoded) obey(decoded.message);
}

void Bunker::obey(const bunker::Message& message) {
  if (const auto* motion = std::get_if<bunker::MotionCommand>(&message)) {
    ++commands_;
    machine_.command({motion->linear_mps, motion->angular_radps}, now());
  } else if (const auto* mode = std::get_if<bunker::ControlModeCommand>(&message)) {
    machine_.request_mode(static_cast<std::uint8_t>(mode->mode), params().radio.fight_limit, now());
  } else if (const auto* clear = std::get_if<bunker::ClearErrors>(&message)) {
    clear_error_bits(clear->which == 0 ? 0xFFFFu : 1u << (2 + clear->which));
  } else if (const auto* wanted = std::get_if<bunker::LightCommand>(&message)) {
    light(*wanted);
  }
}

/// Every command carries the mode. While the radio drives it is not asked for anything.
void Bunker::obey(const V1Order& order) {
  clear_error_bits(order.cleared);
  if (order.motion) {
    ++commands_;
    machine_.command(*order.motion, now());
  }
  if (machine_.shown_mode(now()) == base::ControlMode::Radio) return;
  machine_.request_mode(order.mode, 0, now());
}

void Bunker::describe(Truth& t) const {
  t.left_track_mps = tracks_.left().track_mps;
  t.right_track_mps = tracks_.right().track_mps;
  t.control_mode = machine_.shown_mode(now());
  t.vehicle_state = machine_.state();
  t.commands = commands_;
}

void Bunker::restart() {
  machine_.power_cycle();
  tracks_.zero_odometer();
  odometer_ = {};
  state_count_ = radio_count_ = 0;
  last_radio_.reset();
  lights_.reset();
  light_count_ = 0;
}

}  // namespace roverd::sim
