#include "ratio/driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::ratio {
namespace {

constexpr int kUntakenMax = 5;
constexpr double kPause_s = 0.5;
constexpr double kMeasuredFresh_s = 0.5;
constexpr auto kStatusPeriod = std::chrono::milliseconds(100);

std::vector<gate::Table> table_of(const Params& p) {
  gate::Limits limits;
  limits.max_speed = p.max_wheel_mps + 1e-3;
  limits.max_turn = 2.0;
  limits.max_speed_step = p.max_accel_mps2 * p.period_s * 2.0 + 2e-3;
  limits.max_turn_step = 2.0;  // at a small speed any ratio is harmless
  return gate::ratio(limits);
}

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Driver::Driver(std::string name, const Params& params, MakeLink make_link,
               OnMeasurement on_measurement)
    : params_(params),
      on_measurement_(on_measurement),
      gate_(table_of(params)),
      port_(
          {std::move(name), "connecting", params.retry_first_s, params.retry_max_s},
          std::move(make_link), [this](base::Bytes b, Time t) { on_bytes(b, t); },
          [this] { forget(); }, std::move(on_measurement)) {
  port_.hear_sent([this](base::Bytes b, Time t) { on_sent(b, t); });
}

void Driver::start(Time now) {
  replays_ = false;
  port_.start(now);
}

void Driver::forget() {
  gate_.permit(false);
  decoder_.forget();
  measured_.reset();
  torn_ = false;
  untaken_ = 0;
}

void Driver::stop(Time now) {
  box_.clear();
  if (port_.is_open()) transmit({}, now);
  port_.stop(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

Message Driver::wanted(Time now) {
  const auto twist = box_.take(now, params_.command_timeout_s);
  driving_ = twist && port_.is_up();
  if (!driving_) return {};
  Message m = from_twist(*twist, params_.track_width_m);
  const double since_s =
      last_sent_ ? std::min(base::seconds(now - *last_sent_), 2.0 * params_.period_s) : 0.0;
  const double from =
      last_sent_ && base::seconds(now - *last_sent_) < kPause_s ? last_.speed_mps : 0.0;
  m.speed_mps = std::clamp(m.speed_mps, -params_.max_wheel_mps, params_.max_wheel_mps);
  m.speed_mps = gate::eased(from, m.speed_mps, params_.max_accel_mps2 * since_s);
  if (m.speed_mps == 0.0) m.ratio = 0.0;
  return m;
}

void Driver::tick(Time now) {
  if (port_.is_open() && !replays_) {
    const bool was_driving = driving_;
    const bool due = !last_sent_ || base::seconds(now - *last_sent_) >= params_.period_s - 1e-3;
    const Message m = wanted(now);
    const bool stops = m.speed_mps == 0.0 && (last_.speed_mps != 0.0 || was_driving != driving_);
    if (due || stops) transmit(m, now);
    if (measured_ && params_.silent_reopen_s > 0.0 &&
        base::seconds(now - *measured_) > params_.silent_reopen_s) {
      port_.fail("the robot does not answer", now);
    }
  }
  tell(now);
  port_.tick(now);
}

void Driver::transmit(const Message& message, Time now) {
  std::string line = encode(message);
  last_ = message;
  if (!gate_.allows(bytes_of(line), now)) {
    port_.count("commands refused by the gate", 1);
    last_ = {};
    line = encode({});
    if (!gate_.allows(bytes_of(line), now)) return;
  }
  last_sent_ = now;
  if (torn_) line.insert(line.begin(), '\n');
  switch (port_.write(bytes_of(line))) {
    case link::SendResult::Sent:
      torn_ = false;
      untaken_ = 0;
      port_.heard(now);
      gate_.permit(port_.is_up());
      break;
    case link::SendResult::Busy:
      torn_ = true;
      if (++untaken_ >= kUntakenMax) port_.fail("the robot takes no commands", now);
      break;
    case link::SendResult::Closed:  // still connecting
      break;
  }
}

void Driver::on_bytes(base::Bytes bytes, Time stamp) {
  decoder_.feed(bytes, [&](const Message& m) {
    if (std::abs(m.speed_mps) > 4.0 * params_.max_wheel_mps + 1.0) {
      return port_.refused("impossible speed");
    }
    measured_ = stamp;
    port_.received(stamp);
    on_measurement_(base::BaseMotion{stamp, to_twist(m, params_.track_width_m)});
  });
  if (decoder_.refused() == damaged_) return;
  port_.count("damaged line", decoder_.refused() - damaged_);
  damaged_ = decoder_.refused();
}

void Driver::on_sent(base::Bytes bytes, Time stamp) {
  sent_.feed(bytes, [&](const Message& m) {
    replays_ = true;
    last_ = m;
    port_.heard(stamp);
  });
}

void Driver::tell(Time now) {
  if (!port_.is_up() || now < next_status_) return;
  next_status_ = now + kStatusPeriod;
  base::BaseStatus status;
  status.stamp = now;
  status.vehicle_state = base::VehicleState::Normal;
  status.control_mode = base::ControlMode::Can;
  on_measurement_(std::move(status));
  if (measured_ && base::seconds(now - *measured_) < kMeasuredFresh_s) return;
  base::BaseMotion motion{now, to_twist(last_, params_.track_width_m)};
  motion.assumed = true;
  on_measurement_(motion);
}

}  // namespace roverd::ratio
