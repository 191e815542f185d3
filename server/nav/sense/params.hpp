#pragma once
// What the sense chain may be told. Sections [sense], [sense.ground], [sense.persist],
// [sense.grid], [sense.health], [sense.rays] and [sense.protect].

#include <cmath>

#include "base/params.hpp"

namespace roverd::nav::sense {

/// Points to voxels.
struct ReduceParams {
  double max_range_m = 8.0;
  double voxel_m = 0.05;
  double low_m = -2.5;
  double high_m = 2.5;
  double body_margin_m = 0.05;
  double body_height_m = 0.5;
};

template <class V>
void fields(V& v, ReduceParams& p) {
  v("max_range_m", p.max_range_m, 1.0, 30.0, "what is farther from the body is not looked at");
  v("voxel_m", p.voxel_m, 0.01, 0.5, "points within a cube of this side count as one");
  v("low_m", p.low_m, -10.0, 0.0, "what is deeper below the body's plane is not looked at");
  v("high_m", p.high_m, 0.2, 10.0, "what is higher above it is not, either");
  v("body_margin_m", p.body_margin_m, 0.0, 1.0,
    base::lower_is_stricter("what a sensor sees this close around the body is the body itself"));
  v("body_height_m", p.body_height_m, 0.05, 5.0, "up to this height");
}

/// Ground, obstacle, overhang.
struct GroundParams {
  double cell_m = 0.15;
  double max_slope_deg = 20.0;
  double min_height_m = 0.08;
  double rough_m = 0.05;
  double pass_below_m = 0.8;
  bool drop = false;
  double drop_m = 0.20;
};

template <class V>
void fields(V& v, GroundParams& p) {
  v("cell_m", p.cell_m, 0.05, 1.0, "the ground is laid through five by five cells of this side");
  v("max_slope_deg", p.max_slope_deg, 0.0, 45.0,
    base::lower_is_stricter("ground that rises more steeply against the body is an obstacle"));
  v("min_height_m", p.min_height_m, 0.02, 1.0,
    base::lower_is_stricter("what rises higher above the ground around it is an obstacle"));
  v("rough_m", p.rough_m, 0.0, 0.3, "half of the height of grass and ruts");
  v("pass_below_m", p.pass_below_m, 0.1, 5.0,
    base::higher_is_stricter("what hangs higher above the ground is passed below"));
  v("drop", p.drop, base::higher_is_stricter("ground that ends is an obstacle, too"));
  v("drop_m", p.drop_m, 0.05, 2.0, base::lower_is_stricter("a step down of more than this"));
}

/// Rain, dust, insects: what is seen once and not again.
struct PersistParams {
  double cell_m = 0.05;
  int hits = 3;
  int of_scans = 5;
  int at_once = 3;
  double least_m = 0.02;
};

template <class V>
void fields(V& v, PersistParams& p) {
  v("cell_m", p.cell_m, 0.03, 0.5, "hits within three by three cells of this side are the same");
  v("hits", p.hits, 1, 8, base::lower_is_stricter("a thing is there when that many scans"));
  v("of_scans", p.of_scans, 1, 8, base::higher_is_stricter("of the last so many saw it"));
  v("at_once", p.at_once, 1, 100,
    base::lower_is_stricter("or when one scan sees that many voxels of it: no delay"));
  v("least_m", p.least_m, 0.0, 0.1,
    base::lower_is_stricter(
        "what returns fewer echoes than a thing of this width is a drop: near a "
        "sensor many beams would meet it"));
}

/// The rolling grid.
struct GridParams {
  double size_m = 20.0;
  double cell_m = 0.05;
  int clear_scans = 2;
  double keep_free_s = 30.0;
  double keep_hit_s = 0.0;
};

template <class V>
void fields(V& v, GridParams& p) {
  v("size_m", p.size_m, 4.0, 60.0, "side of the square that moves with the robot");
  v("cell_m", p.cell_m, 0.02, 0.5, "side of a cell");
  v("clear_scans", p.clear_scans, 1, 20,
    base::higher_is_stricter("an obstacle is gone when so many scans saw through it"));
  v("keep_free_s", p.keep_free_s, 0.5, 3600.0,
    base::lower_is_stricter("out of sight, what was free is unknown after this"));
  v("keep_hit_s", p.keep_hit_s, 0.0, 36000.0,
    base::only_disarmed("out of sight, an obstacle is unknown after this; 0: it stays until it was "
                        "seen through, or the robot has gone away from it"));
}

/// A sensor's health.
struct HealthParams {
  double rate_hz = 10.0;
  double silent_s = 0.3;
  double min_rate_part = 0.7;
  double max_unknown_part = 0.5;
  double max_bad_part = 0.5;
};

template <class V>
void fields(V& v, HealthParams& p) {
  v("rate_hz", p.rate_hz, 0.5, 200.0, "pieces a second that the sensor should give");
  v("silent_s", p.silent_s, 0.05, 5.0, base::lower_is_stricter("older than this, it is blind"));
  v("min_rate_part", p.min_rate_part, 0.1, 1.0,
    base::higher_is_stricter("slower than this part of its rate, it is degraded"));
  v("max_unknown_part", p.max_unknown_part, 0.01, 1.0,
    base::lower_is_stricter("more directions unknown than this part: it is blind; half of it: "
                            "degraded"));
  v("max_bad_part", p.max_bad_part, 0.01, 1.0,
    base::lower_is_stricter("more points that are no numbers or stand in the sensor: the same"));
}

/// The planar scan out of a cloud, and the simple stop by counted rays (systems of the field,
/// sections 3 and 5).
struct RaysParams {
  bool enabled = false;
  bool instead = false;
  double fan_deg = 34.0;
  double step_deg = 1.0;
  double band_m = 0.30;
  double far_m = 3.0;
  double far_as_m = 4.0;
  double blind_m = 0.0;
  double stop_fan_deg = 15.94;
  double stop_m = 0.70;
  int stop_rays = 5;
  double slow_m = 1.5;
};

template <class V>
void fields(V& v, RaysParams& p) {
  v("enabled", p.enabled,
    base::higher_is_stricter("what drives ahead is stopped by counted rays as well"));
  v("instead", p.instead,
    base::lower_is_stricter("by them alone: nothing that is swept beside, behind or in a turn "
                            "stops it"));
  v("fan_deg", p.fan_deg, 1.0, 180.0, "to either side of straight ahead");
  v("step_deg", p.step_deg, 0.1, 10.0, "between neighbouring rays");
  v("band_m", p.band_m, 0.02, 2.0, "points so far above and below the sensor's height count");
  v("far_m", p.far_m, 0.5, 30.0, "farther rays count as endless");
  v("far_as_m", p.far_as_m, 0.5, 60.0, "and are written as this");
  v("blind_m", p.blind_m, 0.0, 2.0, "what seems nearer to the sensor than this is left out");
  v("stop_fan_deg", p.stop_fan_deg, 1.0, 180.0,
    base::higher_is_stricter("rays within this of straight ahead are counted"));
  v("stop_m", p.stop_m, 0.1, 10.0, base::higher_is_stricter("where they are shorter than this"));
  v("stop_rays", p.stop_rays, 1, 1000,
    base::lower_is_stricter("and so many of them stop the robot"));
  v("slow_m", p.slow_m, 0.0, 10.0,
    base::higher_is_stricter("where so many are shorter than this, it drives no faster than it "
                             "stops from before stop_m; up to stop_m: it does not slow before"));
}

/// Nothing is touched.
struct ProtectParams {
  double side_m = 0.08;
  double gap_m = 0.20;
  double delay_s = 0.20;
  double decel_mps2 = 0.6;
  double turn_decel_radps2 = 0.42;
  double horizon_s = 6.0;
  double reach_m = 6.0;
  double creep_mps = 0.25;
  double creep_back_mps = 0.0;
  double creep_turn_radps = 0.0;
  double override_mps = 0.15;
  double dock_m = 0.6;
  double foresee_s = 3.0;
  double foresee_gap_m = 0.30;
  double turn_part = 1.0;
};

/// What the guard leaves beside the body of the middle of a cell: a cell may hold its thing
/// anywhere, half of its diagonal off.
inline double beside_m(const ProtectParams& p, double cell_m) noexcept {
  return p.side_m + cell_m * std::sqrt(0.5);
}

template <class V>
void fields(V& v, ProtectParams& p) {
  v("side_m", p.side_m, 0.0, 1.0, base::higher_is_stricter("room left beside what is passed"));
  v("gap_m", p.gap_m, 0.05, 2.0, base::higher_is_stricter("room left before what stops it"));
  v("delay_s", p.delay_s, 0.0, 2.0,
    base::higher_is_stricter("from the sight of a thing to the begin of braking"));
  v("decel_mps2", p.decel_mps2, 0.05, 5.0, base::lower_is_stricter("braking that is sure"));
  v("turn_decel_radps2", p.turn_decel_radps2, 0.05, 10.0,
    base::lower_is_stricter("braking of a turn that is sure"));
  v("horizon_s", p.horizon_s, 1.0, 20.0,
    base::higher_is_stricter("the commanded curve is followed so far ahead"));
  v("reach_m", p.reach_m, 1.0, 30.0, base::higher_is_stricter("and not farther than this"));
  v("creep_mps", p.creep_mps, 0.0, 1.0,
    base::lower_is_stricter("ahead into what no sensor sees; 0: not at all"));
  v("creep_back_mps", p.creep_back_mps, 0.0, 1.0,
    base::lower_is_stricter("the same backwards; 0: only where it was seen"));
  v("creep_turn_radps", p.creep_turn_radps, 0.0, 1.0,
    base::lower_is_stricter("the same when turning on the spot; 0: only where it was seen"));
  v("override_mps", p.override_mps, 0.02, 0.5,
    base::lower_is_stricter(
        "a hand that overrides the guard drives no faster, and no corner of the "
        "body turns faster"));
  v("dock_m", p.dock_m, 0.0, 3.0,
    base::lower_is_stricter("this near to where DOCK ends, what stands within 0.3 m of the "
                            "vehicle's end there is the dock, and does not stop it; 0: it does"));
  v("foresee_s", p.foresee_s, 0.0, 10.0,
    base::higher_is_stricter("whoever moves is believed to go on so for this long; 0: he is not "
                             "foreseen"));
  v("foresee_gap_m", p.foresee_gap_m, 0.0, 3.0,
    base::higher_is_stricter("room left to whoever moves, where it passes him before or behind"));
  v("turn_part", p.turn_part, 0.0, 2.0,
    base::higher_is_stricter(
        "whoever moves nearby may turn towards it at any moment with this part "
        "of his speed: it drives no faster than it stands by then; 0: only "
        "who comes is heeded"));
}

}  // namespace roverd::nav::sense
