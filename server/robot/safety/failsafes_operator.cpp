// The failsafes of who watches over the robot.

#include <array>

#include "robot/safety/failsafe_words.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/words.hpp"

namespace roverd::robot {
namespace {

using Told = std::optional<std::string>;

/// No operator is heard, and `what` shall follow.
Told link_lost(const Facts& f, const SafetyParams& p, Time now, std::string_view what) {
  if (p.link_lost != what) return {};
  const auto& heard = f.world.operators;
  if (!heard) return "no operator has been heard yet";
  if (!older(heard->stamp, p.link_timeout_s, now)) return {};
  return "no operator has been heard for " + number(base::seconds(now - heard->stamp), "%.0f s");
}

constexpr std::array kOperatorRows{
    Failsafe{
        .id = "link_lost",
        .seen = "no operator is heard any more (no stream that watches the vehicle says a word), "
                "and hold is chosen instead of {link_lost}",
        .after = "{link_timeout_s}",
        .response = Response::Hold,
        .acts = Acts::ByItself,
        .ends = kGoneAndGoOn,
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p,
                   Time now) { return link_lost(f, p, now, "hold"); },
        .provoke =
            [](MadeUp& m) {
              m.params.link_lost = "hold";
              m.world.operators.reset();
            },
    },
    Failsafe{
        .id = "link_lost",
        .seen = "the same, and return is chosen",
        .after = "{link_timeout_s}",
        .response = Response::Return,
        .acts = Acts::ByItself,
        .ends = "home is reached; an operator is heard and says what is next",
        .over = kHands,
        .test = [](const Facts& f, const SafetyParams& p,
                   Time now) { return link_lost(f, p, now, "return"); },
        .provoke =
            [](MadeUp& m) {
              m.params.link_lost = "return";
              m.world.operators->stamp = m.now - std::chrono::hours(1);
            },
    },
};

}  // namespace

std::span<const Failsafe> operator_failsafes() noexcept {
  return kOperatorRows;
}

}  // namespace roverd::robot
