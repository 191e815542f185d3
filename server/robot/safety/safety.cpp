#include "robot/safety/safety.hpp"

#include <cmath>

#include "base/angle.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using base::ControlMode;
using base::Severity;
using base::Switch;
using base::VehicleState;

/// So long positions may be refused before arming waits for them.
constexpr double kRefusedLong_s = 1.0;

base::Check check(const char* id, bool ok, Severity severity, std::string detail) {
  return {id, ok, severity, std::move(detail)};
}

/// Empty: the receiver's own time goes on as it should.
std::string time_trouble(const Facts& f, const ArmingParams& p, Time now) {
  if (const auto& step = f.world.receiver_clock.last_step()) {
    const double ago_s = base::seconds(now - step->stamp);
    if (ago_s < p.healthy_s) {
      return "the receiver's time stepped back by " + number(step->back_s, "%.1f s") +
             number(ago_s, ", %.0f s ago") + ": waiting " +
             number(std::ceil(p.healthy_s - ago_s), "%.0f s") + " more to trust it";
    }
  }
  const base::InputHealth& in = f.estimate.position;
  const bool refused = in.refused_since && in.why == base::Refusal::Stamp &&
                       base::seconds(now - *in.refused_since) > kRefusedLong_s;
  if (!refused) return {};
  return "positions are not used: the receiver's times are doubled, out of order or too old";
}

/// "4 s more", and of what broke the healthy time.
std::string still_to_wait(const World& w, double good_s, double healthy_s, Time now) {
  std::string text =
      "waiting " + number(std::ceil(healthy_s - good_s), "%.0f s") + " more to trust it";
  if (!w.gnss_broke) return text;
  return text + ": " + w.gnss_broke_by + number(base::seconds(now - *w.gnss_broke), " %.0f s ago");
}

/// A receiver that speaks, and says no positions: what its driver says of that; else empty.
std::string no_position(const World& w) {
  for (const base::DriverStatus& d : w.drivers) {
    if (!d.detail) continue;
    const auto fact = d.detail->facts.find("no_position");
    if (fact != d.detail->facts.end()) return fact->second;
  }
  return {};
}

base::Check check_gnss(const Facts& f, const SafetyParams& safety, const ArmingParams& p,
                       Time now) {
  const char* id = "gnss_fix";
  const World& w = f.world;
  if (f.estimate.placed && f.estimate.free_m < safety.gnss_free_m) {
    return check(
        id, true, Severity::Error,
        "none; the operator said where the robot was " + number(f.estimate.free_m, "%.0f m ago"));
  }
  if (f.estimate.by_map && f.last_position && !older(f.last_position, 2.0, now)) {
    return check(id, true, Severity::Error, "none is needed: the map shows where the robot is");
  }
  if (f.estimate.by_landmark && f.estimate.free_m < safety.gnss_free_m) {
    return check(
        id, true, Severity::Error,
        "none is needed: a known place was seen " + number(f.estimate.free_m, "%.0f m ago"));
  }
  const bool silent = !w.gnss || older(w.gnss->stamp, 2.0, now);
  if (const std::string why = no_position(w); silent && !why.empty()) {
    return check(id, false, Severity::Error, why);
  }
  if (!w.gnss) return check(id, false, Severity::Error, "no GNSS receiver has been heard");
  const std::string fix(base::to_string(w.gnss->fix));
  if (silent) {
    return check(id, false, Severity::Error, "the GNSS receiver is silent");
  }
  if (!w.gnss_good_since) return check(id, false, Severity::Error, "no usable fix: " + fix);
  if (w.gnss->satellites && *w.gnss->satellites < p.satellites_min) {
    return check(id, false, Severity::Error,
                 std::to_string(*w.gnss->satellites) + " satellites; at least " +
                     std::to_string(p.satellites_min) + " are needed");
  }
  if (const std::string wrong = time_trouble(f, p, now); !wrong.empty()) {
    return check(id, false, Severity::Error, "fix " + fix + ", but " + wrong);
  }
  if (const auto& off = f.estimate.votes.unproved_differed) {
    const double ago_s = base::seconds(now - *off);
    if (ago_s < p.healthy_s) {
      return check(id, false, Severity::Error,
                   "fix " + fix + ", but its positions contradicted other sensors" +
                       number(ago_s, ", %.0f s ago") + ": waiting " +
                       number(std::ceil(p.healthy_s - ago_s), "%.0f s") + " more to trust it");
    }
  }
  const double good_s = base::seconds(now - *w.gnss_good_since);
  if (good_s < p.healthy_s) {
    return check(id, false, Severity::Error,
                 "fix " + fix + ", " + still_to_wait(w, good_s, p.healthy_s, now));
  }
  // What claims centimetres is believed: not before it was watched.
  if (w.gnss->fix >= base::FixType::RtkFloat && f.wander_unknown_s > 0.0) {
    return check(id, false, Severity::Error,
                 "fix " + fix + ", waiting " + number(std::ceil(f.wander_unknown_s), "%.0f s") +
                     " more, at most, to see whether its positions wander");
  }
  return check(id, true, Severity::Error, "fix " + fix);
}

