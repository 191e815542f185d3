#include "robot/safety/safety.hpp"

#include <cmath>
#include <cstdio>

#include "base/angle.hpp"
#include "robot/safety/votes_watch.hpp"

namespace roverd::robot {
namespace {

using base::ControlMode;
using base::Severity;
using base::Switch;
using base::VehicleState;

/// So long positions may be refused before arming waits for them.
constexpr double kRefusedLong_s = 1.0;

bool older(std::optional<Time> stamp, double limit_s, Time now) noexcept {
  return !stamp || base::seconds(now - *stamp) > limit_s;
}

std::string number(double value, const char* format) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string error_words(const base::BaseStatus& status) {
  std::string text;
  for (const std::string& e : status.errors) text += (text.empty() ? "" : ", ") + e;
  return text.empty() ? "no error bit set" : text;
}

std::string in_brackets(const std::string& where) {
  return where.empty() ? "" : " (" + where + ")";
}

class Assessor {
 public:
  Assessor(const Facts& facts, const SafetyParams& p, Time now) : f_(facts), p_(p), now_(now) {}

  Assessment run() {
    const World& w = f_.world;
    const bool radio = radio_drives(w, p_, now_);
    if (f_.estop) add(Response::Stop, "estop", "emergency stop is latched");
    base_state();
    hazards();
    bumper();
    if (radio) add(Response::None, "radio_control", "the radio drives");
    if (!radio && w.base_heard) {
      const std::string trouble = radio_trouble(w, p_, now_);
      if (!trouble.empty()) add(Response::Hold, "radio_lost", trouble);
    }
    if (!radio) base_waits();
    if (!radio) base_follows();
    position(radio);
    battery();
    for (const base::HostProblem& problem : w.host) {
      if (problem.alarming) add(Response::Warn, problem.id.c_str(), problem.detail);
    }
    return std::move(out_);
  }

 private:
  void add(Response response, const char* id, std::string detail) {
    if (response > out_.response) {
      out_.response = response;
      out_.cause = detail;
    }
    out_.conditions.push_back({id, std::move(detail)});
  }

  void base_state() {
    const World& w = f_.world;
    if (!w.base_heard) {
      add(Response::Hold, "base_lost", "the base has not been heard yet");
      return;
    }
    if (base_lost(w, p_, now_)) {
      const double age_s = base::seconds(now_ - *w.base_heard);
      add(Response::Hold, "base_lost",
          age_s > p_.base_timeout_s ? "no word from the base for " + number(age_s, "%.1f s")
                                    : std::string("the base does not tell its state"));
    }
    if (!w.base) return;
    switch (w.base->vehicle_state) {
      case VehicleState::Normal:
        break;
      case VehicleState::Estop:
        out_.base_estop = true;
        add(Response::Stop, "base_estop", "the emergency stop at the base is pressed");
        break;
      case VehicleState::Exception:
        add(Response::Hold, "base_exception", "the base reports: " + error_words(*w.base));
        break;
      case VehicleState::Unknown:
        add(Response::Hold, "base_exception", "the base is in a state unknown to this program");
        break;
    }
  }

  void hazards() {
    for (const base::DriverStatus& driver : f_.world.drivers) {
      if (!driver.detail) continue;
      for (const std::string& hazard : driver.detail->hazards) {
        add(Response::Hold, "driver_hazard", driver.name + ": " + hazard);
      }
    }
  }

  /// A hit itself latches the emergency stop (Robot::judge).
  void bumper() {
    const auto& bumper = f_.world.bumper;
    if (!bumper) return;
    if (bumper->pressed) {
      add(Response::Stop, "bumper", "the bumper" + in_brackets(bumper->where) + " is pressed");
    } else if (older(bumper->stamp, p_.bumper_timeout_s, now_)) {
      add(Response::Hold, "bumper_lost", "the bumper is silent");
    }
  }

  void base_waits() {
    if (!f_.base_waited_since) return;
    const double waited_s = base::seconds(now_ - *f_.base_waited_since);
    add(waited_s > p_.base_accept_s ? Response::Hold : Response::None, "base_not_ready",
        f_.world.base ? "the base is in control mode " +
                            std::string(base::to_string(f_.world.base->control_mode)) +
                            " and takes no commands"
                      : std::string("the base does not tell its control mode"));
  }

  void base_follows() {
    if (f_.base_left) {
      add(Response::Hold, "base_left_control",
          "the base left our control by itself: it was switched off and on, or heard no command");
    }
    if (!f_.commands_lost) return;
    // While nothing is asked of it nothing more can be told, and an operator may try again.
    add(f_.not_following ? Response::Hold : Response::None, "base_not_following",
        "the base does not do what it is told: commands seem not to reach it");
  }

