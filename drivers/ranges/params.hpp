#pragma once
// Settings of the driver of range sensors. Lists are numbers with blanks or commas between; one
// number holds for all ranges.

#include <string>

#include "base/params.hpp"

namespace roverd::ranges {

struct Params {
  int count = 1;
  std::string unit = "m";
  std::string bearings_deg = "0";
  std::string fov_deg = "30";
  std::string x_m = "0";
  std::string y_m = "0";
  double fan_step_deg = 5.0;
  double max_range_m = 4.0;
  double clear_to_m = 0.0;
  double latency_s = 0.0;
  double silent_after_s = 0.3;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("count", p.count, 1, 16, "ranges in a line; a line with more or fewer is refused");
  v("unit", p.unit, "of a number that tells none: m, cm or mm");
  v("bearings_deg", p.bearings_deg,
    base::only_disarmed("where each range looks, from the mount's ahead, left positive"));
  v("fov_deg", p.fov_deg, base::only_disarmed("how wide each range looks, 1 to 120"));
  v("x_m", p.x_m, base::only_disarmed("where each range's sensor stands, ahead of the mount"));
  v("y_m", p.y_m, base::only_disarmed("the same, left of the mount"));
  v("fan_step_deg", p.fan_step_deg, 0.5, 30.0,
    "between the points of the arc that a range becomes");
  v("max_range_m", p.max_range_m, 0.05, 100.0, "what is farther counts as nothing seen");
  v("clear_to_m", p.clear_to_m, 0.0, 20.0,
    base::lower_is_stricter("nothing seen counts as free so far; 0: as unknown, since soft and "
                            "slanting things give no echo either"));
  v("latency_s", p.latency_s, 0.0, 1.0, "from the measuring to the line's arrival");
  v("silent_after_s", p.silent_after_s, 0.1, 10.0, "without a line for so long they are lost");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

/// Names the field that is no list of numbers, has too many or too few, or is out of range.
base::Result<void> validate(const Params& p);

}  // namespace roverd::ranges
