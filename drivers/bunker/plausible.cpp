#include "bunker/plausible.hpp"

#include <cmath>

namespace roverd::bunker {
namespace {

using Found = std::optional<Impossible>;

Found within(std::string_view what, double value, double low, double high,
             std::string_view unit) noexcept {
  if (value >= low && value <= high) return std::nullopt;
  return Impossible{what, value, unit};
}
Found at_most(std::string_view what, double value, double most, std::string_view unit) noexcept {
  return within(what, value, -most, most, unit);
}

Found battery(double volts) noexcept {
  return within("battery", volts, 0.0, kMaxBattery_v, " V");
}
Found twist(double linear_mps, double angular_radps, double max_mps) noexcept {
  if (auto bad = at_most("speed", linear_mps, max_mps, " m/s")) return bad;
  return at_most("turn rate", angular_radps, kMaxTurn_radps, " rad/s");
}
Found motor(double rpm, double current_a) noexcept {
  if (auto bad = at_most("motor speed", rpm, kMaxMotor_rpm, " rpm")) return bad;
  return at_most("motor current", current_a, kMaxCurrent_a, " A");
}

struct Check {
  double max_mps;

  template <class Other>
  Found operator()(const Other&) const noexcept {
    return std::nullopt;
  }
  Found operator()(const SystemState& m) const noexcept { return battery(m.battery_v); }
  Found operator()(const v1::SystemState& m) const noexcept { return battery(m.battery_v); }
  Found operator()(const MotionState& m) const noexcept {
    return twist(m.linear_mps, m.angular_radps, max_mps);
  }
  Found operator()(const v1::MotionState& m) const noexcept {
    return twist(m.linear_mps, m.angular_radps, max_mps);
  }
  Found operator()(const ActuatorFast& m) const noexcept { return motor(m.rpm, m.current_a); }
  Found operator()(const v1::Motor& m) const noexcept { return motor(m.rpm, m.current_a); }
  Found operator()(const ActuatorSlow& m) const noexcept {
    if (auto bad = within("driver supply", m.driver_voltage_v, 0.0, kMaxBattery_v, " V"))
      return bad;
    return within("driver temperature", m.driver_temp_c, kColdest_c, kHottest_c, " C");
  }
  Found operator()(const Battery& m) const noexcept {
    if (auto bad = within("charge", m.soc_pct, 0.0, 100.0, " %")) return bad;
    if (auto bad = within("health", m.soh_pct, 0.0, 100.0, " %")) return bad;
    if (auto bad = battery(m.voltage_v)) return bad;
    if (auto bad = at_most("battery current", m.current_a, kMaxCurrent_a, " A")) return bad;
    return within("battery temperature", m.temperature_c, kColdest_c, kHottest_c, " C");
  }
};

}  // namespace

std::optional<Impossible> impossible(const Message& message, double max_mps) noexcept {
  return std::visit(Check{max_mps}, message);
}
std::optional<Impossible> impossible(const v1::Message& message, double max_mps) noexcept {
  return std::visit(Check{max_mps}, message);
}

}  // namespace roverd::bunker
