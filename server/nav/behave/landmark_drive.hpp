#pragma once
// Past landmarks by what is seen of them (nav/marks), in the frame O of the odometry: it needs no
// satellites and does not notice when the position jumps.
//
//   Idle ──begin──▶ Seeking ──one is seen ahead──▶ Driving ──stands on_m behind the last──▶ Done
//                     │  ▲                          │   │      (short of `count`: Failed)
//                     │  └───── interrupt() ────────┘   └─ none is seen any more, for wait_s
//                     ├─ none within entry_m ─▶ Failed          before any was passed ─▶ Failed
//                     └─ nobody looks: stands, and for wait_s ─▶ Failed
//
// Each is passed at the same distance on the same side (marks/course.hpp); which one counts, and
// the way past the next ones, is laid anew with every look. Where none of the sensors that told the
// one ahead has looked for old_s, or none is ahead where one was, the robot brakes along the way in
// hand. Control thread; allocates when it lays a way.

#include <optional>
#include <string>

#include "base/setting.hpp"
#include "nav/behave/mark_sight.hpp"
#include "nav/marks/course.hpp"
#include "nav/marks/sight_drive.hpp"

namespace roverd::nav {

class LandmarkDrive {
 public:
  enum class State { Idle, Seeking, Driving, Done, Failed };

  LandmarkDrive(base::Setting<PathParams> path, MarkSettings params);

  struct Order {
    marks::Side side = marks::Side::Left;  ///< of the vehicle, where they are
    /// From them to the vehicle's middle; empty: the parameter, as it is at each look.
    std::optional<double> offset_m{};
    std::string name{};  ///< only those that are called so; empty: all
    std::optional<double> speed_mps{};
    std::optional<int> count{};     ///< done behind so many; empty: behind the last that is seen
    std::optional<marks::By> by{};  ///< by whose word; empty: the parameter, at each look
    int passed = 0;                 ///< of an item that was interrupted: so many are done already
  };
  void begin(Order order) noexcept;
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept;

  /// @param vehicle as everywhere; its place and direction are taken from the sight.
  TrackOutput step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  /// With those of before an interruption.
  int passed() const noexcept { return order_.passed + course_.passed(); }
  double offset_m() const noexcept;
  marks::By by() const noexcept;
  /// Who tells the one that is ahead, or told the last one.
  ToldBy told_by() const noexcept;
  /// Positive: the vehicle is left of the way.
  double cross_track_m() const noexcept { return drive_.cross_track_m(); }
  TrackPhase phase() const noexcept;

 private:
  bool look(const MarkSight& sight);
  void seek(const marks::Pose2& body);
  void judge(double dt_s);
  void end_or_fail(std::string why);
  void fail(std::string why);
  bool enough() const noexcept { return order_.count && passed() >= *order_.count; }
  std::string what() const;

  base::Setting<PathParams> path_params_;
  MarkSettings params_;
  marks::SightDrive drive_;
  marks::Course course_;
  State state_ = State::Idle;
  std::string reason_;
  Order order_;
  bool begun_ = false;              ///< the course knows where it begins
  bool again_ = false;              ///< it goes on from elsewhere
  bool ahead_ = false;              ///< one is still to be passed
  std::optional<base::Time> laid_;  ///< by the view of this time
  ToldBy told_by_;
  double unseen_s_ = 0.0;  ///< there is none to drive to, or nobody looks
  double stood_s_ = 0.0;   ///< at the end of what is laid
};

}  // namespace roverd::nav
