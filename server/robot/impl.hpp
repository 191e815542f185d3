#pragma once
// The inside of Robot. Only the files of this room include it.
//
// A tick, and who does what in it:
//
//   inbox ─▶ world, estimator ─▶ safety/: assessment, checks, watches ─▶ arm, machine: what may be
//   commands ─▶ commands.cpp, modes/: what is asked                          │
//        who drives:  e-stop > radio > by_hand > missions | self_driving ◀───┘
//                                   │
//                     fence, guard: the last words ─▶ send ─▶ publish
//
// Each part is a class with its own diagram and tests; Impl knows them all, hands each what it
// needs and nothing more, and keeps what belongs to no one: where the robot is, and what was sent.
// The radio's take-over keeps the mode; a mission goes on by itself when control returns.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "nav/estimate/estimator.hpp"
#include "robot/calibration.hpp"
#include "robot/compile.hpp"
#include "robot/delivered.hpp"
#include "robot/guard/detour.hpp"
#include "robot/guard/guard.hpp"
#include "robot/guard/row_watch.hpp"
#include "robot/handling.hpp"
#include "robot/known_places.hpp"
#include "robot/loop_clock.hpp"
#include "robot/map_frame.hpp"
#include "robot/mission_keeper.hpp"
#include "robot/modes/auto_hand.hpp"
#include "robot/modes/by_hand.hpp"
#include "robot/modes/driven_way.hpp"
#include "robot/modes/home.hpp"
#include "robot/modes/machine.hpp"
#include "robot/modes/self_driving.hpp"
#include "robot/modes/straight_start.hpp"
#include "robot/modes/way_home.hpp"
#include "robot/outbox.hpp"
#include "robot/parameter_set.hpp"
#include "robot/radio/keys.hpp"
#include "robot/safety/arm_switch.hpp"
#include "robot/safety/base_watch.hpp"
#include "robot/safety/battery_use.hpp"
#include "robot/safety/driver_falls.hpp"
#include "robot/safety/estimate_watch.hpp"
#include "robot/safety/fence_keep.hpp"
#include "robot/safety/last_stop.hpp"
#include "robot/safety/lean.hpp"
#include "robot/safety/position_watch.hpp"
#include "robot/safety/reset_latch.hpp"
#include "robot/safety/safety.hpp"
#include "robot/safety/votes_watch.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

struct PendingCommand {
  Command command;
  Validity validity;
  Reply reply;
};

/// The words of the public command in those of nav.
nav::StartAt start_at(const StartMission& c) noexcept;

/// As far as a mission's beginning needs it.
inline nav::Stand stand_of(const base::Pose& pose) noexcept {
  return {pose.at, pose.heading_known ? std::optional(pose.yaw_rad) : std::nullopt,
          pose.horizontal_sigma_m};
}

struct Robot::Impl {
  using Mode = base::Mode;

  explicit Impl(Config c);

  // Shared between threads; each is safe by itself.
  std::shared_ptr<const Config> reviewed;  ///< set before the first tick
  base::Latest<Config> shared_config;
  base::Inbox<base::Measurement> measurements{4096};
  base::Inbox<std::shared_ptr<const Surroundings>> surroundings{4};
  base::Inbox<std::shared_ptr<const Surroundings>> surroundings_done{16};
  base::Inbox<RowQuestion> row_questions{8};
  base::Inbox<std::shared_ptr<const nav::tags::TagsSeen>> tags{32};
  base::Inbox<KnownPlaces::List> known_lists{8};
  base::Inbox<nav::sense::Odometry> odometry{256};
  base::Inbox<std::shared_ptr<const AroundQuestion>> around_questions{2};
  base::Inbox<std::shared_ptr<const AroundAnswer>> around_answers{4};
  static constexpr std::size_t kCommands = 64;
  base::Inbox<PendingCommand> commands{kCommands};
  base::Latest<base::Snapshot> snapshot;
  base::Latest<nav::Learned> learned;
  base::Latest<DrivenWay> shared_way;
  base::Latest<std::vector<base::KnownPlace>> shared_places;
  Delivered<CompiledMission> loaded;
  Delivered<LaidFence> shared_fence;
  std::atomic<bool> estop_asked{false};
  std::optional<Time> unnamed_stop;    ///< latched then; who asked for it comes with the command
  std::atomic<std::uint64_t> made{1};  ///< ids of missions and fences that are laid out
  std::atomic<std::uint32_t> frame_ids{2};  ///< 1 is for the first fix
  Outbox outbox;

