#pragma once
// Everything the robot may be told, section by section. sections() lists the structs under the
// names they have in the configuration file; each struct lists its fields (base/params.hpp).

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/behave/mode_params.hpp"
#include "nav/behave/params.hpp"
#include "nav/estimate/params.hpp"
#include "nav/track/path.hpp"
#include "robot/radio/actions.hpp"
#include "robot/safety/battery_gauge.hpp"

namespace roverd::robot {

/// Section [robot].
struct RobotParams {
  std::string home_at_arm = "keep";
};

template <class V>
void fields(V& v, RobotParams& p) {
  v("home_at_arm", p.home_at_arm,
    "keep: the first arming sets home here where nobody has set it, and no later one moves it; "
    "unless_chosen: each arming does, unless an operator or a mission said where home is; here: "
    "each arming does. The driven way of SMART_RTL begins anew where home moves");
}

/// Driving by hand over the network. Section [robot.manual].
struct ManualParams {
  double max_mps = 1.0;
  double max_yaw_rate_radps = 0.75;
  double accel_mps2 = 0.8;
  double yaw_accel_radps2 = 2.0;
  double timeout_s = 0.5;
};

template <class V>
void fields(V& v, ManualParams& p) {
  v("max_mps", p.max_mps, 0.05, 3.0, "commands by hand are cut to this speed");
  v("max_yaw_rate_radps", p.max_yaw_rate_radps, 0.05, 3.0, "and to this turn rate");
  v("accel_mps2", p.accel_mps2, 0.1, 5.0, "speeding up; stopping is at once");
  v("yaw_accel_radps2", p.yaw_accel_radps2, 0.1, 20.0, "change of the turn rate");
  v("timeout_s", p.timeout_s, 0.1, 0.5, "without a newer command the robot stops");
}

/// What must hold while moving. Section [robot.safety].
struct SafetyParams {
  double base_timeout_s = 0.4;
  double status_timeout_s = 1.5;
  double base_accept_s = 3.0;
  double follow_timeout_s = 0.3;
  bool radio_required = true;
  double radio_timeout_s = 0.5;
  double bumper_timeout_s = 1.0;
  double spin_s = 3.0;
  double gnss_slow_s = 2.0;
  double gnss_hold_s = 6.0;
  double gnss_free_m = 35.0;
  double contradiction_free_m = 5.0;
  double reset_repeat_s = 60.0;
  double sigma_slow_m = 2.0;
  double sigma_hold_m = 3.0;
  double sigma_hold_s = 2.0;
  double battery_warn_pct = 20.0;
  double battery_stop_pct = 8.0;
};

template <class V>
void fields(V& v, SafetyParams& p) {
  v("base_timeout_s", p.base_timeout_s, 0.1, 2.0, "no word from the base for so long: stop");
  v("status_timeout_s", p.status_timeout_s, 0.3, 10.0, "no state of the base for so long: stop");
  v("base_accept_s", p.base_accept_s, 0.5, 30.0,
    "a base that does not take commands for so long while armed: hold");
  v("follow_timeout_s", p.follow_timeout_s, 0.1, 10.0,
    "commanded motion that the base does not show for so long, beyond a lag of 0.4 s: hold");
  v("radio_required", p.radio_required,
    "a transmitter must be heard: it is the operator's way to take over");
  v("radio_timeout_s", p.radio_timeout_s, 0.2, 5.0,
    "transmitter silent, or its counter frozen, for so long: stop");
  v("bumper_timeout_s", p.bumper_timeout_s, 0.1, 10.0,
    "a bumper that was heard once and then not for so long: hold");
  v("spin_s", p.spin_s, 0.5, 60.0,
    "wheels that turn for so long while the receiver sees the robot all but stand: hold");
  v("gnss_slow_s", p.gnss_slow_s, 0.5, 60.0, "no usable fix for so long: creep");
  v("gnss_hold_s", p.gnss_hold_s, 1.0, 600.0, "no usable fix for so long, and no gyro: hold");
  v("gnss_free_m", p.gnss_free_m, 0.0, 10000.0,
    "with a gyro the robot drives on without a fix for so many metres: then hold");
  v("contradiction_free_m", p.contradiction_free_m, 0.0, 1000.0,
    "the robot creeps on for so many metres while the satellites' position is left out because it "
    "contradicts the other sensors: then hold");
  v("reset_repeat_s", p.reset_repeat_s, 0.0, 3600.0,
    "an estimate that is set anew twice within so long holds until a person acknowledged it");
  v("sigma_slow_m", p.sigma_slow_m, 0.02, 50.0, "position less certain than this: creep");
  v("sigma_hold_m", p.sigma_hold_m, 0.05, 50.0, "position less certain than this: hold");
  v("sigma_hold_s", p.sigma_hold_s, 0.1, 60.0, "for so long");
  v("battery_warn_pct", p.battery_warn_pct, 0.0, 100.0, "charge below this: warn");
  v("battery_stop_pct", p.battery_stop_pct, 0.0, 100.0, "charge below this: hold");
}

/// What arming asks for. Section [robot.arming].
struct ArmingParams {
  double healthy_s = 5.0;
  int satellites_min = 6;
  double sigma_max_m = 2.0;
  double heading_sigma_deg = 10.0;
};

template <class V>
void fields(V& v, ArmingParams& p) {
  v("healthy_s", p.healthy_s, 0.0, 120.0, "a usable fix must have lasted so long");
  v("satellites_min", p.satellites_min, 0, 30, "satellites in use, where the receiver tells");
  v("sigma_max_m", p.sigma_max_m, 0.02, 50.0, "the position must be this certain");
  v("heading_sigma_deg", p.heading_sigma_deg, 0.5, 90.0,
    "less certain of the heading, arming warns that the robot will creep at first");
}

/// Keeping inside the fence. Section [robot.fence].
struct FenceParams {
  double margin_m = 0.1;
  double react_s = 0.4;
  double decel_mps2 = 0.5;
};

template <class V>
void fields(V& v, FenceParams& p) {
  v("margin_m", p.margin_m, 0.0, 20.0,
    "no part of the vehicle comes nearer to the fence; the position's uncertainty comes on top");
  v("react_s", p.react_s, 0.1, 3.0, "from a command to standing, beside the braking itself");
  v("decel_mps2", p.decel_mps2, 0.05, 5.0, "braking that can be relied on");
}

/// The actions of missions that the robot does by itself. There are no others.
inline const std::vector<std::string> kActions{"set_home"};

struct Config {
  nav::VehicleParams vehicle;  ///< section [vehicle], beside what only people need
  nav::EstimateParams estimate;
  nav::TrackParams track;
  nav::SpeedParams speed;
  nav::PivotParams pivot;
  nav::BehaveParams behave;
  nav::ModeParams modes;
  RobotParams robot;
  ManualParams manual;
  SafetyParams safety;
  FenceParams fence;
  ArmingParams arming;
  RadioParams radio;
  BatteryParams battery;

