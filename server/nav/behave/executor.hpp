#pragma once
// Carries out a route, step by step.
//
//   Idle ──load──▶ Loaded ──start──▶ Running ──last step──▶ Finished ──start──▶ Running
//                                    │  ▲  ▲
//                       pause, a loss▼  │resume        stuck, a place missed:
//                                   Paused            Running ─▶ Blocked ──resume─▶ Running
//                                   stop: any of these ─▶ Aborted ──start─▶ Running
//
// An item that cannot be reached is Blocked, or left for the next one, or the robot returns home:
// BehaveParams::unreachable; a row, a wall, landmarks or a dock are always Blocked. interrupt()
// keeps Running but forgets what the tracker was doing: somebody else drives; go_on() continues at
// the same place, driving back to it first if the robot was moved. Control thread; allocates only
// when a new way begins.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/setting.hpp"
#include "base/snapshot.hpp"
#include "nav/behave/along_wall.hpp"
#include "nav/behave/join.hpp"
#include "nav/behave/landmark_drive.hpp"
#include "nav/behave/mode_params.hpp"
#include "nav/behave/params.hpp"
#include "nav/behave/rotate_in_place.hpp"
#include "nav/behave/route.hpp"
#include "nav/behave/row_drive.hpp"
#include "nav/behave/tag_dock.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// Where to begin.
struct StartAt {
  enum class From { First, Nearest, Item } from = From::First;
  int item = 1;
};

/// Something that happened in a step.
struct Notice {
  enum class Kind {
    ItemReached,
    ItemMissed,
    Overshot,  ///< it stands beyond a stop, and backs up to it
    Action,    ///< `detail`: its name, then a blank and its arguments as JSON
    Finished,
    Lap,
    Blocked,
    Lost
  } kind = Kind::ItemReached;
  int item = 0;
  std::string detail;
};

/// Where the mission stands, in the words of the snapshot.
struct Progress {
  std::optional<int> current_item;          ///< empty: none in hand
  std::optional<EnuPoint> target;           ///< the next place on its way
  std::optional<EnuPoint> item_end;         ///< where the item in hand counts as reached
  std::optional<double> way_to_item_end_m;  ///< along the way; empty: straight to it
  std::optional<double> cross_track_m;
  std::optional<double> arrival_radius_m;     ///< within it the item in hand counts as reached
  std::optional<double> cross_track_limit_m;  ///< farther off its way the robot is lost
  /// To the end of the mission; of this lap where it repeats for ever. Jumps are not counted.
  std::optional<double> distance_left_m;
  std::optional<double> eta_s;  ///< until then, as the speeds are planned
  std::optional<base::Lead> lead{};
};

/// The way in hand ahead of its place, for whoever looks for a way around what stands on it.
struct WayAhead {
  std::vector<EnuPoint> way;  ///< at most kStep_m apart; two at least
  double from_m = 0.0;        ///< arc length of the first point
  bool at_end = false;        ///< the last one must be come to, for `item` or a stop
  int item = 0;               ///< 0: none
  static constexpr double kStep_m = 0.2;
};

/// The step a start would begin with; steps.size() if there is none.
std::size_t first_step(const Route& route, const StartAt& start,
                       std::optional<EnuPoint> here) noexcept;
/// Where a start begins, as far as it is known before anything moves.
struct Beginning {
  std::size_t step = 0;          ///< steps.size(): there is no such item
  std::optional<Joining> joins;  ///< it goes on from where the robot stands
  std::optional<EnuPoint> target;
};
/// @param stand empty: not known where. @param home for return_home.
Beginning beginning(const Route& route, const StartAt& at, const std::optional<Stand>& stand,
                    std::optional<EnuPoint> home, const PathParams& path,
                    const BehaveParams& behave) noexcept;
/// The first place a mission drives to from that step on. @param home for return_home.
std::optional<EnuPoint> first_target(const Route& route, std::size_t step,
                                     std::optional<EnuPoint> home) noexcept;

/// That step of a course needs neither a place nor a heading of the map: see
/// Executor::asks_no_place(). @param step out of range: it does
bool asks_no_place(const Course& course, std::size_t step) noexcept;

/// What should be looked for.
struct RowWanted {
  std::uint64_t id = 0;  ///< another one: another row, or the same anew
  rows::RowOrder order;
};

class Executor {
 public:
  Executor(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
           base::Setting<ModeParams> modes = {}, base::Setting<RowDriveParams> rows = {},
           MarkSettings marks = {});

