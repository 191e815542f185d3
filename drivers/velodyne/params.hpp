#pragma once
// Settings of the Velodyne driver.

#include "base/params.hpp"

namespace roverd::velodyne {

struct Params {
  double min_range_m = 0.4;
  double max_range_m = 130.0;
  double clear_to_m = 0.0;
  bool vertical_offsets = false;
  double silent_after_s = 0.3;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("min_range_m", p.min_range_m, 0.0, 10.0, "a nearer return tells nothing: unknown");
  v("max_range_m", p.max_range_m, 1.0, 131.07, "a farther return counts as a missing one");
  v("clear_to_m", p.clear_to_m, 0.0, 100.0,
    base::lower_is_stricter(
        "a missing return counts as free so far; 0: as unknown, since black, wet and mirroring "
        "things send none back either"));
  v("vertical_offsets", p.vertical_offsets,
    "add each laser's own height over the middle of the sensor, 11 mm at most");
  v("silent_after_s", p.silent_after_s, 0.2, 10.0,
    "without a whole turn for so long the sensor is lost; it turns 5 to 20 times a second");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

inline base::Result<void> validate(const Params& p) {
  if (p.min_range_m < p.max_range_m) return {};
  return base::fail(base::Code::Invalid, "min_range_m must be smaller than max_range_m",
                    {{"min_range_m", "must be smaller than max_range_m"}});
}

}  // namespace roverd::velodyne
