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

gate::Limits limits_of(const Params& p) {
  gate::Limits limits;
  // One wire step more than the driver's own cut: that one rounds to the nearest.
  limits.max_linear = static_cast<int>(p.max_linear_mps * 1000.0) + 1;
  limits.max_angular = static_cast<int>(p.max_angular_radps * 1000.0) + 1;
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
      error_table_(params.error_table == "old" ? kOldErrorBits : kErrorBits),
      make_link_(std::move(make_link)),
      on_measurement_(std::move(on_measurement)),
      gate_(limits_of(params)),
      life_(params.retry_first_s, params.retry_max_s),
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
    link_.store(owned_link_.get(), std::memory_order_release);
  }
  last_feedback_ = now;
  v2_seen_ = false;
  life_.opening("waiting for 0x211 or 0x221");
  open_ = true;  // before open: a link may hand over the first frame from inside it
  if (const auto opened = owned_link_->open(); !opened) fail(opened.error().detail, now);
}

void Driver::lose(const std::string& reason, Time now) {
  up_.store(false, std::memory_order_release);
  mode_.store(ControlMode::Unknown, std::memory_order_release);
  gate_.permit(false);
  odometry_.forget();
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
  report(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - last_feedback_);
  if (life_.phase() == Phase::Up && silent_s > params_.lost_after_s) {
    lose("no 0x211 or 0x221 for " + seconds_text(params_.lost_after_s), now);
  } else if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    fail("the bus is open but silent: no 0x211 or 0x221", now);
  }
}

void Driver::report(Time now) {
  if (!life_.report_due(now)) return;
  auto told = status(now);
  if (owned_link_) {
    auto bus = owned_link_->report(now);
    told.detail = std::make_shared<const base::DriverDetail>(
        base::DriverDetail{std::move(bus.counts), {}, std::move(bus.facts), {}});
  }
  on_measurement_(std::move(told));
}

void Driver::stop(Time now) {
  now_ = now;
  if (life_.phase() == Phase::Down) return;
  // From here on the gate lets nothing out but zeros and standby, whatever the control loop sends.
  up_.store(false, std::memory_order_release);
  gate_.permit(false);
  if (ours_.exchange(false)) {
    for (int i = 0; i < kLastZeros; ++i) transmit(encode(MotionCommand{}), now);
    transmit(encode(ControlModeCommand{RequestedMode::Standby}), now);
  }
  mode_.store(ControlMode::Unknown, std::memory_order_release);
  open_ = false;
  if (owned_link_) owned_link_->close();
  odometry_.forget();
  life_.down();
  report(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

base::DriverStatus Driver::status(Time now) const {
  base::DriverStatus s;
  s.stamp = now;
  s.name = name_;
  s.phase = life_.phase();
  s.reason = life_.reason();
  s.received = received_;
  s.refused = refused_ + odometry_.refused();
  s.sent = sent_.load(std::memory_order_relaxed);
  s.last_received = last_received_;
  return s;
}

void Driver::on_frame(const CanFrame& frame, Time stamp) {
  if (!open_) return;
  if (refuse_v1(frame, stamp)) return;
  const Decoded decoded = decode(frame, left_stick_);
  if (decoded.verdict == Verdict::TooShort) ++refused_;
  if (decoded.verdict != Verdict::Decoded) return;
  ++received_;
  last_received_ = stamp;
  if (frame.id == id::kMotionState || frame.id == id::kRadioState) v2_seen_ = true;
  if (frame.id == id::kMotionState || frame.id == id::kSystemState) feedback(stamp);
  gate_.saw(frame, stamp);
  on_message(decoded.message, stamp);
}

bool Driver::refuse_v1(const CanFrame& frame, Time stamp) {
  if (!is_v1_system_state(frame)) return false;
  ++refused_;
  fail(v2_seen_ ? "speaks protocols V1 (0x151) and V2 (0x221, 0x241) at once: will not drive it"
                : "speaks protocol V1 (0x151 seen), which is not supported; V2 is needed",
       stamp);
  report(stamp);
  return true;
}

void Driver::feedback(Time stamp) {
  last_feedback_ = stamp;
  if (life_.phase() == Phase::Up) return;
  life_.up();
  gate_.permit(true);
  up_.store(true, std::memory_order_release);
  report(stamp);
}

void Driver::on_message(const Message& message, Time stamp) {
  if (const auto* s = std::get_if<SystemState>(&message)) {
    on_system(*s, stamp);
  } else if (const auto* m = std::get_if<MotionState>(&message)) {
    on_measurement_(
        base::BaseMotion{stamp, {.linear_mps = m->linear_mps, .angular_radps = m->angular_radps}});
  } else if (const auto* r = std::get_if<RadioFrame>(&message)) {
    on_radio(*r, stamp);
  } else if (const auto* o = std::get_if<Odometer>(&message)) {
    on_odometer(*o, stamp);
  } else if (const auto* b = std::get_if<Battery>(&message)) {
    on_battery(*b, stamp);
  }
  // Lights, actuators and alarms are understood and counted; nobody asks for them yet.
}

void Driver::on_system(const SystemState& s, Time stamp) {
  mode_.store(s.control_mode(), std::memory_order_release);
  base::BaseStatus out;
  out.stamp = stamp;
  out.vehicle_state = s.vehicle_state();
  out.control_mode = s.control_mode();
  out.battery_v = s.battery_v;
  out.error_code = s.error_code;
  for (const ErrorBit& bit : error_bits(s.error_code, error_table_)) {
    out.errors.emplace_back(bit.text);
  }
  out.radio_lost = has_error(s.error_code, "rc_signal_loss", error_table_);
  out.battery_fault = has_error(s.error_code, "battery_fault", error_table_);
  on_measurement_(std::move(out));
}

void Driver::on_radio(const RadioFrame& r, Time stamp) {
  const std::array<base::Switch, 4> heard{r.swa(), r.swb(), r.swc(), r.swd()};
  for (std::size_t i = 0; i < heard.size(); ++i) {
    if (heard[i] != base::Switch::Unknown) switches_[i] = heard[i];
  }
  const auto axis = [](std::int8_t raw) { return std::clamp(raw / 100.0, -1.0, 1.0); };
  base::RadioState out;
  out.stamp = stamp;
  out.swa = switches_[0];
  out.swb = switches_[1];
  out.swc = switches_[2];
  out.swd = switches_[3];
  out.right_lr = axis(r.right_lr);
  out.right_ud = axis(r.right_ud);
  out.left_ud = axis(r.left_ud);
  out.left_lr = axis(r.left_lr);
  out.vra = axis(r.vra);
  out.count = r.count;
  on_measurement_(out);
}

void Driver::on_odometer(const Odometer& o, Time stamp) {
  if (const auto travel = odometry_.add(o, stamp)) {
    on_measurement_(base::WheelTravel{stamp, travel->left_m, travel->right_m});
  }
}

void Driver::on_battery(const Battery& b, Time stamp) {
  if (b.soc_pct > 100) {
    ++refused_;
    return;
  }
  on_measurement_(base::BatteryState{stamp, static_cast<double>(b.soc_pct), b.voltage_v,
                                     b.current_a, b.temperature_c});
}

}  // namespace roverd::bunker
