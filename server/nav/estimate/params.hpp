#pragma once
// What the estimator may be told about the robot and its sensors. Section [nav.estimate].

#include <array>
#include <string_view>

#include "base/params.hpp"

namespace roverd::nav {

struct EstimateParams {
  double track_width_m = 0.60;
  double antenna_forward_m = 0.0;
  double antenna_left_m = 0.0;
  double antenna_up_m = 0.0;
  double antenna_baseline_m = 1.0;
  double gnss_latency_s = 0.12;
  double compass_latency_s = 0.12;
  double compass_sigma_deg = 4.0;
  double compass_bias_sigma_deg = 30.0;
  double compass_left_deg_per_a = 0.0;
  double compass_right_deg_per_a = 0.0;
  double compass_current_sigma_deg_per_a = 0.0;
  double compass_current_lag_s = 2.0;
  int left_motor = 2;
  int right_motor = 1;
  double heading_sigma_deg = 1.0;
  double aligned_deg = 4.0;
  double odometry_scale_sigma = 0.10;
  double yaw_scale = 0.8;
  double yaw_scale_sigma = 0.2;
  double pull_sigma_1pm = 0.03;
  double pivot_sigma_m = 0.05;
  double gyro_bias_sigma_dps = 0.5;
  double drift_scale = 1.0;
  int satellites_min = 6;
  double hdop_max = 2.5;
  double accuracy_max_m = 3.0;
  double speed_accuracy_max_mps = 0.5;
  double contradiction_sigma = 4.0;
  double contradiction_return_s = 10.0;
  double anchor_max_m = 10.0;
  double map_lat = 0.0;
  double map_lon = 0.0;

  bool has_map() const noexcept { return map_lat != 0.0 || map_lon != 0.0; }
};

template <class V>
void compass_fields(V& v, EstimateParams& p) {
  v("compass_latency_s", p.compass_latency_s, 0.0, 0.8, "age of a heading when its bytes arrive");
  v("compass_sigma_deg", p.compass_sigma_deg, 0.5, 45.0, "noise of one compass heading");
  v("compass_bias_sigma_deg", p.compass_bias_sigma_deg, 1.0, 90.0,
    "how wrong the compass may be before the robot has moved");
  v("compass_left_deg_per_a", p.compass_left_deg_per_a, -5.0, 5.0,
    "the left motor's current turns the compass clockwise by so much");
  v("compass_right_deg_per_a", p.compass_right_deg_per_a, -5.0, 5.0, "the right motor's likewise");
  v("compass_current_sigma_deg_per_a", p.compass_current_sigma_deg_per_a, 0.0, 2.0,
    "how wrong these two may be; they are learned while driving; 0: they are exact");
  v("compass_current_lag_s", p.compass_current_lag_s, 0.0, 30.0,
    "time constant with which the currents act on the compass");
  v("left_motor", p.left_motor, 1, 8, "number of the left side's motor, for its current");
  v("right_motor", p.right_motor, 1, 8, "number of the right side's motor");
}

template <class V>
void gnss_fields(V& v, EstimateParams& p) {
  v("antenna_forward_m", p.antenna_forward_m, -5.0, 5.0,
    base::only_disarmed("GNSS antenna ahead of the body's origin"));
  v("antenna_left_m", p.antenna_left_m, -5.0, 5.0,
    base::only_disarmed("GNSS antenna left of the body's origin"));
  v("antenna_up_m", p.antenna_up_m, 0.0, 10.0,
    base::only_disarmed("GNSS antenna above the ground: it sways when the robot leans"));
  v("antenna_baseline_m", p.antenna_baseline_m, 0.1, 20.0,
    base::only_disarmed("between two antennas: their heading is not better than 0.01 m over it"));
  v("gnss_latency_s", p.gnss_latency_s, 0.0, 0.8,
    "age of a position or velocity when its bytes arrive; too small weaves, too large as well");
  v("drift_scale", p.drift_scale, 0.0, 5.0,
    "scales the assumed slow drift of positions that are not RTK fixed");
  v("satellites_min", p.satellites_min, 0, 30,
    base::higher_is_stricter("positions from fewer satellites are not used"));
  v("hdop_max", p.hdop_max, 1.0, 50.0,
    base::lower_is_stricter("nor those from satellites that stand worse than this"));
  v("accuracy_max_m", p.accuracy_max_m, 0.05, 100.0,
    base::lower_is_stricter("nor those of which the receiver is less sure (1 sigma)"));
  v("speed_accuracy_max_mps", p.speed_accuracy_max_mps, 0.05, 10.0,
    base::lower_is_stricter("velocities of which the receiver is less sure are not used"));
}

template <class V>
void fields(V& v, EstimateParams& p) {
  v("track_width_m", p.track_width_m, 0.1, 5.0,
    base::only_disarmed(
        "distance between the middles of the two tracks; slip is learned on top of it"));
  gnss_fields(v, p);
  compass_fields(v, p);
  v("heading_sigma_deg", p.heading_sigma_deg, 0.05, 20.0,
    "noise of a heading from two antennas, where the receiver does not tell");
  v("aligned_deg", p.aligned_deg, 0.5, 45.0,
    "a heading this certain counts as found; less certain, the robot begins straight on");
  v("odometry_scale_sigma", p.odometry_scale_sigma, 0.0, 0.5,
    "how wrong the travelled distance may be, as a part of one");
  v("yaw_scale", p.yaw_scale, 0.3, 1.5,
    "true turn rate over that of the tracks, at the start; a skid-steer stays below 1");
  v("yaw_scale_sigma", p.yaw_scale_sigma, 0.0, 0.5,
    "how wrong the turn rate computed from the tracks may be, as a part of one");
  v("pull_sigma_1pm", p.pull_sigma_1pm, 0.0, 0.2,
    "how much the robot may bend to one side on straight tracks");
  v("pivot_sigma_m", p.pivot_sigma_m, 0.0, 1.0,
    "how far before or behind its origin the robot may turn; 0: about that");
  v("gyro_bias_sigma_dps", p.gyro_bias_sigma_dps, 0.01, 10.0,
    "how much a gyro may show while the robot stands, before that was seen");
  v("contradiction_sigma", p.contradiction_sigma, 2.0, 20.0,
    "two sensors contradict each other when they differ by so many sigmas, and a floor");
  v("contradiction_return_s", p.contradiction_return_s, 1.0, 600.0,
    "a sensor that was left out is used again after agreeing with the others for so long");
  v("anchor_max_m", p.anchor_max_m, 0.1, 100.0,
    "an anchor may move the receiver's positions by no more than this");
  v("map_lat", p.map_lat, -90.0, 90.0,
    "latitude of the local map's origin, for driving without GNSS; both 0: there is no such map");
  v("map_lon", p.map_lon, -180.0, 180.0, "longitude of the local map's origin");
}

/// Of these the estimator makes what it believes at first; later it knows better by itself, so that
/// a change acts when the program starts anew.
inline constexpr std::array<std::string_view, 11> kBelievedAtFirst = {
    "compass_left_deg_per_a",
    "compass_right_deg_per_a",
    "compass_current_sigma_deg_per_a",
    "odometry_scale_sigma",
    "yaw_scale",
    "yaw_scale_sigma",
    "pull_sigma_1pm",
    "pivot_sigma_m",
    "gyro_bias_sigma_dps",
    "map_lat",
    "map_lon"};

}  // namespace roverd::nav