  // Control thread from here on.
  ParameterSet config;
  bool config_unpublished = true;
  LoopClock clock;
  World world;
  std::vector<std::string> down_told;  ///< drivers that are down, and were told to be
  nav::Estimator estimator;
  std::optional<base::Pose> pose;
  base::EstimatorHealth health;  ///< of the estimator, at this tick

  ArmSwitch arm;
  LastStop last_stop;
  ModeMachine machine;
  MissionKeeper missions;
  SelfDriving self_driving;
  ByHand by_hand;
  AutoHand auto_hand;
  StraightStart straight;
  HomePlace home;
  DrivenWayKeeper driven;
  std::uint64_t driven_told = 0;
  FenceKeep fence;
  Guard guard;
  Detour detour{config.path, config.behave};
  std::shared_ptr<const std::vector<base::LatLon>> detour_told;
  base::Time detour_told_at{};
  double around_left_m = 0.0;  ///< arc length of the mission's way where it left it
  std::uint64_t around_way_id = 0;
  bool around_again = false;  ///< it was held on its way around: one from here is looked for
  base::Time around_again_at{};
  bool around_backs = false;     ///< the last answer was that it cannot turn where it stands
  bool around_hopeless = false;  ///< there is no way around, and that was told
  std::string around_none;       ///< why, as it was told
  std::string around_in_doubt;   ///< why there may be none, while one is driven
  std::vector<std::shared_ptr<const AroundAnswer>> around_batch;
  Mode guarded_mode = Mode::Hold;
  bool overridden = false;    ///< a hand holds the guard off, and was told so
  std::string overrider;      ///< who does
  bool waits_before = false;  ///< the drive was not asked at this tick: something stands before it
  std::optional<base::Time> blind_since;
  std::string blind;  ///< why nothing may drive by itself: a sensor; empty: nothing is wrong
  base::Time looked_for_map{};                 ///< of the mission, while it leads into it
  std::optional<base::Time> out_of_map_since;  ///< it may lie elsewhere, or the robot is not in it
  bool blind_pause = false;  ///< the mission waits because of it, and nobody has said a word since
  std::optional<base::Time> sees_since;
  bool recognises = false;  ///< cameras tell of walls and landmarks, and nothing looks around
  bool reads_tags = false;  ///< cameras do
  nav::tags::TagBook tag_book;
  KnownPlaces known_places;
  std::vector<KnownPlaces::List> known_batch;
  std::shared_ptr<const nav::marks::View> looked_beside;  ///< for known places
  std::vector<std::shared_ptr<const nav::tags::TagsSeen>> tags_batch;
  RowQuestion row_asked;
  std::vector<std::shared_ptr<const Surroundings>> surroundings_batch;
  RadioKeys keys;
  std::vector<RadioKey> pressed;
  bool radio_had_control = false;

  BaseWatch base_watch;
  EstimateWatch estimate_watch;
  VotesWatch votes_watch;
  ResetLatch reset_latch;
  PositionWatch position_watch;
  LeanWatch lean_watch;
  LeanWatch roll_watch;
  DriverFalls driver_falls;
  BatteryUse battery_use;
  Handling handling;
  KeptCalibration calibrated;
  base::Time calibration_seen{};  ///< headings up to here
  std::string self_test;  ///< of the failsafes, at the start; empty: nothing is wrong with them
  Assessment assessment;
  std::vector<base::Check> checks;
  int ticks_unchecked = 0;

  base::Driver driver = base::Driver::None;
  base::DriveCommand sent;
  std::string speed_reason;
  base::PlacePhase place_told = base::PlacePhase::Off;
  std::string place_told_in;  ///< the map of that
  bool latch_told = false;    ///< to Robot::on_latch

  static constexpr const char* kOperator = "by the operator";
  const char* asker = kOperator;  ///< whose command is carried out, for the events
  std::vector<base::Measurement> measurement_batch;
  std::vector<PendingCommand> command_batch;
  std::shared_ptr<const void> retired;  ///< by the command that is being carried out

