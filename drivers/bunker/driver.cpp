#include "bunker/driver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace roverd::bunker {

using base::ControlMode;

namespace {

/// Zeros at shutdown: one may be lost on a busy bus.
constexpr int kLastZeros = 3;

int percent_of(double value, double full) {
  return v1::percent(value, full, value);
}

gate::BunkerLimits limits_of(const Params& p) {
  gate::BunkerLimits limits;
  // One wire step more than the driver's own cut: that one rounds to the nearest.
  limits.max_linear = static_cast<int>(p.max_linear_mps * 1000.0) + 1;
  limits.max_angular = static_cast<int>(p.max_angular_radps * 1000.0) + 1;
  limits.max_linear_pct = percent_of(p.max_linear_mps, p.v1_full_linear_mps);
  limits.max_angular_pct = percent_of(p.max_angular_radps, p.v1_full_angular_radps);
  limits.max_linear_step_pct =
      percent_of(limits.max_linear_step / 1000.0, p.v1_full_linear_mps) + 1;
  limits.max_angular_step_pct =
      percent_of(limits.max_angular_step / 1000.0, p.v1_full_angular_radps) + 1;
  limits.motion_max_age_s = p.motion_fresh_s;
  limits.state_max_age_s = p.state_fresh_s;
  return limits;
}

std::string seconds_text(double s) {
  std::string text = std::to_string(s);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

}  // namespace

base::Result<void> validate(const Params& params) {
  if (params.rc_left_stick_order != "ud_lr" && params.rc_left_stick_order != "lr_ud") {
    return base::fail(base::Code::Invalid, "rc_left_stick_order must be ud_lr or lr_ud",
                      {{"rc_left_stick_order", "must be ud_lr or lr_ud"}});
  }
  if (params.error_table != "current" && params.error_table != "old") {
    return base::fail(base::Code::Invalid, "error_table must be current or old",
                      {{"error_table", "must be current or old"}});
  }
  return {};
}

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      left_stick_(params.rc_left_stick_order == "lr_ud" ? LeftStick::LrUd : LeftStick::UdLr),
      on_measurement_(std::move(on_measurement)),
      gate_(gate::bunker(limits_of(params))),
      interpreter_(params.error_table == "old" ? kOldErrorBits : kErrorBits, on_measurement_),
      odometry_(params.odometer_max_mps),
      port_(
          {std::move(name), "waiting for 0x211 or 0x221", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](const CanFrame& f, Time t) { on_frame(f, t); },
          [this] { forget(); }, on_measurement_) {
  if (const auto valid = validate(params); !valid)
    throw std::invalid_argument(valid.error().detail);
  port_.on_opening([this](link::FrameLink& bus, Time now) { begin(bus, now); });
  port_.on_reporting([this](Time now) { refresh_detail(now); });
  port_.on_completing([this](base::DriverStatus& s) { complete(s); });
}

void Driver::start(Time now) {
  port_.start(now);
}

void Driver::begin(link::FrameLink& bus, Time now) {
  bus.attend(own_ids());
  link_.store(&bus, std::memory_order_release);
  firmware_asks_ = 0;
  firmware_at_ = now;
  v1_seen_ = v2_seen_ = false;
  speaks_v1_.store(false, std::memory_order_release);
  state_count_ = {};
  radio_count_ = {};
  if (up_from_) up_from_ = now + kOneVoice;
}

void Driver::forget() noexcept {
  up_.store(false, std::memory_order_release);
  mode_.store(ControlMode::Unknown, std::memory_order_release);
  gate_.permit(false);
  odometry_.forget();
  state_count_ = {};
  radio_count_ = {};
  radio_took_.reset();
  v1_mode_raw_ = 0xFF;
  clear_next_ = 0;
}

void Driver::tick(Time now) {
  if (port_.is_open()) check_silence(now);
  ask_firmware(now);
  if (clear_next_ != 0 && now - clear_at_ >= kClearPause) clear_next(now);
  port_.tick(now);
  tell_news(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - port_.last_heard());
  if (port_.is_up() && silent_s > params_.lost_after_s) {
    port_.lose(std::string(v1_seen_ ? "no 0x131 or 0x151 for " : "no 0x211 or 0x221 for ") +
                   seconds_text(params_.lost_after_s),
               now);
  } else if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail("the bus is open but silent: no 0x211 or 0x221", now);
  }
}

void Driver::stop(Time now) {
  if (port_.phase() == base::DriverPhase::Down) return;
  // From here on the gate lets nothing out but zeros and standby, whatever the control loop sends.
  up_.store(false, std::memory_order_release);
  gate_.permit(false);
  if (ours_.exchange(false)) {
    for (int i = 0; i < kLastZeros; ++i) transmit(zero_frame(ControlMode::Unknown), now);
    transmit(mode_frame(RequestedMode::Standby), now);
  }
  turn_ = {};
  foreign_motion_.reset();
  port_.stop(now);
}

void Driver::restart(Time now) {
  ++restarts_;
  stop(now);
  start(now);
}

}  // namespace roverd::bunker
