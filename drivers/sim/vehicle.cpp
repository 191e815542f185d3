#include "sim/vehicle.hpp"

#include <cmath>
#include <string>

#include "base/angle.hpp"

namespace roverd::sim {

Vehicle::Vehicle(const Params& params, std::uint64_t seed, const Start& start)
    : params_(params),
      start_(start),
      frame_(1, start.at),
      battery_(params.battery),
      receiver_(seed, frame_),
      imu_(seed),
      now_(start.time),
      yaw_rad_(base::yaw_from_heading(start.heading_deg)) {}

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
  const Moved moved = drive(dt_s);
  battery_.step(params_.battery, moved.power_w, dt_s);
  move(moved, dt_s);
  report();
}

void Vehicle::move(const Moved& moved, double dt_s) {
  const GroundMotion& g = moved.ground;
  const double mid_rad = yaw_rad_ + g.twist.angular_radps * dt_s / 2.0;
  const double east_mps =
      g.twist.linear_mps * std::cos(mid_rad) - g.lateral_mps * std::sin(mid_rad);
  const double north_mps =
      g.twist.linear_mps * std::sin(mid_rad) + g.lateral_mps * std::cos(mid_rad);
  at_ = {at_.east_m + east_mps * dt_s, at_.north_m + north_mps * dt_s};
  yaw_rad_ = base::wrap_rad(yaw_rad_ + g.twist.angular_radps * dt_s);
  driven_m_ += std::hypot(east_mps, north_mps) * dt_s;
  twist_ = g.twist;

  const BodyState body{now_,
                       start_.wall + (now_ - start_.time),
                       at_,
                       yaw_rad_,
                       east_mps,
                       north_mps,
                       g.twist.angular_radps};
  const std::string text = receiver_.step(params_, faults_, body, moved.motor_difference_a);
  if (!text.empty() && on_gnss) {
    on_gnss({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, now_);
  }
  const Imu::Packets packets = imu_.step(params_, faults_, body, moved.motor_difference_a);
  if (!packets.empty() && on_imu) on_imu(packets, now_);
}

Truth Vehicle::truth() const {
  Truth t;
  t.time = now_;
  t.at = frame_.to_global(at_);
  t.local = at_;
  t.yaw_rad = yaw_rad_;
  t.twist = twist_;
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
  halt();
}

void Vehicle::power_cycle() {
  faults_.error_bits = 0;
  twist_ = {};
  halt();
  restart();
  imu_.power_cycle();
}

}  // namespace roverd::sim
