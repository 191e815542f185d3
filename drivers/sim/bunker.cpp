#include "sim/bunker.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "base/angle.hpp"
#include "bunker/codec.hpp"
#include "sim/base_v1.hpp"
#include "sim/battery.hpp"
#include "sim/machine.hpp"
#include "sim/noise.hpp"
#include "sim/receiver.hpp"
#include "sim/reports.hpp"
#include "sim/tracks.hpp"

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

struct Bunker::Impl {
  Impl(Bunker& owner, const Params& p, std::uint64_t seed, const Start& s)
      : out(owner),
        params(p),
        start(s),
        frame(1, s.at),
        tracks(seed),
        battery(p.battery),
        receiver(seed, frame),
        to_base(seed, Stream::LossToBase),
        from_base(seed, Stream::LossFromBase),
        now(s.time),
        yaw_rad(base::yaw_from_heading(s.heading_deg)) {}

  bool radio_heard() const noexcept {
    return radio.on && !faults.radio_loss && !faults.radio_freeze;
  }
  std::uint16_t error_code() const noexcept {
    unsigned code = static_cast<unsigned>(faults.error_bits);
    if (battery.fault(params.battery)) code |= kBatteryFaultBit;
    if (battery.warning(params.battery)) code |= kBatteryWarningBit;
    if (machine.radio_lost() && !faults.radio_loss_unflagged) code |= kRadioLostBit;
    if (machine.state() == base::VehicleState::Estop) code |= kSeenWithEstopBit;
    return static_cast<std::uint16_t>(code);
  }

  void step();
  void move(double dt_s);
  void report();
  void report_v1();
  void report_radio();
  void report_motors(bool slow);
  void send(const CanFrame& f);
  void obey(const bunker::Message& message);
  void obey(const V1Order& order);
  bool speaks_v1() const noexcept { return params.base.protocol == "v1"; }

  Bunker& out;
  Params params;
  Start start;
  base::LocalFrame frame;
  Tracks tracks;
  Machine machine;
  Battery battery;
  Receiver receiver;
  Noise to_base, from_base;
  Radio radio;
  Faults faults;

  Time now;
  std::optional<Time> jump_until;
  std::int64_t steps = 0;
  base::EnuPoint at;
  double yaw_rad;
  double driven_m = 0.0;
  double left_heat_c = 0.0;
  double right_heat_c = 0.0;
  std::uint64_t commands = 0;
  std::uint8_t state_count = 0;
  std::uint8_t radio_count = 0;
  V1Voice v1_voice;
  std::optional<CanFrame> last_radio;
};

void Bunker::Impl::step() {
  const double dt_s = base::seconds(kStep);
  now += kStep;
  ++steps;
  if (jump_until && now >= *jump_until) {
    faults.gnss_jump_east_m = faults.gnss_jump_north_m = faults.gnss_jump_s = 0.0;
    jump_until.reset();
  }
  const Wanted wanted =
      machine.step(params,
                   {.radio = radio,
                    .radio_heard = radio_heard(),
                    .estop = faults.estop,
                    .battery_fault = battery.fault(params.battery),
                    .motor_fault = (static_cast<unsigned>(faults.error_bits) & kMotorBits) != 0},
                   now);
  tracks.step(params.drive, wanted.twist, wanted.brake, dt_s);
  battery.step(params.battery, tracks.left().power_w + tracks.right().power_w, dt_s);
  left_heat_c = warmed(left_heat_c, tracks.left().current_a, dt_s);
  right_heat_c = warmed(right_heat_c, tracks.right().current_a, dt_s);
  move(dt_s);
  report();
}

