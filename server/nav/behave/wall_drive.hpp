#pragma once
// Along a wall by what is seen of it (nav/marks), in the frame O of the odometry: it needs no
// satellites and does not notice when the position jumps.
//
//   Idle ──begin──▶ Seeking ──a wall is seen──▶ Driving ──stands at its end, or as far as it was
//                     │  ▲                       │   │                          asked──▶ Done
//                     │  └──── interrupt() ──────┘   └─ stands without one for wait_s ─▶ Failed
//                     └─ none within entry_m ─▶ Failed
//
// The way is laid anew with every look, and ends where what is known ends. A view older than old_s,
// and a side on which no wall is seen for so long, brake the robot along the way in hand. Seeking
// it creeps straight on from where it began. Control thread; allocates when it lays a way.

#include <optional>
#include <string>

#include "base/setting.hpp"
#include "nav/behave/mark_sight.hpp"
#include "nav/marks/sight_drive.hpp"

namespace roverd::nav {

class WallDrive {
 public:
  enum class State { Idle, Seeking, Driving, Done, Failed };

  WallDrive(base::Setting<PathParams> path, MarkSettings params);

  struct Order {
    marks::Side side = marks::Side::Left;
    std::optional<double> distance_m{};  ///< empty: the parameter, as it is at each look
    std::optional<double> speed_mps{};
    std::optional<double> length_m{};  ///< done after so much way; empty: at its end
    std::optional<marks::By> by{};     ///< by whose word; empty: the parameter, at each look
    double driven_m = 0.0;             ///< of an item that was interrupted: so much is done already
  };
  void begin(const Order& order) noexcept;
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept;
  /// It ends at the latest beside this place of O, as it is known by now.
  void end_beside(EnuPoint place) noexcept { until_ = place; }

  /// @param vehicle as everywhere; its place and direction are taken from the sight.
  TrackOutput step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  double driven_m() const noexcept { return driven_m_; }
  /// Somebody else drives it along the wall for a while, which counts.
  void carried(const marks::Pose2& body) noexcept;
  /// It is done: somebody else has driven it to its end.
  void finish() noexcept;
  marks::By by() const noexcept;
  /// Who tells the wall beside it, right now. Nobody: it is looked for, or remembered.
  ToldBy told_by(base::Time now) const noexcept;
  /// Positive: the vehicle is left of the way.
  double cross_track_m() const noexcept { return drive_.cross_track_m(); }
  TrackPhase phase() const noexcept;

 private:
  void count(const marks::Pose2& body, bool counts) noexcept;
  double distance_m() const noexcept;
  bool look(const MarkSight& sight);
  void seek(const marks::Pose2& body);
  void judge(double dt_s);
  void fail(std::string why);
  std::string wall_text() const;
  std::string ended_text() const;  ///< why it goes on no further

  base::Setting<PathParams> path_params_;
  MarkSettings params_;
  marks::SightDrive drive_;
  State state_ = State::Idle;
  std::string reason_;
  Order order_;
  std::optional<EnuPoint> until_;     ///< in O
  std::optional<marks::Pose2> last_;  ///< X_OB of the last step
  std::optional<base::Time> laid_;    ///< by the view of this time
  base::Time scanned_at_{};           ///< a scan told the wall beside it last
  base::Time imaged_at_{};            ///< a vision program did
  double driven_m_ = 0.0;
  double unseen_s_ = 0.0;   ///< no wall on that side, or nobody looks
  double stood_s_ = 0.0;    ///< at the end of what is laid
  bool to_length_ = false;  ///< the way that is laid ends where the item does
};

}  // namespace roverd::nav
