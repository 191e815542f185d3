#pragma once
// Messages of the base to measurements of the robot. Two frames may make one measurement (a motor's
// fast and slow state, the battery and its alarms), and a lever between two detents keeps its last
// good position: that is the state kept here. No clock, no I/O.

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "base/measurements.hpp"
#include "bunker/codec.hpp"
#include "bunker/v1.hpp"

namespace roverd::bunker {

class Interpreter {
 public:
  using Sink = std::function<void(const base::Measurement&)>;

  Interpreter(const ErrorTable& error_table, Sink sink)
      : error_table_(error_table), sink_(std::move(sink)) {}

  /// Everything but the odometer, which the driver turns into travel (bunker/odometry.hpp).
  void take(const Message& message, base::Time stamp);
  /// @param mode what the driver makes of mode 0, which has two meanings in V1.
  void take(const v1::Message& message, base::ControlMode mode, base::Time stamp);

  /// Printable characters of the version text, or the four numbers of the old form; may be empty.
  const std::string& firmware() const noexcept { return firmware_; }
  /// Alarm and warning bytes of 0x362 that are not zero, raw.
  const std::vector<std::string>& battery_alarms() const noexcept { return alarms_; }
  base::VehicleState vehicle_state() const noexcept { return vehicle_state_; }

 private:
  static constexpr std::size_t kMotors = 4;
  static constexpr std::size_t kLongestFirmware = 128;

  void system(base::BaseStatus status, const ErrorTable& table);
  void radio(const RadioFrame& r, base::Time stamp);
  void light(const Light& l, base::Time stamp);
  void fast(const ActuatorFast& m, base::Time stamp);
  void slow(const ActuatorSlow& m, base::Time stamp);
  void battery(const Battery& b, base::Time stamp);
  void alarms(const BatteryAlarms& a, base::Time stamp);
  void version(const VersionText& part, base::Time stamp);
  base::MotorState& motor(std::size_t number, base::Time stamp);

  const ErrorTable& error_table_;
  const Sink sink_;
  std::array<base::Switch, 4> switches_{};
  std::array<base::MotorState, kMotors> motors_{};
  std::optional<base::BatteryState> battery_;
  std::vector<std::string> alarms_;
  std::string firmware_;
  std::optional<base::Time> firmware_part_;
  base::VehicleState vehicle_state_ = base::VehicleState::Unknown;
};

}  // namespace roverd::bunker
