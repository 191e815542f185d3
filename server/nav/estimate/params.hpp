#pragma once
// What the estimator may be told about the robot and its sensors. Section [nav.estimate].

namespace roverd::nav {

struct EstimateParams {
  double track_width_m = 0.60;
  double antenna_forward_m = 0.0;
  double antenna_left_m = 0.0;
  double gnss_latency_s = 0.12;
  double compass_latency_s = 0.12;
  double compass_sigma_deg = 4.0;
  double compass_bias_sigma_deg = 30.0;
  double heading_sigma_deg = 1.0;
  double odometry_scale_sigma = 0.10;
  double yaw_scale = 0.8;
  double yaw_scale_sigma = 0.2;
  double pull_sigma_1pm = 0.03;
  double drift_scale = 1.0;
};

template <class V>
void fields(V& v, EstimateParams& p) {
  v("track_width_m", p.track_width_m, 0.1, 5.0,
    "distance between the middles of the two tracks; slip is learned on top of it");
  v("antenna_forward_m", p.antenna_forward_m, -5.0, 5.0,
    "GNSS antenna ahead of the centre of rotation");
  v("antenna_left_m", p.antenna_left_m, -5.0, 5.0, "GNSS antenna left of the centre of rotation");
  v("gnss_latency_s", p.gnss_latency_s, 0.0, 0.8,
    "age of a position or velocity when its bytes arrive; too small weaves, too large as well");
  v("compass_latency_s", p.compass_latency_s, 0.0, 0.8, "age of a heading when its bytes arrive");
  v("compass_sigma_deg", p.compass_sigma_deg, 0.5, 45.0, "noise of one compass heading");
  v("compass_bias_sigma_deg", p.compass_bias_sigma_deg, 1.0, 90.0,
    "how wrong the compass may be before the robot has moved");
  v("heading_sigma_deg", p.heading_sigma_deg, 0.05, 20.0,
    "noise of a heading from two antennas: about 0.01 m over the baseline");
  v("odometry_scale_sigma", p.odometry_scale_sigma, 0.0, 0.5,
    "how wrong the travelled distance may be, as a part of one");
  v("yaw_scale", p.yaw_scale, 0.3, 1.5,
    "true turn rate over that of the tracks, at the start; a skid-steer stays below 1");
  v("yaw_scale_sigma", p.yaw_scale_sigma, 0.0, 0.5,
    "how wrong the turn rate computed from the tracks may be, as a part of one");
  v("pull_sigma_1pm", p.pull_sigma_1pm, 0.0, 0.2,
    "how much the robot may bend to one side on straight tracks");
  v("drift_scale", p.drift_scale, 0.0, 5.0,
    "scales the assumed slow drift of positions that are not RTK fixed");
}

}  // namespace roverd::nav
