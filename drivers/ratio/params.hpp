#pragma once
// Settings of the speed-and-ratio driver.

#include "base/params.hpp"

namespace roverd::ratio {

struct Params {
  double track_width_m = 0.4;
  double max_wheel_mps = 0.8;
  double max_accel_mps2 = 1.0;
  double period_s = 0.2;
  double command_timeout_s = 0.25;
  double silent_reopen_s = 0.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("track_width_m", p.track_width_m, 0.05, 3.0, "between the driven wheels");
  v("max_wheel_mps", p.max_wheel_mps, 0.0, 5.0, "the faster wheel; the bend stays the same");
  v("max_accel_mps2", p.max_accel_mps2, 0.1, 10.0, "speed grows no faster; stopping is at once");
  v("period_s", p.period_s, 0.02, 0.4, "between two lines; a stop goes at once");
  v("command_timeout_s", p.command_timeout_s, 0.05, 0.25, "an older command: stop");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0,
    "a robot that has spoken and then is silent for so long is connected anew; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before connecting again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before connecting again");
}

inline base::Result<void> validate(const Params&) {
  return {};
}

}  // namespace roverd::ratio
