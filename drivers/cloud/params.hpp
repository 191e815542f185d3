#pragma once
// Settings of the cloud driver.

#include "base/params.hpp"
#include "base/sight.hpp"

namespace roverd::cloud {

struct Params {
  double min_range_m = 0.1;
  double max_range_m = 20.0;
  double clear_to_m = 0.0;
  int decimate = 2;
  int max_points = 1'000'000;
  double latency_s = 0.0;
  double silent_after_s = 0.3;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
  /// No setting: the sender's clock is this computer's own steady one.
  bool same_clock = false;
  /// No setting: how the camera's frame stands on the body, as the profile says.
  base::Mount mount{.z_m = 0.5};
};

template <class V>
void fields(V& v, Params& p) {
  v("min_range_m", p.min_range_m, 0.0, 10.0, "what seems nearer is unknown");
  v("max_range_m", p.max_range_m, 0.5, 1000.0, "what seems farther counts as nothing seen");
  v("clear_to_m", p.clear_to_m, 0.0, 100.0,
    base::lower_is_stricter(
        "where nothing is seen it counts as free so far; 0: as unknown, since black, shining and "
        "very near things give a depth camera nothing either"));
  v("decimate", p.decimate, 1, 16,
    "a depth image's squares of so many pixels give one point each: the nearest");
  v("max_points", p.max_points, 1, 4'000'000, "a frame with more is refused");
  v("latency_s", p.latency_s, 0.0, 1.0, "from the measuring to the sending, where it is known");
  v("silent_after_s", p.silent_after_s, 0.1, 10.0, "without a frame for so long it is lost");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

inline base::Result<void> validate(const Params& p) {
  if (p.min_range_m < p.max_range_m) return {};
  return base::fail(base::Code::Invalid, "min_range_m must be smaller than max_range_m",
                    {{"min_range_m", "must be smaller than max_range_m"}});
}

}  // namespace roverd::cloud
