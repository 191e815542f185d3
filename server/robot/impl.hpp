#pragma once
// The inside of Robot. Only the files of this room include it.
//
// Modes (armed or not; nothing moves unless armed):
//
//            ┌─────────────── set mode ───────────────┐
//            ▼                                        ▼
//   MANUAL ◀───▶ HOLD ◀──pause, finished, a loss── AUTO
//                  └────start, resume, set mode──────▶
//
//   Disarmed ──arm (all checks pass)──▶ Armed ──disarm, e-stop──▶ Disarmed
//   e-stop: Released ──anyone, the base──▶ Latched ──reset, base released──▶ Released, disarmed,
//   HOLD
//
// Who drives: e-stop > radio > teleoperation (MANUAL) > autonomy (AUTO). The radio's take-over
// keeps mode AUTO and the mission running; it goes on from the same place when control returns.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "nav/behave/executor.hpp"
#include "nav/estimate/estimator.hpp"
#include "robot/compile.hpp"
#include "robot/follow.hpp"
#include "robot/manual.hpp"
#include "robot/outbox.hpp"
#include "robot/radio_keys.hpp"
#include "robot/safety.hpp"
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
  explicit Impl(Config c);

  // Shared between threads; each is safe by itself.
  const Config config;
  base::Inbox<base::Measurement> measurements{4096};
  base::Inbox<PendingCommand> commands{64};
  base::Latest<base::Snapshot> snapshot;
  base::Latest<CompiledMission> loaded;
  std::atomic<bool> estop_asked{false};
  std::atomic<std::uint32_t> frame_ids{2};  ///< 1 is for the first fix
  Outbox outbox;

  // Control thread from here on.
  nav::Estimator estimator;
  nav::Executor executor;
  Manual manual;
  RadioKeys keys;
  std::vector<RadioKey> pressed;
  World world;
  std::shared_ptr<const CompiledMission> mission;
  bool mission_unpublished = false;

  base::Mode mode = base::Mode::Hold;
  bool armed = false;
  bool estop = false;
  std::optional<base::LatLon> home;
  bool home_is_chosen = false;  ///< by an operator or a mission, so arming leaves it

  Time now{};
  base::WallTime wall{};
  std::optional<Time> last_tick;
  double dt_s = 0.02;
  std::optional<base::Pose> pose;
  Assessment assessment;
  std::vector<base::Check> checks;
  std::optional<Time> base_waited_since;
  FollowWatch follow;
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
  std::uint64_t resets_seen = 0;
  base::FixType fix_told = base::FixType::None;
  base::FixType fix_seen = base::FixType::None;
  Time fix_seen_since{};
  std::vector<base::Measurement> measurement_batch;
  std::vector<PendingCommand> command_batch;

  // tick, in this order (robot.cpp, commands.cpp, radio.cpp, decide.cpp, publish.cpp)
  void begin(Time t, base::WallTime w, base::Duration lateness);
  void take_estop();
  void take_commands();
  void take_measurements();
  void note_driver(const base::DriverStatus& d);
  void judge();
  base::DriveCommand decide();
  bool publish();

  // commands.cpp: what was done, or why not
  base::Result<void> handle(const Arm&);
  base::Result<void> handle(const Disarm&);
  base::Result<void> handle(const SetMode& c);
  base::Result<void> handle(const Estop& c);
  base::Result<void> handle(const ResetEstop&);
  base::Result<void> handle(const StartMission& c);
  base::Result<void> handle(const PauseMission&);
  base::Result<void> handle(const ResumeMission&);
  base::Result<void> handle(const StopMission&);
  base::Result<void> handle(const SkipItem& c);
  base::Result<void> handle(const SetHome& c);
  base::Result<void> handle(const Drive& c);
  base::Result<void> handle(const LoadMission& c);
  base::Result<void> handle(const ReviseMission& c);
  base::Result<void> may_drive_mission() const;
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

  // decide.cpp
  base::DriveCommand drive_by_hand();
  base::DriveCommand drive_mission();
  void tell_notices();
  void watch_changes();
  void watch_frame();
  void watch_base();
  base::BodyTwist possible(const base::BodyTwist& told) const noexcept;

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
