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

#include "base/calibration.hpp"
#include "base/drive_command.hpp"
#include "base/geo.hpp"
#include "base/known_place.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/row_state.hpp"
#include "base/sensing.hpp"
#include "base/tag_state.hpp"
#include "base/time.hpp"

namespace roverd::base {

enum class Mode {
  Manual,
  Hold,
  Auto,
  Guided,
  Rtl,
  SmartRtl,
  Follow,
  Steering,
  Acro,
  Simple,
  Dock,
  Loiter,
  Circle
};
std::string_view to_string(Mode mode) noexcept;  // MANUAL HOLD AUTO GUIDED RTL SMART_RTL …
std::optional<Mode> mode_from(std::string_view text) noexcept;
/// All of them, for whoever asked for another: "MANUAL HOLD AUTO …"
std::string mode_words();

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

/// Where the robot probably is: half axes of the 1σ ellipse.
struct Ellipse {
  double major_m = 0.0;
  double minor_m = 0.0;
  double major_yaw_rad = 0.0;  ///< direction of the larger axis; it has no front: (−π/2, π/2]
};

/// Velocity along the body's axes. What seems to be crab is none of it: two antennas that are
/// mounted askew look the same.
struct OverGround {
  double ahead_mps = 0.0;
  double left_mps = 0.0;
};

/// The estimator's answer.
struct Pose {
  Time stamp;
  EnuPoint at;
  LatLon global;
  double yaw_rad = 0.0;
  bool heading_known = true;        ///< false: yaw_rad means nothing
  std::optional<double> speed_mps;  ///< along the body's forward axis, signed; over ground without
                                    ///< odometry, then never negative
  std::optional<double> yaw_rate_radps;  ///< empty without odometry
  /// Of the origin by odometry and what was learned of this ground. Empty without odometry.
  std::optional<OverGround> over_ground{};
  double horizontal_sigma_m = 0.0;  ///< 1σ, larger axis of the ellipse
  double yaw_sigma_rad = 0.0;       ///< 1σ of yaw_rad as that tells where it will drive
  double heading_sigma_rad = 0.0;   ///< 1σ of yaw_rad as that tells where it points: larger where
                                    ///< only driving showed it, and driving may go a bit aside
  Ellipse ellipse;
  std::optional<double> alt_msl_m;
  std::string
      source;  ///< "gnss", "map", "gnss+odometry", "map+odometry", "landmark+odometry", "odometry"
};

/// Where in its route a mission stands: enough to go on from there, also after a restart.
struct MissionPlace {
  bool back = false;    ///< on the way back of back_and_forth
  int step = 0;         ///< index of the step in hand; behind the last one: at the end
  int standing = -1;    ///< index of the waypoint at which the robot stands; −1: at none
  double s_m = -1.0;    ///< arc length on the route's path; negative: not on it
  double wait_s = 0.0;  ///< left of a wait
  double left = 0.0;    ///< of a move, m, or a turn, rad; 0: all. Of a row or wall: driven, m
  std::vector<int> jumps_left;  ///< of each jump; −1: not counted yet
  int laps = 0;                 ///< driven of a mission that repeats
  bool driving = false;         ///< it was under way: the robot may have gone on a little from here
  std::optional<LatLon> at{};   ///< where the robot was then, while it drove and knew it to 0.5 m
  friend bool operator==(const MissionPlace&, const MissionPlace&) = default;
};

/// What an item by sight is driven by right now.
struct Lead {
  std::string_view what;         ///< row wall landmarks tag
  bool scan = false;             ///< scanners tell it
  bool vision = false;           ///< cameras do. Neither: it is looked for, or remembered
  std::string_view by = "auto";  ///< whose word it is to be driven by: auto scan vision
};

struct MissionProgress {
  std::string mission_id;
  std::int64_t revision = 0;
  std::string name;
  ExecutionState state = ExecutionState::Idle;
  std::string reason;               ///< why paused, blocked, aborted
  std::optional<int> current_item;  ///< 1-based
  int items = 0;
  /// To where the item in hand counts as reached; of a circle along its way.
  std::optional<double> distance_to_item_m;
  std::optional<double> bearing_to_item_deg;
  std::optional<double> cross_track_m;        ///< positive: the robot is left of the path
  std::optional<double> arrival_radius_m;     ///< within it the item in hand counts as reached
  std::optional<double> cross_track_limit_m;  ///< farther off its way the robot pauses
  std::optional<double> distance_left_m;
  std::optional<double> eta_s;
  std::optional<MissionPlace> place;  ///< running, paused or blocked
  std::optional<Lead> lead{};         ///< an item by sight is driven
  bool waits_for_word = false;        ///< it stays at a place until somebody says to go on
  bool laid_by_old = false;           ///< its way was laid out by parameters that changed since
};

/// How far what a mode other than AUTO does has come.
/// Held: the radio took over, and what it interrupted waits for a word.
enum class ActivityState { None, Driving, Turning, Waiting, Held, Reached, Failed };
std::string_view to_string(ActivityState s) noexcept;  // none driving turning waiting held …

/// What a mode other than AUTO is doing, or did last.
struct Activity {
  std::uint64_t id = 0;   ///< counts what was begun; 0: nothing yet
  std::string_view kind;  ///< "goto" "heading" "move" "turn" "return" "retrace" "follow" "dock"
                          ///< "calibration" "loiter" "circle"
  ActivityState state = ActivityState::None;
  std::string reason;          ///< why failed, held or waiting
  std::optional<LatLon> goal;  ///< of CIRCLE: its centre
  std::optional<double> goal_yaw_rad;
  std::optional<int> tag;            ///< of DOCK, where it is a tag
  std::optional<double> distance_m;  ///< left to the goal, along the way; of FOLLOW: to the target
  std::optional<double> turn_rad;    ///< left to turn, left positive
  std::optional<double> radius_m;    ///< of CIRCLE; of LOITER: farther away it drives back
  std::optional<double> turns;       ///< of CIRCLE; empty: without end
  std::optional<bool> clockwise;     ///< of CIRCLE
  std::optional<LatLon> target;      ///< of FOLLOW, as it was told last
  std::optional<double> target_age_s;
};

/// The fence, as the robot sees it.
struct FenceState {
  std::string name;
  bool inside = true;
  std::optional<double> distance_m;  ///< to its nearest limit; negative outside; empty: no limit
  bool compared = true;  ///< with the loaded mission; false: both came at the same moment, or the
                         ///< margin was changed since
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

/// Does the robot know where it points? Unknown: at best a compass hints at it. Aligning: known to
/// some degrees. Aligned: well enough to drive at full speed.
enum class Alignment { Unknown, Aligning, Aligned };
std::string_view to_string(Alignment a) noexcept;  // unknown aligning aligned

/// Why the estimator does not use a measurement.
enum class Refusal {
  NotFinite,   ///< NaN, infinite
  Impossible,  ///< no place on earth, no speed that this robot can have
  Stamp,       ///< doubled, out of order, in the future, too old
  Zero,        ///< latitude and longitude exactly zero
  Date,        ///< before receivers like this were made
  Satellites,  ///< too few of them
  Dilution,    ///< they stand badly (HDOP)
  Accuracy,    ///< the device itself is not sure enough
  Disturbed,   ///< a compass during and after a turn on the spot
  Jump,        ///< outside of what can be believed
  Receivers,   ///< another receiver says something else
  Outvoted,    ///< the other sensors contradict it
};
inline constexpr std::size_t kRefusals = 12;
std::string_view to_string(Refusal r) noexcept;  // not_finite impossible time zero …

/// The newest comparison of a measurement with what was expected of it.
struct Innovation {
  double size = 0.0;  ///< measured minus expected: rad, or the length in m or m/s
  double nis = 0.0;   ///< its square in units of its own variance, y'S⁻¹y
};

/// What one kind of measurement did lately.
struct InputHealth {
  std::optional<Innovation> innovation;
  std::uint64_t rejected = 0;
  std::optional<Time> refused_since;  ///< none was used from then on
  Refusal why = Refusal::Jump;        ///< of the last refusal
};

/// The estimate was set anew. What was driven by it keeps its place: `jump` is old minus new.
struct EstimateReset {
  std::string_view what;  ///< position, heading, pose, anchor, map
  EnuPoint jump;
  double jump_rad = 0.0;   ///< of the yaw
  double claimed_m = 0.0;  ///< 1 sigma that was claimed before, doubts left aside
  double claimed_rad = 0.0;
  Time stamp;
};

/// The operator said at which point the robot stood: the receiver's positions are moved by so much.
struct Anchor {
  EnuPoint offset;  ///< what is added to the receiver's position
  LatLon at;        ///< of the point
  std::optional<int> item;
  Time stamp;
};

/// The receiver's positions moved by so much, all at once, and stay so: its base was moved, or the
/// robot was carried. They are not used until a person has chosen.
struct BaseShift {
  EnuPoint offset;  ///< new minus old
  Time since;
};

/// Two antennas that do not point where the robot drives.
struct Askew {
  double offset_rad = 0.0;  ///< their heading minus the course, left positive
  double sigma_rad = 0.0;
  double way_m = 0.0;  ///< over which it was measured
};

/// What tells of the motion, each for itself. A course over ground belongs to the velocity.
enum class Sense { Tracks, Gyro, Position, Velocity, Compass, Antennas };
inline constexpr std::size_t kSenses = 6;
std::string_view to_string(Sense s) noexcept;  // tracks gyro gnss_position gnss_velocity …

/// By how much two of them differ.
struct Difference {
  enum class Of { Turn, Way, Heading } of = Of::Turn;
  double size = 0.0;      ///< Turn, Heading: rad, left positive; Way: m
  double window_s = 0.0;  ///< Turn, Way: within so long
};

/// What the others make of one of them.
struct SenseVote {
  bool heard = false;                   ///< lately
  bool frozen = false;                  ///< it says the same again and again
  bool left_out = false;                ///< of the estimate, for it contradicts the others
  std::optional<Time> since;            ///< left out
  Difference off;                       ///< of the contradiction that it was left out for
  std::array<bool, kSenses> against{};  ///< whom it contradicted then
};

/// Do they agree?
struct Votes {
  std::array<SenseVote, kSenses> of;  ///< by Sense
  /// These two contradict each other, and nobody can tell which one is wrong.
  std::optional<std::array<Sense, 2>> undecided;
  Difference undecided_off;
  /// What a contradiction that stands takes from every claim of accuracy.
  double doubt_m = 0.0;
  double doubt_rad = 0.0;
  std::uint64_t accusations = 0;  ///< since the start
  /// When fixed positions that driving has not proved yet contradicted another sensor last.
  std::optional<Time> unproved_differed;

