#pragma once
// The robot: measurements and commands in, one DriveCommand and one Snapshot out, 50 times a
// second.
//
//   inbox, commands ─▶ tick(now): take → estimate → modes and executor → arbiter → limits
//                        → send → publish
//
// Thread rules: tick and heed_stop run on the control thread, and nothing else does; they are
// noexcept, do no I/O but the two callables `send` and `wake`, allocate little, and wait for nobody
// (queues are taken with try_lock). measurements(), request(), snapshot(), replies(), events(),
// edits() may be used from any thread. Without a thread, a test calls tick() with any times it
// likes.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/drive_command.hpp"
#include "base/inbox.hpp"
#include "base/known_place.hpp"
#include "base/latest.hpp"
#include "base/measurements.hpp"
#include "base/params.hpp"
#include "base/result.hpp"
#include "base/snapshot.hpp"
#include "mission/checks.hpp"
#include "mission/fence/fence.hpp"
#include "mission/plan.hpp"
#include "nav/estimate/learned.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/params.hpp"
#include "nav/tags/tag_place.hpp"
#include "robot/config.hpp"
#include "robot/guard/blocked.hpp"
#include "robot/guard/outline.hpp"

namespace roverd::robot {

using base::Time;

struct AroundAnswer;    // see robot/guard/around.hpp
struct AroundQuestion;  // likewise
struct RowQuestion;     // see robot/guard/row_watch.hpp
struct Surroundings;    // see robot/guard/surroundings.hpp

/// One revision of a mission as the api hands it over. Immutable.
struct MissionCopy {
  std::string id;
  std::int64_t revision = 0;
  mission::Plan plan;
};

/// by_hand: the position need not be known; nothing drives by itself before it is.
struct Arm {
  bool by_hand = false;
};
struct Disarm {};
/// AUTO goes on with a mission that waits. It starts none: StartMission names which.
/// A place to go to, in words of the outside. Neither `at` nor `local`: a way to go, by yaw and
/// speed, that holds until it is too old (ModeParams::stream_timeout_s).
struct GoTo {
  std::optional<base::LatLon> at;
  std::optional<base::EnuPoint> local;  ///< in the robot's map
  std::optional<double> yaw_rad;
  std::optional<double> speed_mps;
  bool reverse = false;
};
/// Exactly one of the first three.
struct MoveBy {
  std::optional<double> forward_m;  ///< negative: backwards
  std::optional<double> turn_rad;   ///< left positive, any size
  std::optional<double> yaw_rad;    ///< turn to it, the shorter way
  std::optional<double> speed_mps;  ///< of forward_m
};
/// A moving target for FOLLOW.
struct SetTarget {
  std::optional<base::LatLon> at;
  std::optional<base::EnuPoint> local;  ///< else
  std::optional<base::EnuPoint> velocity_mps;
  double age_s = 0.0;  ///< when this was asked; the robot adds what passes until it takes it
  base::Time asked;
  enum class Offset { None, North, Course } offset = Offset::None;
  double a_m = 0.0;  ///< North: east. Course: forward
  double b_m = 0.0;  ///< North: north. Course: left
};
struct SetMode {
  base::Mode mode = base::Mode::Hold;
  /// Of DOCK: the pose, or a tag; reverse: with the tail. Of CIRCLE: its centre, needed; of LOITER:
  /// the place, empty: here; with a speed.
  std::optional<GoTo> goal{};
  /// DOCK, in the place of the goal: the tag of this number; stand_off_m before it, empty: as
  /// nav.tag_dock says.
  std::optional<int> tag{};
  std::optional<double> stand_off_m{};
  std::optional<double> radius_m{};  ///< CIRCLE, LOITER
  std::optional<double> turns{};     ///< CIRCLE; empty: without end
  bool clockwise = false;            ///< CIRCLE
};
/// One parameter, by the name of its section and its own: "nav.track.lookahead_min_m".
struct SetParameter {
  std::string name;
  base::ParamValue value;
  std::string who{};  ///< for the event
  bool next_start =
      false;  ///< it acts then: nothing changes now, but that it may be is judged here
};
struct LaidFence;  // see robot/safety/fence_guard.hpp
/// What may be driven on from the next tick on. Null: no fence.
struct SetFence {
  std::shared_ptr<const LaidFence> fence;
};
struct Estop {
  std::string who;
};
struct ResetEstop {};
/// A person has looked where the robot stands, after an estimate that was set anew far off.
struct Acknowledge {};
struct StartMission {
  std::string mission_id;
  std::int64_t revision = 0;
  enum class From { First, Nearest, Item } from = From::First;
  int item = 1;  ///< 1-based, with From::Item
};
struct PauseMission {};
/// A mission that waits goes on; with none, as ResumeActivity.
struct ResumeMission {};
/// What a mode other than AUTO did when the radio took over goes on.
struct ResumeActivity {};
struct StopMission {};
struct SkipItem {
  int item = 0;  ///< 1-based target; 0: the next one
};
struct SetHome {
  std::optional<base::LatLon> at;  ///< empty: here
};
/// Where the robot stands, or which way it points, or both. Conflict while it moves.
struct SetPose {
  std::optional<base::LatLon> at;
  std::optional<base::EnuPoint> local;  ///< in the robot's frame, if `at` is empty
  std::optional<double> heading_deg;    ///< compass, finite
};
/// The robot stands at a known point: the receiver's positions are moved there for this session, or
/// until the fix class changes. Conflict while it moves, or too far away.
struct SetAnchor {
  std::optional<base::LatLon> at;
  std::optional<int> item;  ///< of the loaded mission, if `at` is empty; from 1
};
struct DropAnchor {};
/// The receiver's positions moved for good (EstimatorHealth::base_shift): which ones count?
/// Conflict while it moves, or when nothing has moved.
struct SettleShift {
  bool keep = false;  ///< the old ones; the receiver's are moved back as by an anchor
};
/// The two antennas are mounted askew as measured (EstimatorHealth::antennas_askew): take that from
/// their headings, or take nothing from them any more. Conflict while it moves, or without either.
struct CorrectAntennas {
  bool apply = false;
};
/// Begins a guided calibration drive from here. Conflict as of any goal, and where its figure does
/// not fit.
struct Calibrate {
  base::CalibrationKind kind = base::CalibrationKind::Drive;
};
/// What the last one measured. Conflict where it measured nothing, or while the robot moves.
struct SettleCalibration {
  bool keep = false;
};
/// What was kept of earlier ones, and all else that was learned of the vehicle.
struct ForgetCalibration {};
/// Teleoperation. Void after 0.5 s without a newer one. Conflict while it may not act: see
/// modes/manual.hpp for who must have let go since when.
struct Drive {
  base::BodyTwist twist;
  bool deadman = false;
  std::uint64_t source = 1;    ///< who says it; never used for two
  std::optional<Time> said{};  ///< the state that its sender saw was true then; empty: now
  bool gone = false;           ///< the source has left, or is not understood; with the dead-man off
  /// Held down with the dead-man: on, slowly, where the guard would stop (guard/guard.hpp).
  bool override_guard = false;
  std::string who{};  ///< with override_guard, for the events; empty: not known
};
/// A hand on the speed of what drives by itself (modes/auto_hand.hpp). Not held, it is never late.
struct Throttle {
  double share = 0.0;  ///< of the speed, 0 to 1
  bool held = false;
  std::uint64_t source = 1;  ///< who says it; never used for two
  bool gone = false;         ///< the source has left, or is not understood; not held
};
/// Sticks in the middle; see modes/manual.hpp.
bool neutral(const base::BodyTwist& twist) noexcept;
struct CompiledMission;  // route of one MissionCopy in one LocalFrame; see robot/compile.hpp
struct LoadMission {
  std::shared_ptr<const CompiledMission> mission;
};
/// The loaded revision by the present parameters, in the place of the one that was laid out by
/// others. Conflict while it is in hand, or if another one is loaded.
struct LayAnew {
  std::shared_ptr<const CompiledMission> mission;
};
/// Loads a mission and goes on with it where another life of this program left it. All or nothing.
struct ResumeAt {
  std::shared_ptr<const CompiledMission> mission;
  base::MissionPlace place;
};

enum class EditKind { AddWaypoint, RemoveItem, Clear };
/// What the radio wants of the loaded mission; the store is to keep it. The robot asks for nothing
/// more until a ReviseMission comes, or the mission stays as it is.
struct MissionEdit {
  EditKind kind = EditKind::AddWaypoint;
  base::LatLon at;         ///< where the robot was
  std::string mission_id;  ///< loaded at that moment; empty: none
  std::int64_t revision = 0;
  std::optional<int> item;  ///< RemoveItem: 1-based; empty: the last one
  base::WallTime wall;
};
/// What the radio wants of the recording of a driven way; whoever keeps it answers by an event.
enum class TeachWish { Start, Pause, Stop, Discard };

/// Puts a new revision in the place of the loaded one, while it is driven if it is: added items
/// come last and the drive goes on; without the current item it goes on with the next one.
struct ReviseMission {
  EditKind kind = EditKind::AddWaypoint;
  int item = 0;         ///< 1-based: the one added or removed
  std::string from_id;  ///< what must be loaded; empty: nothing
  std::int64_t from_revision = 0;
  std::shared_ptr<const CompiledMission> mission;  ///< null: nothing is left to drive
};

using Command =
    std::variant<Arm, Disarm, SetMode, Estop, ResetEstop, Acknowledge, StartMission, PauseMission,
                 ResumeMission, ResumeActivity, StopMission, SkipItem, SetHome, SetPose, SetAnchor,
                 DropAnchor, SettleShift, CorrectAntennas, Drive, LoadMission, ReviseMission, GoTo,
                 MoveBy, SetTarget, SetParameter, SetFence, ResumeAt, LayAnew, Calibrate,
                 SettleCalibration, ForgetCalibration, Throttle>;

/// Whoever says it wants the robot to stand, or lets go of it. Stops are never too late: they are
/// carried out whenever they arrive.
bool is_stop(const Command& c) noexcept;
/// So many of them find room where other commands do not any more.
inline constexpr std::size_t kStopsWaiting = 512;

/// How long a command is good, and what its sender had seen when it was given.
struct Validity {
  /// Not explicit: what moves nothing says only until when it is good.
  Validity(Time until, Time seen_at = Time::max()) noexcept : not_after(until), seen(seen_at) {}
  Time not_after;  ///< still waiting then, it is refused
  Time seen;       ///< a stop that was taken later than this refuses it; max(): none does
};

/// Called with what the robot *did*. Runs on whatever thread drains replies().
using Reply = std::function<void(base::Result<void>)>;

struct PendingReply {
  Reply reply;  ///< may be empty
  base::Result<void> result;
  /// What takes long to free (a mission that was loaded before): not for the thread of the reply.
  std::shared_ptr<const void> left{};
};

/// Code of Robot::changed_safety's findings.
inline constexpr const char* kSafetyParameter = "safety_parameter";

/// What `start` would do now. All unknowns empty.
/// Items that are driven as one smooth way.
struct SmoothedItems {
  int first = 0;  ///< 1-based
  int last = 0;
  double deviation_m = 0.0;  ///< the way passes beside them, and their legs, by no more
};

struct Preview {
  std::string mission_id;
  std::int64_t revision = 0;
  std::string name;
  int first_item = 0;  ///< 1-based
  std::optional<base::LatLon> first_target;
  /// It goes on from where the robot stands, so far behind the begin of its way.
  std::optional<double> joins_after_m;
  int left_out = 0;  ///< items of that way that are not driven to
  std::optional<double> distance_m;
  std::optional<double> bearing_deg;
  double speed_mps = 0.0;
  mission::AtEnd at_end = mission::AtEnd::Hold;
  std::vector<SmoothedItems> smoothed{};  ///< at most kSmoothedShown, those farthest beside first
};
inline constexpr std::size_t kSmoothedShown = 50;

/// A place of the way, and how it is driven from there on.
struct WayPace {
  base::LatLon at;
  double distance_m = 0.0;  ///< along the way
  double speed_mps = 0.0;   ///< planned here; its square is a straight line to the next one
  double set_mps = 0.0;     ///< the most that item, bend and vehicle allow from here on
  int item = 0;             ///< that is driven to from here on
  bool reverse = false;
};

/// A turn on the spot.
struct WayTurn {
  std::optional<double> from_yaw_rad;  ///< empty: as the robot comes
  double to_yaw_rad = 0.0;
  double by_rad = 0.0;     ///< left positive; 0 where nobody knows from where
  double above_rad = 0.0;  ///< from nobody knows where: only if it points away by more than this
};

struct WayStop {
  base::LatLon at;
  double distance_m = 0.0;
  int item = 0;  ///< that is there
  std::vector<WayTurn> turns{};
};

/// The way through the loaded mission as it is laid out: corners rounded, dense points smoothed.
struct MissionWay {
  std::string mission_id;
  std::int64_t revision = 0;
  double length_m = 0.0;
  double within_m = 0.0;             ///< the way is nowhere farther from the line
  std::vector<base::LatLon> line{};  ///< at most kWayPoints; none where it drives nowhere by itself
  std::vector<WayPace> pace{};       ///< at most kWayPoints
  std::vector<WayStop> stops{};      ///< with their turns at most kWayPoints
  std::size_t stops_left_out = 0;    ///< stops and turns behind those
};
inline constexpr std::size_t kWayPoints = 5'000;

/// What RTL or SMART_RTL would do now. All unknowns empty.
struct WayHomePreview {
  bool possible = false;
  std::string reason;    ///< why not
  std::string_view end;  ///< what the target is: "home" "rally_point" "begin_of_way"
  std::optional<base::LatLon> target;
  std::optional<double> distance_m;  ///< along the line
  std::vector<base::LatLon> line;    ///< from the robot to the target, in outline; may be empty
};

/// What a calibration drive would need now. All unknowns empty.
struct CalibrationPreview {
  base::CalibrationKind kind = base::CalibrationKind::Drive;
  bool possible = false;
  std::string reason;  ///< why not
  base::CalibrationSpace space;
  double seconds = 0.0;
  std::vector<base::LatLon> corners;  ///< of the space, around; empty: nobody knows where
};

/// One parameter of the robot's sections.
struct Parameter {
  std::string section;  ///< "nav.track"
  base::ParamInfo info;
  base::ParamValue initial;  ///< by default
  bool at_once = true;       ///< a change acts at the next tick; else at the next start
  bool by_way =
      false;  ///< it acts in the way of missions: that of a loaded one is laid anew for it
};

class Robot {
 public:
  explicit Robot(const Config& config);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Set before the first tick. Called at every tick, never waits; what it returns is ignored: a
  /// lost command shows in the base's feedback.
  std::function<void(const base::DriveCommand&, Time)> send;
  /// Set before the first tick. Called by tick when replies(), events() or edits() got something;
  /// must not wait (an eventfd write).
  std::function<void()> wake;

