// The failsafes of where the robot is. What is wrong with the position is shown in every mode, and
// followed by something only while the robot drives by itself.

#include <array>

#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/lean.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using std::chrono::seconds;
using Told = std::optional<std::string>;

double position_age_s(const Facts& f, Time now) noexcept {
  return f.last_position ? base::seconds(now - *f.last_position) : 1e9;
}

/// No position from a receiver, and the way counts: gyro and odometry carry on for some metres.
bool carried_on(const Facts& f, const SafetyParams& p, Time now) noexcept {
  return f.pose && position_age_s(f, now) > p.gnss_slow_s && f.estimate.gyro && f.last_position;
}
/// No position, no gyro: the heading is soon worth little, so the time counts.
bool adrift(const Facts& f, const SafetyParams& p, Time now) noexcept {
  return f.pose && position_age_s(f, now) > p.gnss_slow_s && !(f.estimate.gyro && f.last_position);
}

std::string carried_words(const Facts& f, const SafetyParams& p) {
  return "no position from GNSS for " + number(f.estimate.free_m, "%.0f of ") +
         number(p.gnss_free_m, "%.0f m");
}
std::string adrift_words(const Facts& f, Time now) {
  return "no usable position from GNSS for " + number(position_age_s(f, now), "%.0f s");
}

std::string lean_words(const Facts& f) {
  return "the robot leans by " + number(lean_deg(*f.attitude), "%.0f deg");
}

/// Neither, where the item in hand is driven by what is seen and counted.
bool needed(const Facts& f) noexcept {
  return !f.by_sight;
}

bool uncertain(const Facts& f, const SafetyParams& p) noexcept {
  return f.pose && f.pose->horizontal_sigma_m > p.sigma_slow_m;
}
std::string uncertain_words(const Facts& f) {
  return "the position is uncertain by " + number(f.pose->horizontal_sigma_m, "%.1f m");
}

bool too_wide(const Facts& f) noexcept {
  return f.pose && f.corridor_m && f.corridor_bad_since;
}
std::string corridor_words(const Facts& f) {
  return "the position is uncertain by " + number(2.0 * f.pose->horizontal_sigma_m, "%.2f m") +
         " (2 sigma), the mission's corridor has " + number(*f.corridor_m, "%.2f m");
}
void leave_the_corridor(MadeUp& m) {
  m.facts.corridor_m = m.pose->horizontal_sigma_m;
  m.facts.corridor_bad_since = m.now;
}

