// The failsafes of sensors that contradict each other: docs/sensors.md. Followed by something only
// while the robot drives by itself.

#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/votes_watch.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using base::Sense;
using Told = std::optional<std::string>;

/// All that are left out, one after the other; empty: none is.
Told left_out(const Facts& f) {
  const base::Votes& votes = f.estimate.votes;
  std::string text;
  for (std::size_t i = 0; i < base::kSenses; ++i) {
    if (!votes.of[i].left_out) continue;
    if (!text.empty()) text += "; ";
    text += contradiction_words(votes, static_cast<Sense>(i));
  }
  if (text.empty()) return {};
  return text;
}

std::string shift_words(base::EnuPoint by) {
  const double towards_deg = base::heading_from_yaw(std::atan2(by.north_m, by.east_m));
  return "the receiver's positions moved by " +
         number(std::hypot(by.east_m, by.north_m), "%.1f m") + number(towards_deg, " to %.0f deg") +
         " and stay so: was its base moved, or the robot carried?";
}

std::string askew_words(const base::Askew& off) {
  const double deg = base::deg_from_rad(off.offset_rad);
  return "the two antennas point " + number(std::abs(deg), "%.1f deg") + " to the " +
         (deg > 0.0 ? "left" : "right") + " of where the robot drives, measured over " +
         number(off.way_m, "%.0f m") +
         ": they are not used. Correct them by that, if they are mounted so";
}

/// To creep on by the others is sound where the place was known before: what lied may have spoiled
/// it, or it was never known well.
bool unsure(const Facts& f, const SafetyParams& p) noexcept {
  return f.pose && f.pose->horizontal_sigma_m > p.contradiction_sigma_m;
}

/// Too little is left to drive by.
bool too_few(const Facts& f, const SafetyParams& p) noexcept {
  const base::Votes& votes = f.estimate.votes;
  int carrying = 0;  // of those that carry the estimate
  for (const Sense s : {Sense::Tracks, Sense::Gyro, Sense::Position, Sense::Velocity}) {
    carrying += votes[s].left_out ? 1 : 0;
  }
  const bool position = votes[Sense::Position].left_out &&
                        (f.estimate.free_m > p.contradiction_free_m || unsure(f, p));
  return votes[Sense::Tracks].left_out || carrying > 1 || position;
}

void leave_out(MadeUp& m, Sense s) {
  m.estimate.votes.of[static_cast<std::size_t>(s)].left_out = true;
}

constexpr std::array kSensorRows{
    Failsafe{
        .id = "estimate_latched",
        .seen =
            "the estimate was set anew far beyond what it had claimed, or twice in a short time",
        .after = "at once; twice within {reset_repeat_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "a person has looked, and acknowledges it or says where it stands",
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (f.latched.empty()) return {};
          return std::string(f.latched) + ": look where the robot stands, and acknowledge it";
        },
        .provoke = [](MadeUp& m) { m.facts.latched = "the position was set anew"; },
    },
    Failsafe{
        .id = "base_moved",
        .seen = "the receiver's positions moved at once by 0.3 m or more, and stay so (RTK fixed)",
        .after = "6.5 s",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "a person has chosen the old place or the new one, or the positions are back",
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.estimate.base_shift) return {};
          return shift_words(f.estimate.base_shift->offset);
        },
        .provoke =
            [](MadeUp& m) {
              m.estimate.base_shift = {{3.0, 0.0}, m.now};
            },
    },
    Failsafe{
        .id = "antennas_askew",
        .seen = "two antennas do not point where the robot drives, by more than 8.6 deg and always",
        .after = "1 m driven",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = "a person confirms the offset, or they point right again",
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.estimate.antennas_askew) return {};
          return askew_words(*f.estimate.antennas_askew);
        },
        .provoke =
            [](MadeUp& m) {
              m.estimate.antennas_askew = {0.35, 0.01, 3.0};
            },
    },
    Failsafe{
        .id = "blind",
        .seen = "a sensor that the profile demands is silent, covered or blinded",
        .after = "0.3 s",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "the cause is gone, then an operator's word; a mission without one, where "
                "`sense.blocked.resume_blind` says so",
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (f.blind.empty()) return {};
          return std::string(f.blind);
        },
        .provoke = [](MadeUp& m) { m.facts.blind = "the sensor front is silent"; },
    },
    Failsafe{
        .id = "sensors_contradict",
        .seen = "two sensors contradict each other, and it cannot be told which one is wrong",
        .after = "1.6 s; 0.6 s where fixed positions run away from the velocity, or contradict "
                 "another sensor before driving has proved them; at once where they run off from "
                 "odometry and gyro",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.estimate.votes.undecided) return {};
          return undecided_words(f.estimate.votes);
        },
        .provoke =
            [](MadeUp& m) {
              m.estimate.votes.undecided = {Sense::Tracks, Sense::Gyro};
            },
    },
    Failsafe{
        .id = "sensor_left_out",
        .seen = "odometry, or two that carry the estimate, contradict the others; or the position "
                "does, and it was left out for so far, or where the robot is is uncertain by more "
                "than {contradiction_sigma_m}, 1 sigma",
        .after = "0.6 s; {contradiction_free_m} driven",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p, Time) -> Told {
          if (!too_few(f, p)) return {};
          return left_out(f);
        },
        .provoke = [](MadeUp& m) { leave_out(m, Sense::Tracks); },
    },
    Failsafe{
        .id = "sensor_left_out",
        .seen = "the satellites' position contradicts the others, and is left out",
        .after = "0.6 s",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
          if (!f.estimate.votes[Sense::Position].left_out) return {};
          return left_out(f);
        },
        .provoke = [](MadeUp& m) { leave_out(m, Sense::Position); },
    },
    Failsafe{
        .id = "sensor_left_out",
        .seen = "gyro, velocity, compass or antennas contradict the others: one is left out",
        .after = "0.6 s",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .test = [](const Facts& f, const SafetyParams&, Time) -> Told { return left_out(f); },
        .provoke = [](MadeUp& m) { leave_out(m, Sense::Gyro); },
    },
};

}  // namespace

std::span<const Failsafe> sensor_failsafes() noexcept {
  return kSensorRows;
}

}  // namespace roverd::robot