  /// What the body's origin keeps to, so that no part of the body comes nearer than the margin.
  FenceParams kept_fence() const {
    FenceParams p = fence;
    p.margin_m += vehicle.reach_m();
    return p;
  }

  /// What following a path needs; the vehicle goes no faster than it can.
  nav::PathParams path() const {
    nav::PathParams p{track, speed, pivot, vehicle};
    p.speed.max_mps = std::min(speed.max_mps, vehicle.max_speed_mps);
    return p;
  }
};

template <class V>
void sections(V& v, Config& c) {
  v("nav.estimate", c.estimate);
  v("nav.track", c.track);
  v("nav.speed", c.speed);
  v("nav.pivot", c.pivot);
  v("nav.behave", c.behave);
  v("nav.modes", c.modes);
  v("robot", c.robot);
  v("robot.manual", c.manual);
  v("robot.safety", c.safety);
  v("robot.fence", c.fence);
  v("robot.arming", c.arming);
  v("radio", c.radio);
  v("battery", c.battery);
}

/// The check of the whole, beyond the range of each: words, rules within a section, values that are
/// each in range and make no sense together. The same for the configuration's files, for what was
/// kept, and for a change while the robot runs. Invalid; the field is the parameter's full name.
base::Result<void> check(const Config& c);

/// Sets one parameter by its full name ("nav.track.law"), those of [vehicle] too, and checks the
/// whole. NotFound, Invalid: nothing changed, the field is "/value".
base::Result<void> set_parameter(Config& config, const std::string& name,
                                 const base::ParamValue& value);

using NamedValue = std::pair<std::string, base::ParamValue>;

/// Takes in what was changed and kept while the program ran before; in which order they are told
/// does not matter. What this version does not take is left out, and the value before it holds.
/// @return why, one sentence for each that was left out, beginning with its name.
std::vector<std::string> take_kept(Config& config, std::vector<NamedValue> kept);

/// What the vehicle is, and what is believed at first, has been taken in when the program started.
/// All else acts at the next tick.
bool acts_at_next_start(std::string_view section, std::string_view name) noexcept;

}  // namespace roverd::robot