base::Check check_accuracy(const Facts& f, const ArmingParams& p) {
  if (!f.pose) {
    return check("position_accuracy", false, Severity::Error, "the position is not known");
  }
  return check("position_accuracy", f.pose->horizontal_sigma_m <= p.sigma_max_m, Severity::Error,
               "uncertain by " + number(f.pose->horizontal_sigma_m, "%.2f m") + "; at most " +
                   number(p.sigma_max_m, "%.2f m"));
}

/// Was it set anew, so far that somebody should look?
base::Check check_estimate(const Facts& f) {
  const char* id = "estimate";
  const std::string look = ": look where the robot stands";
  if (!f.latched.empty()) {
    return check(id, false, Severity::Error,
                 std::string(f.latched) + look + ", and acknowledge it");
  }
  if (!f.moved_disarmed.empty()) {
    return check(id, false, Severity::Warning,
                 std::string(f.moved_disarmed) + ", while it was disarmed" + look);
  }
  return check(id, true, Severity::Error, "was not set anew");
}

base::Check check_heading(const Facts& f, const ArmingParams& p) {
  const double sigma_deg = f.pose ? base::deg_from_rad(f.pose->yaw_sigma_rad) : 180.0;
  const bool ok = sigma_deg <= p.heading_sigma_deg;
  return check("heading", ok, Severity::Warning,
               sigma_deg > 90.0 ? std::string("heading unknown: the robot will creep at first")
                                : "uncertain by " + number(sigma_deg, "%.0f deg") +
                                      (ok ? "" : ": the robot will creep at first"));
}

base::Check check_state(const World& w) {
  const char* id = "base_state";
  if (!w.base) return check(id, false, Severity::Error, "the base has not told its state");
  switch (w.base->vehicle_state) {
    case VehicleState::Normal:
      return check(id, true, Severity::Error, "normal");
    case VehicleState::Estop:
      return check(id, false, Severity::Error, "the emergency stop at the base is pressed");
    case VehicleState::Exception:
      return check(id, false, Severity::Error, "the base reports: " + error_words(*w.base));
    case VehicleState::Unknown:
      break;
  }
  return check(id, false, Severity::Error, "the base is in a state unknown to this program");
}

base::Check check_radio(const World& w, const SafetyParams& p, Time now) {
  if (radio_drives(w, p, now)) {
    return check("radio", false, Severity::Error,
                 "the radio drives: put its switch SWB up to hand over control");
  }
  const std::string trouble = radio_trouble(w, p, now);
  return check("radio", trouble.empty(), Severity::Error,
               trouble.empty() ? "heard, hands over control" : trouble);
}

base::Check check_battery(const World& w, const SafetyParams& p) {
  const char* id = "battery";
  if (w.base && w.base->battery_fault) {
    return check(id, false, Severity::Error, "the base reports an empty battery");
  }
  if (!w.battery) return check(id, true, Severity::Warning, "the base tells no charge");
  const std::string text = number(w.battery->charge_pct, "%.0f %%");
  if (w.battery->charge_pct < p.battery_stop_pct) return check(id, false, Severity::Error, text);
  return check(id, w.battery->charge_pct >= p.battery_warn_pct, Severity::Warning, text);
}

base::Check check_hazards(const World& w) {
  std::string text;
  for (const base::DriverStatus& d : w.drivers) {
    if (!d.detail) continue;
    for (const std::string& hazard : d.detail->hazards) {
      text += (text.empty() ? "" : "; ") + d.name + ": " + hazard;
    }
  }
  return check("driver_hazard", text.empty(), Severity::Error, text.empty() ? "none" : text);
}

/// By hand it may be driven blind.
base::Check check_sensors(const Facts& f) {
  return check("sensors", f.blind.empty(), Severity::Warning,
               f.blind.empty() ? "all that are required see"
                               : std::string(f.blind) + ": nothing drives by itself");
}

base::Check check_drivers(const World& w) {
  std::string text;
  for (const base::DriverStatus& d : w.drivers) {
    if (d.phase == base::DriverPhase::Up) continue;
    text += (text.empty() ? "" : "; ") + d.name + " is " + std::string(to_string(d.phase));
    if (!d.reason.empty()) text += ": " + d.reason;
  }
  return check("drivers", text.empty(), Severity::Warning, text.empty() ? "all up" : text);
}