  // tick, in this order (robot.cpp, commands.cpp, radio/panel.cpp, decide.cpp, publish.cpp)
  void take_estop(Time now);
  void name_stop(Time now);
  void take_commands();
  base::Result<void> carry_out(const PendingCommand& pending);
  void take_measurements();
  void note_driver(const base::DriverStatus& d);
  nav::VehicleLearner::Seen seen() const;
  void judge();
  base::DriveCommand decide();
  bool publish();
  void publish_driven_way();
  void tell_wait(base::Snapshot& s) const;
  void survive(const char* what, const Robot& self) noexcept;
  void tell_latch(const Robot& self);

  // commands.cpp: what was done, or why not
  base::Result<void> handle(const Arm&);
  base::Result<void> handle(const Disarm&);
  base::Result<void> handle(const SetMode& c);
  base::Result<void> handle(const Estop& c);
  base::Result<void> handle(const ResetEstop&);
  base::Result<void> handle(const Acknowledge&);
  base::Result<void> handle(const StartMission& c);
  base::Result<void> handle(const PauseMission&);
  base::Result<void> handle(const ResumeMission&);
  base::Result<void> handle(const ResumeActivity&);
  base::Result<void> handle(const StopMission&);
  base::Result<void> handle(const SkipItem& c);
  base::Result<void> handle(const SetHome& c);
  base::Result<void> handle(const SetPose& c);
  base::Result<void> handle(const SetAnchor& c);
  base::Result<void> handle(const DropAnchor&);
  base::Result<void> handle(const SettleShift& c);
  base::Result<void> handle(const CorrectAntennas& c);
  base::Result<void> handle(const Calibrate& c);
  base::Result<void> handle(const SettleCalibration& c);
  base::Result<void> handle(const ForgetCalibration&);
  base::Result<void> handle(const Drive& c);
  base::Result<void> handle(const Throttle& c);
  base::Result<void> handle(const LoadMission& c);
  base::Result<void> handle(const ReviseMission& c);
  base::Result<void> handle(const GoTo& c);
  base::Result<void> handle(const MoveBy& c);
  base::Result<void> handle(const SetTarget& c);
  base::Result<void> handle(const SetParameter& c);
  base::Result<void> handle(const SetFence& c);
  base::Result<void> handle(const ResumeAt& c);
  base::Result<void> handle(const LayAnew& c);
  base::Result<void> may_change(const SetParameter& c, const Config& next) const;
  /// @param from empty: it does not begin or go on now
  base::Result<void> in_its_map(const CompiledMission& mission,
                                const std::optional<base::MissionPlace>& from) const;
  MapNow map_now() const;
  std::optional<std::string> out_of_map();
  base::Result<void> may_drive_mission(const std::optional<base::MissionPlace>& from = {}) const;
  bool by_sight_from(const nav::Route& route, const base::MissionPlace& from) const noexcept;
  /// @param homeward what leads to where a return leads, too @param sight it asks for no place
  base::Result<void> may_drive_by_itself(bool homeward = false, bool sight = false) const;
  void adopt(std::shared_ptr<const CompiledMission> mission);
  void retire(std::shared_ptr<const void> old);
  base::Result<void> start(const nav::StartAt& at);
  base::Result<void> resume();

  /// The only way to another mode. @return whether it is another one now
  bool change_mode(ModeCause cause, const std::string& why, Mode chosen = Mode::Hold);
  void disarm(const std::string& why);
  void latch_estop(const std::string& who);
  bool latch_silently();
  void tell_stop(const std::string& who);
  void hold(const std::string& why);
  /// Nothing where home is out of the map's reach.
  std::optional<base::EnuPoint> home_point() const;
  /// Needs a frame.
  bool within_reach(base::LatLon at) const;
  Facts facts() const;
  std::optional<base::Attitude> attitude() const;
  /// What is there of `level_mps2` where it is and where it drives to.
  double braking_here_mps2(double level_mps2) const;
  double most_roll_deg() const noexcept;