  /// Allowed unless Running. Null: nothing is loaded.
  void load(std::shared_ptr<const Route> route);
  /// The same mission, laid out by other parameters. Not Running, Paused or Blocked; what became of
  /// it stays told.
  void lay_anew(std::shared_ptr<const Route> route);
  /// Conflict when nothing is loaded, it already runs, the item does not exist, or the first place
  /// is too far away.
  base::Result<void> start(const StartAt& at, EnuPoint here, std::optional<EnuPoint> home);
  void pause(std::string reason);
  void stop(std::string reason);
  /// Conflict unless Paused or Blocked, or staying until this word; or when the place to go on with
  /// is too far away.
  base::Result<void> resume(EnuPoint here);
  /// It stays at a place until somebody says to go on: resume.
  bool waits_for_word() const noexcept;
  /// What resume would refuse, without doing it.
  base::Result<void> may_resume(EnuPoint here) const;
  /// Where it stands; empty: nothing is in hand. @param yaw_rad as the robot points now: of an arc
  /// it drove some as it braked for a pause. Empty: not known
  std::optional<base::MissionPlace> place(std::optional<double> yaw_rad = std::nullopt) const;
  /// Loads a route and is Paused at a place of it, as if it had been interrupted there. Where it
  /// was being driven, resume goes on from the nearest place ahead: the robot rolled on meanwhile.
  /// Conflict if the place is none of this route's.
  base::Result<void> restore(std::shared_ptr<const Route> route, const base::MissionPlace& place,
                             std::string reason);
  /// Goes on with another item. @param item from 1; 0: the next one.
  base::Result<void> skip(int item);
  /// Another route in the place of the loaded one, also while it runs: its items are the same, and
  /// more come after them. The drive goes on without a stop. Not Running, Paused or Blocked: load.
  void extend(std::shared_ptr<const Route> route);
  /// Likewise, but one item is gone. If it was the one in hand, the next one is.
  void drop(std::shared_ptr<const Route> route, int item);
  void interrupt() noexcept;
  /// The same where nobody else drives: it stands, and what it sees of a row holds.
  void wait() noexcept;
  /// After interrupt() or wait(). Pauses when the place is too far away.
  void go_on(EnuPoint here);

  /// As far as reach_m, or to the next place that must be come to. Places of a smooth way need not,
  /// nor do items that may be left out (BehaveParams::unreachable). Empty: it does not run, stands,
  /// turns, drives backwards or by the odometry alone.
  std::optional<WayAhead> ahead(EnuPoint here, double reach_m) const;
  /// The robot drove around what stood on the way and goes on with it at to_m; what lies between
  /// the two arc lengths was left out, and is told so.
  void bypass(double from_m, double to_m, EnuPoint here);
  /// The item in hand lies in what stands there: as any that cannot be reached.
  void give_up_item(std::string why) { block(std::move(why)); }

  /// One control step while Running. @param home for return_home where the mission has none.
  TrackOutput step(const Vehicle& vehicle, double limit_mps, std::optional<EnuPoint> home,
                   double dt_s);

  /// A row is to be driven by sight: what should be looked for. Empty: none.
  std::optional<RowWanted> row_wanted() const noexcept;
  /// The step in hand needs neither a place nor a heading of the map: a row, a wall, landmarks, or
  /// what leads from one row to the next by moves of kAcross_m together and turns, with waits and
  /// actions between. Such moves and turns are driven by the odometry alone where something tells
  /// it (see_row): no correction of the position bends them.
  bool asks_no_place() const noexcept;
  static constexpr double kAcross_m = 30.0;
  /// Null: no tag is docked at now.
  const tags::TagDock* docks() const noexcept {
    return running() && doing_ == Doing::Dock ? &dock_ : nullptr;
  }
  /// Null: no row is driven now.
  const RowDrive* row() const noexcept {
    return running() && doing_ == Doing::Row ? &row_ : nullptr;
  }
  const RowToDrive* row_order() const noexcept;
  /// Nothing moves in the next step: it waits, or stays where it is, for longer than that.
  bool stands(const Vehicle& vehicle, double dt_s) const noexcept;

  /// Before go_on(), resume() and step(): what is seen of it. Empty: nothing on this robot looks
  /// around.
  void see_row(const std::optional<RowSight>& sight) noexcept { row_sight_ = sight; }

