#pragma once
// What the field does to the robot: a slope, ground that does not hold everywhere alike, ruts, and
// trees over it. All off at first: level ground under an open sky. Places are metres east and north
// of where the simulator started; what they are like follows from the seed.

namespace roverd::sim {

struct GroundParams {
  double slope_deg = 0.0;
  double uphill_deg = 0.0;
  double slide = 0.3;
  double gravity_share = 0.5;
  double slip_patches = 0.0;
  double crab_patches = 0.0;
  double patch_m = 3.0;
  double rut_dps = 0.0;
  double rut_every_m = 5.0;
};

template <class V>
void fields(V& v, GroundParams& p) {
  v("slope_deg", p.slope_deg, 0.0, 35.0, "of the plane that the field is; pitch and roll follow");
  v("uphill_deg", p.uphill_deg, 0.0, 360.0, "compass direction that leads straight up");
  v("slide", p.slide, 0.0, 2.0,
    "for each metre of track: so many metres downhill, times the slope's tangent; none standing");
  v("gravity_share", p.gravity_share, 0.0, 1.0,
    "share of g times the sine of the pitch that braking and acceleration feel, either way; what "
    "is left of them is never under a fifth");
  v("slip_patches", p.slip_patches, 0.0, 0.8,
    "either track slips further by up to this share, by the place under it");
  v("crab_patches", p.crab_patches, 0.0, 0.5,
    "the vehicle slides sideways by up to this share of its way, by the place, to either side");
  v("patch_m", p.patch_m, 0.3, 100.0, "from one middle of a patch to the next");
  v("rut_dps", p.rut_dps, 0.0, 90.0,
    "a rut half a metre around turns the vehicle by up to so much at 1 m/s, less when slower");
  v("rut_every_m", p.rut_every_m, 1.0, 1000.0, "mean way from one rut to the next");
}

struct TreesParams {
  double share = 0.0;
  double patch_m = 12.0;
  double noise = 6.0;
  double multipath_m = 0.8;
  double multipath_tau_s = 15.0;
  double fixed_share = 0.3;
  double none_share = 0.1;
  double hold_s = 2.0;
};

template <class V>
void fields(V& v, TreesParams& p) {
  v("share", p.share, 0.0, 1.0, "of the ground that lies under trees, about; 1: all of it");
  v("patch_m", p.patch_m, 1.0, 1000.0, "from one middle of a wood or clearing to the next");
  v("noise", p.noise, 1.0, 100.0, "times the receiver's white noise, there");
  v("multipath_m", p.multipath_m, 0.0, 20.0,
    "1 sigma per axis of a slow further error, there; the claimed accuracy knows nothing of it");
  v("multipath_tau_s", p.multipath_tau_s, 0.1, 600.0, "time constant of it");
  v("fixed_share", p.fixed_share, 0.0, 1.0, "of the time a receiver keeps its fix class there");
  v("none_share", p.none_share, 0.0, 1.0,
    "of the rest it has none at all, else float (one without corrections: a single fix)");
  v("hold_s", p.hold_s, 0.1, 60.0, "so long a fix class stays before it is drawn anew");
}

/// The outline of the body, about its origin on the ground, and what it stands over. For touches;
/// the robot has its own idea of it.
struct BodyParams {
  double front_m = 0.51;
  double rear_m = 0.51;
  double width_m = 0.78;
  double height_m = 0.4;
  double clearance_m = 0.05;
};

template <class V>
void fields(V& v, BodyParams& p) {
  v("front_m", p.front_m, 0.05, 20.0, "from the origin to the foremost edge");
  v("rear_m", p.rear_m, 0.05, 20.0, "from the origin to the rearmost edge");
  v("width_m", p.width_m, 0.1, 10.0, "of the whole body");
  v("height_m", p.height_m, 0.1, 10.0, "what hangs higher passes over it");
  v("clearance_m", p.clearance_m, 0.0, 2.0, "what is lower passes under it");
}

}  // namespace roverd::sim
