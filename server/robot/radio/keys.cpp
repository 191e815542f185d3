#include "robot/radio/keys.hpp"

namespace roverd::robot {
namespace {

using base::Mode;
using base::Switch;

constexpr RadioAction kSwitchActions[] = {
    {"none", "nothing", RadioDeed::None},
    {"by_knob", "what the knob chooses", RadioDeed::ByKnob},
    {"mode.manual", "mode MANUAL", RadioDeed::SetMode, Mode::Manual},
    {"mode.hold", "mode HOLD", RadioDeed::SetMode, Mode::Hold},
    {"mode.auto", "mode AUTO", RadioDeed::SetMode, Mode::Auto},
    {"mode.guided", "mode GUIDED", RadioDeed::SetMode, Mode::Guided},
    {"mode.rtl", "mode RTL", RadioDeed::SetMode, Mode::Rtl},
    {"mode.smart_rtl", "mode SMART_RTL", RadioDeed::SetMode, Mode::SmartRtl},
    {"mode.follow", "mode FOLLOW", RadioDeed::SetMode, Mode::Follow},
    {"mode.steering", "mode STEERING", RadioDeed::SetMode, Mode::Steering},
    {"mode.acro", "mode ACRO", RadioDeed::SetMode, Mode::Acro},
    {"mode.simple", "mode SIMPLE", RadioDeed::SetMode, Mode::Simple},
    {"mode.dock", "mode DOCK", RadioDeed::SetMode, Mode::Dock},
    {"mode.loiter", "mode LOITER, here", RadioDeed::SetMode, Mode::Loiter},
    {"arm", "arm", RadioDeed::Arm},
    {"disarm", "disarm", RadioDeed::Disarm},
    {"estop", "emergency stop", RadioDeed::Estop},
    {"mission.add_waypoint", "add a waypoint here", RadioDeed::AddWaypoint},
    {"mission.remove_current", "remove the current waypoint", RadioDeed::RemoveCurrent},
    {"mission.clear", "clear the mission", RadioDeed::ClearMission},
    {"mission.start", "start or resume the mission", RadioDeed::StartMission},
    {"mission.pause", "pause the mission", RadioDeed::PauseMission},
    {"mission.stop", "stop the mission", RadioDeed::StopMission},
    {"home.set", "set home here", RadioDeed::SetHome},
    {"teach.start", "start or resume the recording", RadioDeed::StartTeach},
    {"teach.pause", "pause the recording", RadioDeed::PauseTeach},
    {"teach.stop", "make a mission of the recording", RadioDeed::StopTeach},
    {"teach.discard", "discard the recording", RadioDeed::DiscardTeach},
};

/// Checks every field that names an action; those with a range are none.
struct CheckWords {
  std::string_view bad{};
  std::string word{};
  bool knob_by_knob = false;

  template <class N>
  void operator()(std::string_view, N&, double, double, std::string_view) {}
  void operator()(std::string_view, bool&, std::string_view) {}
  void operator()(std::string_view name, std::string& value, std::string_view) {
    if (!bad.empty()) return;
    const RadioAction* action = radio_action(value);
    const bool circle =
        name.starts_with("knob_") && action != nullptr && action->deed == RadioDeed::ByKnob;
    if (action != nullptr && !circle) return;
    bad = name;
    word = value;
    knob_by_knob = circle;
  }
};

}  // namespace

const RadioAction* radio_action(std::string_view word) noexcept {
  for (const RadioAction& action : kSwitchActions) {
    if (action.word == word) return &action;
  }
  return nullptr;
}

base::Result<void> check(const RadioParams& params) {
  CheckWords words;
  RadioParams copy = params;
  fields(words, copy);
  if (words.bad.empty()) return {};
  std::string detail(words.bad);
  if (words.knob_by_knob) {
    detail += " cannot be by_knob: the knob would ask itself";
  } else {
    detail += " must be one of";
    for (const RadioAction& action : kSwitchActions) {
      detail += (&action == kSwitchActions ? " " : ", ") + std::string(action.word);
    }
    detail += "; is \"" + words.word + "\"";
  }
  std::string text = detail.substr(words.bad.size() + 1);
  return base::fail(base::Code::Invalid, std::move(detail),
                    {{std::string(words.bad), std::move(text)}});
}

RadioKey RadioKeys::swa(Switch position) const noexcept {
  if (position == Switch::Up) return {radio_action(params_->swa_up), "SWA up"};
  if (position == Switch::Down) return {radio_action(params_->swa_down), "SWA down"};
  return {};
}

RadioKey RadioKeys::swc(Switch position) const noexcept {
  if (position == Switch::Up) return {radio_action(params_->swc_up), "SWC up"};
  if (position == Switch::Middle) return {radio_action(params_->swc_middle), "SWC middle"};
  if (position == Switch::Down) return {radio_action(params_->swc_down), "SWC down"};
  return {};
}

RadioKey RadioKeys::swd(Switch position) const noexcept {
  if (position == Switch::Up) return {radio_action(params_->swd_up), "SWD up"};
  if (position == Switch::Down) return {radio_action(params_->swd_down), "SWD down"};
  return {};
}

void RadioKeys::lost() noexcept {
  swa_key_ = swc_key_ = swd_key_ = {};
}

const RadioAction* RadioKeys::by_knob(double vra) const noexcept {
  const double limit = params_->knob_limit_pct / 100.0;
  return radio_action(vra < -limit  ? params_->knob_low
                      : vra > limit ? params_->knob_high
                                    : params_->knob_middle);
}

/// @return true if the key has just come to stand in another position than before.
bool RadioKeys::settles(Key& key, Switch position, Time stamp) const noexcept {
  if (position == Switch::Unknown || position == key.settled) {
    key.candidate = Switch::Unknown;
    return false;
  }
  if (position != key.candidate) {
    key.candidate = position;
    key.since = stamp;
  }
  if (base::seconds(stamp - key.since) < params_->debounce_s) return false;
  const bool acts = key.settled.has_value();
  key.settled = position;
  key.candidate = Switch::Unknown;
  return acts;
}

RadioKeys::Pressed RadioKeys::take(const base::RadioState& radio, Switch swb) noexcept {
  if (last_ && base::seconds(radio.stamp - *last_) > safety_->radio_timeout_s) lost();
  last_ = radio.stamp;
  Pressed pressed{};
  if (settles(swd_key_, radio.swd, radio.stamp)) pressed[0] = swd(radio.swd);
  if (settles(swc_key_, radio.swc, radio.stamp)) pressed[1] = swc(radio.swc);
  const bool blocked = params_->swb_down_blocks_swa && swb == Switch::Down;
  if (settles(swa_key_, radio.swa, radio.stamp) && !blocked) {
    pressed[2] = swa(radio.swa);
  }
  for (RadioKey& key : pressed) {
    if (key.action != nullptr && key.action->deed == RadioDeed::ByKnob) {
      key.action = by_knob(radio.vra);
    }
    if (key.action != nullptr && key.action->deed == RadioDeed::None) key = {};
  }
  return pressed;
}

RadioPositions RadioKeys::positions(const base::RadioState& radio) const noexcept {
  return {swa(radio.swa).action, swc(radio.swc).action, swd(radio.swd).action, by_knob(radio.vra)};
}

}  // namespace roverd::robot