  /// True whatever the mode; only AUTO needs it.
  void position(bool radio) {
    const bool matters = f_.autonomous && !radio;
    const auto tell = [&](Response response, const char* id, std::string detail) {
      add(matters ? response : Response::None, id, std::move(detail));
    };
    if (!f_.pose) {
      tell(Response::Hold, "pose_unknown", "the position is not known");
      return;
    }
    if (f_.estimate.receivers_disagree) {
      tell(Response::Hold, "gnss_disagree", "two receivers say different places");
    }
    sensors(tell);
    without_gnss(tell);
    if (f_.spins)
      tell(Response::Hold, "wheels_spin", "the wheels turn and the robot does not move");
    const double sigma_m = f_.pose->horizontal_sigma_m;
    if (sigma_m > p_.sigma_slow_m) {
      const bool hold =
          f_.sigma_bad_since && base::seconds(now_ - *f_.sigma_bad_since) > p_.sigma_hold_s;
      tell(hold ? Response::Hold : Response::Slow, "pose_uncertain",
           "the position is uncertain by " + number(sigma_m, "%.1f m"));
    }
  }

  /// Who contradicts the others, and what is left without him.
  template <class Tell>
  void sensors(const Tell& tell) {
    using base::Sense;
    const base::Votes& votes = f_.estimate.votes;
    if (!f_.latched.empty()) {
      tell(Response::Hold, "estimate_latched",
           std::string(f_.latched) + ": look where the robot stands, and acknowledge it");
    }
    if (votes.undecided) tell(Response::Hold, "sensors_contradict", undecided_words(votes));
    int carrying = 0;  // of those that carry the estimate
    for (const Sense s : {Sense::Tracks, Sense::Gyro, Sense::Position, Sense::Velocity}) {
      carrying += votes[s].left_out ? 1 : 0;
    }
    for (std::size_t i = 0; i < base::kSenses; ++i) {
      if (!votes.of[i].left_out) continue;
      const Sense s = static_cast<Sense>(i);
      const bool far = f_.estimate.free_m > p_.contradiction_free_m;
      Response response = Response::Warn;
      if (s == Sense::Position) response = far ? Response::Hold : Response::Slow;
      if (s == Sense::Tracks || carrying > 1) response = Response::Hold;
      tell(response, "sensor_left_out", contradiction_words(votes, s));
    }
  }

  /// With gyro and odometry the way counts; without a gyro the heading is soon worth little.
  template <class Tell>
  void without_gnss(const Tell& tell) {
    const double age_s = f_.last_position ? base::seconds(now_ - *f_.last_position) : 1e9;
    if (age_s <= p_.gnss_slow_s) return;
    const double way_m = f_.estimate.free_m;
    if (f_.estimate.gyro && f_.last_position) {
      tell(way_m > p_.gnss_free_m ? Response::Hold : Response::Warn, "gnss_lost",
           "no position from GNSS for " + number(way_m, "%.0f of ") +
               number(p_.gnss_free_m, "%.0f m"));
      return;
    }
    tell(age_s > p_.gnss_hold_s ? Response::Hold : Response::Slow, "gnss_lost",
         "no usable position from GNSS for " + number(age_s, "%.0f s"));
  }

  void battery() {
    const World& w = f_.world;
    if (w.base && w.base->battery_fault) {
      add(Response::Hold, "battery", "the base reports an empty battery");
    } else if (w.battery && w.battery->charge_pct < p_.battery_stop_pct) {
      add(Response::Hold, "battery", "charge is " + number(w.battery->charge_pct, "%.0f %%"));
    } else if (w.battery && w.battery->charge_pct < p_.battery_warn_pct) {
      add(Response::Warn, "battery_low", "charge is " + number(w.battery->charge_pct, "%.0f %%"));
    }
  }

  const Facts& f_;
  const SafetyParams& p_;
  Time now_;
  Assessment out_;
};

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
  const double good_s = base::seconds(now - *w.gnss_good_since);
  if (good_s < p.healthy_s) {
    return check(id, false, Severity::Error,
                 "fix " + fix + ", " + still_to_wait(w, good_s, p.healthy_s, now));
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
  const std::optional<Time> status = w.base ? std::optional(w.base->stamp) : std::nullopt;
  return older(w.base_heard, p.base_timeout_s, now) || older(status, p.status_timeout_s, now);
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

Assessment assess(const Facts& facts, const SafetyParams& p, Time now) {
  return Assessor(facts, p, now).run();
}

std::vector<base::Check> arming_checks(const Facts& f, const SafetyParams& safety,
                                       const ArmingParams& p, bool mission_loaded, Time now) {
  const World& w = f.world;
  std::vector<base::Check> all;
  all.reserve(11);
  all.push_back(check_gnss(f, safety, p, now));
  all.push_back(check_accuracy(f, p));
  all.push_back(check_heading(f, p));
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
  all.push_back(check_drivers(w));
  all.push_back(check_computer(w));
  all.push_back(check("mission", mission_loaded, Severity::Info,
                      mission_loaded ? "loaded" : "no mission is loaded"));
  return all;
}

}  // namespace roverd::robot
