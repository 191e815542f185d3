#pragma once
// Everything the robot may be told, section by section. sections() lists the structs under the
// names they have in the configuration file; each struct lists its fields (base/params.hpp).

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/behave/mode_params.hpp"
#include "nav/behave/params.hpp"
#include "nav/behave/row_drive.hpp"
#include "nav/behave/wall_drive.hpp"
#include "nav/estimate/params.hpp"
#include "nav/marks/params.hpp"
#include "nav/rows/params.hpp"
#include "nav/sense/params.hpp"
#include "nav/tags/params.hpp"
#include "nav/track/path.hpp"
#include "nav/track/tool.hpp"
#include "robot/guard/blocked.hpp"
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
  double delay_free_s = 0.25;
  double delay_stop_s = 0.5;
  double auto_timeout_s = 0.5;
};

template <class V>
void fields(V& v, ManualParams& p) {
  v("max_mps", p.max_mps, 0.05, 3.0,
    base::lower_is_stricter("commands by hand are cut to this speed"));
  v("max_yaw_rate_radps", p.max_yaw_rate_radps, 0.05, 3.0,
    base::lower_is_stricter("and to this turn rate"));
  v("accel_mps2", p.accel_mps2, 0.1, 5.0,
    base::lower_is_stricter("speeding up; stopping is at once"));
  v("yaw_accel_radps2", p.yaw_accel_radps2, 0.1, 20.0,
    base::lower_is_stricter("change of the turn rate"));
  v("timeout_s", p.timeout_s, 0.1, 0.5,
    base::lower_is_stricter("without a newer command the robot stops"));
  v("delay_free_s", p.delay_free_s, 0.05, 1.0,
    base::lower_is_stricter("commands by hand that are later than this are obeyed more slowly"));
  v("delay_stop_s", p.delay_stop_s, 0.1, 2.0,
    base::lower_is_stricter("and from here on not at all; in between the speed falls evenly"));
  v("auto_timeout_s", p.auto_timeout_s, 0.1, 2.0,
    base::lower_is_stricter("a hand on the speed of what drives by itself that is silent for so "
                            "long is lost: the robot slows to a stop"));
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
  double contradiction_free_m = 8.0;
  double contradiction_sigma_m = 0.5;
  double reset_repeat_s = 60.0;
  double sigma_free_m = 1.0;
  double sigma_slow_m = 2.0;
  double sigma_hold_m = 3.0;
  double sigma_hold_s = 2.0;
  double battery_warn_pct = 20.0;
  double battery_stop_pct = 8.0;
  std::string link_lost = "go_on";
  double link_timeout_s = 10.0;
  double tilt_warn_deg = 20.0;
  double tilt_stop_deg = 30.0;
  int driver_falls = 3;
  std::string battery_home = "warn";
};

