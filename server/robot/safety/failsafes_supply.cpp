// The failsafes of what the robot lives on: its battery and its own computer.

#include <algorithm>
#include <array>

#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using Told = std::optional<std::string>;

bool fault(const World& w) noexcept {
  return w.base && w.base->battery_fault;
}
bool below(const World& w, double pct) noexcept {
  return w.battery && w.battery->charge_pct < pct;
}
std::string charge_words(const World& w) {
  return "charge is " + number(w.battery->charge_pct, "%.0f %%");
}

/// A way round the fence is longer than the straight one.
constexpr double kDetour = 1.5;

/// The charge does not bring it home, and `what` shall follow.
Told not_home(const Facts& f, const SafetyParams& p, std::string_view what) {
  const auto& battery = f.world.battery;
  if (p.battery_home != what || !battery || !f.home_m || !f.use_pct_per_m) return {};
  const double needs_pct = kDetour * *f.home_m * *f.use_pct_per_m;
  if (battery->charge_pct - p.battery_stop_pct >= needs_pct) return {};
  return charge_words(f.world) + ", and home is " + number(*f.home_m, "%.0f m away: that needs ") +
         number(needs_pct, "%.0f %%") + number(p.battery_stop_pct, " above %.0f %%");
}

void far_from_home(MadeUp& m, const char* what) {
  m.params.battery_home = what;
  m.facts.home_m = 5000.0;
  m.facts.use_pct_per_m = 0.02;
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

/// What the motors' drives say of themselves.
Told motor_faults(const World& w) {
  std::string text;
  for (const base::MotorState& m : w.motors) {
    if (m.faults.empty()) continue;
    text +=
        (text.empty() ? "motor " : "; motor ") + std::to_string(m.motor) + ": " + list(m.faults);
  }
  return text.empty() ? Told() : Told(text);
}

/// What this computer says of itself under that name, where it is alarming.
Told problem(const Facts& f, std::string_view id) {
  for (const base::HostProblem& p : f.world.host) {
    if (p.alarming && p.id == id) return p.detail;
  }
  return {};
}

/// What no row above knows by name must not get lost.
constexpr std::array<std::string_view, 5> kProblems{"storage_failed", "storage_silent",
                                                    "storage_low", "clock_unset", "loop_late"};
Told other_problem(const World& w) {
  for (const base::HostProblem& p : w.host) {
    const bool known = std::find(kProblems.begin(), kProblems.end(), p.id) != kProblems.end();
    if (p.alarming && !known) return p.detail;
  }
  return {};
}

void plant(MadeUp& m, const char* id) {
  m.world.host.push_back({id, "made up"});
}

constexpr std::array kSupplyRows{
    Failsafe{
        .id = "battery",
        .seen = "the base reports an empty battery",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!fault(f.world)) return {};
          return "the base reports an empty battery";
        },
        .provoke = [](MadeUp& m) { m.world.base->battery_fault = true; },
    },
    Failsafe{
        .id = "battery",
        .seen = "the charge is below {battery_stop_pct}",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (!below(f.world, p.battery_stop_pct)) return {};
          return charge_words(f.world);
        },
        .provoke = [](MadeUp& m) { m.world.battery->charge_pct = 1.0; },
    },
    Failsafe{
        .id = "battery_low",
        .seen = "the charge is below {battery_warn_pct}",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          const World& w = f.world;
          if (fault(w) || below(w, p.battery_stop_pct) || !below(w, p.battery_warn_pct)) return {};
          return charge_words(w);
        },
        .provoke = [](MadeUp& m) { m.world.battery->charge_pct = m.params.battery_warn_pct - 1.0; },
    },
    Failsafe{
        .id = "battery_home",
        .seen = "the charge is not enough to come home (1.5 times the straight way), by what a "
                "metre was seen to cost; hold is chosen instead of {battery_home}",
        .after = "at once",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time) { return not_home(f, p, "hold"); },
        .provoke = [](MadeUp& m) { far_from_home(m, "hold"); },
    },
    Failsafe{
        .id = "battery_home",
        .seen = "the same, and return is chosen",
        .after = "at once",
        .response = Response::Return,
        .acts = Acts::ByItself,
        .ends = "home is reached",
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p,
                   Time) { return not_home(f, p, "return"); },
        .provoke = [](MadeUp& m) { far_from_home(m, "return"); },
    },
    Failsafe{
        .id = "battery_home",
        .seen = "the same, and neither is chosen",
        .after = "at once",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time) { return not_home(f, p, "warn"); },
        .provoke = [](MadeUp& m) { far_from_home(m, "warn"); },
    },
    Failsafe{
        .id = "battery_alarm",
        .seen = "the battery's own management warns (its cells, its current, its temperature)",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.world.battery || f.world.battery->alarms.empty()) return {};
          return "the battery warns: " + list(f.world.battery->alarms);
        },
        .provoke = [](MadeUp& m) { m.world.battery->alarms = {"warning 1: 0x04"}; },
    },
    Failsafe{
        .id = "motor_fault",
        .seen = "a motor's drive reports a fault (voltage, current, temperature, sensor); what "
                "the base itself stops for is a base_exception",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) { return motor_faults(f.world); },
        .provoke =
            [](MadeUp& m) {
              base::MotorState motor;
              motor.motor = 1;
              motor.faults = {"motor too hot"};
              m.world.motors.push_back(motor);
            },
    },
    Failsafe{
        .id = "driver_falls",
        .seen = "a driver was up and fell {driver_falls} times",
        .after = "within a minute",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (f.falls.falls < p.driver_falls) return {};
          return "the driver " + f.falls.name + " fell " + std::to_string(f.falls.falls) +
                 " times within a minute";
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.falls = {"gnss", m.params.driver_falls};
            },
    },
    Failsafe{
        .id = "self_test",
        .seen = "at the start a row of this table did not speak on what it is there for",
        .after = "at the start",
        .response = Response::Hold,
        .ends = "another version of the program",
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (f.self_test.empty()) return {};
          return std::string(f.self_test);
        },
        .provoke = [](MadeUp& m) { m.facts.self_test = "made up"; },
    },
    Failsafe{
        .id = "storage_failed",
        .seen = "the disk is full, gone, read-only or failing, or the database was taken away",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&,
                   Time) { return problem(f, "storage_failed"); },
        .provoke = [](MadeUp& m) { plant(m, "storage_failed"); },
    },
    Failsafe{
        .id = "storage_silent",
        .seen = "the disk does not answer",
        .after = "10 s",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&,
                   Time) { return problem(f, "storage_silent"); },
        .provoke = [](MadeUp& m) { plant(m, "storage_silent"); },
    },
    Failsafe{
        .id = "storage_low",
        .seen = "less than 200 MB are left on the disk",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) { return problem(f, "storage_low"); },
        .provoke = [](MadeUp& m) { plant(m, "storage_low"); },
    },
    Failsafe{
        .id = "clock_unset",
        .seen = "the clock stands before 2025",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) { return problem(f, "clock_unset"); },
        .provoke = [](MadeUp& m) { plant(m, "clock_unset"); },
    },
    Failsafe{
        .id = "loop_late",
        .seen = "one in a thousand wake-ups of the control loop was later than a period",
        .after = "a minute of them",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) { return problem(f, "loop_late"); },
        .provoke = [](MadeUp& m) { plant(m, "loop_late"); },
    },
    Failsafe{
        .id = "computer",
        .seen = "anything else that is alarming about this computer",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) { return other_problem(f.world); },
        .provoke = [](MadeUp& m) { plant(m, "made_up"); },
    },
};

}  // namespace

std::span<const Failsafe> supply_failsafes() noexcept {
  return kSupplyRows;
}

}  // namespace roverd::robot
