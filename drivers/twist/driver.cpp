#include "twist/driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::twist {
namespace {

constexpr double kPeriod_s = 0.019;  ///< 50 Hz on a tick of 10 or 20 ms
constexpr double kPause_s = 0.3;
constexpr double kLongestStep_s = 0.1;
constexpr int kLastStops = 3;
constexpr auto kStatusPeriod = std::chrono::milliseconds(100);

std::vector<gate::Table> table_of(const Params& p) {
  gate::Limits limits;
  limits.max_speed = p.max_linear_mps + 1e-3;
  limits.max_turn = p.max_angular_radps + 1e-3;
  limits.max_speed_step = p.max_accel_mps2 * kLongestStep_s + 2e-3;
  limits.max_turn_step = p.max_turn_accel_radps2 * kLongestStep_s + 2e-3;
  limits.feedback_max_age_s = p.feedback_timeout_s;
  return p.form == "binary" ? gate::twist_binary(limits) : gate::twist_text(limits);
}

}  // namespace

base::Result<void> validate(const Params& p) {
  if (p.form == "text" || p.form == "binary") return {};
  return base::fail(base::Code::Invalid, "form must be text or binary",
                    {{"form", "must be text or binary"}});
}

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      binary_(params.form == "binary"),
      on_measurement_(on_measurement),
      gate_(table_of(params)),
      port_(
          {std::move(name), "waiting for feedback", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](base::Bytes b, Time t) { on_bytes(b, t); },
          [this] { forget(); }, std::move(on_measurement)) {}

void Driver::forget() {
  gate_.permit(false);
  text_.forget();
  frames_.forget();
  heard_.reset();
}

void Driver::stop(Time now) {
  box_.clear();
  for (int i = 0; i < kLastStops && port_.is_open(); ++i) transmit({}, now);
  port_.stop(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  if (port_.is_open()) {
    const double silent_s = base::seconds(now - port_.last_heard());
    if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
      port_.fail(port_.silence("no feedback"), now);
    } else if (port_.is_up() && silent_s > params_.feedback_timeout_s) {
      port_.lose(port_.silence("no feedback"), now);
    }
    if (!last_sent_ || base::seconds(now - *last_sent_) >= kPeriod_s) drive(now);
  }
  port_.tick(now);
}

void Driver::drive(Time now) {
  const auto twist = box_.take(now, params_.command_timeout_s);
  const double since_s = last_sent_ ? base::seconds(now - *last_sent_) : kPause_s + 1.0;
  const double step_s = std::min(since_s, kLongestStep_s);
  const Command from = since_s > kPause_s ? Command{} : last_;
  Command c;
  if (twist && port_.is_up()) {
    const auto cut = [](double value, double most) { return std::clamp(value, -most, most); };
    c.enable = true;
    c.speed_mps = gate::eased(from.speed_mps, cut(twist->linear_mps, params_.max_linear_mps),
                              params_.max_accel_mps2 * step_s);
    c.turn_radps =
        gate::eased(from.turn_radps, cut(twist->angular_radps, params_.max_angular_radps),
                    params_.max_turn_accel_radps2 * step_s);
  }
  if (!transmit(c, now)) transmit({}, now);
}

/// @return false if the gate refused.
bool Driver::transmit(Command command, Time now) {
  command.seq = seq_;
  std::vector<std::uint8_t> bytes;
  if (binary_) {
    bytes = encode_binary(command);
  } else {
    const std::string line = encode_text(command);
    bytes.assign(line.begin(), line.end());
  }
  if (!gate_.allows(bytes, now)) {
    port_.count("commands refused by the gate", 1);
    return false;
  }
  ++seq_;
  last_ = command;
  last_sent_ = now;
  port_.write(bytes);
  return true;
}

void Driver::on_bytes(base::Bytes bytes, Time stamp) {
  const auto take = [&](const Said& said) {
    if (const auto* f = std::get_if<Feedback>(&said)) {
      on_feedback(*f, stamp);
    } else {
      port_.refused("a command: the wires are swapped or echoed");
    }
  };
  if (binary_) {
    frames_.feed(bytes, take);
  } else {
    text_.feed(bytes, take);
  }
  const std::uint64_t damaged = frames_.refused() + text_.refused();
  if (damaged == damaged_) return;
  port_.count("damaged", damaged - damaged_);
  damaged_ = damaged;
}

void Driver::on_feedback(const Feedback& f, Time stamp) {
  if (heard_ && f.seq == heard_->seq) return port_.refused("the sequence stands still");
  if (std::abs(f.speed_mps) > params_.travel_max_mps) return port_.refused("impossible speed");
  if (heard_ && static_cast<std::uint8_t>(f.seq - heard_->seq) != 1) {
    port_.count("gaps in the sequence", 1);
  }
  port_.received(stamp);
  gate_.saw(stamp);
  port_.heard(stamp);
  gate_.permit(true);
  travel(f, stamp);
  heard_ = f;
  heard_at_ = stamp;
  on_measurement_(base::BaseMotion{stamp, {f.speed_mps, f.turn_radps}});
  tell(f, stamp);
}

/// Jumps (the device was started anew, its counter wrapped) are no travel.
void Driver::travel(const Feedback& f, Time stamp) {
  if (!heard_) return;
  const double left_m = f.left_m - heard_->left_m;
  const double right_m = f.right_m - heard_->right_m;
  const double most_m = params_.travel_max_mps * (base::seconds(stamp - heard_at_) + 0.1);
  if (std::abs(left_m) > most_m || std::abs(right_m) > most_m) {
    return port_.refused("impossible travel");
  }
  on_measurement_(base::WheelTravel{stamp, left_m, right_m});
}

void Driver::tell(const Feedback& f, Time stamp) {
  if (stamp < next_status_) return;
  next_status_ = stamp + kStatusPeriod;
  base::BaseStatus s;
  s.stamp = stamp;
  s.vehicle_state = base::VehicleState::Normal;
  const auto has = [&](std::uint8_t bit) { return (f.status & bit) != 0; };
  if (has(kMotorFault)) s.errors.emplace_back("motor fault");
  if (has(kTooHot)) s.errors.emplace_back("too hot");
  if (!s.errors.empty()) s.vehicle_state = base::VehicleState::Exception;
  if (f.estop) s.vehicle_state = base::VehicleState::Estop;
  s.control_mode = has(kByHand)    ? base::ControlMode::Radio
                   : has(kObeying) ? base::ControlMode::Can
                                   : base::ControlMode::Standby;
  s.battery_fault = has(kLowBattery);
  s.error_code = f.status;
  if (f.battery_v > 0.0) s.battery_v = f.battery_v;
  on_measurement_(std::move(s));
}

}  // namespace roverd::twist