  // modes/enter.cpp, goals.cpp, returns.cpp: entering
  base::Result<void> guide(const nav::GuidedGoal& goal, std::string_view kind);
  base::Result<base::EnuPoint> place_of(const GoTo& c) const;
  base::Result<void> go_on();
  base::Result<void> enter_guided();
  base::Result<void> enter_home(Mode to);
  void begin_home(ModeCause cause, Mode to, const WayHome& found, const std::string& why);
  void go_back(const std::string& why);
  base::Result<void> enter_follow();
  base::Result<void> enter_dock(const SetMode& c);
  base::Result<void> enter_dock_at_tag(const SetMode& c);
  base::Result<void> enter_loiter(const SetMode& c);
  base::Result<void> enter_circle(const SetMode& c);
  base::Result<void> circle_inside(const nav::OrbitGoal& goal) const;
  base::Result<void> enter_sticks(Mode to);
  WayHome way_home(Mode mode) const;
  void choose_home(base::LatLon at);
  void begin_way_anew();

  // modes/drive.cpp: one tick of them
  base::DriveCommand drive_by_hand();
  base::DriveCommand drive_mission();
  base::DriveCommand drive_by_itself();
  nav::Vehicle vehicle() const;
  double limit_mps() const noexcept;
  double free_limit_mps() const noexcept;
  double hand_mps() const noexcept;
  bool hand_holds() const noexcept;
  std::string_view reason_under_hand(std::string_view reason) const noexcept;
  base::DriveCommand under_hand(base::DriveCommand command);
  void watch_hand();
  /// Of the mission that runs.
  std::optional<double> corridor_m() const noexcept;
  void tell_notices();
  void act(const nav::Notice& n);
  void lay_way();

  // decide.cpp
  base::DriveCommand choose();
  base::DriveCommand keep_inside(base::DriveCommand command);
  // guard/watched.cpp
  void look_around();
  base::DriveCommand keep_off(base::DriveCommand command);
  base::BodyTwist guarded(const base::BodyTwist& wanted);
  void ask_for_row();
  std::optional<base::RowState> row_state() const;
  bool by_sight() const noexcept;
  std::optional<nav::RowSight> row_sight() const;
  std::optional<nav::MarkSight> mark_sight() const;
  nav::sense::Pose2 local_in_odometry() const noexcept;
  void take_known_places();
  void see_known_poles();
  void read_the_tags(const nav::sense::Odometry& now);
  nav::tags::TagSight tag_sight() const noexcept;
  std::shared_ptr<const std::vector<base::TagState>> tag_states() const;
  const nav::tags::TagDock* docks_at_tag() const noexcept;
  bool ask_around();
  void take_around();
  void no_way_around(const AroundAnswer& answer);
  void tell_hopeless();
  void watch_detour();
  std::optional<base::BodyTwist> drive_around();
  base::BodyTwist step_detour();
  std::shared_ptr<const std::vector<base::LatLon>> detour_way();
  void end_detour();
  void go_on_behind(double at_m);
  void keep_guard();
  void spare_dock();
  void watch_blind_pause();
  bool waits_for_way();
  void be_blocked(Then then);
  void give_up(const std::string& why);
  base::Result<void> inside(base::EnuPoint to) const;
  double way_margin_m() const;
  void watch_frame();
  void watch_base();
  void watch_estimate();
  void watch_place();
  void watch_radio(bool drives);

  // positioning.cpp
  base::Result<void> may_be_placed() const;
  void told_where();
  base::Result<base::EnuPoint> anchor_point(const SetAnchor& c) const;
  base::DriveCommand seek_heading();
  base::BodyTwist straight_first(const base::BodyTwist& wanted);

  // calibration.cpp
  base::Result<void> keep_calibration(const base::CalibrationState& state);
  nav::CalibrationSight calibration_sight();
  void see_handling();
  void sent_handling();

  // radio/panel.cpp
  void press(const base::RadioState& frame);
  void act_on_radio();
  base::Result<void> carry_out(const RadioAction& action);
  base::Result<void> drive_by_radio();
  base::Result<void> ask_for_edit(RadioDeed deed);
  base::Result<void> ask_for_teach(TeachWish wish);
  base::RadioMeaning radio_meaning() const noexcept;

  base::TeleopState teleop() const;

  void event(base::Severity level, const char* kind, std::string detail) {
    outbox.event(clock.wall(), level, kind, std::move(detail));
  }
};

}  // namespace roverd::robot
