#pragma once
// Helpers for tests of the vehicles that are spoken to in bytes: no slip, no noise, no lag where a
// test does not ask for it.

#include <string>
#include <vector>

#include "plant.hpp"
#include "sim/cart.hpp"

namespace roverd::sim {

/// What is commanded is what happens, at once.
inline Params ideal_cart(const std::string& wire) {
  Params p = ideal();
  p.device.wire = wire;
  p.device.feedback_hz = 50.0;
  p.drive.delay_s = p.drive.lag_s = 0.0;
  p.drive.accel_mps2 = p.drive.decel_mps2 = 10.0;
  p.drive.turn_accel_radps2 = p.drive.turn_decel_radps2 = 20.0;
  p.drive.command_timeout_s = 0.3;
  p.car.wheel_lag_s = 0.0;
  p.car.wheel_rate_radps = 20.0;
  return p;
}

struct CartPlant {
  explicit CartPlant(const Params& p, std::uint64_t seed = 1)
      : cart(p, seed, facing_east()), now(facing_east().time) {
    cart.on_drive = [this](Bytes b, Time t) {
      said.emplace_back(b.begin(), b.end());
      said_at.push_back(t);
    };
    cart.on_bumper = [this](Bytes b, Time t) {
      bumper.emplace_back(b.begin(), b.end());
      bumper_at.push_back(t);
    };
  }

  void wait(base::Duration d) {
    now += d;
    cart.advance_to(now);
  }
  /// The same command every 20 ms.
  template <class Data>
  void repeat(const Data& command, base::Duration d) {
    for (base::Duration t{}; t < d; t += 20ms) {
      cart.receive({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()});
      wait(20ms);
    }
  }
  void fault(const std::function<void(Faults&)>& change) {
    Faults f;
    change(f);
    ASSERT_TRUE(cart.set_faults(f));
  }
  Truth truth() const { return cart.truth(); }

  Cart cart;
  Time now;
  std::vector<std::string> said;
  std::vector<Time> said_at;
  std::vector<std::string> bumper;
  std::vector<Time> bumper_at;
};

}  // namespace roverd::sim