template <class V>
void fields(V& v, SafetyParams& p) {
  v("base_timeout_s", p.base_timeout_s, 0.1, 2.0,
    base::lower_is_stricter("no word from the base for so long: stop"));
  v("status_timeout_s", p.status_timeout_s, 0.3, 10.0,
    base::lower_is_stricter("no state of the base for so long: stop"));
  v("base_accept_s", p.base_accept_s, 0.5, 30.0,
    base::lower_is_stricter("a base that does not take commands for so long while armed: hold"));
  v("follow_timeout_s", p.follow_timeout_s, 0.1, 10.0,
    base::lower_is_stricter(
        "commanded motion that the base does not show for so long, beyond a lag of 0.4 s: hold"));
  v("radio_required", p.radio_required,
    base::higher_is_stricter("a transmitter must be heard: it is the operator's way to take over"));
  v("radio_timeout_s", p.radio_timeout_s, 0.2, 5.0,
    base::lower_is_stricter("transmitter silent, or its counter frozen, for so long: stop"));
  v("bumper_timeout_s", p.bumper_timeout_s, 0.1, 10.0,
    base::lower_is_stricter("a bumper that was heard once and then not for so long: hold"));
  v("spin_s", p.spin_s, 0.5, 60.0,
    base::lower_is_stricter(
        "wheels that turn for so long while the receiver sees the robot all but stand: hold"));
  v("gnss_slow_s", p.gnss_slow_s, 0.5, 60.0,
    base::lower_is_stricter("no usable fix for so long: creep"));
  v("gnss_hold_s", p.gnss_hold_s, 1.0, 600.0,
    base::lower_is_stricter("no usable fix for so long, and no gyro: hold"));
  v("gnss_free_m", p.gnss_free_m, 0.0, 10000.0,
    base::lower_is_stricter(
        "with a gyro the robot drives on without a fix for so many metres: then hold"));
  v("contradiction_free_m", p.contradiction_free_m, 0.0, 1000.0,
    base::lower_is_stricter(
        "the robot creeps on for so many metres while the satellites' position is left out because "
        "it contradicts the other sensors: then hold"));
  v("contradiction_sigma_m", p.contradiction_sigma_m, 0.02, 50.0,
    base::lower_is_stricter("where it is left out and the position is less certain than this (1 "
                            "sigma), the robot does not creep on: hold"));
  v("reset_repeat_s", p.reset_repeat_s, 0.0, 3600.0,
    base::higher_is_stricter("an estimate set anew by over 0.5 m or 10 deg twice within so long "
                             "holds until a person acknowledged it"));
  v("sigma_free_m", p.sigma_free_m, 0.02, 50.0,
    base::lower_is_stricter("up to this uncertainty of the position nothing is slower; from here "
                            "to sigma_slow_m the speed falls evenly"));
  v("sigma_slow_m", p.sigma_slow_m, 0.02, 50.0,
    base::lower_is_stricter("position less certain than this: creep"));
  v("sigma_hold_m", p.sigma_hold_m, 0.05, 50.0,
    base::lower_is_stricter("position less certain than this: hold"));
  v("sigma_hold_s", p.sigma_hold_s, 0.1, 60.0, base::lower_is_stricter("for so long"));
  v("battery_warn_pct", p.battery_warn_pct, 0.0, 100.0,
    base::higher_is_stricter("charge below this: warn"));
  v("battery_stop_pct", p.battery_stop_pct, 0.0, 100.0,
    base::higher_is_stricter("charge below this: hold"));
  v("link_lost", p.link_lost,
    base::only_disarmed(
        "what follows when no operator is heard any more while the robot drives by "
        "itself: go_on, hold or return (straight home; hold where that is not "
        "possible). Heard is a stream that watches the vehicle and says something"));
  v("link_timeout_s", p.link_timeout_s, 1.0, 600.0,
    base::lower_is_stricter("after so long without a word of any operator"));
  v("tilt_warn_deg", p.tilt_warn_deg, 1.0, 90.0,
    base::lower_is_stricter("leaning more than this, whichever way: warn"));
  v("tilt_stop_deg", p.tilt_stop_deg, 2.0, 90.0,
    base::lower_is_stricter("leaning more than this: hold"));
  v("driver_falls", p.driver_falls, 1, 60,
    base::lower_is_stricter("a driver that was up and fell so often within a minute: warn"));
  v("battery_home", p.battery_home,
    base::only_disarmed("what follows when the charge above battery_stop_pct is not enough for 1.5 "
                        "times the straight way home, by what the robot was seen to use: warn, "
                        "return or hold"));
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
  v("healthy_s", p.healthy_s, 0.0, 120.0,
    base::higher_is_stricter("a usable fix must have lasted so long"));
  v("satellites_min", p.satellites_min, 0, 30,
    base::higher_is_stricter("satellites in use, where the receiver tells"));
  v("sigma_max_m", p.sigma_max_m, 0.02, 50.0,
    base::lower_is_stricter("the position must be this certain"));
  v("heading_sigma_deg", p.heading_sigma_deg, 0.5, 90.0,
    base::lower_is_stricter(
        "less certain of the heading, arming warns that the robot will creep at first"));
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
    base::higher_is_stricter("no part of the vehicle comes nearer to the fence; the position's "
                             "uncertainty comes on top"));
  v("react_s", p.react_s, 0.1, 3.0,
    base::higher_is_stricter("from a command to standing, beside the braking itself"));
  v("decel_mps2", p.decel_mps2, 0.05, 5.0,
    base::lower_is_stricter("braking that can be relied on"));
}