constexpr std::array kPositionRows{
    Failsafe{
        .id = "tilt",
        .seen = "the robot leans more than {tilt_stop_deg}, whichever way (where something tells)",
        .after = "0.3 s",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = "the radio's sticks; disarmed, the limit may be raised",
        .test = [](const Facts& f, const SafetyParams&, Time now) -> Told {
          if (!f.attitude || !f.leans_since || !older(f.leans_since, LeanWatch::kLasts_s, now)) {
            return {};
          }
          return lean_words(f);
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.attitude = base::Attitude{m.now, 1.0, 0.0};
              m.facts.leans_since = m.now - seconds(1);
            },
    },
    Failsafe{
        .id = "tilt",
        .seen = "the robot leans more than {tilt_warn_deg}",
        .after = "at once",
        .response = Response::Warn,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (!f.attitude || lean_deg(*f.attitude) <= p.tilt_warn_deg) return {};
          return lean_words(f);
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.attitude = base::Attitude{m.now, 0.0, -1.0};
            },
    },
    Failsafe{
        .id = "roll_over",
        .seen = "the robot leans to a side by more than `nav.slope.roll_over_share` of what tips "
                "it over (`vehicle.support_width_m`, `vehicle.mass_height_m`)",
        .after = "0.3 s",
        .response = Response::Hold,
        .ends = kGoneAndGoOn,
        .over = "the radio's sticks; disarmed, the limit may be raised",
        .test = [](const Facts& f, const SafetyParams&, Time now) -> Told {
          if (!f.attitude || !f.rolls_since || !older(f.rolls_since, LeanWatch::kLasts_s, now)) {
            return {};
          }
          return "the robot leans to a side by " +
                 number(std::abs(base::deg_from_rad(f.attitude->roll_rad)), "%.0f deg") +
                 "; it may by " + number(f.most_roll_deg, "%.0f deg");
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.attitude = base::Attitude{m.now, 0.5, 0.0};
              m.facts.rolls_since = m.now - seconds(1);
            },
    },
    Failsafe{
        .id = "pose_unknown",
        .seen = "there is no position at all",
        .after = "at once",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (f.pose) return {};
          return "the position is not known";
        },
        .provoke = [](MadeUp& m) { m.pose.reset(); },
    },
    Failsafe{
        .id = "gnss_disagree",
        .seen = "two receivers say different places",
        .after = "at once",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.pose || !f.estimate.receivers_disagree || !needed(f)) return {};
          return "two receivers say different places";
        },
        .provoke = [](MadeUp& m) { m.estimate.receivers_disagree = true; },
    },
    Failsafe{
        .id = "gnss_disagree",
        .seen = "the same while the mission's item asks for no position, and no fence holds",
        .after = "at once",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.pose || !f.estimate.receivers_disagree) return {};
          return "two receivers say different places; the item in hand needs none";
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.by_sight = true;
              m.estimate.receivers_disagree = true;
            },
    },
    Failsafe{
        .id = "gnss_lost",
        .seen = "no usable position (silent, no fix, its time stands, refused as a jump or too "
                "old), with a "
                "gyro",
        .after = "{gnss_free_m} driven",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!carried_on(f, p, now) || f.estimate.free_m <= p.gnss_free_m) return {};
          if (!needed(f)) return {};
          return carried_words(f, p);
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.last_position = m.now - seconds(90);
              m.estimate.gyro = true;
              m.estimate.free_m = m.params.gnss_free_m + 1.0;
            },
    },
    Failsafe{
        .id = "gnss_lost",
        .seen = "the same without a gyro",
        .after = "{gnss_hold_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!adrift(f, p, now) || position_age_s(f, now) <= p.gnss_hold_s) return {};
          if (!needed(f)) return {};
          return adrift_words(f, now);
        },
        .provoke = [](MadeUp& m) { m.facts.last_position.reset(); },
    },
    Failsafe{
        .id = "gnss_lost",
        .seen = "the same without a gyro, at first",
        .after = "{gnss_slow_s}",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!adrift(f, p, now) || !needed(f)) return {};
          return adrift_words(f, now);
        },
        .provoke =
            [](MadeUp& m) {
              const double age_s = 0.5 * (m.params.gnss_slow_s + m.params.gnss_hold_s);
              m.facts.last_position = m.now - base::from_seconds(age_s);
            },
    },
    Failsafe{
        .id = "gnss_lost",
        .seen = "the same, with or without a gyro and however long, while the mission's item asks "
                "for no position (a row, a move, a turn), and no fence holds",
        .after = "{gnss_slow_s}",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (needed(f)) return {};
          if (carried_on(f, p, now)) return carried_words(f, p);
          if (!adrift(f, p, now)) return {};
          return adrift_words(f, now) + "; the item in hand needs none";
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.by_sight = true;
              m.facts.last_position = m.now - seconds(90);
            },
    },
    Failsafe{
        .id = "gnss_lost",
        .seen = "the same with a gyro, at first",
        .after = "{gnss_slow_s}",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!carried_on(f, p, now)) return {};
          return carried_words(f, p);
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.last_position = m.now - seconds(90);
              m.estimate.gyro = true;
            },
    },
    Failsafe{
        .id = "gyro_lost",
        .seen = "the gyro is silent; turns are measured by the tracks",
        .after = "0.1 s",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.gyro_lost) return {};
          return "the gyro is silent: turns are measured by the tracks";
        },
        .provoke = [](MadeUp& m) { m.facts.gyro_lost = true; },
    },
    Failsafe{
        .id = "wheels_spin",
        .seen = "the wheels turn while the receiver sees the robot all but stand",
        .after = "{spin_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.pose || !f.spins) return {};
          return "the wheels turn and the robot does not move";
        },
        .provoke = [](MadeUp& m) { m.facts.spins = true; },
    },
    Failsafe{
        .id = "pose_uncertain",
        .seen = "the position's uncertainty (1 sigma) passes {sigma_hold_m}",
        .after = "{sigma_hold_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!uncertain(f, p) || !f.sigma_bad_since || !needed(f)) return {};
          if (!older(f.sigma_bad_since, p.sigma_hold_s, now)) return {};
          return uncertain_words(f);
        },
        .provoke =
            [](MadeUp& m) {
              m.pose->horizontal_sigma_m = m.params.sigma_hold_m + 1.0;
              m.facts.sigma_bad_since = m.now - seconds(90);
            },
    },
    Failsafe{
        .id = "pose_uncertain",
        .seen = "the position's uncertainty (1 sigma) passes {sigma_slow_m}; slower, evenly, from "
                "{sigma_free_m} on",
        .after = "at once",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (!uncertain(f, p) || !needed(f)) return {};
          return uncertain_words(f);
        },
        .provoke = [](MadeUp& m) { m.pose->horizontal_sigma_m = m.params.sigma_slow_m + 0.1; },
    },
    Failsafe{
        .id = "pose_uncertain",
        .seen = "the same while the mission's item asks for no position, and no fence holds",
        .after = "at once",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (!uncertain(f, p)) return {};
          return uncertain_words(f) + "; the item in hand needs none";
        },
        .provoke =
            [](MadeUp& m) {
              m.facts.by_sight = true;
              m.pose->horizontal_sigma_m = m.params.sigma_slow_m + 0.1;
            },
    },
    Failsafe{
        .id = "corridor",
        .seen = "the position is less certain (2 sigma) than the corridor of the mission is wide "
                "(`settings.corridor_m`)",
        .after = "{sigma_hold_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time now) -> Told {
          if (!too_wide(f) || !older(f.corridor_bad_since, p.sigma_hold_s, now)) return {};
          return corridor_words(f);
        },
        .provoke =
            [](MadeUp& m) {
              leave_the_corridor(m);
              m.facts.corridor_bad_since = m.now - seconds(90);
            },
    },
    Failsafe{
        .id = "corridor",
        .seen = "the same, at first",
        .after = "at once",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!too_wide(f)) return {};
          return corridor_words(f);
        },
        .provoke = leave_the_corridor,
    },
};

}  // namespace

std::span<const Failsafe> position_failsafes() noexcept {
  return kPositionRows;
}

}  // namespace roverd::robot