  /// Set before the first tick. Called by request() on its caller's thread when a stop was asked
  /// for: whoever runs the ticks is to call heed_stop() soon. Must not wait.
  std::function<void()> alert;

  /// Set before the first tick. Called by tick() and heed_stop() when the emergency stop was
  /// latched or released, before the answers to it leave; must not wait.
  std::function<void(bool latched)> on_latch;

  /// Before the first tick: the emergency stop is latched from before. @param why for people
  void begin_latched(const std::string& why, base::WallTime wall);
  /// Before the first tick: what another life of this program learned.
  void recall(const nav::Learned& learned) noexcept;
  /// Before the first tick: what the vehicle's profile and the configuration's file say, before
  /// anybody changed it. Without it: what the robot was made with.
  void reviewed(const Config& config);
  /// Any thread: what others found out (the host, the maps, the certificate), for events(). Rings
  /// `wake`, which must not be set any more while this may be called.
  void tell(base::Event event);
  /// Any thread. What is worth keeping, a second old at most; null: nothing yet.
  std::shared_ptr<const nav::Learned> learned() const;

  /// Any thread: from drivers.
  base::Inbox<base::Measurement>& measurements() noexcept;
  /// Before the first tick: the profile has sensors, and by this the guard (guard/guard.hpp) keeps
  /// from what they see. Without it the robot drives blind, as it is told.
  /// @param demands what drives by itself needs one of them at least. @param blocked what becomes
  /// of a drive that they stopped; its word passed check(). @param outline of the tool.
  /// @param rays the stop by counted rays, where it is enabled. These sections hold in place of
  /// those that the robot was made with, until one of them is changed as a parameter.
  void guard_by(const nav::sense::ProtectParams& params, bool demands = true,
                const BlockedParams& blocked = {}, const OutlineParams& outline = {},
                const nav::sense::RaysParams& rays = {});
  /// Before the first tick: no sensor looks around, but cameras' programs tell of walls and
  /// landmarks. There is no guard; what is driven by sight is driven by them.
  void recognise();
  /// Before the first tick: cameras of this robot read tags.
  void read_tags();
  /// Any thread: what they read, image by image.
  base::Inbox<std::shared_ptr<const nav::tags::TagsSeen>>& tags() noexcept;
  /// Any thread: from the next tick on these are the things whose place is known. Null: ignored.
  void know(std::shared_ptr<const std::vector<base::KnownPlace>> places);
  /// Any thread: what stands around it; the newest counts.
  base::Inbox<std::shared_ptr<const Surroundings>>& surroundings() noexcept;
  /// The same thread: those that are not needed any more, to be let go.
  base::Inbox<std::shared_ptr<const Surroundings>>& surroundings_done() noexcept;
  /// Any thread: ways around what stands before a mission are asked for here, the newest counts,
  base::Inbox<std::shared_ptr<const AroundQuestion>>& around_questions() noexcept;
  /// and answered here (guard/around.hpp). While nobody answers the robot waits.
  base::Inbox<std::shared_ptr<const AroundAnswer>>& around_answers() noexcept;
  /// Any thread: what row is to be looked for by whoever makes the surroundings; the newest counts.
  base::Inbox<RowQuestion>& row_questions() noexcept;
  /// Any thread: how the body moved, 50 times a second, for whoever makes the surroundings.
  base::Inbox<nav::sense::Odometry>& odometry() noexcept;

