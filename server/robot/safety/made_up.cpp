#include "robot/safety/made_up.hpp"

namespace roverd::robot {

MadeUp::MadeUp() {
  base::BaseStatus status;
  status.stamp = now;
  status.vehicle_state = base::VehicleState::Normal;
  status.control_mode = base::ControlMode::Can;
  world.base = status;
  world.base_heard = now;
  world.motion = base::BaseMotion{now, {}};
  base::RadioState transmitter;
  transmitter.stamp = now;
  transmitter.swb = base::Switch::Up;
  world.radio = transmitter;
  world.radio_counted = now;
  world.swb = base::Switch::Up;
  world.operators = base::OperatorLink{now, 1};
  world.battery = base::BatteryState{now, 80.0, 50.0, {}, {}};
  pose.emplace();
  pose->stamp = now;
  pose->horizontal_sigma_m = 0.05;
  facts.last_position = now;
  facts.armed = facts.autonomous = true;
}

base::DriverDetail& MadeUp::driver() {
  auto detail = std::make_shared<base::DriverDetail>();
  base::DriverDetail& told = *detail;
  base::DriverStatus status;
  status.stamp = now;
  status.name = "base";
  status.phase = base::DriverPhase::Up;
  status.detail = std::move(detail);
  world.drivers.push_back(std::move(status));
  return told;
}

}  // namespace roverd::robot
