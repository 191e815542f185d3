#include "robot/modes/machine.hpp"

#include <array>

namespace roverd::robot {
namespace {

using base::Mode;

constexpr unsigned bit(ModeKind kind) noexcept {
  return 1U << static_cast<unsigned>(kind);
}
constexpr unsigned kByHand = bit(ModeKind::ByHand);
constexpr unsigned kStanding = bit(ModeKind::Standing);
constexpr unsigned kMission = bit(ModeKind::Mission);
constexpr unsigned kByItself = bit(ModeKind::ByItself);
constexpr unsigned kAny = kByHand | kStanding | kMission | kByItself;

enum class Leads { ToChosen, ToAuto, ToHold };

struct Arrow {
  ModeCause cause;
  unsigned from;  ///< kinds
  Leads leads;
  bool also_guided = true;  ///< GUIDED, where its kind is in `from`
};

/// The table of machine.hpp.
constexpr std::array kArrows{
    Arrow{ModeCause::Chosen, kAny, Leads::ToChosen},
    Arrow{ModeCause::MissionDrives, kAny, Leads::ToAuto},
    Arrow{ModeCause::Loss, kAny, Leads::ToHold},
    Arrow{ModeCause::Return, kMission | kByItself, Leads::ToChosen},
    Arrow{ModeCause::Estop, kAny, Leads::ToHold},
    Arrow{ModeCause::EstopReset, kAny, Leads::ToHold},
    Arrow{ModeCause::Armed, kMission | kByItself, Leads::ToHold},
    Arrow{ModeCause::Disarmed, kMission | kByItself, Leads::ToHold},
    Arrow{ModeCause::Fault, kMission | kByItself, Leads::ToHold},
    Arrow{ModeCause::MissionOver, kMission, Leads::ToHold},
    Arrow{ModeCause::ActivityOver, kByItself, Leads::ToHold, false},
};

}  // namespace

ModeKind kind_of(Mode mode) noexcept {
  switch (mode) {
    case Mode::Manual:
    case Mode::Acro:
    case Mode::Steering:
    case Mode::Simple:
      return ModeKind::ByHand;
    case Mode::Hold:
      return ModeKind::Standing;
    case Mode::Auto:
      return ModeKind::Mission;
    case Mode::Guided:
    case Mode::Rtl:
    case Mode::SmartRtl:
    case Mode::Follow:
    case Mode::Dock:
    case Mode::Loiter:
    case Mode::Circle:
      return ModeKind::ByItself;
  }
  return ModeKind::Standing;
}

bool drives_by_itself(Mode mode) noexcept {
  return kind_of(mode) == ModeKind::Mission || kind_of(mode) == ModeKind::ByItself;
}

bool leads_home(Mode mode) noexcept {
  return mode == Mode::Rtl || mode == Mode::SmartRtl || mode == Mode::Dock;
}

std::optional<ModeChange> ModeMachine::would(ModeCause cause, Mode chosen) const noexcept {
  for (const Arrow& arrow : kArrows) {
    if (arrow.cause != cause || (arrow.from & bit(kind())) == 0) continue;
    if (mode_ == Mode::Guided && !arrow.also_guided) continue;
    const Mode to = arrow.leads == Leads::ToAuto     ? Mode::Auto
                    : arrow.leads == Leads::ToChosen ? chosen
                                                     : Mode::Hold;
    // A mission is begun, not chosen.
    if (to == mode_ || (arrow.leads == Leads::ToChosen && to == Mode::Auto)) return std::nullopt;
    return ModeChange{mode_, to, mode_ == Mode::Auto, kind_of(to) == ModeKind::ByItself};
  }
  return std::nullopt;
}

std::optional<ModeChange> ModeMachine::take(ModeCause cause, Mode chosen) noexcept {
  const auto change = would(cause, chosen);
  if (change) mode_ = change->to;
  return change;
}

}  // namespace roverd::robot
