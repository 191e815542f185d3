#include "bunker/driver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace roverd::bunker {

using base::ControlMode;
using Phase = base::DriverPhase;

namespace {

/// Zeros at shutdown: one may be lost on a busy bus.
constexpr int kLastZeros = 3;

int percent_of(double value, double full) {
  return v1::percent(value, full, value);
}

gate::Limits limits_of(const Params& p) {
  gate::Limits limits;
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
    : name_(std::move(name)),
      params_(params),
      left_stick_(params.rc_left_stick_order == "lr_ud" ? LeftStick::LrUd : LeftStick::UdLr),
      make_link_(std::move(make_link)),
      on_measurement_(std::move(on_measurement)),
      gate_(limits_of(params)),
      life_(params.retry_first_s, params.retry_max_s),
      interpreter_(params.error_table == "old" ? kOldErrorBits : kErrorBits, on_measurement_),
      odometry_(params.odometer_max_mps) {
  if (const auto valid = validate(params); !valid)
    throw std::invalid_argument(valid.error().detail);
}

Driver::~Driver() {
  if (owned_link_) owned_link_->close();
}

void Driver::start(Time now) {
  now_ = now;
  if (life_.phase() != Phase::Down) return;
  open(now);
  report(now);
}

void Driver::open(Time now) {
  if (!owned_link_) {
    auto made = make_link_();
    if (!made) return life_.faulty(made.error().detail, now);
    owned_link_ = std::move(*made);
    owned_link_->on_frame = [this](const CanFrame& f, Time t) { on_frame(f, t); };
    owned_link_->on_closed = [this](const std::string& reason) { fail(reason, now_); };
    owned_link_->attend(own_ids());
    link_.store(owned_link_.get(), std::memory_order_release);
  }
  last_feedback_ = now;
  firmware_asks_ = 0;
  firmware_at_ = now;
  v1_seen_ = v2_seen_ = false;
  speaks_v1_.store(false, std::memory_order_release);
  state_count_ = {};
  radio_count_ = {};
  if (up_from_) up_from_ = now + kOneVoice;
  life_.opening("waiting for 0x211 or 0x221");
  open_ = true;  // before open: a link may hand over the first frame from inside it
  if (const auto opened = owned_link_->open(); !opened) fail(opened.error().detail, now);
}

void Driver::lose(const std::string& reason, Time now) {
  up_.store(false, std::memory_order_release);
  mode_.store(ControlMode::Unknown, std::memory_order_release);
  gate_.permit(false);
  odometry_.forget();
  state_count_ = {};
  radio_count_ = {};
  radio_took_.reset();
  v1_mode_raw_ = 0xFF;
  clear_next_ = 0;
  life_.faulty(reason, now);
}

void Driver::fail(const std::string& reason, Time now) {
  lose(reason, now);
  open_ = false;
  owned_link_->close();
}

void Driver::tick(Time now) {
  now_ = now;
  if (open_) {
    check_silence(now);
  } else if (life_.retry_due(now)) {
    open(now);
  }
  ask_firmware(now);
  if (clear_next_ != 0 && now - clear_at_ >= kClearPause) clear_next(now);
  report(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - last_feedback_);
  if (life_.phase() == Phase::Up && silent_s > params_.lost_after_s) {
    lose(std::string(v1_seen_ ? "no 0x131 or 0x151 for " : "no 0x211 or 0x221 for ") +
             seconds_text(params_.lost_after_s),
         now);
  } else if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    fail("the bus is open but silent: no 0x211 or 0x221", now);
  }
}

void Driver::stop(Time now) {
  now_ = now;
  if (life_.phase() == Phase::Down) return;
  // From here on the gate lets nothing out but zeros and standby, whatever the control loop sends.
  up_.store(false, std::memory_order_release);
  gate_.permit(false);
  if (ours_.exchange(false)) {
    for (int i = 0; i < kLastZeros; ++i) transmit(zero_frame(ControlMode::Unknown), now);
    transmit(mode_frame(RequestedMode::Standby), now);
  }
  mode_.store(ControlMode::Unknown, std::memory_order_release);
  open_ = false;
  if (owned_link_) owned_link_->close();
  odometry_.forget();
  turn_ = {};
  foreign_motion_.reset();
  clear_next_ = 0;
  life_.down();
  report(now);
}

void Driver::restart(Time now) {
  ++restarts_;
  stop(now);
  start(now);
}

}  // namespace roverd::bunker