base::Check check_computer(const World& w) {
  std::string text;
  for (const base::HostProblem& problem : w.host)
    text += (text.empty() ? "" : "; ") + problem.detail;
  return check("computer", text.empty(), Severity::Warning, text.empty() ? "all is well" : text);
}

}  // namespace

bool radio_drives(const World& w, const SafetyParams& p, Time now) noexcept {
  const bool base_says = w.base && w.base->control_mode == ControlMode::Radio &&
                         !older(w.base->stamp, p.status_timeout_s, now);
  const bool switch_says =
      radio_heard(w, p, now) && (w.swb == Switch::Middle || w.swb == Switch::Down);
  return base_says || switch_says;
}

bool radio_heard(const World& w, const SafetyParams& p, Time now) noexcept {
  return w.radio && !older(w.radio->stamp, p.radio_timeout_s, now) &&
         !older(w.radio_counted, p.radio_timeout_s, now) && !(w.base && w.base->radio_lost);
}

bool base_listens(const World& w) noexcept {
  return w.base && w.base->control_mode == ControlMode::Can &&
         w.base->vehicle_state == VehicleState::Normal;
}

bool base_lost(const World& w, const SafetyParams& p, Time now) noexcept {
  const bool silent = older(w.base_heard, p.base_timeout_s, now);
  return silent || !w.base || older(w.base->stamp, p.status_timeout_s, now);
}

std::string radio_trouble(const World& w, const SafetyParams& p, Time now) {
  if (!p.radio_required) return {};
  if (!w.radio) return "the radio transmitter has not been heard";
  if (w.base && w.base->radio_lost) return "the base reports that it lost the radio transmitter";
  if (older(w.radio->stamp, p.radio_timeout_s, now)) return "the radio transmitter is silent";
  if (older(w.radio_counted, p.radio_timeout_s, now)) {
    return "the radio transmitter's counter stands still";
  }
  if (w.swb == Switch::Unknown) return "the position of the radio's switch SWB is unknown";
  return {};
}

Assessment assess(const Facts& facts, const SafetyParams& p, Time now,
                  std::span<const Failsafe> rows) {
  Assessment out;
  for (const Failsafe& row : rows) {
    // Of one id the stronger row comes first, and speaks alone.
    if (!out.conditions.empty() && out.conditions.back().id == row.id) continue;
    std::optional<std::string> told = row.test(facts, p, now);
    if (!told) continue;
    const Response follows = acts_now(row, facts, p, now) ? row.response : Response::None;
    out.slow = out.slow || follows == Response::Slow || follows >= Response::Hold;
    if (follows == Response::Disarm) out.disarms = row.seen;
    if (follows > out.response) {
      out.response = follows;
      out.cause = *told;
    }
    out.conditions.push_back({std::string(row.id), std::move(*told)});
  }
  const auto& base = facts.world.base;
  out.base_estop = facts.world.base_heard && base && base->vehicle_state == VehicleState::Estop;
  return out;
}

std::vector<base::Check> arming_checks(const Facts& f, const SafetyParams& safety,
                                       const ArmingParams& p, bool mission_loaded, Time now) {
  const World& w = f.world;
  std::vector<base::Check> all;
  all.reserve(15);
  all.push_back(check_gnss(f, safety, p, now));
  all.push_back(check_accuracy(f, p));
  all.push_back(check_heading(f, p));
  all.push_back(check_estimate(f));
  const bool lost = base_lost(w, safety, now);
  all.push_back(check("base_link", !lost, Severity::Error,
                      !w.base_heard ? "the base has not been heard yet"
                      : lost        ? "no word from the base"
                                    : "the base answers"));
  all.push_back(check_state(w));
  all.push_back(check_radio(w, safety, now));
  all.push_back(check_battery(w, safety));
  all.push_back(check("estop", !f.estop, Severity::Error,
                      f.estop ? "emergency stop is latched: reset it first" : "released"));
  all.push_back(check("self_test", f.self_test.empty(), Severity::Error,
                      f.self_test.empty() ? std::string("every failsafe speaks when it must")
                                          : std::string(f.self_test)));
  all.push_back(check_hazards(w));
  all.push_back(check_drivers(w));
  if (f.looks) all.push_back(check_sensors(f));
  all.push_back(check_computer(w));
  all.push_back(check("mission", mission_loaded, Severity::Info,
                      mission_loaded ? "loaded" : "no mission is loaded"));
  return all;
}

}  // namespace roverd::robot
