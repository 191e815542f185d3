#include "robot/safety/failsafes.hpp"

#include <array>

#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/safety.hpp"

namespace roverd::robot {
namespace {

constexpr std::array kElsewhere{
    Failsafe{
        .id = "fence",
        .seen = "what is commanded would not stop inside the fence (braking, delay, uncertainty)",
        .after = "at once",
        .response = Response::Hold,
        .ends = "an operator drives away from it; by hand it only stops",
        .over = kRadio,
        .watched_by = "server/robot/safety/fence_keep.hpp",
    },
    Failsafe{
        .id = "teleop_stale",
        .seen = "the commands by hand stop coming",
        .after = "`robot.manual.timeout_s`",
        .response = Response::Hold,
        .acts = Acts::ByHand,
        .ends = "the stick is let go, then it acts again",
        .over = kRadio,
        .watched_by = "server/robot/modes/by_hand.hpp",
    },
    Failsafe{
        .id = "link_delay",
        .seen =
            "who drives by hand is late: round trip and jitter pass `robot.manual.delay_free_s`",
        .after = "at once",
        .response = Response::Slow,
        .acts = Acts::ByHand,
        .ends = "by itself; at `robot.manual.delay_stop_s` it stands",
        .over = kRadio,
        .watched_by = "server/robot/modes/link_delay.hpp",
    },
    Failsafe{
        .id = "release_stick",
        .seen = "a stick is held already when something begins",
        .after = "at once",
        .response = Response::Hold,
        .acts = Acts::ByHand,
        .ends = "the stick is let go",
        .over = kRadio,
        .watched_by = "server/robot/modes/manual.hpp",
    },
    Failsafe{
        .id = "auto_hand",
        .seen = "the hand on the speed of what drives by itself is let go, silent or gone, after "
                "one was there",
        .after = "at once; silence: `robot.manual.auto_timeout_s`",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = "a hand holds it again, after silence let go first; or HOLD, and a person's start",
        .over = kHands,
        .watched_by = "server/robot/modes/auto_hand.hpp",
    },
    Failsafe{
        .id = "heading_unknown",
        .seen = "the heading is not known: it creeps straight ahead to find it, and "
                "holds where 3 m do not show it",
        .after = "at once",
        .response = Response::Slow,
        .acts = Acts::ByItself,
        .ends = kEndsByItself,
        .over = kHands,
        .watched_by = "server/robot/positioning.cpp",
    },
    Failsafe{
        .id = "estimate_reset",
        .seen = "the sensors contradicted the estimate for too long: it was set anew, an event; "
                "what is driven goes on from the new place, or is off its route",
        .after = "2 s (5 s with a gyro)",
        .response = Response::None,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .watched_by = "server/robot/safety/estimate_watch.hpp",
    },
    Failsafe{
        .id = "input_refused",
        .seen = "positions, velocities, headings or distances are not used (jump, age, doubled, "
                "zero …), an event; what is missing then has rows of its own",
        .after = "2 s",
        .response = Response::None,
        .ends = kEndsByItself,
        .over = kNeedsNone,
        .watched_by = "server/robot/safety/estimate_watch.hpp",
    },
    Failsafe{
        .id = "cross_track_lost",
        .seen = "off the route by more than `nav.behave.lost_m`, or than the mission's corridor",
        .after = "`nav.behave.lost_s`",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "an operator's word",
        .over = kHands,
        .watched_by = "server/nav/behave/executor.hpp",
    },
    Failsafe{
        .id = "blocked",
        .seen = "driving, and no progress (stuck, slipping)",
        .after = "`nav.behave.stuck_s`",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "an operator's word; or skip or return, by `nav.behave.unreachable`, but "
                "not within a row",
        .over = kHands,
        .watched_by = "server/nav/behave/executor.hpp",
    },
    Failsafe{
        .id = "obstacle",
        .seen = "a sensor sees something on the way that is commanded, or none has seen that way",
        .after = "at once, down to standing",
        .response = Response::Slow,
        .ends = "by itself: the way has been clear for 1 s",
        .over = "by hand at creep speed, held down; the radio's sticks",
        .watched_by = "server/robot/guard/watched.cpp",
    },
    Failsafe{
        .id = "blocked",
        .seen = "the same, and what drives by itself has stood before it for so long",
        .after = "`sense.blocked.after_s`",
        .response = Response::Warn,
        .acts = Acts::ByItself,
        .ends = "the way is clear; or return, or the mission's end, by `sense.blocked.then`",
        .over = kHands,
        .watched_by = "server/robot/guard/blocked.hpp",
    },
    Failsafe{
        .id = "anchor_dropped",
        .seen = "the fix class changed under a position that an operator had anchored",
        .after = "at once",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = "an operator's word",
        .over = kHands,
        .watched_by = "server/robot/safety/estimate_watch.hpp",
    },
    Failsafe{
        .id = "loop_fault",
        .seen = "an exception ends a tick of the control loop",
        .after = "at once",
        .response = Response::Disarm,
        .ends = "an operator arms again",
        .over = kRadio,
        .watched_by = "server/robot/robot.cpp",
    },
};

}  // namespace

std::string_view to_string(Response r) noexcept {
  constexpr std::array<std::string_view, 7> kWords{"show", "warn",   "slow", "return",
                                                   "hold", "disarm", "stop"};
  return kWords.at(static_cast<std::size_t>(r));
}

std::string_view to_string(Acts a) noexcept {
  constexpr std::array<std::string_view, 3> kWords{"always", "by itself", "by hand"};
  return kWords.at(static_cast<std::size_t>(a));
}

std::span<const Failsafe> failsafes_elsewhere() noexcept {
  return kElsewhere;
}

std::span<const Failsafe> failsafes() noexcept {
  static const std::vector<Failsafe> all = [] {
    std::vector<Failsafe> rows;
    for (const auto theme : {base_failsafes(), operator_failsafes(), sensor_failsafes(),
                             position_failsafes(), supply_failsafes()}) {
      rows.insert(rows.end(), theme.begin(), theme.end());
    }
    return rows;
  }();
  return all;
}

bool acts_now(const Failsafe& row, const Facts& f, const SafetyParams& p, Time now) noexcept {
  if (row.response == Response::Return && f.homeward) return false;
  switch (row.acts) {
    case Acts::Always:
      return true;
    case Acts::ByItself:
      return f.autonomous && !radio_drives(f.world, p, now);
    case Acts::ByHand:
      return !f.autonomous;
  }
  return true;
}

}  // namespace roverd::robot
