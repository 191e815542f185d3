#include "ackermann/driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace roverd::ackermann {
namespace {

constexpr int kLastParks = 3;
constexpr double kPause_s = 0.3;  ///< after a longer one speed begins at zero
constexpr auto kMotionPeriod = std::chrono::milliseconds(20);
constexpr auto kStatusPeriod = std::chrono::milliseconds(100);
/// A late tick may make up for so much; the gate's step is cut accordingly.
constexpr double kLongestStep_s = 0.05;

std::vector<gate::Table> table_of(const Params& p) {
  gate::Limits limits;
  limits.max_speed = p.max_speed_mps + 1e-3;
  limits.max_turn = p.max_wheel_rad + std::abs(p.zero_rad) + p.zero_max_rad + 1e-3;
  limits.max_speed_step = p.max_accel_mps2 * kLongestStep_s + 1e-3;
  limits.max_turn_step = p.max_wheel_rate_radps * kLongestStep_s + 0.01;
  limits.feedback_max_age_s = p.feedback_timeout_s;
  return gate::ackermann(limits, p.feedback_required);
}

}  // namespace

base::Result<void> validate(const Params& p) {
  if (std::abs(p.zero_rad) < p.max_wheel_rad) return {};
  return base::fail(base::Code::Invalid, "zero_rad must be smaller than max_wheel_rad",
                    {{"zero_rad", "must be smaller than max_wheel_rad"}});
}

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      on_measurement_(on_measurement),
      gate_(table_of(params)),
      zero_(params.zero_learn ? params.zero_max_rad : 0.0),
      port_(
          {std::move(name), params.feedback_required ? "waiting for feedback" : "opening",
           params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](Bytes b, Time t) { on_bytes(b, t); }, [this] { forget(); },
          std::move(on_measurement)) {
  port_.hear_sent([this](Bytes b, Time t) { on_sent(b, t); });
}

void Driver::start(Time now) {
  spoken_ = false;
  replays_ = false;
  gate_.renew();
  port_.start(now);
}

void Driver::forget() {
  gate_.permit(false);
  heard_.reset();
}

