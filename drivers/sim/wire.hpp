#pragma once
// How a vehicle is spoken to, and how it answers: the device's end of each drive protocol. Bytes in
// however they are cut, bytes out. Pure: time is an argument.

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::sim {

/// The last command that was understood.
struct Order {
  bool drive = false;               ///< false: stand
  base::BodyTwist twist;            ///< of a vehicle driven by side
  double speed_mps = 0.0;           ///< of a car
  std::optional<double> wheel_rad;  ///< of a car; empty: stays
};

/// What the device knows of itself.
struct Condition {
  base::BodyTwist twist;   ///< as the wheels tell it, blind to slip
  double wheel_rad = 0.0;  ///< of a car: what the sensor sees
  double left_m = 0.0;     ///< travel since power-up
  double right_m = 0.0;
  double battery_v = 0.0;
  bool obeying = false;
  bool watchdog = false;  ///< stands because no command came in time
  bool by_hand = false;
  bool motor_fault = false;
  bool low_battery = false;
  bool estop = false;
};

class Wire {
 public:
  virtual ~Wire() = default;

  /// @return how many commands were in it. What is damaged is dropped, as the device does.
  virtual int receive(base::Bytes bytes) = 0;
  virtual const Order& order() const noexcept = 0;
  /// The next report.
  virtual std::vector<std::uint8_t> report(const Condition& condition) = 0;
  /// As after power-up.
  virtual void forget() = 0;
};

/// @param word of device.wire, not "can". @param track_width_m between the wheels, for "ratio".
std::unique_ptr<Wire> make_wire(std::string_view word, double track_width_m);

}  // namespace roverd::sim
