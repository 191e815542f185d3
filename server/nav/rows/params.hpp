#pragma once
// What the finding of rows may be told. Section [nav.rows].

#include "base/params.hpp"

namespace roverd::nav::rows {

struct RowParams {
  double low_m = 0.10;
  double high_m = 1.50;
  double ahead_m = 4.5;
  double behind_m = 3.0;
  double gate_m = 0.30;
  double plant_m = 0.06;
  double width_min_m = 0.8;
  double width_max_m = 4.0;
  double search_deg = 20.0;
  double end_gap_m = 2.5;
  double end_after_m = 2.0;
  double blind_part = 0.5;
  double rays_far_m = 3.0;
  double rays_fan_deg = 34.0;
  double rays_band_m = 0.30;
  int rays_side = 5;
  friend bool operator==(const RowParams&, const RowParams&) = default;
};

template <class V>
void fields(V& v, RowParams& p) {
  v("low_m", p.low_m, -0.5, 2.0, "plants are looked for from this height above the ground");
  v("high_m", p.high_m, 0.1, 5.0, "up to this");
  v("ahead_m", p.ahead_m, 1.0, 15.0, "so far ahead of the robot the row is laid through plants");
  v("behind_m", p.behind_m, 0.0, 10.0, "and so far behind it, through those that it has passed");
  v("gate_m", p.gate_m, 0.1, 1.0, "plants stand so near to where the row's side is expected");
  v("plant_m", p.plant_m, 0.01, 0.5,
    "1 sigma by which half a metre of plants leans in or stands back; more where it is seen so");
  v("width_min_m", p.width_min_m, 0.3, 10.0, "between the two sides' plants, at least");
  v("width_max_m", p.width_max_m, 0.5, 10.0, "and at most");
  v("search_deg", p.search_deg, 1.0, 45.0, "a row is begun pointing along it within this");
  v("end_gap_m", p.end_gap_m, 0.5, 10.0,
    "the row ends where so much more of it is seen to be without plants; shorter is a gap");
  v("end_after_m", p.end_after_m, 0.0, 20.0, "so much of a row must have been seen before its end");
  v("blind_part", p.blind_part, 0.05, 1.0,
    "a scan of which more than this share is unknown, and which sees no ground, tells nothing of "
    "rows");
  v("rays_far_m", p.rays_far_m, 0.5, 30.0, "seeing by rays: farther ones are endless");
  v("rays_fan_deg", p.rays_fan_deg, 5.0, 120.0, "likewise: to either side of straight ahead");
  v("rays_band_m", p.rays_band_m, 0.02, 2.0, "likewise: so far above and below the sensor");
  v("rays_side", p.rays_side, 1, 30, "likewise: so many outermost rays of a side are counted");
}

/// Two that leave nothing between them would make it blind.
inline base::Result<void> check(const RowParams& p) {
  if (!(p.low_m < p.high_m)) {
    return base::fail(base::Code::Invalid, "low_m must be smaller than high_m",
                      {{"low_m", "must be smaller than high_m"}});
  }
  if (!(p.width_min_m < p.width_max_m)) {
    return base::fail(base::Code::Invalid, "width_min_m must be smaller than width_max_m",
                      {{"width_min_m", "must be smaller than width_max_m"}});
  }
  return {};
}

}  // namespace roverd::nav::rows
