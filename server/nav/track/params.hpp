#pragma once
// How the robot follows a path. Sections [vehicle], [nav.track], [nav.speed] and [nav.pivot].

#include <string>

namespace roverd::nav {

/// How the vehicle can move. The words of `kinematics`:
///   skid_steer    tracks or wheels driven by side, slip in every turn; turns on the spot
///   differential  two driven wheels; turns on the spot
///   ackermann     steered front wheels: no turn is narrower than the steering allows
struct VehicleParams {
  std::string kinematics = "skid_steer";
  double wheelbase_m = 1.0;
  double max_speed_mps = 1.5;
  double max_steering_deg = 40.0;
  double max_steering_rate_dps = 30.0;

  bool steered() const noexcept { return kinematics == "ackermann"; }
};

template <class V>
void fields(V& v, VehicleParams& p) {
  v("kinematics", p.kinematics, "skid_steer, differential or ackermann");
  v("wheelbase_m", p.wheelbase_m, 0.1, 10.0, "ackermann: between the axles");
  v("max_speed_mps", p.max_speed_mps, 0.1, 20.0, "the vehicle goes no faster, whatever is asked");
  v("max_steering_deg", p.max_steering_deg, 1.0, 80.0, "ackermann: of the middle front wheel");
  v("max_steering_rate_dps", p.max_steering_rate_dps, 1.0, 720.0,
    "ackermann: how fast that angle changes");
}

struct TrackParams {
  double lookahead_min_m = 0.6;
  double lookahead_time_s = 1.2;
  double lookahead_max_m = 2.0;
  double delay_s = 0.15;
  double corner_deviation_m = 0.10;
  double through_deviation_m = 0.5;
  double arrive_m = 0.04;
  double rejoin_m = 0.5;
};

template <class V>
void fields(V& v, TrackParams& p) {
  v("lookahead_min_m", p.lookahead_min_m, 0.2, 20.0, "shorter is livelier, may weave");
  v("lookahead_time_s", p.lookahead_time_s, 0.2, 10.0, "lookahead grows with speed by this");
  v("lookahead_max_m", p.lookahead_max_m, 0.3, 30.0, "lookahead does not grow beyond");
  v("delay_s", p.delay_s, 0.0, 1.0,
    "from a command to its motion (delay and lag); the pose is predicted by it");
  v("corner_deviation_m", p.corner_deviation_m, 0.02, 2.0,
    "how far a rounded corner may pass beside its waypoint");
  v("through_deviation_m", p.through_deviation_m, 0.02, 5.0,
    "the same for waypoints with turn \"through\" that give no radius");
  v("arrive_m", p.arrive_m, 0.01, 1.0, "a stop counts as reached this close, along the path");
  v("rejoin_m", p.rejoin_m, 0.1, 10.0,
    "farther than this from the place where a mission goes on, the robot first drives there");
}

struct SpeedParams {
  double default_mps = 0.8;
  double max_mps = 1.2;
  double reverse_max_mps = 0.5;
  double creep_mps = 0.4;
  double min_mps = 0.12;
  double accel_mps2 = 0.5;
  double decel_mps2 = 0.4;
  double hold_decel_mps2 = 0.8;
  double lateral_mps2 = 0.5;
  double max_yaw_rate_radps = 0.75;
  double yaw_accel_radps2 = 1.5;
  double heading_sigma_deg = 4.0;
};

template <class V>
void fields(V& v, SpeedParams& p) {
  v("default_mps", p.default_mps, 0.1, 5.0, "when neither item nor mission gives a speed");
  v("max_mps", p.max_mps, 0.1, 5.0, "no item drives faster");
  v("reverse_max_mps", p.reverse_max_mps, 0.1, 5.0, "no item reverses faster");
  v("creep_mps", p.creep_mps, 0.1, 2.0, "speed while heading or position are uncertain");
  v("min_mps", p.min_mps, 0.02, 1.0, "slower, and the tracks stick");
  v("accel_mps2", p.accel_mps2, 0.05, 5.0, "speeding up");
  v("decel_mps2", p.decel_mps2, 0.05, 5.0, "slowing down for what is known in advance");
  v("hold_decel_mps2", p.hold_decel_mps2, 0.05, 5.0,
    "slowing down for a pause or a lost condition");
  v("lateral_mps2", p.lateral_mps2, 0.05, 5.0, "sideways acceleration allowed in bends");
  v("max_yaw_rate_radps", p.max_yaw_rate_radps, 0.1, 5.0, "largest turn rate ever commanded");
  v("yaw_accel_radps2", p.yaw_accel_radps2, 0.1, 20.0, "largest change of the turn rate");
  v("heading_sigma_deg", p.heading_sigma_deg, 0.5, 90.0,
    "less certain of the heading than this, the robot creeps");
}

struct PivotParams {
  double angle_deg = 30.0;
  double done_deg = 2.0;
  double max_rate_radps = 0.5;
  double decel_radps2 = 0.5;
  double slew_radps2 = 1.2;
};

template <class V>
void fields(V& v, PivotParams& p) {
  v("angle_deg", p.angle_deg, 5.0, 180.0,
    "sharper corners are turned on the spot, where the item does not say otherwise");
  v("done_deg", p.done_deg, 0.5, 15.0, "a turn on the spot ends this close");
  v("max_rate_radps", p.max_rate_radps, 0.1, 3.0, "turn rate on the spot, over ground");
  v("decel_radps2", p.decel_radps2, 0.05, 5.0,
    "braking of a turn; a skid-steer brakes half as hard as it accelerates");
  v("slew_radps2", p.slew_radps2, 0.1, 10.0, "change of the commanded turn rate");
}

}  // namespace roverd::nav
