#pragma once
// Settings of the bumper driver.

#include "base/params.hpp"

namespace roverd::bumper {

struct Params {
  double silent_after_s = 0.5;
  double silent_reopen_s = 3.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("silent_after_s", p.silent_after_s, 0.1, 10.0,
    "without an intact line for so long the bumper is lost, and the robot holds");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

inline base::Result<void> validate(const Params&) {
  return {};
}

}  // namespace roverd::bumper
