// The radio as user interface: thrown switches become commands, by the same ways and with the same
// refusals as those that come over the network. Edits of the mission go out as requests: the loop
// does not wait for the store.

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Code;
using base::Mode;
using base::Severity;

const char* refusal_of(RadioDeed deed) noexcept {
  switch (deed) {
    case RadioDeed::SetMode:
    case RadioDeed::StartMission:
      return "mode_refused";
    case RadioDeed::AddWaypoint:
    case RadioDeed::RemoveCurrent:
    case RadioDeed::ClearMission:
      return "mission_edit_refused";
    case RadioDeed::None:
    case RadioDeed::ByKnob:
    case RadioDeed::Arm:
    case RadioDeed::Disarm:
    case RadioDeed::Estop:
    case RadioDeed::PauseMission:
    case RadioDeed::StopMission:
    case RadioDeed::SetHome:
      break;
    case RadioDeed::StartTeach:
    case RadioDeed::PauseTeach:
    case RadioDeed::StopTeach:
    case RadioDeed::DiscardTeach:
      return "teach_refused";
  }
  return "radio_refused";
}

std::string_view meaning_of(const RadioAction* action) noexcept {
  return action != nullptr ? action->meaning : std::string_view{};
}

bool halts(const RadioAction& action) noexcept {
  const RadioDeed deed = action.deed;
  if (deed == RadioDeed::SetMode) return action.mode == Mode::Hold;
  return deed == RadioDeed::Disarm || deed == RadioDeed::Estop || deed == RadioDeed::PauseMission ||
         deed == RadioDeed::StopMission || deed == RadioDeed::ClearMission;
}

}  // namespace

void Robot::Impl::press(const base::RadioState& frame) {
  if (!radio_heard(world, config->safety, clock.now())) keys.lost();
  for (const RadioKey& key : keys.take(frame, world.swb)) {
    if (key.action != nullptr) pressed.push_back(key);
  }
}

void Robot::Impl::act_on_radio() {
  if (!radio_heard(world, config->safety, clock.now())) keys.lost();
  for (const RadioKey& key : pressed) {
    const RadioAction& action = *key.action;
    const std::string text = std::string(key.cause) + ": " + std::string(action.meaning);
    event(Severity::Info, "radio_action", text);
    asker = "by the radio";
    const bool stood = !machine.by_itself();
    const auto done = carry_out(action);
    if (done && stood && machine.by_itself()) auto_hand.begin();
    asker = kOperator;
    // Arming tells its refusal itself.
    if (done || action.deed == RadioDeed::Arm) continue;
    event(Severity::Warning, refusal_of(action.deed), text + " refused: " + done.error().detail);
  }
  pressed.clear();
}

base::Result<void> Robot::Impl::carry_out(const RadioAction& action) {
  if (halts(action)) last_stop.take(clock.now());
  switch (action.deed) {
    case RadioDeed::None:
    case RadioDeed::ByKnob:
      return {};
    case RadioDeed::SetMode:
      return action.mode == Mode::Auto ? drive_by_radio() : handle(SetMode{action.mode});
    case RadioDeed::Arm:
      return handle(Arm{});
    case RadioDeed::Disarm:
      disarm(asker);
      return {};
    case RadioDeed::Estop:
      latch_estop("the radio");
      return {};
    case RadioDeed::AddWaypoint:
    case RadioDeed::RemoveCurrent:
    case RadioDeed::ClearMission:
      return ask_for_edit(action.deed);
    case RadioDeed::StartMission:
      return drive_by_radio();
    case RadioDeed::PauseMission:
      return handle(PauseMission{});
    case RadioDeed::StopMission:
      return handle(StopMission{});
    case RadioDeed::SetHome:
      return handle(SetHome{});
    case RadioDeed::StartTeach:
      return ask_for_teach(TeachWish::Start);
    case RadioDeed::PauseTeach:
      return ask_for_teach(TeachWish::Pause);
    case RadioDeed::StopTeach:
      return ask_for_teach(TeachWish::Stop);
    case RadioDeed::DiscardTeach:
      return ask_for_teach(TeachWish::Discard);
  }
  return {};
}

/// Goes on with what was interrupted; else starts what is loaded. Whoever holds the radio stands
/// beside the robot and edits with it, and has no screen to compare revisions on.
base::Result<void> Robot::Impl::drive_by_radio() {
  if (missions.in_hand() || machine.mode() == Mode::Auto || !missions) {
    return handle(SetMode{Mode::Auto});
  }
  return start(nav::StartAt{});
}

base::Result<void> Robot::Impl::ask_for_edit(RadioDeed deed) {
  const bool adds = deed == RadioDeed::AddWaypoint;
  if (!adds && !missions) return base::fail(Code::Conflict, "no mission is loaded");
  if (deed != RadioDeed::RemoveCurrent && !pose) {
    return base::fail(Code::Conflict, "the position is not known");
  }
  MissionEdit edit;
  edit.wall = clock.wall();
  if (pose) edit.at = pose->global;
  if (missions) {
    edit.mission_id = missions->copy.id;
    edit.revision = missions->copy.revision;
  }
  if (deed == RadioDeed::RemoveCurrent) {
    edit.kind = EditKind::RemoveItem;
    edit.item = missions.executor.progress(std::nullopt).current_item;
  }
  if (deed == RadioDeed::ClearMission) {
    edit.kind = EditKind::Clear;
    // It stops now, not when the disk has written that it is empty.
    if (missions.in_hand()) missions.executor.stop("cleared by the radio");
    change_mode(ModeCause::MissionOver, "the mission was cleared");
  }
  if (!outbox.edit(std::move(edit))) {
    return base::fail(Code::Unavailable, "too many changes wait to be saved");
  }
  return {};
}

base::Result<void> Robot::Impl::ask_for_teach(TeachWish wish) {
  if (outbox.teach(wish)) return {};
  return base::fail(Code::Unavailable, "too many wishes wait");
}

base::RadioMeaning Robot::Impl::radio_meaning() const noexcept {
  base::RadioMeaning m;
  if (!world.radio) return m;
  const RadioPositions at = keys.positions(*world.radio);
  m.swa = meaning_of(at.swa);
  m.swc = meaning_of(at.swc);
  m.swd = meaning_of(at.swd);
  m.vra = meaning_of(at.knob);
  if (world.swb == base::Switch::Up) m.swb = "the computer drives";
  if (world.swb == base::Switch::Middle || world.swb == base::Switch::Down) {
    m.swb = "the sticks drive";
  }
  return m;
}

}  // namespace roverd::robot
