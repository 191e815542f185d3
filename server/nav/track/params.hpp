#pragma once
// How the robot follows a path. Sections [vehicle], [nav.track], [nav.speed] and [nav.pivot].

#include <cmath>
#include <string>

#include "base/params.hpp"

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
  double length_m = 1.023;
  double width_m = 0.778;
  double support_width_m = 0.6;
  double mass_height_m = 0.25;

  bool steered() const noexcept { return kinematics == "ackermann"; }
  /// Farthest that any part of the body is from its origin: the middle of a vehicle that turns on
  /// the spot, the middle of the rear axle of a steered one.
  double reach_m() const noexcept {
    return std::hypot(0.5 * (steered() ? length_m + wheelbase_m : length_m), 0.5 * width_m);
  }
};

template <class V>
void fields(V& v, VehicleParams& p) {
  v("kinematics", p.kinematics, "skid_steer, differential or ackermann");
  v("wheelbase_m", p.wheelbase_m, 0.1, 10.0, "ackermann: between the axles");
  v("max_speed_mps", p.max_speed_mps, 0.1, 20.0, "the vehicle goes no faster, whatever is asked");
  v("max_steering_deg", p.max_steering_deg, 1.0, 80.0, "ackermann: of the middle front wheel");
  v("max_steering_rate_dps", p.max_steering_rate_dps, 1.0, 720.0,
    "ackermann: how fast that angle changes");
  v("length_m", p.length_m, 0.1, 10.0, "over everything");
  v("width_m", p.width_m, 0.1, 5.0, "over everything");
  v("support_width_m", p.support_width_m, 0.05, 5.0,
    "between the middles of the tracks or outer wheels: over one of them it tips");
  v("mass_height_m", p.mass_height_m, 0.02, 5.0,
    "of the centre of mass above the ground, with the load it carries");
}

/// Which point follows the way: the vehicle's origin, a tool's, or a trailer's axle
/// (nav/track/tool.hpp).
struct ToolParams {
  double forward_m = 0.0;
  double left_m = 0.0;
  double hitch_m = 0.0;
  double trailer_m = 0.0;

  bool fitted() const noexcept { return forward_m != 0.0 || left_m != 0.0 || pulled(); }
  bool pulled() const noexcept { return trailer_m > 0.0; }
  /// Farthest that the point is from the vehicle's origin.
  double reach_m() const noexcept {
    return pulled() ? hitch_m + std::hypot(trailer_m, left_m) : std::hypot(forward_m, left_m);
  }
};

template <class V>
void fields(V& v, ToolParams& p) {
  v("forward_m", p.forward_m, -5.0, 5.0,
    base::only_disarmed("the point that follows the mission's way, so far ahead of the vehicle's "
                        "origin; negative: behind; 0 with a trailer"));
  v("left_m", p.left_m, -5.0, 5.0,
    base::only_disarmed("and so far to the left; negative: to the right"));
  v("hitch_m", p.hitch_m, 0.0, 5.0,
    base::only_disarmed("a trailer's coupling lies so far behind the vehicle's origin"));
  v("trailer_m", p.trailer_m, 0.0, 10.0,
    base::only_disarmed("from the coupling to the trailer's axle, which then follows the way; 0: "
                        "no trailer"));
}

inline base::Result<void> check(const ToolParams& p) {
  if (!p.pulled() || p.forward_m == 0.0) return {};
  return base::fail(base::Code::Invalid, "forward_m must be 0 with a trailer: its axle follows",
                    {{"forward_m", "must be 0 with a trailer"}});
}

/// How the robot steers back to its path. The words of `law` (nav/track/law.hpp):
///   path_frame    feedback of offset and heading on the path's own curvature; the default
///   pure_pursuit  an arc to a point ahead; calm, cuts corners
///   stanley       by the front axle; for steered vehicles with clean positions
struct TrackParams {
  std::string law = "path_frame";
  double settle_min_m = 0.45;
  double settle_time_s = 0.45;
  double damping = 0.9;
  double lookahead_min_m = 0.6;
  double lookahead_time_s = 1.2;
  double lookahead_max_m = 2.0;
  double stanley_gain_1ps = 1.5;
  double delay_s = 0.15;
  double observer_s = 1.0;
  double observer_max_radps = 0.25;
  double corner_deviation_m = 0.10;
  double through_deviation_m = 0.5;
  double smooth_m = 0.15;
  double arrive_m = 0.04;
  double rejoin_m = 0.5;
};

