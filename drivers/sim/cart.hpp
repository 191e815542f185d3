#pragma once
// A simulated vehicle that is spoken to in bytes: a car, or tracks or wheels driven by side.
//
//   receive(bytes) ─▶ wire ─▶ watchdog, e-stop, hand ─▶ car | tracks ─▶ true pose ─▶ GNSS, compass
//                       ▲                                    │
//   on_drive ◀──────────┴──────────── feedback ──────────────┘           on_bumper ◀── bumper
//
//   obeys      the last command says so, is younger than drive.command_timeout_s, the battery is
//              not empty, no motor fault
//   by hand    the transmitter is heard and its switch SWB stands in the middle or down: the sticks
//              drive (a car: one axis steers), and the wire says so where it can
//   e-stop     brakes at once, whatever is wanted

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "sim/car.hpp"
#include "sim/noise.hpp"
#include "sim/odometer.hpp"
#include "sim/tracks.hpp"
#include "sim/vehicle.hpp"
#include "sim/wire.hpp"

namespace roverd::sim {

class Cart final : public Vehicle {
 public:
  /// @param params device.wire is not "can".
  Cart(const Params& params, std::uint64_t seed, const Start& start);

  /// Called from within advance_to; either may be empty.
  std::function<void(Bytes, Time)> on_drive;
  std::function<void(Bytes, Time)> on_bumper;

  /// Bytes from the host on the drive link, now: one datagram, or any part of a stream.
  void receive(Bytes bytes);

 private:
  Moved drive(double dt_s) override;
  void report() override;
  void describe(Truth& truth) const override;
  void halt() override;
  void restart() override;

  Order wanted();
  Moved roll(const Order& order, bool brake, double dt_s);
  Condition condition() const;
  void say_bumper();

  const std::unique_ptr<Wire> wire_;
  const bool steered_;
  Car car_;
  Tracks tracks_;
  Odometer odometer_;
  Noise to_base_, from_base_;
  std::optional<Time> commanded_;
  std::uint64_t commands_ = 0;
  double car_travel_m_ = 0.0;
  base::ControlMode mode_ = base::ControlMode::Standby;
  base::VehicleState state_ = base::VehicleState::Normal;
  std::optional<int> said_bumper_;
};

}  // namespace roverd::sim
