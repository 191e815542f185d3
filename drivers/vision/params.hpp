#pragma once
// Settings of the driver of vision programs.

#include "base/params.hpp"

namespace roverd::vision {

struct Params {
  double latency_s = 0.1;
  double half_view_deg = 30.0;
  double silent_after_s = 2.0;
  double silent_reopen_s = 10.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("latency_s", p.latency_s, 0.0, 2.0, "from the taking of the image to the datagram's arrival");
  v("half_view_deg", p.half_view_deg, 5.0, 90.0,
    "the camera sees so far to either side of its axis: what is not told there is gone");
  v("silent_after_s", p.silent_after_s, 0.2, 60.0,
    "without a datagram for so long the camera's program is lost");
  v("silent_reopen_s", p.silent_reopen_s, 0.0, 600.0, "a silent port is opened again; 0: never");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before opening again");
}

inline base::Result<void> validate(const Params&) {
  return {};
}

}  // namespace roverd::vision
