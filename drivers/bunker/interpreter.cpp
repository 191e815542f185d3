#include "bunker/interpreter.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace roverd::bunker {
namespace {

using base::Time;

/// Bits of ActuatorSlow::driver_state that are faults; the others are enable and reset.
constexpr std::array<const char*, 6> kMotorFaults{
    "supply voltage too low",        "motor too hot", "over-current", "driver too hot",
    "sensor fault or CAN link lost", "driver error"};

/// The parts of a version text follow each other at once.
constexpr double kTextPause_s = 1.0;

std::string raw_byte(const char* name, std::uint8_t value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%s 0x%02X", name, value);
  return text.data();
}

}  // namespace

void Interpreter::take(const Message& message, Time stamp) {
  if (const auto* s = std::get_if<SystemState>(&message)) {
    base::BaseStatus status;
    status.stamp = stamp;
    status.vehicle_state = s->vehicle_state();
    status.control_mode = s->control_mode();
    status.battery_v = s->battery_v;
    status.error_code = s->error_code;
    system(std::move(status), error_table_);
  } else if (const auto* m = std::get_if<MotionState>(&message)) {
    sink_(
        base::BaseMotion{stamp, {.linear_mps = m->linear_mps, .angular_radps = m->angular_radps}});
  } else if (const auto* r = std::get_if<RadioFrame>(&message)) {
    radio(*r, stamp);
  } else if (const auto* l = std::get_if<LightState>(&message)) {
    light(*l, stamp);
  } else if (const auto* f = std::get_if<ActuatorFast>(&message)) {
    fast(*f, stamp);
  } else if (const auto* w = std::get_if<ActuatorSlow>(&message)) {
    slow(*w, stamp);
  } else if (const auto* b = std::get_if<Battery>(&message)) {
    battery(*b, stamp);
  } else if (const auto* a = std::get_if<BatteryAlarms>(&message)) {
    alarms(*a, stamp);
  } else if (const auto* v = std::get_if<Version>(&message)) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%u %u %u %u", v->number[0], v->number[1], v->number[2],
                  v->number[3]);
    firmware_ = text.data();
  } else if (const auto* t = std::get_if<VersionText>(&message)) {
    version(*t, stamp);
  }
}

void Interpreter::take(const v1::Message& message, base::ControlMode mode, Time stamp) {
  if (const auto* s = std::get_if<v1::SystemState>(&message)) {
    base::BaseStatus status;
    status.stamp = stamp;
    status.vehicle_state = s->vehicle_state();
    status.control_mode = mode;
    status.battery_v = s->battery_v;
    status.error_code = s->error_code;
    system(std::move(status), v1::kErrorBits);
  } else if (const auto* m = std::get_if<v1::MotionState>(&message)) {
    sink_(
        base::BaseMotion{stamp, {.linear_mps = m->linear_mps, .angular_radps = m->angular_radps}});
  } else if (const auto* l = std::get_if<v1::LightState>(&message)) {
    light(*l, stamp);
  } else if (const auto* w = std::get_if<v1::Motor>(&message)) {
    base::MotorState& state = motor(w->motor, stamp);
    state.speed_rpm = w->rpm;
    state.current_a = w->current_a;
    state.driver_temperature_c = w->driver_temp_c;
    state.motor_temperature_c = w->motor_temp_c;
    sink_(state);
  }
}

void Interpreter::system(base::BaseStatus status, const ErrorTable& table) {
  for (const ErrorBit& bit : error_bits(status.error_code, table)) {
    status.errors.emplace_back(bit.text);
  }
  status.radio_lost = has_error(status.error_code, "rc_signal_loss", table);
  status.battery_fault = has_error(status.error_code, "battery_fault", table);
  vehicle_state_ = status.vehicle_state;
  sink_(std::move(status));
}

void Interpreter::radio(const RadioFrame& r, Time stamp) {
  const std::array<base::Switch, 4> heard{r.swa(), r.swb(), r.swc(), r.swd()};
  for (std::size_t i = 0; i < heard.size(); ++i) {
    if (heard[i] != base::Switch::Unknown) switches_[i] = heard[i];
  }
  const auto axis = [](std::int8_t raw) { return std::clamp(raw / 100.0, -1.0, 1.0); };
  base::RadioState out;
  out.stamp = stamp;
  out.swa = switches_[0];
  out.swb = switches_[1];
  out.swc = switches_[2];
  out.swd = switches_[3];
  out.right_lr = axis(r.right_lr);
  out.right_ud = axis(r.right_ud);
  out.left_ud = axis(r.left_ud);
  out.left_lr = axis(r.left_lr);
  out.vra = axis(r.vra);
  out.count = r.count;
  sink_(out);
}

void Interpreter::light(const Light& l, Time stamp) {
  sink_(base::LightState{stamp, l.enabled, static_cast<int>(l.front_mode), l.front_value,
                         static_cast<int>(l.rear_mode), l.rear_value});
}

base::MotorState& Interpreter::motor(std::size_t number, Time stamp) {
  base::MotorState& state = motors_[std::min(number, kMotors) - 1];
  state.motor = static_cast<int>(number);
  state.stamp = stamp;
  return state;
}

void Interpreter::fast(const ActuatorFast& m, Time stamp) {
  base::MotorState& state = motor(m.motor, stamp);
  state.speed_rpm = m.rpm;
  state.current_a = m.current_a;
  state.encoder_pulses = m.pulses;
  sink_(state);
}

void Interpreter::slow(const ActuatorSlow& m, Time stamp) {
  base::MotorState& state = motor(m.motor, stamp);
  state.supply_v = m.driver_voltage_v;
  state.driver_temperature_c = m.driver_temp_c;
  state.motor_temperature_c = m.motor_temp_c;
  state.faults.clear();
  for (std::size_t i = 0; i < kMotorFaults.size(); ++i) {
    if ((static_cast<unsigned>(m.driver_state) >> i & 1U) != 0) {
      state.faults.emplace_back(kMotorFaults[i]);
    }
  }
  sink_(state);
}

void Interpreter::battery(const Battery& b, Time stamp) {
  battery_ = base::BatteryState{
      stamp, static_cast<double>(b.soc_pct), b.voltage_v, b.current_a, b.temperature_c, alarms_};
  sink_(*battery_);
}

void Interpreter::alarms(const BatteryAlarms& a, Time stamp) {
  std::vector<std::string> words;
  if (a.alarm1 != 0) words.push_back(raw_byte("alarm 1:", a.alarm1));
  if (a.alarm2 != 0) words.push_back(raw_byte("alarm 2:", a.alarm2));
  if (a.warn1 != 0) words.push_back(raw_byte("warning 1:", a.warn1));
  if (a.warn2 != 0) words.push_back(raw_byte("warning 2:", a.warn2));
  if (words == alarms_) return;
  alarms_ = std::move(words);
  if (!battery_) return;  // told with the first 0x361
  battery_->stamp = stamp;
  battery_->alarms = alarms_;
  sink_(*battery_);
}

void Interpreter::version(const VersionText& part, Time stamp) {
  const bool first = !firmware_part_ || base::seconds(stamp - *firmware_part_) > kTextPause_s;
  if (first) firmware_.clear();
  firmware_part_ = stamp;
  for (const char c : part.text) {
    const bool printable = c >= ' ' && c <= '~';
    if (printable && firmware_.size() < kLongestFirmware) firmware_ += c;
  }
}

}  // namespace roverd::bunker
