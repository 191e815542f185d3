#pragma once
// Everything the robot says of itself at one tick: written by the control loop, read by api.
// Immutable once published. Ages are computed by the reader from `now` and the stamps.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/drive_command.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::base {

enum class Mode { Manual, Hold, Auto, Guided, Rtl, SmartRtl, Follow, Steering, Acro, Simple, Dock };
std::string_view to_string(Mode mode) noexcept;  // MANUAL HOLD AUTO GUIDED RTL SMART_RTL …
std::optional<Mode> mode_from(std::string_view text) noexcept;

/// Who moves the robot now. Priority: e-stop > radio > teleoperation > autonomy.
enum class Driver { None, Autonomy, Teleop, Radio };
std::string_view to_string(Driver driver) noexcept;  // none auto teleop rc

enum class ExecutionState { Idle, Loaded, Running, Paused, Blocked, Finished, Aborted };
std::string_view to_string(ExecutionState s) noexcept;  // idle loaded running …

enum class Severity { Info, Warning, Error };
std::string_view to_string(Severity s) noexcept;  // info warning error

struct Check {
  std::string id;  ///< stable snake_case word: "gnss_fix"
  bool ok = false;
  Severity severity = Severity::Error;  ///< of a failing check; only errors refuse arming
  std::string detail;
};

/// The estimator's answer.
struct Pose {
  Time stamp;
  EnuPoint at;
  LatLon global;
  double yaw_rad = 0.0;
  std::optional<double> speed_mps;  ///< along the body's forward axis, signed; over ground without
                                    ///< odometry, then never negative
  std::optional<double> yaw_rate_radps;  ///< empty without odometry
  double horizontal_sigma_m = 0.0;       ///< 1σ, larger axis of the ellipse
  double yaw_sigma_rad = 0.0;
  std::optional<double> alt_msl_m;
  std::string source;  ///< "gnss", "gnss+odometry", "odometry"
};

/// Where in its route a mission stands: enough to go on from there, also after a restart.
struct MissionPlace {
  bool back = false;            ///< on the way back of back_and_forth
  int step = 0;                 ///< index of the step in hand; behind the last one: at the end
  int standing = -1;            ///< index of the waypoint at which the robot stands; −1: at none
  double s_m = -1.0;            ///< arc length on the route's path; negative: not on it
  double wait_s = 0.0;          ///< left of a wait
  double left = 0.0;            ///< left of a move, m, or of a turn, rad; 0: all of it
  std::vector<int> jumps_left;  ///< of each jump; −1: not counted yet
  friend bool operator==(const MissionPlace&, const MissionPlace&) = default;
};

struct MissionProgress {
  std::string mission_id;
  std::int64_t revision = 0;
  std::string name;
  ExecutionState state = ExecutionState::Idle;
  std::string reason;               ///< why paused, blocked, aborted
  std::optional<int> current_item;  ///< 1-based
  int items = 0;
  std::optional<double> distance_to_item_m;
  std::optional<double> bearing_to_item_deg;
  std::optional<double> cross_track_m;  ///< positive: the robot is left of the path
  std::optional<double> distance_left_m;
  std::optional<double> eta_s;
  std::optional<MissionPlace> place;  ///< running, paused or blocked
};

/// How far what a mode other than AUTO does has come.
enum class ActivityState { None, Driving, Turning, Waiting, Reached, Failed };
std::string_view to_string(ActivityState s) noexcept;  // none driving turning waiting …

/// What a mode other than AUTO is doing, or did last.
struct Activity {
  std::uint64_t id = 0;   ///< counts what was begun; 0: nothing yet
  std::string_view kind;  ///< "goto" "heading" "move" "turn" "return" "retrace" "follow" "dock"
  ActivityState state = ActivityState::None;
  std::string reason;  ///< why failed or waiting
  std::optional<LatLon> goal;
  std::optional<double> goal_yaw_rad;
  std::optional<double> distance_m;  ///< left to the goal, along the way; of FOLLOW: to the target
  std::optional<double> turn_rad;    ///< left to turn, left positive
  std::optional<LatLon> target;      ///< of FOLLOW, as it was told last
  std::optional<double> target_age_s;
};

/// The fence, as the robot sees it.
struct FenceState {
  std::string name;
  bool inside = true;
  std::optional<double> distance_m;  ///< to its nearest limit; negative outside; empty: no limit
};

/// Something that prevents or limits motion now.
struct SafetyCondition {
  std::string id;  ///< "estop", "radio_lost", "base_lost", "pose_uncertain" …
  std::string detail;
  friend bool operator==(const SafetyCondition&, const SafetyCondition&) = default;
};

/// What the radio's switches and knob mean as they stand, in words; empty: not known.
struct RadioMeaning {
  std::string_view swa, swb, swc, swd, vra;  ///< of static texts
};

struct EstimatorHealth {
  double compass_bias_rad = 0.0;
  double odometry_scale = 1.0;
  double pull_1pm = 0.0;  ///< curvature of a vehicle that is told to go straight; left positive
  std::uint64_t rejected = 0;
  std::uint64_t resets = 0;
};

struct LoopHealth {
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;  ///< woke more than one period late
  double last_lateness_s = 0.0;
  /// Wake-ups counted by lateness: entry i holds those below 2^i us (and not below 2^(i−1)), the
  /// last one all that were later.
  std::array<std::uint64_t, 20> lateness_log2_us{};
};

struct Snapshot {
  Time now;
  WallTime wall;
  std::uint64_t tick = 0;

  Mode mode = Mode::Hold;
  bool armed = false;
  bool estop = false;
  Driver control = Driver::None;
  std::string speed_reason;  ///< the term that limits the speed now: "item", "bend", "approach" …

  std::optional<Pose> pose;
  std::optional<LocalFrame> frame;
  std::optional<LatLon> home;
  std::optional<GnssFix> gnss;
  std::optional<GnssVelocity> gnss_velocity;
  std::optional<Attitude> attitude;
  std::vector<SatellitesInView> satellites;  ///< one entry for each receiver that tells
  std::optional<BaseStatus> base;
  std::optional<BaseMotion> motion;
  std::optional<SteeringState> steering;
  std::optional<BatteryState> battery;
  std::vector<MotorState> motors;  ///< by number
  std::optional<LightState> lights;
  std::optional<Bumper> bumper;
  std::optional<RadioState> radio;
  RadioMeaning radio_meaning;
  std::vector<DriverStatus> drivers;

  MissionProgress mission;
  Activity activity;
  std::optional<FenceState> fence;
  DriveCommand command;  ///< what was sent at this tick
  std::vector<SafetyCondition> safety;
  std::vector<Check> checks;
  bool ready_to_arm = false;
  EstimatorHealth estimator;
  LoopHealth loop;
};

/// One thing an operator must be able to find later. Written by the robot, stored once.
struct Event {
  WallTime wall;
  Severity level = Severity::Info;
  std::string kind;    ///< stable snake_case word: "armed", "mode", "item_reached", "estop" …
  std::string detail;  ///< one sentence
};

}  // namespace roverd::base