  const SenseVote& operator[](Sense s) const noexcept { return of[static_cast<std::size_t>(s)]; }
};

struct EstimatorHealth {
  Alignment alignment = Alignment::Unknown;
  std::string_view advice;                ///< what helps, for a driver; empty: nothing is needed
  bool gyro = false;                      ///< the yaw rate is a gyro's, not the tracks'
  std::optional<double> gyro_bias_radps;  ///< left positive
  double compass_bias_rad = 0.0;
  bool compass_heard = false;
  double odometry_scale = 1.0;
  double pull_1pm = 0.0;  ///< curvature of a vehicle that is told to go straight; left positive
  double pivot_m = 0.0;   ///< so far ahead of its origin it turns about
  /// Metres to its left for each metre ahead: it slides down a slope. Not where it points counts
  /// for its way, but where it goes.
  double side_slip = 0.0;
  std::optional<EnuPoint> gnss_offset;  ///< slow error of the receiver, as estimated
  InputHealth position, velocity, compass, heading, odometry, inertial;
  InputHealth place;         ///< what the map says
  InputHealth landmark;      ///< what known places say
  bool by_map = false;       ///< the position is the map's, not the satellites'
  bool by_landmark = false;  ///< known places led, since fixed satellites or a map did last
  /// What is added to the places of the map: by so much the satellites showed that its anchor is
  /// off. Zero where nothing did.
  EnuPoint map_offset;
  std::uint64_t rejected = 0;
  std::array<std::uint64_t, kRefusals> refusals{};  ///< by cause
  bool receivers_disagree = false;
  double free_m = 0.0;  ///< driven since a position was told
  bool placed = false;  ///< an operator told the last position, not a receiver
  std::uint64_t resets = 0;
  std::optional<EstimateReset> last_reset;
  std::optional<Anchor> anchor;
  std::optional<BaseShift> base_shift;
  std::optional<Askew> antennas_askew;  ///< not used until a person has confirmed the offset
  double antennas_offset_rad = 0.0;     ///< confirmed: what is taken from their headings
  Votes votes;
};

struct LoopHealth {
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;  ///< woke more than one period late
  std::uint64_t faults = 0;      ///< ticks that an exception ended: disarmed, standing
  double last_lateness_s = 0.0;
  /// Wake-ups counted by lateness: entry i holds those below 2^i us (and not below 2^(i−1)), the
  /// last one all that were later.
  std::array<std::uint64_t, 20> lateness_log2_us{};
};

struct LearnedNumber {
  double value = 0.0;
  double sigma = 0.0;  ///< > 0
};

/// How the vehicle answers, as it was learned by driving, beside what was set. All unknowns empty.
struct VehicleLearned {
  std::optional<LearnedNumber> delay_s;            ///< from a command to its motion, for steering
  std::optional<LearnedNumber> drive_delay_s;      ///< likewise, of the speed; this start's
  std::optional<LearnedNumber> braking_mps2;       ///< it brakes no harder; empty: as it was told
  std::optional<LearnedNumber> acceleration_mps2;  ///< likewise
  std::optional<double> braking_shown_mps2;        ///< at least, since it was armed
  double delay_set_s = 0.0;
  double delay_used_s = 0.0;
  double braking_set_mps2 = 0.0;
  double braking_used_mps2 = 0.0;  ///< stops are planned with it
  bool braking_proved = false;     ///< since arming; until then a stop begins as for half of it
  double acceleration_set_mps2 = 0.0;
  double acceleration_used_mps2 = 0.0;
  bool kept = false;  ///< something of it was measured by a calibration drive, and kept
};

/// Driving by hand over the network. Release: a stick must be let go before it acts.
enum class TeleopPhase { Off, Release, Ready, Held };
std::string_view to_string(TeleopPhase phase) noexcept;

struct TeleopState {
  TeleopPhase phase = TeleopPhase::Off;
  std::string reason;                   ///< why it is off, or what helps; else empty
  std::vector<std::uint64_t> released;  ///< the sources of which one may drive
  std::optional<double> delay_s;        ///< of whoever drives: no command is later
  /// Of its speed, what drives by itself is allowed by a hand; empty: nobody uses that.
  std::optional<double> auto_share{};
};

struct Snapshot {
  Time now;
  WallTime wall;
  std::uint64_t tick = 0;

