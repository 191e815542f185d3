#pragma once
// Settings of the Bunker driver.

#include <string>

#include "base/params.hpp"

namespace roverd::bunker {

struct Params {
  double max_linear_mps = 1.5;
  double max_angular_radps = 0.7853;
  std::string rc_left_stick_order = "ud_lr";
  std::string error_table = "current";
  double lost_after_s = 0.5;
  double motion_fresh_s = 0.3;
  double state_fresh_s = 0.7;
  double mode_request_period_s = 0.5;
  int stop_frames = 5;
  bool ask_firmware = true;
  double odometer_max_mps = 4.0;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
  double v1_full_linear_mps = 3.0;
  double v1_full_angular_radps = 2.5235;
};

template <class V>
void fields(V& v, Params& p) {
  v("max_linear_mps", p.max_linear_mps, 0.0, 3.0, "commands are cut to this");
  v("max_angular_radps", p.max_angular_radps, 0.0, 3.0, "commands are cut to this");
  v("rc_left_stick_order", p.rc_left_stick_order,
    "ud_lr or lr_ud: which byte of 0x241 is the left stick's up and down; push it and look");
  v("error_table", p.error_table, "current or old: where the firmware puts its error bits");
  v("lost_after_s", p.lost_after_s, 0.1, 5.0, "without 0x211 and 0x221 the base is lost");
  v("motion_fresh_s", p.motion_fresh_s, 0.05, 2.0, "older 0x221: no motion leaves");
  v("state_fresh_s", p.state_fresh_s, 0.05, 2.0, "older 0x211: no motion leaves");
  v("mode_request_period_s", p.mode_request_period_s, 0.5, 10.0,
    "between two requests for CAN mode while the base is in standby");
  v("stop_frames", p.stop_frames, 1, 50, "zero commands before the base is sent to standby");
  v("ask_firmware", p.ask_firmware,
    "ask the base for its firmware's version (0x4A1, 0x411) while it is up");
  v("odometer_max_mps", p.odometer_max_mps, 0.5, 20.0,
    "a faster odometer step or reported speed is impossible");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0,
    "an open but silent bus is opened again; 0: never (recordings with gaps)");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
  v("v1_full_linear_mps", p.v1_full_linear_mps, 0.1, 10.0,
    "100 percent of a base with protocol V1; too small a value makes it faster than commanded");
  v("v1_full_angular_radps", p.v1_full_angular_radps, 0.1, 10.0, "likewise, turning");
}

/// What `fields` cannot say: the words allowed in the text fields. The error names the field.
base::Result<void> validate(const Params& params);

}  // namespace roverd::bunker
