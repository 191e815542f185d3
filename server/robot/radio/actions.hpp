#pragma once
// What a switch of the radio may do, and what it does on this vehicle. Section [radio].

#include <string>
#include <string_view>

#include "base/result.hpp"
#include "base/snapshot.hpp"

namespace roverd::robot {

enum class RadioDeed {
  None,
  ByKnob,  ///< what the knob chooses
  SetMode,
  Arm,
  Disarm,
  Estop,
  AddWaypoint,
  RemoveCurrent,
  ClearMission,
  StartMission,  ///< or resume it
  PauseMission,
  StopMission,
  SetHome,
  StartTeach,  ///< or go on with it
  PauseTeach,
  StopTeach,
  DiscardTeach
};

struct RadioAction {
  std::string_view word;     ///< as in the configuration: "mission.add_waypoint"
  std::string_view meaning;  ///< for people: "add a waypoint here"
  RadioDeed deed = RadioDeed::None;
  base::Mode mode = base::Mode::Hold;  ///< with SetMode
};

/// The one of that word; null if there is none.
const RadioAction* radio_action(std::string_view word) noexcept;

/// Each field holds the word of an action. SWB is not here: it decides who drives.
struct RadioParams {
  double debounce_s = 0.1;
  double knob_limit_pct = 25.0;
  bool swb_down_blocks_swa = true;
  std::string swa_up = "none";
  std::string swa_down = "by_knob";
  std::string swc_up = "mode.manual";
  std::string swc_middle = "mode.auto";
  std::string swc_down = "mode.hold";
  std::string swd_up = "disarm";
  std::string swd_down = "arm";
  std::string knob_low = "mission.clear";
  std::string knob_middle = "mission.add_waypoint";
  std::string knob_high = "mission.remove_current";
};

template <class V>
void fields(V& v, RadioParams& p) {
  v("debounce_s", p.debounce_s, 0.02, 1.0, "a switch must stand so long before it counts");
  v("knob_limit_pct", p.knob_limit_pct, 1.0, 99.0,
    "the knob VRA is in the middle within this much of its half way, else low or high");
  v("swb_down_blocks_swa", p.swb_down_blocks_swa, "with SWB down SWA does nothing");
  v("swa_up", p.swa_up, "action");
  v("swa_down", p.swa_down, "action; by_knob: the one that the knob chooses at that moment");
  v("swc_up", p.swc_up, "action");
  v("swc_middle", p.swc_middle, "action");
  v("swc_down", p.swc_down, "action: the auxiliary mode");
  v("swd_up", p.swd_up, "action");
  v("swd_down", p.swd_down, "action");
  v("knob_low", p.knob_low, "what by_knob does with the knob turned left");
  v("knob_middle", p.knob_middle, "in the middle");
  v("knob_high", p.knob_high, "turned right");
}

/// Invalid, naming the first field whose word is no action, and the words that are.
base::Result<void> check(const RadioParams& params);

}  // namespace roverd::robot
