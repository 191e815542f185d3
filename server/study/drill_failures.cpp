#include "study/drill_failures.hpp"

#include <cmath>

#include "base/angle.hpp"
#include "base/drill.hpp"
#include "bunker/codec.hpp"

namespace roverd::study {
namespace {

constexpr double kJump_m = 5.0;
constexpr double kGyroOff_dps = 5.0;
constexpr double kSpin = 0.9;
constexpr int kMotorFault = 0x10;
constexpr double kOthers_mps = 0.3;
constexpr int kOthersEvery = 5;  // ticks

bool any_vehicle(const Settings&, const sim::Params&) {
  return true;
}
bool on_can(const Settings&, const sim::Params& p) {
  return p.device.wire == "can";
}
bool with_feedback(const Settings& s, const sim::Params& p) {
  return on_can(s, p) || p.device.feedback_hz > 0.0;
}
bool with_bumper(const Settings& s, const sim::Params& p) {
  return p.device.bumper && s.bumper.wiring.enabled;
}
bool with_imu(const Settings& s, const sim::Params& p) {
  return p.imu.fitted && s.mti.wiring.enabled;
}
bool with_tracks(const Settings&, const sim::Params& p) {
  return p.device.wire != "ackermann";
}
bool with_battery_limit(const Settings& s, const sim::Params& p) {
  return with_feedback(s, p) && s.robot.safety.battery_stop_pct > 0.0;
}

void ask_estop(Ride& r) {
  (void)r.stage.ask(robot::Estop{"the page"});
}

void leave(Ride& r) {
  r.operator_there = false;
}

void take_over(Ride& r) {
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  r.stage.plant().set_radio(radio);
}

void meddle(Ride& r) {
  r.each_tick = [k = 0](Stage& stage) mutable {
    if (k++ % kOthersEvery != 0) return;
    stage.put_on_bus(bunker::encode(bunker::MotionCommand{{.linear_mps = kOthers_mps}}));
  };
}

void die(Ride& r) {
  r.stage.kill_program();
}

void drain_battery(Ride& r) {
  const double limit_pct = r.settings.robot.safety.battery_stop_pct;
  const bool told = on_can(r.settings, r.stage.plant().params());  // elsewhere voltage tells, late
  r.stage.plant().set_battery_pct(told ? limit_pct - 1.0 : 0.5 * limit_pct);
}

void jump(Ride& r) {
  const double left_rad = r.stage.plant().truth().yaw_rad + 0.5 * base::kPi;
  sim::Faults faults;
  faults.gnss_jump_east_m = kJump_m * std::cos(left_rad);
  faults.gnss_jump_north_m = kJump_m * std::sin(left_rad);
  (void)r.stage.plant().set_faults(faults);
}

void spin(Ride& r) {
  sim::Params params = r.stage.plant().params();
  params.drive.slip = kSpin;
  r.stage.plant().set_params(params);
}

std::string no_operator_needed(const robot::Config& c) {
  if (c.safety.link_lost != "go_on") return {};
  return "robot.safety.link_lost is go_on: it drives on without an operator";
}

std::string free_metres(const robot::Config& c) {
  return "robot.safety.gnss_free_m lets it drive " +
         std::to_string(std::lround(c.safety.gnss_free_m)) + " m without a position";
}

}  // namespace

const std::vector<PlayedFailure>& played_failures() {
  using F = sim::Faults;
  static const std::vector<PlayedFailure> all{
      {"estop_page", any_vehicle, ask_estop},
      {"estop_button", any_vehicle, nullptr, [](F& f) { f.estop = true; }},
      {"bumper", with_bumper, nullptr, [](F& f) { f.bumper = 1; }},
      {"operator_lost", any_vehicle, leave, nullptr, no_operator_needed},
      {"radio_takeover", any_vehicle, take_over},
      {"radio_lost", on_can, nullptr, [](F& f) { f.radio_loss = true; }},
      {"radio_frozen", on_can, nullptr,
       [](F& f) { f.radio_freeze = f.radio_loss_unflagged = true; }},
      {"drive_link", any_vehicle, nullptr, [](F& f) { f.bus_off = true; }},
      {"commands_lost", any_vehicle, nullptr, [](F& f) { f.loss_to_base = 1.0; }},
      {"feedback_lost", with_feedback, nullptr, [](F& f) { f.loss_from_base = 1.0; }},
      {"motor_fault", on_can, nullptr, [](F& f) { f.error_bits = kMotorFault; }},
      {"second_commander", on_can, meddle},
      {"program_killed", any_vehicle, die},
      {"battery_empty", with_battery_limit, drain_battery},
      {"gnss_outage", any_vehicle, nullptr, [](F& f) { f.gnss_outage = true; }, free_metres},
      {"gnss_silent", any_vehicle, nullptr, [](F& f) { f.gnss_silent = true; }, free_metres},
      {"gnss_frozen", any_vehicle, nullptr, [](F& f) { f.gnss_position_frozen = true; }},
      {"gnss_jump", any_vehicle, jump},
      {"imu_silent", with_imu, nullptr, [](F& f) { f.imu_silent = true; }},
      {"gyro_biased", with_imu, nullptr, [](F& f) { f.imu_gyro_extra_dps = kGyroOff_dps; }},
      {"wheels_spin", with_tracks, spin},
  };
  return all;
}

}  // namespace roverd::study
