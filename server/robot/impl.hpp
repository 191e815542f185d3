#pragma once
// The inside of Robot. Only the files of this room include it.
//
// Modes (armed or not; nothing moves unless armed):
//
//   by hand                 stopped        by itself, paused by any loss
//   MANUAL                                 AUTO      a mission (nav/behave/executor.hpp)
//   ACRO STEERING SIMPLE ◀──▶ HOLD ◀──▶    GUIDED    a goal (nav/behave/guided.hpp)
//   (nav/behave/sticks.hpp)                RTL SMART_RTL   (nav/behave/homeward.hpp)
//                                          FOLLOW (nav/behave/follow.hpp)  DOCK (…/dock.hpp)
//
//   Any mode leads to any other by set mode; a mode refuses to begin (Conflict, with the reason)
//   where its conditions do not hold, and then the one before goes on. Leaving AUTO pauses the
//   mission. RTL, SMART_RTL, FOLLOW and DOCK end in HOLD. Between two that drive by themselves the
//   robot stands first (robot/modes/changeover.hpp).
//
//   Disarmed ──arm (all checks pass)──▶ Armed ──disarm, e-stop──▶ Disarmed
//   e-stop: Released ──anyone, the base──▶ Latched ──reset, base released──▶ Released, disarmed,
//   HOLD
//
// Who drives: e-stop > radio > by hand over the network > by itself. Whoever drives, the fence has
// the last word. The radio's take-over keeps the mode and what it does; it goes on from the same
// place when control returns.

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "nav/behave/breadcrumbs.hpp"
#include "nav/behave/dock.hpp"
#include "nav/behave/executor.hpp"
#include "nav/behave/follow.hpp"
#include "nav/behave/guided.hpp"
#include "nav/behave/homeward.hpp"
#include "nav/behave/sticks.hpp"
#include "nav/estimate/estimator.hpp"
#include "robot/compile.hpp"
#include "robot/modes/changeover.hpp"
#include "robot/modes/held_by_radio.hpp"
#include "robot/modes/home.hpp"
#include "robot/modes/manual.hpp"
#include "robot/modes/straight_start.hpp"
#include "robot/modes/way_home.hpp"
#include "robot/outbox.hpp"
#include "robot/parameter_set.hpp"
#include "robot/radio/keys.hpp"
#include "robot/safety/fence_guard.hpp"
#include "robot/safety/obedience.hpp"
#include "robot/safety/safety.hpp"
#include "robot/safety/spin.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

struct PendingCommand {
  Command command;
  Time not_after;
  Reply reply;
};

/// The words of the public command in those of nav.
nav::StartAt start_at(const StartMission& c) noexcept;

struct Robot::Impl {
  using Mode = base::Mode;

  explicit Impl(Config c);

  // Shared between threads; each is safe by itself.
  base::Latest<Config> shared_config;
  base::Latest<LaidFence> shared_fence;
  base::Inbox<base::Measurement> measurements{4096};
  base::Inbox<PendingCommand> commands{64};
  base::Latest<base::Snapshot> snapshot;
  base::Latest<CompiledMission> loaded;
  base::Latest<nav::Learned> learned;
  base::Latest<DrivenWay> driven_way;
  std::atomic<bool> estop_asked{false};
  std::atomic<std::uint64_t> made{1};       ///< ids of missions and fences that are laid out
  std::atomic<std::uint32_t> frame_ids{2};  ///< 1 is for the first fix
  Outbox outbox;

  // Control thread from here on.
  ParameterSet config;
  bool config_unpublished = true;
  bool fence_unpublished = false;
  nav::Estimator estimator;
  nav::Executor executor;
  nav::Guided guided;
  nav::Dock dock;
  nav::Homeward homeward;
  nav::Follow follower;
  nav::Sticks sticks;
  nav::Breadcrumbs crumbs;
  std::uint64_t crumbs_resets = 0;
  std::uint64_t crumbs_published = 0;  ///< Breadcrumbs::changes() of what others see
  Changeover changeover;
  std::shared_ptr<const LaidFence> fence;
  bool fence_stops = false;  ///< at this tick
  bool fence_told = false;
  base::Activity activity;
  Manual manual;
  RadioKeys keys;
  std::vector<RadioKey> pressed;
  World world;
  std::shared_ptr<const CompiledMission> mission;
  bool mission_unpublished = false;

  static constexpr const char* kOperator = "by the operator";
  const char* asker = kOperator;  ///< whose command is carried out, for the events
  base::Mode mode = base::Mode::Hold;
  bool armed = false;
  bool estop = false;
  HomePlace home;
  HeldByRadio held;  ///< what a mode other than AUTO did when the radio took over

  Time now{};
  base::WallTime wall{};
  std::optional<Time> last_tick;
  double dt_s = 0.02;
  std::optional<base::Pose> pose;
  Assessment assessment;
  std::vector<base::Check> checks;
  std::optional<Time> base_waited_since;
  ObedienceWatch follow;
  SpinWatch spin;
  bool spun = false;                    ///< at the last tick
  std::optional<Time> in_charge_since;  ///< armed, no radio: the base is to listen to us
  bool base_listened = false;
  bool base_left = false;  ///< at this tick
  bool base_gone = false;  ///< since then
  std::optional<Time> sigma_bad_since;
  bool radio_had_control = false;
  base::Driver driver = base::Driver::None;
  base::DriveCommand sent;
  std::string speed_reason;
  base::LoopHealth loop;
  base::EstimatorHealth health;  ///< of the estimator, at this tick
  StraightStart straight;
  std::uint64_t resets_seen = 0;
  bool gyro_seen = false;
  bool anchored = false;
  base::Alignment alignment_seen = base::Alignment::Unknown;
  std::array<bool, 4> refusal_told{};
  base::FixType fix_told = base::FixType::None;
  base::FixType fix_seen = base::FixType::None;
  Time fix_seen_since{};
  std::vector<base::Measurement> measurement_batch;
  std::vector<PendingCommand> command_batch;
  std::optional<Time> fault_told;       ///< the last event about one
  std::shared_ptr<const void> retired;  ///< by the command that is being carried out