/// A way that is asked for must keep so much more than the margin: tracking is not exact.
inline constexpr double kFenceAllowance_m = 0.2;

/// The actions of missions that the robot does by itself. There are no others.
inline const std::vector<std::string> kActions{"set_home"};

struct Config {
  nav::VehicleParams vehicle;  ///< section [vehicle], beside what only people need
  nav::EstimateParams estimate;
  nav::TrackParams track;
  nav::SpeedParams speed;
  nav::PivotParams pivot;
  nav::SlopeParams slope;
  nav::ToolParams tool;
  nav::BehaveParams behave;
  nav::ModeParams modes;
  nav::RowDriveParams row;
  nav::rows::RowParams rows;
  nav::SightParams sight;
  nav::marks::WallParams wall;
  nav::marks::LandmarkParams landmarks;
  nav::tags::TagDockParams tag_dock;
  RobotParams robot;
  ManualParams manual;
  SafetyParams safety;
  FenceParams fence;
  ArmingParams arming;
  RadioParams radio;
  BatteryParams battery;
  // The guard's, where the robot sees.
  nav::sense::RaysParams rays;
  nav::sense::ProtectParams protect;
  BlockedParams blocked;
  /// Counts the changes of what a mission's way is laid out by (lays_way); no parameter.
  std::uint64_t way = 0;

  /// What the body's origin keeps to, so that no part of the body comes nearer than the margin.
  FenceParams kept_fence() const {
    FenceParams p = fence;
    p.margin_m += std::max(vehicle.reach_m(), tool.reach_m());
    return p;
  }

  /// And what a way that is asked for keeps of it: tracking is not exact.
  double way_margin_m() const { return kept_fence().margin_m + kFenceAllowance_m; }

  /// The narrowest arc that a way may have, m; 0: the vehicle turns on the spot.
  double narrowest_turn_m() const;

  /// What following a path needs; the vehicle goes no faster than it can, and with a trailer it
  /// takes bends as a steered one.
  nav::PathParams path() const {
    nav::PathParams p{track, speed, pivot, nav::pulling(vehicle, tool), slope, tool};
    p.speed.max_mps = std::min(speed.max_mps, vehicle.max_speed_mps);
    return p;
  }
  /// The same along walls and past landmarks.
  nav::PathParams wall_path() const { return nav::by_sight(path(), wall.gains, sight); }
  nav::PathParams landmark_path() const { return nav::by_sight(path(), landmarks.gains, sight); }
};

template <class V>
void sections(V& v, Config& c) {
  v("nav.estimate", c.estimate);
  v("nav.track", c.track);
  v("nav.speed", c.speed);
  v("nav.pivot", c.pivot);
  v("nav.slope", c.slope);
  v("nav.tool", c.tool);
  v("nav.behave", c.behave);
  v("nav.modes", c.modes);
  v("nav.row", c.row);
  v("nav.rows", c.rows);
  v("nav.sight", c.sight);
  v("nav.wall", c.wall);
  v("nav.landmarks", c.landmarks);
  v("nav.tag_dock", c.tag_dock);
  v("robot", c.robot);
  v("robot.manual", c.manual);
  v("robot.safety", c.safety);
  v("robot.fence", c.fence);
  v("robot.arming", c.arming);
  v("radio", c.radio);
  v("battery", c.battery);
  v("sense.rays", c.rays);
  v("sense.protect", c.protect);
  v("sense.blocked", c.blocked);
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

/// What the vehicle is, what is believed at first, and which rays are made of what a sensor saw,
/// has been taken in when the program started. All else acts at the next tick.
bool acts_at_next_start(std::string_view section, std::string_view name) noexcept;

/// Does it go into the way that a mission is laid out by when it is loaded (its corners, and the
/// speeds planned for it)?
bool lays_way(std::string_view section, std::string_view name) noexcept;
/// And does it act nowhere else?
bool acts_by_way(std::string_view section, std::string_view name) noexcept;

/// The side to which a parameter may be changed while the robot is armed. In the sections that are
/// there for safety's sake, and in those of geometry and of the radio's levers, what says nothing
/// of itself changes only while it is disarmed.
base::Stricter stricter_side(std::string_view section, const base::ParamInfo& info) noexcept;

}  // namespace roverd::robot
