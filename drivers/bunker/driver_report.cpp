// What the Bunker driver says of itself.

#include <utility>

#include "bunker/driver.hpp"

namespace roverd::bunker {

using base::ControlMode;

Driver::Hazards Driver::hazards(Time now) const noexcept {
  return {.foreign_motion = foreign_motion_ && now - *foreign_motion_ < kForeignHold,
          .swapped = turn_.swapped(),
          .frozen = port_.is_open() && state_count_.frozen()};
}

void Driver::tell_news(Time now) {
  if (detail_ && hazards(now) != told_) port_.say(now);
}

void Driver::refresh_detail(Time now) {
  const bool news = detail_ && hazards(now) != told_;
  if (!detail_ || news || now - detail_at_ >= link::Lifecycle::kReportPeriod) {
    detail_ = make_detail(now);
  }
}

std::shared_ptr<const base::DriverDetail> Driver::make_detail(Time now) {
  auto detail = std::make_shared<base::DriverDetail>();
  detail->counts = tally_.words();
  if (odometry_.refused() > 0) {
    detail->counts["impossible value in 0x311: odometer jump"] = odometry_.refused();
  }
  if (const auto refused = gate_.counts().refused_total(); refused > 0) {
    detail->counts["own frames stopped by the gate"] = refused;
  }
  detail->rates_hz = rates_.words(now);
  detail->facts = facts(now);
  link::BusReport bus = port_.bus(now);
  detail->facts.merge(bus.facts);
  detail->counts.merge(bus.counts);
  told_ = hazards(now);
  detail->others_command = told_.foreign_motion;
  if (told_.foreign_motion) {
    detail->hazards.emplace_back(speaks_v1_.load() ? "somebody else sends motion commands (0x130)"
                                                   : "somebody else sends motion commands (0x111)");
  }
  if (told_.swapped) {
    detail->hazards.emplace_back(
        "left and right are swapped: the odometer (0x311) and the motion state (0x221) turn "
        "opposite ways");
  }
  if (told_.frozen) {
    detail->hazards.emplace_back(
        speaks_v1_.load() ? "the base's state (0x151) repeats itself: its counter stands"
                          : "the base's state (0x211) repeats itself: its counter stands");
  }
  detail_at_ = now;
  return detail;
}

std::map<std::string, std::string> Driver::facts(Time now) const {
  std::map<std::string, std::string> out;
  if (v1_seen_ && v2_seen_) {
    out["protocol"] = "V1 and V2";
  } else if (v1_seen_ || v2_seen_) {
    out["protocol"] = v1_seen_ ? "V1" : "V2";
  }
  out["control_mode"] = to_string(mode_.load(std::memory_order_acquire));
  out["vehicle_state"] = to_string(interpreter_.vehicle_state());
  out["control"] = control_words(now);
  if (!interpreter_.firmware().empty()) out["firmware"] = interpreter_.firmware();
  std::string alarms;
  for (const std::string& alarm : interpreter_.battery_alarms()) {
    alarms += (alarms.empty() ? "" : ", ") + alarm;
  }
  if (!alarms.empty()) out["battery_alarms"] = alarms;
  return out;
}

std::string Driver::control_words(Time now) const {
  if (!up_.load(std::memory_order_acquire)) return "the base is not heard";
  if (interpreter_.vehicle_state() == base::VehicleState::Estop) {
    return "the emergency stop button at the base is pressed";
  }
  const bool ours = ours_.load(std::memory_order_relaxed);
  switch (mode_.load(std::memory_order_acquire)) {
    case ControlMode::Standby: {
      const Time::rep asked = asked_since_.load(std::memory_order_relaxed);
      if (asked == 0) return "nobody drives";
      if (now - Time(base::Duration(asked)) <= kRefusedAfter) return "asked for CAN control";
      return "refused: asked for CAN control for more than 2 s, the base stays in standby";
    }
    case ControlMode::Can:
      return ours ? "this computer drives" : "in CAN mode, this computer is silent";
    case ControlMode::Uart:
      return "a host on the serial port drives";
    case ControlMode::Radio:
      return ours ? "the radio took over" : "the radio drives";
    case ControlMode::Unknown:
      break;
  }
  return "the base does not tell its control mode";
}

void Driver::complete(base::DriverStatus& s) const {
  s.refused = refused_ + odometry_.refused();
  s.sent = sent_.load(std::memory_order_relaxed);
  s.restarts = restarts_;
  s.detail = detail_;
}

}  // namespace roverd::bunker