  // tick, in this order (robot.cpp, commands.cpp, radio.cpp, decide.cpp, publish.cpp)
  void begin(Time t, base::WallTime w, base::Duration lateness);
  void take_estop();
  void take_commands();
  void take_measurements();
  void note_driver(const base::DriverStatus& d);
  void judge();
  base::DriveCommand decide();
  bool publish();
  void publish_driven_way();
  void survive(const char* what, const Robot& self) noexcept;

  // commands.cpp: what was done, or why not
  base::Result<void> handle(const Arm&);
  base::Result<void> handle(const Disarm&);
  base::Result<void> handle(const SetMode& c);
  base::Result<void> handle(const Estop& c);
  base::Result<void> handle(const ResetEstop&);
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
  base::Result<void> handle(const Drive& c);
  base::Result<void> handle(const LoadMission& c);
  base::Result<void> handle(const ReviseMission& c);
  base::Result<void> handle(const GoTo& c);
  base::Result<void> handle(const MoveBy& c);
  base::Result<void> handle(const SetTarget& c);
  base::Result<void> handle(const SetParameter& c);
  base::Result<void> handle(const SetFence& c);
  base::Result<void> handle(const ResumeAt& c);
  base::Result<void> may_drive_mission() const;
  base::Result<void> may_drive_by_itself() const;
  base::Result<void> mission_inside(const nav::StartAt& at) const;
  void adopt(const LoadMission& c);
  void retire(std::shared_ptr<const void> old);
  base::Result<void> start(const nav::StartAt& at);
  base::Result<void> resume();

  void set_mode(base::Mode to, const std::string& why);
  void disarm(const std::string& why);
  void latch_estop(const std::string& who);
  void hold(const std::string& why);
  /// Nothing where home is out of the map's reach.
  std::optional<base::EnuPoint> home_point() const;
  /// Needs a frame.
  bool within_reach(base::LatLon at) const;
  Facts facts() const;

  // modes.cpp, goals.cpp, returns.cpp: entering and leaving
  base::Result<void> guide(const nav::GuidedGoal& goal, std::string_view kind);
  base::Result<base::EnuPoint> place_of(const GoTo& c) const;
  base::Result<void> enter_guided();
  base::Result<void> enter_return();
  base::Result<void> enter_retrace();
  base::Result<void> enter_follow();
  base::Result<void> enter_dock(const SetMode& c);
  base::Result<void> enter_sticks(Mode to);
  WayHomeFacts way_home_facts() const;
  DrivenWay driven() const;
  void begin_return(Mode to, const WayHome& home_way, std::string_view kind);
  void choose_home(base::LatLon at);
  void take_over(Mode to, const std::string& why);
  void begin_activity(std::string_view kind);
  bool by_itself() const noexcept;
  void interrupt_modes();
  void hold_for_a_word();
  void drop_crumbs();

  // drive_modes.cpp: one tick of them
  nav::Vehicle vehicle() const;
  double limit_mps() const noexcept;
  base::DriveCommand drive_by_sticks();
  base::DriveCommand drive_by_itself();
  nav::TrackOutput step_mode(const nav::Vehicle& v, double limit);
  void end_mode(base::ActivityState state, const char* kind, const std::string& detail);
  void watch_mode();
  void tell_activity();
  void lay_crumbs();

  // fence_duty.cpp
  base::Result<void> inside(base::EnuPoint to) const;
  base::Result<void> way_home_inside() const;
  bool compared() const noexcept;
  base::DriveCommand keep_inside(base::DriveCommand command);
  base::FenceState fence_state() const;

  // decide.cpp
  base::DriveCommand choose();
  base::DriveCommand drive_by_hand();
  base::DriveCommand drive_mission();
  void tell_notices();
  void act(const nav::Notice& n);
  void watch_changes();
  void watch_frame();
  void watch_base();
  base::BodyTwist possible(const base::BodyTwist& told) const noexcept;

  // place.cpp
  base::Result<void> may_be_placed() const;
  base::Result<base::EnuPoint> anchor_point(const SetAnchor& c) const;
  void watch_estimate();
  void watch_refusals();
  base::DriveCommand seek_heading();
  base::BodyTwist straight_first(const base::BodyTwist& wanted);

  // radio.cpp
  void press(const base::RadioState& frame);
  void act_on_radio();
  base::Result<void> carry_out(const RadioAction& action);
  base::Result<void> drive_by_radio();
  base::Result<void> ask_for_edit(RadioDeed deed);
  base::Result<void> ask_for_teach(TeachWish wish);
  base::RadioMeaning radio_meaning() const noexcept;

  void event(base::Severity level, const char* kind, std::string detail) {
    outbox.event(wall, level, kind, std::move(detail));
  }
  base::MissionProgress progress() const;
};

}  // namespace roverd::robot
