// The failsafes of what carries the robot and stops it: base, bumper, radio, drivers.

#include <array>

#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/safety.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using base::VehicleState;
using std::chrono::seconds;
using Told = std::optional<std::string>;

bool in_state(const Facts& f, VehicleState state) noexcept {
  return f.world.base && f.world.base->vehicle_state == state;
}

/// What drivers see; of all drivers, or of those that see somebody else command the base.
Told hazards(const World& world, bool of_others) {
  std::string text;
  for (const base::DriverStatus& d : world.drivers) {
    if (!d.detail || (of_others && !d.detail->others_command)) continue;
    for (const std::string& hazard : d.detail->hazards) {
      text += (text.empty() ? "" : "; ") + d.name + ": " + hazard;
    }
    if (of_others && d.detail->hazards.empty()) {
      text += (text.empty() ? "" : "; ") + d.name + ": somebody else commands the base";
    }
  }
  return text.empty() ? Told() : Told(text);
}

std::string control_mode_words(const World& world) {
  if (!world.base) return "the base does not tell its control mode";
  return "the base is in control mode " + std::string(to_string(world.base->control_mode)) +
         " and takes no commands";
}

bool radio_absent(const Facts& f, const SafetyParams& p, Time now) noexcept {
  return !radio_drives(f.world, p, now);
}