  Mode mode = Mode::Hold;
  bool armed = false;
  bool armed_by_hand = false;  ///< although the position was not known: to be driven by hand
  bool estop = false;
  Driver control = Driver::None;
  std::string speed_reason;  ///< the term that limits the speed now: "item", "bend", "approach" …

  std::optional<Pose> pose;
  std::optional<LocalFrame> frame;
  std::optional<LatLon> home;
  std::optional<GnssFix> gnss;
  std::optional<GnssVelocity> gnss_velocity;
  std::optional<PlaceState> place;  ///< in the map that is in use; empty: nothing looks for it
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
  std::string autonomy_refusal;  ///< why nothing may drive by itself now; empty: it may
  std::optional<FenceState> fence;
  DriveCommand command;  ///< what was sent at this tick
  /// The way around what stands before the mission, while it is driven: the robot's own place on it
  /// first. Null: none.
  std::shared_ptr<const std::vector<LatLon>> detour;
  std::optional<Obstacle> obstacle;  ///< that limits the speed, or stops
  /// By its cameras; null: none of them reads tags.
  std::shared_ptr<const std::vector<TagState>> tags;
  /// Those that were entered, by name; null: none.
  std::shared_ptr<const std::vector<KnownPlaceState>> known_places;
  std::optional<RowState> row;  ///< while a mission drives along one
  std::shared_ptr<const std::vector<SensorState>>
      sensors;                 ///< of the profile; empty: it has none, or nothing came yet
  bool sensors_stale = false;  ///< what they said of themselves is too old to be true
  std::optional<OdometryPlace> odometry;  ///< at this tick; empty: nothing looks around
  TeleopState teleop;
  std::vector<SafetyCondition> safety;
  std::vector<Check> checks;
  bool ready_to_arm = false;
  EstimatorHealth estimator;
  VehicleLearned learned;
  CalibrationState calibration;
  bool antennas_heard = false;  ///< a heading of two antennas, since the start
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