  /// Before step(): what is seen of walls and landmarks. Empty: nothing on this robot looks around.
  void see_marks(const std::optional<MarkSight>& sight) noexcept { mark_sight_ = sight; }

  base::ExecutionState state() const noexcept { return state_; }
  /// Another one: what was found out about the way ahead is of no use any more.
  std::uint64_t way_id() const noexcept { return way_id_; }
  const std::string& reason() const noexcept { return reason_; }
  /// Null: nothing runs, or it is at its end.
  const RouteStep* step_in_hand() const noexcept { return running() ? step_now() : nullptr; }
  bool running() const noexcept { return state_ == base::ExecutionState::Running; }
  bool interrupted() const noexcept { return interrupted_; }
  /// Of the mission that runs; empty: it asks for none, or nothing runs.
  std::optional<double> corridor_m() const noexcept {
    return running() ? route_->corridor_m : std::nullopt;
  }
  /// What item, bend and vehicle allow where it is on its way; empty: it drives along none.
  std::optional<double> set_mps() const noexcept {
    const bool on_way = doing_ == Doing::Path || on_own_way();
    return running() && on_way ? tracker_.set_mps() : std::nullopt;
  }
  TrackPhase phase() const noexcept {
    return doing_ == Doing::Row         ? row_.phase()
           : doing_ == Doing::Wall      ? wall_.phase()
           : doing_ == Doing::Landmarks ? landmarks_.phase()
           : doing_ == Doing::Dock      ? dock_.phase()
                                        : tracker_.phase();
  }
  /// @param here empty: the position is not known, and neither is a way that begins there.
  /// @param sigma_m of that position.
  Progress progress(std::optional<EnuPoint> here, double sigma_m = 0.0) const;
  /// What happened since the last call.
  std::vector<Notice>& notices() noexcept { return notices_; }

 private:
  enum class Doing { Nothing, Path, Connector, Arc, Wait, Turn, Stay, Row, Wall, Landmarks, Dock };
  /// Way and time, jumps not counted.
  struct Left {
    double m = 0.0;
    double s = 0.0;
  };

  std::optional<EnuPoint> place_to_go_on() const noexcept;
  void enter(const Vehicle& vehicle, std::optional<EnuPoint> home);
  bool enter_step(const RouteStep& step, const Vehicle& vehicle, std::optional<EnuPoint> home);
  bool enter_go(const RouteStep& step, const Vehicle& vehicle);
  bool begin_here(const RouteStep& step, const Vehicle& vehicle);
  void join(const Joining& where, const Vehicle& vehicle);
  bool has_joined(const Vehicle& vehicle) const noexcept;
  double beside_m(const Vehicle& vehicle) const noexcept;
  bool passed_by(const RouteStep* step, double off_m);
  double cross_track_limit_m(double sigma_m) const noexcept;
  bool connect(EnuPoint to, const RouteNode* node, const Vehicle& vehicle);
  /// @param least_m shorter ways are none; empty: as this vehicle is sent round for a place
  bool lay_connector(Vertex end, const Vehicle& vehicle, std::optional<double> least_m = {});
  bool enter_move(const RouteStep& step, const Vehicle& vehicle);
  bool enter_turn(const RouteStep& step, const Vehicle& vehicle);
  bool enter_arc(const RouteStep& step, const Vehicle& vehicle);
  double arc_left_rad(std::optional<double> yaw_rad = std::nullopt) const noexcept;
  /// On a way that was laid from where it stood: connector_.
  bool on_own_way() const noexcept { return doing_ == Doing::Connector || doing_ == Doing::Arc; }
  TrackOutput step_turn(const Vehicle& vehicle, double dt_s);
  std::optional<rows::Pose2> until_in_odometry(EnuPoint place, const Vehicle& vehicle,
                                               const rows::Pose2& body) const noexcept;
  bool enter_row(const RouteStep& step);
  TrackOutput step_row(const Vehicle& vehicle, double limit_mps, double dt_s);
  bool enter_wall(const RouteStep& step);
  TrackOutput step_wall(const Vehicle& vehicle, double limit_mps, double dt_s);
  bool enter_landmarks(const RouteStep& step);
  TrackOutput step_landmarks(const Vehicle& vehicle, double limit_mps, double dt_s);
  bool enter_dock(const RouteStep& step);
  TrackOutput step_dock(const Vehicle& vehicle, double limit_mps, double dt_s);
  void carry(const Vehicle& vehicle) noexcept;
  bool by_odometry() const noexcept;
  std::optional<Vehicle> carried(const Vehicle& vehicle) const noexcept;
  bool pushed_away(const RouteStep& step, const Vehicle& vehicle) const noexcept;
  bool enter_stay(const RouteStep& step, const Vehicle& vehicle);
  void step_stay(const Vehicle& vehicle);
  bool cut_goal(const Vehicle& vehicle, double dt_s);
  EnuPoint cut(EnuPoint to, EnuPoint here) const noexcept;
  bool at_end(const Vehicle& vehicle, std::optional<EnuPoint> home);
  void turn_round();
  void pass_nodes(const Vehicle& vehicle);
  void leg_done(const Vehicle& vehicle);
  bool leads_on(const RouteStep* step);
  bool missed(const Vehicle& vehicle);
  bool back_up(const Vehicle& vehicle, double off_m);
  void block(std::string why);
  bool must_come_to(const RouteStep& step) const noexcept;
  void reached(const RouteStep& step);
  void pass(const RouteStep& step);
  void finish();
  void watch(const Vehicle& vehicle, double dt_s);
  void watch_stuck(const Vehicle& vehicle, double dt_s);
  void begin_at(std::size_t step);
  bool in_hand() const noexcept;
  void move_to(const Course& fresh, std::size_t more_steps, std::size_t more_nodes);
  const RouteStep* step_now() const noexcept;
  void catch_up(EnuPoint here);
  double may_have_come_to_m() const noexcept;
  std::optional<Left> left(const RouteStep& step, std::optional<EnuPoint> here) const noexcept;
  void tell_item_end(Progress& p, std::optional<EnuPoint> here) const noexcept;
  Left laps_left() const noexcept;
  std::optional<base::Lead> lead() const noexcept;