constexpr std::array kBaseRows{
    Failsafe{
        .id = "estop",
        .seen = "somebody pressed the emergency stop: page, API, radio, base, bumper",
        .after = "at once",
        .response = Response::Stop,
        .ends = kReset,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.estop) return {};
          return "emergency stop is latched";
        },
        .provoke = [](MadeUp& m) { m.facts.estop = true; },
    },
    Failsafe{
        .id = "base_lost",
        .seen = "the base has not been heard since the start",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (f.world.base_heard) return {};
          return "the base has not been heard yet";
        },
        .provoke = [](MadeUp& m) { m.world.base_heard.reset(); },
    },
    Failsafe{
        .id = "base_lost",
        .seen = "no word from the base: bus off, cable, power",
        .after = "{base_timeout_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.world.base_heard || !older(f.world.base_heard, p.base_timeout_s, now)) return {};
          return "no word from the base for " +
                 number(base::seconds(now - *f.world.base_heard), "%.1f s");
        },
        .provoke = [](MadeUp& m) { m.world.base_heard = m.now - seconds(5); },
    },
    Failsafe{
        .id = "base_lost",
        .seen = "the base moves its wheels' counters, but does not tell its state",
        .after = "{status_timeout_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.world.base_heard || !base_lost(f.world, p, now)) return {};
          return "the base does not tell its state";
        },
        .provoke = [](MadeUp& m) { m.world.base->stamp = m.now - seconds(20); },
    },
    Failsafe{
        .id = "base_estop",
        .seen = "the emergency stop at the base is pressed",
        .after = "at once",
        .response = Response::Stop,
        .ends = "the button is released, then the stop is reset; disarmed",
        .over = kNobody,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.world.base_heard || !in_state(f, VehicleState::Estop)) return {};
          return "the emergency stop at the base is pressed";
        },
        .provoke = [](MadeUp& m) { m.world.base->vehicle_state = VehicleState::Estop; },
    },
    Failsafe{
        .id = "base_exception",
        .seen = "the base reports a fault of its own (drive, current, temperature, battery)",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.world.base_heard || !in_state(f, VehicleState::Exception)) return {};
          return "the base reports: " + error_words(*f.world.base);
        },
        .provoke = [](MadeUp& m) { m.world.base->vehicle_state = VehicleState::Exception; },
    },
    Failsafe{
        .id = "base_exception",
        .seen = "the base is in a state that this program does not know",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.world.base_heard || !in_state(f, VehicleState::Unknown)) return {};
          return "the base is in a state unknown to this program";
        },
        .provoke = [](MadeUp& m) { m.world.base->vehicle_state = VehicleState::Unknown; },
    },
    Failsafe{
        .id = "driver_hazard",
        .seen = "somebody else commands the base",
        .after = "at once",
        .response = Response::Disarm,
        .ends = "he is silent; then arm again",
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) { return hazards(f.world, true); },
        .provoke =
            [](MadeUp& m) {
              m.driver().hazards.emplace_back("somebody else sends 0x111");
              m.driver().others_command = true;
            },
    },
    Failsafe{
        .id = "driver_hazard",
        .seen = "a driver sees a danger that it alone can see",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) { return hazards(f.world, false); },
        .provoke = [](MadeUp& m) { m.driver().hazards.emplace_back("two bases answer"); },
    },
    Failsafe{
        .id = "bumper",
        .seen = "the bumper is pressed, be it shorter than a tick",
        .after = "at once",
        .response = Response::Stop,
        .ends = "the bumper is free, then the stop is reset; disarmed",
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.world.bumper || !f.world.bumper->pressed) return {};
          return "the bumper" + in_brackets(f.world.bumper->where) + " is pressed";
        },
        .provoke =
            [](MadeUp& m) {
              m.world.bumper = base::Bumper{m.now, true, "front"};
            },
    },
    Failsafe{
        .id = "bumper_lost",
        .seen = "a bumper that was heard once is silent",
        .after = "{bumper_timeout_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          const auto& bumper = f.world.bumper;
          if (!bumper || bumper->pressed || !older(bumper->stamp, p.bumper_timeout_s, now)) {
            return {};
          }
          return "the bumper is silent";
        },
        .provoke =
            [](MadeUp& m) {
              m.world.bumper = base::Bumper{m.now - seconds(20), false, {}};
            },
    },
    Failsafe{
        .id = "radio_control",
        .seen = "the radio takes over: its switch, or the base says so",
        .after = "at once",
        .response = Response::None,
        .ends = "the switch hands over; a mission goes on by itself, all else when told",
        .over = "the button at the base",
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!radio_drives(f.world, p, now)) return {};
          return "the radio drives";
        },
        .provoke = [](MadeUp& m) { m.world.swb = base::Switch::Down; },
    },
    Failsafe{
        .id = "radio_lost",
        .seen = "a transmitter is demanded ({radio_required}) and not heard, reported lost, or "
                "its counter stands still",
        .after = "{radio_timeout_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = "a profile that demands no radio",
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.world.base_heard || !radio_absent(f, p, now)) return {};
          std::string trouble = radio_trouble(f.world, p, now);
          return trouble.empty() ? Told() : Told(std::move(trouble));
        },
        .provoke = [](MadeUp& m) { m.world.radio_counted = m.now - seconds(20); },
    },
    // Else a mission would go on in the moment in which a base that lost its radio drops back.
    Failsafe{
        .id = "radio_lost",
        .seen = "the same while the radio drives",
        .after = "{radio_timeout_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = "a profile that demands no radio",
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          const World& w = f.world;
          if (!w.base_heard || !w.radio || !p.radio_required) return {};
          if (!radio_drives(w, p, now) || radio_heard(w, p, now)) return {};
          return "the radio drove and is not heard any more";
        },
        .provoke =
            [](MadeUp& m) {
              m.world.base->control_mode = base::ControlMode::Radio;
              m.world.radio->stamp = m.now - seconds(20);
            },
    },
    Failsafe{
        .id = "base_not_ready",
        .seen = "armed, and the base takes no commands",
        .after = "{base_accept_s}",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.base_waited_since || !radio_absent(f, p, now)) return {};
          if (!older(f.base_waited_since, p.base_accept_s, now)) return {};
          return control_mode_words(f.world);
        },
        .provoke = [](MadeUp& m) { m.facts.base_waited_since = m.now - seconds(60); },
    },
    Failsafe{
        .id = "base_not_ready",
        .seen = "the same, at first: no motion is commanded before",
        .after = "at once",
        .response = Response::None,
        .ends = kEndsByItself,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.base_waited_since || !radio_absent(f, p, now)) return {};
          return control_mode_words(f.world);
        },
        .provoke = [](MadeUp& m) { m.facts.base_waited_since = m.now; },
    },
    Failsafe{
        .id = "base_left_control",
        .seen = "the base leaves our control by itself",
        .after = "at once",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.base_left || !radio_absent(f, p, now)) return {};
          return "the base left our control by itself: it was switched off and on, or heard no "
                 "command";
        },
        .provoke = [](MadeUp& m) { m.facts.base_left = true; },
    },
    Failsafe{
        .id = "base_not_following",
        .seen = "the base does not do what it is told: commands lost, stuck, a track off",
        .after = "{follow_timeout_s}",
        .response = Response::Hold,
        .ends = "an operator tries again; it is forgotten when the base moves as told",
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.not_following || !f.commands_lost || !radio_absent(f, p, now)) return {};
          return "the base does not do what it is told: commands seem not to reach it";
        },
        .provoke = [](MadeUp& m) { m.facts.commands_lost = m.facts.not_following = true; },
    },
    // While nothing is asked of it nothing more can be told, and an operator may try again.
    Failsafe{
        .id = "base_not_following",
        .seen = "it did not, and nothing is asked of it now",
        .after = "at once",
        .response = Response::None,
        .ends = "the base moves as told",
        .over = kRadio,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!f.commands_lost || !radio_absent(f, p, now)) return {};
          return "the base does not do what it is told: commands seem not to reach it";
        },
        .provoke = [](MadeUp& m) { m.facts.commands_lost = true; },
    },
};

}  // namespace

std::span<const Failsafe> base_failsafes() noexcept {
  return kBaseRows;
}

}  // namespace roverd::robot
