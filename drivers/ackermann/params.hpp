#pragma once
// Settings of the Ackermann driver.

#include "base/params.hpp"

namespace roverd::ackermann {

struct Params {
  double wheelbase_m = 1.3;
  double max_speed_mps = 1.4;
  double max_accel_mps2 = 3.0;
  double max_wheel_rad = 0.7;
  double max_wheel_rate_radps = 0.8;
  double zero_rad = 0.0;
  bool zero_learn = true;
  double zero_max_rad = 0.12;
  double assumed_delay_s = 0.25;
  double command_timeout_s = 0.25;
  bool feedback_required = false;
  double feedback_timeout_s = 0.3;
  double possible_speed_mps = 15.0;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("wheelbase_m", p.wheelbase_m, 0.1, 10.0, "between the axles");
  v("max_speed_mps", p.max_speed_mps, 0.0, 15.0, "commands are cut to this");
  v("max_accel_mps2", p.max_accel_mps2, 0.1, 20.0, "commands grow no faster; stopping is at once");
  v("max_wheel_rad", p.max_wheel_rad, 0.01, 1.4, "of the middle front wheel, either side");
  v("max_wheel_rate_radps", p.max_wheel_rate_radps, 0.01, 20.0, "the wheel is turned no faster");
  v("zero_rad", p.zero_rad, -0.5, 0.5,
    "added to every wheel angle that is sent, taken from every one that is heard");
  v("zero_learn", p.zero_learn,
    "correct the zero further while driving straight, where the controller reports the angle");
  v("zero_max_rad", p.zero_max_rad, 0.0, 0.5, "the learned part is never larger");
  v("assumed_delay_s", p.assumed_delay_s, 0.0, 1.2,
    "a controller that tells nothing is believed to do so late what it was told");
  v("command_timeout_s", p.command_timeout_s, 0.05, 0.25, "an older command: speed 0, park");
  v("feedback_required", p.feedback_required,
    "the controller sends the same layout back; without it the car is lost");
  v("feedback_timeout_s", p.feedback_timeout_s, 0.05, 2.0,
    "once it has spoken, so long a silence: nothing moves");
  v("possible_speed_mps", p.possible_speed_mps, 0.5, 60.0, "faster feedback is refused");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0,
    "a silent port is opened again, where feedback is required; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

base::Result<void> validate(const Params& params);

}  // namespace roverd::ackermann
