#pragma once
// The simulated Bunker: CAN frames in, CAN frames and NMEA bytes out.
//
//   receive(frame) ─▶ base machine ─▶ delay, lag, limits ─▶ tracks ─▶ slip ─▶ true pose
//                         │                                   │                   │
//                     0x211 0x241                  0x221 0x251.. 0x311      GNSS, compass

#include <cstdint>
#include <functional>
#include <optional>

#include "bunker/codec.hpp"
#include "sim/base_v1.hpp"
#include "sim/machine.hpp"
#include "sim/noise.hpp"
#include "sim/odometer.hpp"
#include "sim/tracks.hpp"
#include "sim/vehicle.hpp"

namespace roverd::sim {

class Bunker final : public Vehicle {
 public:
  Bunker(const Params& params, std::uint64_t seed, const Start& start);

  /// Called from within advance_to, stamped with the time at which the frame leaves. May be empty.
  std::function<void(const CanFrame&, Time)> on_frame;

  /// A frame from the host, now (at the time last advanced to). Unknown ids, extended, remote,
  /// error and short frames are ignored, as the base does.
  void receive(const CanFrame& frame);

 private:
  Moved drive(double dt_s) override;
  void report() override;
  void describe(Truth& truth) const override;
  void halt() override { tracks_.halt(); }
  void restart() override;

  std::uint16_t error_code() const noexcept;
  bool speaks_v1() const noexcept { return params().base.protocol == "v1"; }
  void report_v1();
  void report_radio();
  void report_motors(bool slow);
  void report_lights();
  void light(const bunker::Light& wanted);
  void send(const CanFrame& frame);
  void obey(const bunker::Message& message);
  void obey(const V1Order& order);

  Tracks tracks_;
  Odometer odometer_;
  Machine machine_;
  Noise to_base_, from_base_;
  double left_heat_c_ = 0.0;
  double right_heat_c_ = 0.0;
  std::uint64_t commands_ = 0;
  std::uint8_t state_count_ = 0;
  std::uint8_t radio_count_ = 0;
  V1Voice v1_voice_;
  std::optional<CanFrame> last_radio_;
  /// Told from the first command on: many bases have none fitted and never tell of them.
  std::optional<bunker::Light> lights_;
  std::uint8_t light_count_ = 0;
};

}  // namespace roverd::sim
