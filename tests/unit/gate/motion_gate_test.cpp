#include "gate/motion_gate.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "gate/command_box.hpp"

namespace roverd::gate {
namespace {

using std::chrono::milliseconds;

MotionLimits limits() {
  return {.max_speed = 1.0, .max_turn = 2.0, .max_speed_step = 0.2, .max_turn_step = 0.5};
}
constexpr Motion kStop{};
constexpr Motion drive(double speed, double turn) {
  return {speed, turn, true};
}

TEST(MotionGate, IsSilentUntilPermittedButAlwaysLetsAStopOut) {
  MotionGate gate(limits());
  const Time now{};
  EXPECT_EQ(gate.check(drive(0.1, 0.0), now), Refusal::NotPermitted);
  EXPECT_EQ(gate.check(drive(0.0, 0.0), now), Refusal::NotPermitted);
  EXPECT_EQ(gate.check(kStop, now), Refusal::None);
  gate.permit(true);
  EXPECT_EQ(gate.check(drive(0.1, 0.0), now), Refusal::None);
  gate.permit(false);
  EXPECT_EQ(gate.check(drive(0.1, 0.0), now), Refusal::NotPermitted);
  EXPECT_EQ(gate.check(kStop, now), Refusal::None);
  EXPECT_EQ(gate.refused_total(), 3U);
}

TEST(MotionGate, WhatDoesNotDecodeOrIsNotFiniteOrHalfAStopStaysInside) {
  MotionGate gate(limits());
  gate.permit(true);
  const Time now{};
  EXPECT_EQ(gate.check({}, now), Refusal::WrongContent);
  EXPECT_EQ(gate.check(drive(std::nan(""), 0.0), now), Refusal::WrongContent);
  EXPECT_EQ(gate.check(drive(0.0, std::numeric_limits<double>::infinity()), now),
            Refusal::WrongContent);
  EXPECT_EQ(gate.check(Motion{0.1, 0.0, false}, now), Refusal::WrongContent);
  EXPECT_EQ(gate.check(Motion{0.0, 0.1, false}, now), Refusal::WrongContent);
}

TEST(MotionGate, LimitsAndStepsHoldAndSlowingDownIsFree) {
  MotionGate gate(limits());
  gate.permit(true);
  Time now{};
  const auto next = [&](double speed, double turn) {
    now += milliseconds(20);
    return gate.check(drive(speed, turn), now);
  };
  EXPECT_EQ(next(1.1, 0.0), Refusal::TooLarge);
  EXPECT_EQ(next(0.0, -2.1), Refusal::TooLarge);
  EXPECT_EQ(next(0.3, 0.0), Refusal::TooSudden);
  EXPECT_EQ(next(0.0, 0.6), Refusal::TooSudden);
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(next(0.19 * i, 0.4 * i), Refusal::None);
  EXPECT_EQ(next(0.0, 0.0), Refusal::None);
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(next(0.19 * i, 0.0), Refusal::None);
  EXPECT_EQ(next(-0.3, 0.0), Refusal::TooSudden) << "a reversal counts from zero";
  EXPECT_EQ(next(-0.1, 0.0), Refusal::None);
  now += milliseconds(700);
  EXPECT_EQ(next(0.3, 0.0), Refusal::TooSudden) << "after a pause steps count from zero";
}

TEST(MotionGate, AWheelAngleStepsBothWaysAndMayStandDuringAStop) {
  MotionLimits l = limits();
  l.turn_holds = true;
  MotionGate gate(l);
  gate.permit(true);
  EXPECT_EQ(gate.check(drive(0.0, 0.5), Time{}), Refusal::None);
  EXPECT_EQ(gate.check(drive(0.0, 1.0), Time{}), Refusal::None);
  EXPECT_EQ(gate.check(drive(0.0, 0.0), Time{}), Refusal::TooSudden);
  EXPECT_EQ(gate.check(Motion{0.0, 1.0, false}, Time{}), Refusal::None);
  EXPECT_EQ(gate.check(Motion{0.0, 2.1, false}, Time{}), Refusal::TooLarge);
}

TEST(MotionGate, WhereThereIsFeedbackItMustBeFresh) {
  MotionLimits l = limits();
  l.feedback_max_age_s = 0.3;
  MotionGate gate(l);
  gate.permit(true);
  EXPECT_EQ(gate.check(drive(0.1, 0.0), Time{}), Refusal::Stale);
  gate.saw(Time{});
  EXPECT_EQ(gate.check(drive(0.1, 0.0), Time{milliseconds(300)}), Refusal::None);
  EXPECT_EQ(gate.check(drive(0.1, 0.0), Time{milliseconds(301)}), Refusal::Stale);
  gate.saw(Time{milliseconds(310)});
  gate.permit(false);
  gate.permit(true);
  EXPECT_EQ(gate.check(drive(0.1, 0.0), Time{milliseconds(311)}), Refusal::Stale)
      << "a new permission begins with fresh feedback";
}

TEST(CommandBox, OldDisabledOrNotFiniteIsAStop) {
  CommandBox box;
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{0.5, -0.25}, true}, Time{});
  EXPECT_EQ(box.take(Time{milliseconds(250)}, 0.25), (base::BodyTwist{0.5, -0.25}));
  EXPECT_FALSE(box.take(Time{milliseconds(251)}, 0.25));
  box.put({{0.5, 0.0}, false}, Time{});
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{std::nan(""), 0.0}, true}, Time{});
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{0.5, 0.0}, true}, Time{});
  box.clear();
  EXPECT_FALSE(box.take(Time{}, 0.25));
}

TEST(Eased, GrowsByAStepAndSlowsDownAtOnce) {
  EXPECT_DOUBLE_EQ(eased(0.0, 1.0, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(eased(0.5, 1.0, 0.25), 0.75);
  EXPECT_DOUBLE_EQ(eased(-0.5, -1.0, 0.25), -0.75);
  EXPECT_DOUBLE_EQ(eased(0.9, 1.0, 0.25), 1.0);
  EXPECT_DOUBLE_EQ(eased(1.0, 0.1, 0.25), 0.1);
  // A reversal begins at zero.
  EXPECT_DOUBLE_EQ(eased(1.0, -1.0, 0.25), -0.25);
}

}  // namespace
}  // namespace roverd::gate