  /// Any thread. The answer comes with the next tick through replies(): Late where `validity` says
  /// so, but a stop is always carried out. @return false: no room, nothing was queued and `reply`
  /// will not be called.
  bool request(Command command, Validity validity, Reply reply);

  /// Any thread, at once: compiles a copy into a route in the robot's frame (or a new frame at its
  /// first point while the robot has none). Errors name the items (fields "/items/3").
  base::Result<std::shared_ptr<const CompiledMission>> compile(MissionCopy copy) const;
  /// Any thread: what a start of it would refuse now, as the start itself finds it.
  std::vector<mission::Finding> objections(const CompiledMission& mission,
                                           const StartMission& start) const;
  /// The same of the loaded one; empty where none is.
  std::vector<mission::Finding> objections(const StartMission& start) const;
  /// Any thread: is there a fence that is laid out in the map of this mission?
  bool fenced(const CompiledMission& mission) const;
  /// Any thread. NotFound when nothing is loaded; Conflict when `from` names no item.
  base::Result<Preview> preview(const StartMission& start) const;
  /// Any thread. Invalid unless RTL or SMART_RTL is asked for. Linear in fence and driven way.
  base::Result<WayHomePreview> way_home(base::Mode mode) const;
  /// Any thread; takes long for a long mission. Empty: nothing is loaded.
  std::optional<MissionWay> mission_way() const;
  /// Any thread: what Calibrate would do now.
  base::Result<CalibrationPreview> calibration(base::CalibrationKind kind) const;
  /// Any thread, at once: lays a fence out in the robot's frame, and looks at the loaded mission.
  /// Without a frame yet it forbids every drive without hands; lay it again when there is one.
  std::shared_ptr<const LaidFence> lay_fence(std::shared_ptr<const mission::Fence> fence) const;
  /// Any thread: the parameters as they are now, and as they are by default.
  std::vector<Parameter> parameters() const;
  /// Any thread. What no program would take: NotFound, Invalid. SetParameter also refuses, as
  /// Conflict, what acts only at the next start, and while the robot is armed all that makes it
  /// less safe.
  base::Result<void> check_parameter(const std::string& name, const base::ParamValue& value) const;
  /// Any thread. Safety parameters that are not as the profile says: warnings.
  std::vector<mission::Finding> changed_safety() const;
  /// Any thread.
  std::shared_ptr<const Config> config() const;
  /// Any thread. What is loaded; null if nothing is.
  std::shared_ptr<const MissionCopy> loaded() const;

  base::Inbox<PendingReply>& replies() noexcept;
  base::Inbox<base::Event>& events() noexcept;
  base::Inbox<MissionEdit>& edits() noexcept;
  base::Inbox<TeachWish>& teach_wishes() noexcept;
  /// Any thread; null before the first tick.
  std::shared_ptr<const base::Snapshot> snapshot() const;

  /// Control thread (or a test). @param now never goes backwards. @param wall for events only.
  /// @param lateness how much later than planned the loop woke; for the health figures.
  void tick(Time now, base::WallTime wall, base::Duration lateness = {}) noexcept;

  /// The thread of tick(), between two ticks: a stop that was asked for is latched, and the command
  /// that stands goes out now. Does nothing otherwise. @param now as with tick().
  void heed_stop(Time now) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roverd::robot