void Driver::stop(Time now) {
  box_.clear();
  gate_.permit(false);
  for (int i = 0; i < kLastParks && port_.is_open(); ++i) {
    transmit({0.0F, static_cast<float>(wheel_rad_ + zero_rad()), DriveMode::Park}, now);
  }
  port_.stop(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::tick(Time now) {
  check_silence(now);
  drive(now);
  tell(now);
  port_.tick(now);
}

void Driver::check_silence(Time now) {
  if (!port_.is_open() || (!spoken_ && !params_.feedback_required)) return;
  const double silent_s = base::seconds(now - port_.last_heard());
  if (params_.silent_reopen_s > 0.0 && silent_s > params_.silent_reopen_s) {
    port_.fail("the car does not answer", now);
  } else if (silent_s > params_.feedback_timeout_s && port_.is_up()) {
    port_.lose("the car does not answer", now);
  }
}

Message Driver::wanted(Time now, double dt_s) {
  const auto twist = box_.take(now, params_.command_timeout_s);
  Message m;
  if (!twist || !port_.is_up()) {
    speed_mps_ = 0.0;
    const bool by_hand = heard_ && heard_->mode == DriveMode::Remote;
    m.mode = by_hand && !twist ? DriveMode::Remote : DriveMode::Park;
  } else {
    const double wish =
        std::clamp(twist->linear_mps, -params_.max_speed_mps, params_.max_speed_mps);
    speed_mps_ = gate::eased(speed_mps_, wish, params_.max_accel_mps2 * dt_s);
    const double most = params_.max_wheel_rate_radps * dt_s;
    const double wheel_rad =
        std::clamp(wheel_from_twist(*twist, params_.wheelbase_m).value_or(wheel_rad_),
                   -params_.max_wheel_rad, params_.max_wheel_rad);
    wheel_rad_ += std::clamp(wheel_rad - wheel_rad_, -most, most);
    m.mode = DriveMode::Autonomous;
  }
  m.speed_mps = static_cast<float>(speed_mps_);
  m.wheel_rad = static_cast<float>(wheel_rad_ + zero_rad());
  return m;
}

void Driver::drive(Time now) {
  if (!port_.is_open() || replays_) return;
  const double since_s = last_sent_ ? base::seconds(now - *last_sent_) : kPause_s + 1.0;
  if (since_s > kPause_s) speed_mps_ = 0.0;
  const Message m = wanted(now, std::clamp(since_s, 0.0, kLongestStep_s));
  if (!transmit(m, now)) {
    speed_mps_ = 0.0;
    transmit({0.0F, static_cast<float>(wheel_rad_ + zero_rad()), DriveMode::Park}, now);
  }
}

/// @return false if the gate refused.
bool Driver::transmit(const Message& message, Time now) {
  const auto bytes = encode(message);
  if (!gate_.allows(bytes, now)) {
    port_.count("commands refused by the gate", 1);
    return false;
  }
  last_sent_ = now;
  mode_ = message.mode;
  const auto result = port_.write(bytes);
  if (result == link::SendResult::Sent && !spoken_ && !params_.feedback_required &&
      port_.phase() != base::DriverPhase::Down) {
    port_.heard(now);
    gate_.permit(port_.is_up());
  }
  return true;
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  const Decoded d = decode(bytes);
  if (d.fault != Fault::None) return port_.refused(to_string(d.fault));
  if (std::abs(d.message.speed_mps) > params_.possible_speed_mps) {
    return port_.refused("impossible speed");
  }
  if (std::abs(d.message.wheel_rad) > 1.5F) return port_.refused("impossible wheel angle");
  on_feedback(d.message, stamp);
}

void Driver::on_sent(Bytes bytes, Time stamp) {
  const Decoded d = decode(bytes);
  if (d.fault != Fault::None) return;
  replays_ = true;
  mode_ = d.message.mode;
  speed_mps_ = d.message.speed_mps;
  wheel_rad_ = d.message.wheel_rad - zero_rad();
  if (!spoken_ && !params_.feedback_required) port_.heard(stamp);
}

void Driver::on_feedback(const Message& m, Time stamp) {
  spoken_ = true;
  gate_.saw(stamp);
  port_.received(stamp);
  port_.heard(stamp);
  gate_.permit(true);
  const double seen_rad = m.wheel_rad - params_.zero_rad;
  if (params_.zero_learn && heard_ && mode_ == DriveMode::Autonomous) {
    zero_.add(m.speed_mps, wheel_rad_, seen_rad,
              std::min(base::seconds(stamp - heard_at_), kLongestStep_s));
  }
  heard_ = m;
  heard_at_ = stamp;
  on_measurement_(base::SteeringState{stamp, seen_rad});
  on_measurement_(
      base::BaseMotion{stamp, twist_from_wheel(m.speed_mps, seen_rad, params_.wheelbase_m)});
}

/// What it was told is not yet what it does.
base::BodyTwist Driver::assumed_now() {
  const double speed_mps = mode_ == DriveMode::Autonomous ? speed_mps_ : 0.0;
  told_at_ = (told_at_ + 1) % told_.size();
  told_[told_at_] = twist_from_wheel(speed_mps, wheel_rad_, params_.wheelbase_m);
  const auto late = std::lround(params_.assumed_delay_s / base::seconds(kMotionPeriod));
  const auto back = std::min(told_.size() - 1, static_cast<std::size_t>(late));
  return told_[(told_at_ + told_.size() - back) % told_.size()];
}

void Driver::tell(Time now) {
  if (!port_.is_up()) return;
  if (!spoken_ && now >= next_motion_) {
    next_motion_ = now + kMotionPeriod;
    base::BaseMotion motion{now, assumed_now()};
    motion.assumed = true;
    on_measurement_(motion);
  }
  if (now < next_status_) return;
  next_status_ = now + kStatusPeriod;
  base::BaseStatus status;
  status.stamp = spoken_ ? heard_at_ : now;
  status.vehicle_state = base::VehicleState::Normal;
  status.control_mode = base::ControlMode::Can;
  if (heard_ && heard_->mode == DriveMode::Remote) status.control_mode = base::ControlMode::Radio;
  if (heard_ && heard_->mode == DriveMode::Park) status.control_mode = base::ControlMode::Standby;
  on_measurement_(std::move(status));
  char text[32];
  std::snprintf(text, sizeof text, "%.4f rad", zero_.zero_rad());
  port_.fact("learned_steering_zero", text);
  port_.fact("feedback", spoken_ ? "measured" : "none: motion is assumed");
}

}  // namespace roverd::ackermann