  base::Setting<PathParams> path_params_;
  base::Setting<BehaveParams> params_;
  base::Setting<ModeParams> modes_;
  Tracker tracker_;
  std::shared_ptr<const Route> route_;
  const Course* course_ = nullptr;
  Path connector_;
  Vertex connector_end_;
  double arc_rad_ = 0.0;               ///< left positive; while it waits what is left of it
  std::optional<double> arc_yaw_rad_;  ///< as it pointed when it was driven last
  RotateInPlace rotation_;
  RowDrive row_;
  std::optional<RowSight> row_sight_;
  AlongWall wall_;
  LandmarkDrive landmarks_;
  tags::TagDock dock_;
  std::optional<MarkSight> mark_sight_;
  std::uint64_t rows_begun_ = 0;
  std::optional<rows::Pose2> carry_;  ///< X_EO: a move or turn is driven by odometry from here
  bool row_left_ = false;             ///< somebody else drove: the row is looked for anew
  std::vector<int> jumps_left_;       ///< per jump; −1: not counted yet
  std::vector<Notice> notices_;

  base::ExecutionState state_ = base::ExecutionState::Idle;
  std::string reason_;
  Doing doing_ = Doing::Nothing;
  std::size_t at_ = 0;                   ///< index of the step in hand
  std::optional<std::size_t> standing_;  ///< node at which the robot is
  std::optional<EnuPoint> stays_;        ///< Stay: here, also while it drives back
  std::optional<EnuPoint> rejoin_;       ///< the connector leads back to the path here
  std::size_t leg_ = 0;                  ///< kept place on the path
  double s_m_ = 0.0;
  double wait_s_ = 0.0;
  double left_ = 0.0;      ///< of a move or turn that was interrupted; 0: all of it
  double looked_s_ = 0.0;  ///< since a cut goal was looked at
  std::size_t skipped_ = 0;
  int laps_ = 0;                  ///< driven
  bool joins_ = false;            ///< started: the way may be joined ahead of item 1
  double going_round_m_ = 0.0;    ///< farther from the way than lost_m, until it has joined it
  bool rolled_on_ = false;        ///< restored: it was under way when its place was kept
  std::optional<EnuPoint> home_;  ///< of the last step
  std::string fled_;              ///< why it returns before its end
  std::uint64_t way_id_ = 0;
  bool interrupted_ = false;
  bool returning_ = false;  ///< the way home after the last step
  bool drove_ = false;      ///< in this lap
  bool backed_up_ = false;  ///< to the stop in hand, once
  double lost_s_ = 0.0;
  double stuck_s_ = 0.0;
  Vehicle stuck_at_;
};

}  // namespace roverd::nav
