#include "sim/vehicle.hpp"

#include <cmath>
#include <string>

#include "base/angle.hpp"

namespace roverd::sim {

Vehicle::Vehicle(const Params& params, std::uint64_t seed, const Start& start)
    : params_(params),
      seed_(seed),
      start_(start),
      frame_(1, start.at),
      battery_(params.battery),
      jitter_(seed),
      receiver_(seed, frame_),
      imu_(seed),
      now_(start.time),
      yaw_rad_(base::yaw_from_heading(start.heading_deg)),
      drive_now_(params.drive) {}

void Vehicle::advance_to(Time now) {
  while (now_ + kStep <= now) step();
}

void Vehicle::step() {
  const double dt_s = base::seconds(kStep);
  now_ += kStep;
  ++steps_;
  if (jump_until_ && now_ >= *jump_until_) {
    faults_.gnss_jump_east_m = faults_.gnss_jump_north_m = faults_.gnss_jump_s = 0.0;
    jump_until_.reset();
  }
  footing_ = footing();
  drive_now_ = drive_on(params_.drive, params_.ground, footing_, twist_.linear_mps);
  drive_now_.delay_s +=
      jitter_.step(params_.drive.delay_jitter_s, params_.drive.delay_hold_s, dt_s);
  const Moved moved = drive(dt_s);
  battery_.step(params_.battery, moved.power_w, dt_s);
  move(moved, dt_s);
  report();
  if (on_step) on_step();
}

Footing Vehicle::footing() const {
  const Footing plane = footing_at(params_, seed_, at_, yaw_rad_);
  return lie_ ? on_ground(plane, lie_(at_, yaw_rad_)) : plane;
}

void Vehicle::move(const Moved& moved, double dt_s) {
  if (foreign_ != nullptr) return follow(foreign_->state(), dt_s);
  const GroundMotion g = slid(moved.ground, params_, footing_, moved.travel_mps);
  const double mid_rad = yaw_rad_ + g.twist.angular_radps * dt_s / 2.0;
  const double east_mps =
      g.twist.linear_mps * std::cos(mid_rad) - g.lateral_mps * std::sin(mid_rad);
  const double north_mps =
      g.twist.linear_mps * std::sin(mid_rad) + g.lateral_mps * std::cos(mid_rad);
  at_ = {at_.east_m + east_mps * dt_s, at_.north_m + north_mps * dt_s};
  yaw_rad_ = base::wrap_rad(yaw_rad_ + g.twist.angular_radps * dt_s);
  driven_m_ += std::hypot(east_mps, north_mps) * dt_s;
  twist_ = g.twist;
  lateral_mps_ = g.lateral_mps;
  footing_ = footing();

  measure({now_, start_.wall + (now_ - start_.time), at_, yaw_rad_, east_mps, north_mps,
           g.twist.angular_radps, footing_.roll_rad, footing_.pitch_rad, footing_.height_m,
           g.twist.linear_mps * footing_.ahead + g.lateral_mps * footing_.leftward,
           under_trees(params_.trees, seed_, at_)},
          moved.motor_difference_a);
}

void Vehicle::measure(const BodyState& body, double motor_difference_a) {
  const std::string text = receiver_.step(params_, faults_, body, motor_difference_a);
  if (!text.empty() && on_gnss) {
    on_gnss({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, now_);
  }
  const Imu::Packets packets = imu_.step(params_, faults_, body, motor_difference_a);
  if (!packets.empty() && on_imu) on_imu(packets, now_);
}

const ForeignState* Vehicle::foreign_moved(const ForeignOrder& order) {
  if (foreign_ == nullptr) return nullptr;
  constexpr std::int64_t kEvery = 2;
  if (steps_ % kEvery != 0) return &foreign_->state();
  ForeignOrder timed = order;
  timed.t_s = base::seconds(now_ - start_.time);
  return &foreign_->step(timed);
}

void Vehicle::follow(const ForeignState& shown, double dt_s) {
  driven_m_ += std::hypot(shown.speed_mps, shown.lateral_mps) * dt_s;
  at_ = shown.at;
  yaw_rad_ = base::wrap_rad(shown.yaw_rad);
  twist_ = {shown.speed_mps, shown.yaw_rate_radps};
  lateral_mps_ = shown.lateral_mps;
  footing_ = {};
  footing_.roll_rad = shown.roll_rad;
  footing_.pitch_rad = shown.pitch_rad;
  const double c = std::cos(yaw_rad_);
  const double s = std::sin(yaw_rad_);
  BodyState body;
  body.time = now_;
  body.utc = start_.wall + (now_ - start_.time);
  body.at = at_;
  body.yaw_rad = yaw_rad_;
  body.east_mps = c * shown.speed_mps - s * shown.lateral_mps;
  body.north_mps = s * shown.speed_mps + c * shown.lateral_mps;
  body.yaw_rate_radps = shown.yaw_rate_radps;
  body.roll_rad = shown.roll_rad;
  body.pitch_rad = shown.pitch_rad;
  body.under_trees = under_trees(params_.trees, seed_, at_);
  body.gyro_radps = shown.gyro_radps;
  body.compass_deg = shown.compass_deg;
  body.own_gnss = foreign_->has_gnss();
  if (steps_ % 2 == 0) body.fix = shown.fix;
  measure(body, 0.0);
}

Truth Vehicle::truth() const {
  Truth t;
  t.time = now_;
  t.at = frame_.to_global(at_);
  t.local = at_;
  t.yaw_rad = yaw_rad_;
  t.roll_rad = footing_.roll_rad;
  t.pitch_rad = footing_.pitch_rad;
  t.twist = twist_;
  t.lateral_mps = lateral_mps_;
  t.driven_m = driven_m_;
  t.battery_pct = battery_.charge_pct();
  describe(t);
  return t;
}

base::Result<void> Vehicle::set_faults(const Faults& faults) {
  if (!faults.gnss_fix.empty() && !fix_from(faults.gnss_fix)) {
    const std::string text = "must be rtk_fixed, rtk_float, dgps, gps, none or empty";
    return base::fail(base::Code::Invalid, "gnss_fix " + text, {{"gnss_fix", text}});
  }
  const bool jumps = faults.gnss_jump_east_m != faults_.gnss_jump_east_m ||
                     faults.gnss_jump_north_m != faults_.gnss_jump_north_m ||
                     faults.gnss_jump_s != faults_.gnss_jump_s;
  if (jumps) {
    jump_until_.reset();
    if (faults.gnss_jump_s > 0.0) jump_until_ = now_ + base::from_seconds(faults.gnss_jump_s);
  }
  faults_ = faults;
  return {};
}

void Vehicle::place(base::LatLon at, double heading_deg) {
  at_ = frame_.to_local(at);
  yaw_rad_ = base::yaw_from_heading(heading_deg);
  twist_ = {};
  lateral_mps_ = 0.0;
  halt();
}

void Vehicle::power_cycle() {
  faults_.error_bits = 0;
  twist_ = {};
  lateral_mps_ = 0.0;
  halt();
  restart();
  imu_.power_cycle();
}

}  // namespace roverd::sim