template <class V>
void fields(V& v, TrackParams& p) {
  v("law", p.law, "path_frame, pure_pursuit or stanley: how it steers back to the path");
  v("settle_min_m", p.settle_min_m, 0.15, 20.0,
    "path_frame: an offset fades to a twentieth within 4.7 times this; shorter is livelier");
  v("settle_time_s", p.settle_time_s, 0.0, 10.0,
    "path_frame: that length grows with speed by this");
  v("damping", p.damping, 0.5, 3.0, "path_frame: 1 is critical; less is quicker and swings over");
  v("lookahead_min_m", p.lookahead_min_m, 0.2, 20.0,
    "pure_pursuit: shorter is livelier, may weave");
  v("lookahead_time_s", p.lookahead_time_s, 0.2, 10.0,
    "pure_pursuit: lookahead grows with speed by this");
  v("lookahead_max_m", p.lookahead_max_m, 0.3, 30.0,
    "pure_pursuit: lookahead does not grow beyond");
  v("stanley_gain_1ps", p.stanley_gain_1ps, 0.1, 10.0,
    "stanley: more is livelier, noise goes to the wheel");
  v("delay_s", p.delay_s, 0.0, 1.0,
    "from a command to its motion (delay and lag); the pose is predicted by it");
  v("observer_s", p.observer_s, 0.05, 60.0,
    "a turn that nobody commanded (a track that pulls) is learned and countered within this");
  v("observer_max_radps", p.observer_max_radps, 0.0, 1.0, "but no more of it than this; 0: off");
  v("corner_deviation_m", p.corner_deviation_m, 0.02, 2.0,
    "how far a rounded corner may pass beside its waypoint");
  v("through_deviation_m", p.through_deviation_m, 0.02, 5.0,
    "the same for waypoints with turn \"through\" that give no radius");
  v("smooth_m", p.smooth_m, 0.0, 2.0,
    "dense points (up to 2 m apart) are driven as one smooth way, so far beside them at most; 1.4 "
    "times beside one or two of many that noise threw out; 0: each of them is met");
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
  double accel_mps2 = 0.7;
  double decel_mps2 = 0.6;
  double jerk_mps3 = 3.0;
  double hold_decel_mps2 = 0.8;
  double lateral_mps2 = 0.5;
  double max_yaw_rate_radps = 0.78;
  double yaw_accel_radps2 = 1.5;
  double yaw_decel_radps2 = 1.0;
  double heading_sigma_deg = 4.0;
};

template <class V>
void fields(V& v, SpeedParams& p) {
  v("default_mps", p.default_mps, 0.1, 5.0, "when neither item nor mission gives a speed");
  v("max_mps", p.max_mps, 0.1, 5.0, base::lower_is_stricter("no item drives faster"));
  v("reverse_max_mps", p.reverse_max_mps, 0.1, 5.0,
    base::lower_is_stricter("no item reverses faster"));
  v("creep_mps", p.creep_mps, 0.1, 2.0,
    base::lower_is_stricter("speed while heading or position are uncertain"));
  v("min_mps", p.min_mps, 0.02, 1.0, "slower, and the tracks stick");
  v("accel_mps2", p.accel_mps2, 0.05, 5.0, base::lower_is_stricter("speeding up"));
  v("decel_mps2", p.decel_mps2, 0.05, 5.0,
    base::lower_is_stricter("slowing down for what is known in advance"));
  v("jerk_mps3", p.jerk_mps3, 0.1, 100.0, "change of either while following a path");
  v("hold_decel_mps2", p.hold_decel_mps2, 0.05, 5.0,
    base::higher_is_stricter("slowing down for a pause or a lost condition"));
  v("lateral_mps2", p.lateral_mps2, 0.05, 5.0,
    base::lower_is_stricter("sideways acceleration allowed in bends"));
  v("max_yaw_rate_radps", p.max_yaw_rate_radps, 0.1, 5.0,
    base::lower_is_stricter("largest turn rate ever commanded"));
  v("yaw_accel_radps2", p.yaw_accel_radps2, 0.1, 20.0,
    base::lower_is_stricter("change of the turn rate while it grows"));
  v("yaw_decel_radps2", p.yaw_decel_radps2, 0.1, 20.0,
    "and while it falls; a skid-steer brakes half as hard as it accelerates");
  v("heading_sigma_deg", p.heading_sigma_deg, 0.5, 90.0,
    base::lower_is_stricter("less certain of the heading than this, the robot creeps"));
}

struct PivotParams {
  double angle_deg = 30.0;
  double done_deg = 2.0;
  double max_rate_radps = 0.6;
  double decel_radps2 = 0.42;
  double slew_radps2 = 1.2;
  double timeout_s = 30.0;
};

template <class V>
void fields(V& v, PivotParams& p) {
  v("angle_deg", p.angle_deg, 5.0, 180.0,
    "sharper corners are turned on the spot, where the item does not say otherwise");
  v("done_deg", p.done_deg, 0.5, 15.0, "a turn on the spot ends this close");
  v("max_rate_radps", p.max_rate_radps, 0.1, 3.0,
    base::lower_is_stricter("turn rate on the spot, over ground"));
  v("decel_radps2", p.decel_radps2, 0.05, 5.0,
    "braking of a turn; a skid-steer brakes half as hard as it accelerates");
  v("slew_radps2", p.slew_radps2, 0.1, 10.0, "change of the commanded turn rate");
  v("timeout_s", p.timeout_s, 2.0, 300.0,
    base::lower_is_stricter("a turn that takes longer does not come to its end"));
}

}  // namespace roverd::nav