void Bunker::Impl::move(double dt_s) {
  const GroundMotion g = tracks.ground();
  const double mid_rad = yaw_rad + g.twist.angular_radps * dt_s / 2.0;
  const double east_mps =
      g.twist.linear_mps * std::cos(mid_rad) - g.lateral_mps * std::sin(mid_rad);
  const double north_mps =
      g.twist.linear_mps * std::sin(mid_rad) + g.lateral_mps * std::cos(mid_rad);
  at = {at.east_m + east_mps * dt_s, at.north_m + north_mps * dt_s};
  yaw_rad = base::wrap_rad(yaw_rad + g.twist.angular_radps * dt_s);
  driven_m += std::hypot(east_mps, north_mps) * dt_s;

  const BodyState body{now,
                       start.wall + (now - start.time),
                       at,
                       yaw_rad,
                       east_mps,
                       north_mps,
                       g.twist.angular_radps};
  const std::string text =
      receiver.step(params, faults, body, tracks.right().current_a - tracks.left().current_a);
  if (!text.empty() && out.on_gnss) {
    out.on_gnss({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, now);
  }
}

/// The periods of the real base; the phases spread the load over the bus.
void Bunker::Impl::report() {
  if (speaks_v1()) return report_v1();
  const auto every = [this](int period, int phase) { return steps % period == phase; };
  if (every(4, 0)) {
    const base::BodyTwist t = tracks.measured();
    send(bunker::encode(bunker::MotionState{{t.linear_mps, t.angular_radps, 0.0, 0.0}}));
    send(bunker::encode(
        bunker::Odometer{wrapped_mm(tracks.left().travel_m), wrapped_mm(tracks.right().travel_m)}));
  }
  if (every(4, 1)) report_radio();
  if (every(4, 2)) report_motors(false);
  if (every(20, 3)) {
    send(bunker::encode(bunker::SystemState{raw(machine.state()), raw(machine.shown_mode(now)),
                                            battery.voltage_v(), error_code(), state_count++}));
  }
  if (every(20, 7)) report_motors(true);
  if (every(100, 11)) {
    const auto charge = static_cast<std::uint8_t>(std::lround(battery.charge_pct()));
    send(bunker::encode(
        bunker::Battery{charge, 100, battery.voltage_v(), battery.current_a(), kAmbient_c}));
  }
}

void Bunker::Impl::report_v1() {
  unsigned code = static_cast<unsigned>(faults.error_bits);
  if (battery.fault(params.battery)) code |= kBatteryFaultBit;
  if (battery.warning(params.battery)) code |= kV1BatteryWarningBit;
  if (machine.radio_lost() && !faults.radio_loss_unflagged) code |= kV1RadioLostBit;
  const auto motor = [this](const MotorState& m, double heat_c) {
    return V1Facts::Motor{m.current_a, m.track_mps * params.drive.motor_rev_per_m * 60.0,
                          kAmbient_c + heat_c};
  };
  const V1Facts facts{.vehicle_state = machine.state(),
                      .control_mode = machine.shown_mode(now),
                      .battery_v = battery.voltage_v(),
                      .error_code = static_cast<std::uint16_t>(code),
                      .measured = tracks.measured(),
                      .right = motor(tracks.right(), right_heat_c),
                      .left = motor(tracks.left(), left_heat_c)};
  for (const CanFrame& f : v1_voice.at(steps, facts)) send(f);
}

void Bunker::Impl::report_radio() {
  if (radio_heard()) {
    last_radio = bunker::encode(radio_report(radio, radio_count++));
  } else if (!faults.radio_freeze || !last_radio) {
    return;
  }
  send(*last_radio);
}

/// Motor 1 drives the right track, motor 2 the left one.
void Bunker::Impl::report_motors(bool slow) {
  const auto one = [&](std::uint8_t motor, const MotorState& m, double heat_c) {
    if (slow) {  // the driver sits on the motor's heat sink
      const std::int16_t warm_c = whole(kAmbient_c + heat_c);
      return bunker::encode(
          bunker::ActuatorSlow{motor, battery.voltage_v(), warm_c,
                               static_cast<std::int8_t>(std::min<int>(warm_c, 127)), 0});
    }
    const double per_m = params.drive.motor_rev_per_m;
    return bunker::encode(bunker::ActuatorFast{motor, whole(m.track_mps * per_m * 60.0),
                                               m.current_a, wrapped_pulses(m.travel_m * per_m)});
  };
  send(one(1, tracks.right(), right_heat_c));
  send(one(2, tracks.left(), left_heat_c));
}

void Bunker::Impl::send(const CanFrame& f) {
  const bool lost = from_base.uniform() < faults.loss_from_base;
  if (lost || faults.bus_off || !out.on_frame) return;
  out.on_frame(f, now);
}

Bunker::Bunker(const Params& params, std::uint64_t seed, const Start& start)
    : impl_(std::make_unique<Impl>(*this, params, seed, start)) {}

Bunker::~Bunker() = default;

void Bunker::receive(const CanFrame& f) {
  const bool lost = impl_->to_base.uniform() < impl_->faults.loss_to_base;
  if (lost || impl_->faults.bus_off) return;
  if (impl_->speaks_v1()) {
    if (const auto order = v1_order(f, impl_->params.base)) impl_->obey(*order);
    return;
  }
  for (const CanFrame& part : version_answer(f, impl_->params.base.firmware)) impl_->send(part);
  const bunker::Decoded decoded = bunker::decode(f);
  if (decoded.verdict == bunker::Verdict::Decoded) impl_->obey(decoded.message);
}

void Bunker::Impl::obey(const bunker::Message& message) {
  if (const auto* motion = std::get_if<bunker::MotionCommand>(&message)) {
    ++commands;
    machine.command({motion->linear_mps, motion->angular_radps}, now);
  } else if (const auto* mode = std::get_if<bunker::ControlModeCommand>(&message)) {
    machine.request_mode(static_cast<std::uint8_t>(mode->mode), params.radio.fight_limit, now);
  } else if (const auto* clear = std::get_if<bunker::ClearErrors>(&message)) {
    const unsigned gone = clear->which == 0 ? 0xFFFFu : 1u << (2 + clear->which);
    faults.error_bits = static_cast<int>(static_cast<unsigned>(faults.error_bits) & ~gone);
  }
}

/// Every command carries the mode. While the radio drives it is not asked for anything.
void Bunker::Impl::obey(const V1Order& order) {
  faults.error_bits &= ~static_cast<int>(order.cleared);
  if (order.motion) {
    ++commands;
    machine.command(*order.motion, now);
  }
  if (machine.shown_mode(now) == base::ControlMode::Radio) return;
  machine.request_mode(order.mode, 0, now);
}

void Bunker::advance_to(Time now) {
  while (impl_->now + kStep <= now) impl_->step();
}

Truth Bunker::truth() const {
  const Impl& s = *impl_;
  return {.time = s.now,
          .at = s.frame.to_global(s.at),
          .local = s.at,
          .yaw_rad = s.yaw_rad,
          .twist = s.tracks.ground().twist,
          .left_track_mps = s.tracks.left().track_mps,
          .right_track_mps = s.tracks.right().track_mps,
          .driven_m = s.driven_m,
          .battery_pct = s.battery.charge_pct(),
          .control_mode = s.machine.shown_mode(s.now),
          .vehicle_state = s.machine.state(),
          .commands = s.commands};
}

const base::LocalFrame& Bunker::frame() const noexcept {
  return impl_->frame;
}
const Radio& Bunker::radio() const noexcept {
  return impl_->radio;
}
void Bunker::set_radio(const Radio& radio) {
  impl_->radio = radio;
}
const Faults& Bunker::faults() const noexcept {
  return impl_->faults;
}

base::Result<void> Bunker::set_faults(const Faults& faults) {
  if (!faults.gnss_fix.empty() && !fix_from(faults.gnss_fix)) {
    const std::string text = "must be rtk_fixed, rtk_float, dgps, gps, none or empty";
    return base::fail(base::Code::Invalid, "gnss_fix " + text, {{"gnss_fix", text}});
  }
  const Faults& old = impl_->faults;
  const bool jumps = faults.gnss_jump_east_m != old.gnss_jump_east_m ||
                     faults.gnss_jump_north_m != old.gnss_jump_north_m ||
                     faults.gnss_jump_s != old.gnss_jump_s;
  if (jumps) {
    impl_->jump_until.reset();
    if (faults.gnss_jump_s > 0.0) {
      impl_->jump_until = impl_->now + base::from_seconds(faults.gnss_jump_s);
    }
  }
  impl_->faults = faults;
  return {};
}

const Params& Bunker::params() const noexcept {
  return impl_->params;
}
void Bunker::set_params(const Params& params) {
  impl_->params = params;
}
void Bunker::set_battery_pct(double percent) {
  impl_->battery.set_charge_pct(percent);
}

void Bunker::place(base::LatLon at, double heading_deg) {
  impl_->at = impl_->frame.to_local(at);
  impl_->yaw_rad = base::yaw_from_heading(heading_deg);
  impl_->tracks.halt();
}

void Bunker::power_cycle() {
  impl_->machine.power_cycle();
  impl_->tracks.halt();
  impl_->tracks.zero_odometer();
  impl_->faults.error_bits = 0;
  impl_->state_count = impl_->radio_count = 0;
  impl_->last_radio.reset();
}

}  // namespace roverd::sim
