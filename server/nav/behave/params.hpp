#pragma once
// When a mission counts as lost or stuck. Section [nav.behave].

#include <string>

#include "base/params.hpp"

namespace roverd::nav {

struct BehaveParams {
  double start_within_m = 50.0;
  double join_m = 3.0;
  double lost_m = 3.0;
  double lost_s = 0.5;
  double missed_m = 0.5;
  double arrive_sigmas = 3.0;
  double stuck_s = 10.0;
  double stuck_m = 0.3;
  double stuck_deg = 5.0;
  std::string unreachable = "stop";
};

template <class V>
void fields(V& v, BehaveParams& p) {
  v("start_within_m", p.start_within_m, 1.0, 10000.0,
    base::lower_is_stricter(
        "a mission whose first point is farther away is not started, nor rejoined"));
  v("join_m", p.join_m, 0.0, 50.0,
    base::lower_is_stricter(
        "a mission that is started from its first item goes on from where the robot stands, within "
        "this (or arrive_sigmas) of the way's beginning; 0: it always begins at item 1"));
  v("lost_m", p.lost_m, 0.2, 100.0,
    base::lower_is_stricter("farther from the path than this the robot stops"));
  v("lost_s", p.lost_s, 0.0, 10.0, base::lower_is_stricter("for so long"));
  v("missed_m", p.missed_m, 0.05, 10.0,
    base::lower_is_stricter(
        "a waypoint to stop at that is farther away then, and than its radius: blocked"));
  v("arrive_sigmas", p.arrive_sigmas, 0.0, 5.0,
    base::lower_is_stricter("and than so many sigmas of the position: nobody comes nearer to a "
                            "place than it is known"));
  v("stuck_s", p.stuck_s, 1.0, 120.0,
    base::lower_is_stricter("no progress for so long while driving: blocked"));
  v("stuck_m", p.stuck_m, 0.05, 10.0,
    base::higher_is_stricter("less way than this is no progress"));
  v("stuck_deg", p.stuck_deg, 1.0, 90.0,
    base::higher_is_stricter("less turning than this is no progress"));
  v("unreachable", p.unreachable,
    base::only_disarmed("what follows when an item cannot be reached: stop (blocked), skip (the "
                        "next item) or return "
                        "(home); in a row always stop"));
}

}  // namespace roverd::nav
