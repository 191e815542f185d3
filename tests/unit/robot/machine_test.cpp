// The table of modes: every arrow, and that there is no other.

#include "robot/modes/machine.hpp"

#include <array>

#include <gtest/gtest.h>

namespace roverd::robot {
namespace {

using base::Mode;

constexpr std::array kModes{Mode::Manual, Mode::Hold,     Mode::Auto,   Mode::Guided,
                            Mode::Rtl,    Mode::SmartRtl, Mode::Follow, Mode::Steering,
                            Mode::Acro,   Mode::Simple,   Mode::Dock,   Mode::Loiter,
                            Mode::Circle};
constexpr std::array kByHand{Mode::Manual, Mode::Acro, Mode::Steering, Mode::Simple};
constexpr std::array kToGoals{Mode::Guided, Mode::Rtl,    Mode::SmartRtl, Mode::Follow,
                              Mode::Dock,   Mode::Loiter, Mode::Circle};

template <class All>
bool among(Mode mode, const All& all) {
  return std::find(all.begin(), all.end(), mode) != all.end();
}

ModeMachine in(Mode mode) {
  ModeMachine m;
  if (mode == Mode::Auto) {
    m.take(ModeCause::MissionDrives);
  } else {
    m.take(ModeCause::Chosen, mode);
  }
  EXPECT_EQ(m.mode(), mode);
  return m;
}

/// Where each cause leads from each mode: the table once more, in words of modes.
Mode expected(Mode from, ModeCause cause) {
  const bool by_itself = from == Mode::Auto || among(from, kToGoals);
  switch (cause) {
    case ModeCause::MissionDrives:
      return Mode::Auto;
    case ModeCause::Chosen:
    case ModeCause::Loss:
    case ModeCause::Estop:
    case ModeCause::EstopReset:
      return Mode::Hold;
    case ModeCause::Return:  // to HOLD here: no other mode was named
    case ModeCause::Armed:
    case ModeCause::Disarmed:
    case ModeCause::Fault:
      return by_itself ? Mode::Hold : from;
    case ModeCause::MissionOver:
      return from == Mode::Auto ? Mode::Hold : from;
    case ModeCause::ActivityOver:
      return among(from, kToGoals) && from != Mode::Guided ? Mode::Hold : from;
  }
  return from;
}

class EveryCause : public testing::TestWithParam<ModeCause> {};
INSTANTIATE_TEST_SUITE_P(Machine, EveryCause,
                         testing::Values(ModeCause::Chosen, ModeCause::MissionDrives,
                                         ModeCause::Loss, ModeCause::Estop, ModeCause::EstopReset,
                                         ModeCause::Armed, ModeCause::Disarmed, ModeCause::Fault,
                                         ModeCause::MissionOver, ModeCause::ActivityOver,
                                         ModeCause::Return));

TEST_P(EveryCause, LeadsFromEachModeWhereTheTableSays) {
  for (const Mode from : kModes) {
    ModeMachine m = in(from);
    const Mode to = expected(from, GetParam());
    const auto change = m.take(GetParam());
    EXPECT_EQ(m.mode(), to) << base::to_string(from);
    ASSERT_EQ(change.has_value(), to != from) << base::to_string(from);
    if (!change) continue;
    EXPECT_EQ(change->from, from);
    EXPECT_EQ(change->to, to);
    EXPECT_EQ(change->pauses_mission, from == Mode::Auto);
    EXPECT_FALSE(change->stands_first);
  }
}

TEST(Machine, AnyModeIsChosenFromAnyOtherAndTheRobotStandsBeforeItDrivesByItself) {
  for (const Mode from : kModes) {
    for (const Mode to : kModes) {
      if (to == Mode::Auto) continue;
      ModeMachine m = in(from);
      const auto change = m.take(ModeCause::Chosen, to);
      EXPECT_EQ(m.mode(), to);
      ASSERT_EQ(change.has_value(), from != to);
      if (!change) continue;
      EXPECT_EQ(change->stands_first, among(to, kToGoals)) << base::to_string(to);
      EXPECT_EQ(change->pauses_mission, from == Mode::Auto);
    }
  }
}

TEST(Machine, AReturnLeadsHomeFromWhatDrivesByItselfOnly) {
  for (const Mode from : kModes) {
    ModeMachine m = in(from);
    const bool by_itself = from == Mode::Auto || among(from, kToGoals);
    const auto change = m.take(ModeCause::Return, Mode::Rtl);
    EXPECT_EQ(m.mode(), by_itself ? Mode::Rtl : from) << base::to_string(from);
    if (!change) continue;
    EXPECT_TRUE(change->stands_first);
    EXPECT_EQ(change->pauses_mission, from == Mode::Auto);
  }
}

TEST(Machine, AutoIsNeverChosenOnlyBegun) {
  for (const Mode from : kModes) {
    if (from == Mode::Auto) continue;
    ModeMachine m = in(from);
    EXPECT_FALSE(m.take(ModeCause::Chosen, Mode::Auto));
    EXPECT_EQ(m.mode(), from);
  }
}

TEST(Machine, WhoAsksWhatWouldChangesNothing) {
  const ModeMachine m = in(Mode::Guided);
  ASSERT_TRUE(m.would(ModeCause::Loss));
  EXPECT_EQ(m.mode(), Mode::Guided);
}

TEST(Machine, KnowsWhoDrivesInEachMode) {
  for (const Mode mode : kModes) {
    const ModeKind kind = among(mode, kByHand)    ? ModeKind::ByHand
                          : among(mode, kToGoals) ? ModeKind::ByItself
                          : mode == Mode::Auto    ? ModeKind::Mission
                                                  : ModeKind::Standing;
    EXPECT_EQ(kind_of(mode), kind) << base::to_string(mode);
    EXPECT_EQ(drives_by_itself(mode), kind == ModeKind::Mission || kind == ModeKind::ByItself);
  }
}

}  // namespace
}  // namespace roverd::robot
