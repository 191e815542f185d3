#pragma once
// Settings of the twist driver.

#include <string>

#include "base/params.hpp"

namespace roverd::twist {

struct Params {
  std::string form = "text";
  double max_linear_mps = 1.0;
  double max_angular_radps = 1.5;
  double max_accel_mps2 = 3.0;
  double max_turn_accel_radps2 = 8.0;
  double command_timeout_s = 0.25;
  double feedback_timeout_s = 0.3;
  double travel_max_mps = 5.0;
  double silent_reopen_s = 3.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("form", p.form, "text or binary: how the device speaks");
  v("max_linear_mps", p.max_linear_mps, 0.0, 10.0, "commands are cut to this");
  v("max_angular_radps", p.max_angular_radps, 0.0, 10.0, "commands are cut to this");
  v("max_accel_mps2", p.max_accel_mps2, 0.1, 20.0, "commands grow no faster; stopping is at once");
  v("max_turn_accel_radps2", p.max_turn_accel_radps2, 0.1, 50.0, "the same for the turn rate");
  v("command_timeout_s", p.command_timeout_s, 0.05, 0.25, "an older command: stop");
  v("feedback_timeout_s", p.feedback_timeout_s, 0.05, 2.0, "so long a silence: nothing moves");
  v("travel_max_mps", p.travel_max_mps, 0.1, 50.0, "faster travel is impossible: refused");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

base::Result<void> validate(const Params& params);

}  // namespace roverd::twist
