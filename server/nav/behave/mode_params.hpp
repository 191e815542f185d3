#pragma once
// What the modes other than AUTO hold to. Section [nav.modes].

#include "base/params.hpp"

namespace roverd::nav {

struct ModeParams {
  double move_mps = 0.3;
  double move_back_mps = 0.1;
  double turn_radps = 0.3;
  double stream_timeout_s = 3.0;
  double goal_cut_m = 0.0;
  double goal_cut_s = 2.0;
  double goal_within_m = 1.0;
  double crumb_m = 0.5;
  double dock_mps = 0.2;
  double dock_approach_m = 1.5;
  double dock_within_m = 0.05;
  double dock_within_deg = 3.0;
  double follow_gap_m = 2.0;
  double follow_gap_s = 0.8;
  double follow_stop_m = 1.5;
  double follow_max_m = 100.0;
  double follow_brake_s = 1.0;
  double follow_hold_s = 3.0;
  double follow_jump_mps = 8.0;
  double rate_gain = 1.0;
  double heading_gain = 1.5;
};

template <class V>
void fields(V& v, ModeParams& p) {
  v("move_mps", p.move_mps, 0.05, 2.0, "speed of a move by metres");
  v("move_back_mps", p.move_back_mps, 0.05, 2.0, "speed of a move backwards");
  v("turn_radps", p.turn_radps, 0.05, 2.0, "turn rate of a turn by an angle, over ground");
  v("stream_timeout_s", p.stream_timeout_s, 0.2, 10.0,
    base::lower_is_stricter("GUIDED by heading and speed stops without a newer one for so long"));
  v("goal_cut_m", p.goal_cut_m, 0.0, 1000.0,
    "farther goals are cut to this distance in their direction, and looked at anew while driving; "
    "0: the whole line is driven");
  v("goal_cut_s", p.goal_cut_s, 0.2, 60.0, "how often a cut goal is looked at anew");
  v("goal_within_m", p.goal_within_m, 0.05, 10.0, "a goal that may be cut is reached within");
  v("crumb_m", p.crumb_m, 0.1, 10.0,
    "SMART_RTL: the driven way is kept with this accuracy; less certain positions are left out");
  v("dock_mps", p.dock_mps, 0.05, 1.0, "DOCK: speed of the final straight");
  v("dock_approach_m", p.dock_approach_m, 0.3, 20.0, "DOCK: length of the final straight");
  v("dock_within_m", p.dock_within_m, 0.01, 1.0, "DOCK: docked within this distance of the pose");
  v("dock_within_deg", p.dock_within_deg, 0.5, 20.0, "DOCK: and this angle");
  v("follow_gap_m", p.follow_gap_m, 0.5, 50.0, "FOLLOW: distance to a standing target");
  v("follow_gap_s", p.follow_gap_s, 0.0, 10.0, "FOLLOW: and so much more for each m/s");
  v("follow_stop_m", p.follow_stop_m, 0.3, 50.0,
    base::higher_is_stricter("FOLLOW: nearer than this it stands"));
  v("follow_max_m", p.follow_max_m, 5.0, 1000.0, "FOLLOW: a target farther away is not followed");
  v("follow_brake_s", p.follow_brake_s, 0.2, 10.0,
    base::lower_is_stricter("FOLLOW: an older target: brake"));
  v("follow_hold_s", p.follow_hold_s, 0.5, 60.0,
    base::lower_is_stricter("FOLLOW: no target for so long: HOLD"));
  v("follow_jump_mps", p.follow_jump_mps, 0.5, 50.0,
    "FOLLOW: a target that seems faster has jumped, and is not believed");
  v("rate_gain", p.rate_gain, 0.0, 10.0, "ACRO: 1/s, how a turn rate that is off is made up for");
  v("heading_gain", p.heading_gain, 0.1, 10.0, "STEERING, SIMPLE: 1/s, turn rate for an error");
}

}  // namespace roverd::nav
