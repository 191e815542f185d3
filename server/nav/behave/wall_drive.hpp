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

#include "base/params.hpp"
#include "base/setting.hpp"
#include "nav/marks/sight_drive.hpp"
#include "nav/marks/view.hpp"

namespace roverd::nav {

/// Section [nav.sight]: along walls.
struct SightParams {
  double speed_mps = 0.6;
  double creep_mps = 0.2;
  double entry_m = 2.0;
  double old_s = 0.6;
  double wait_s = 5.0;
};

template <class V>
void fields(V& v, SightParams& p) {
  v("speed_mps", p.speed_mps, 0.05, 3.0, "along a wall whose item says no speed");
  v("creep_mps", p.creep_mps, 0.05, 1.0, "towards a wall that is not seen yet");
  v("entry_m", p.entry_m, 0.0, 20.0, "so far it creeps straight on until it sees the wall");
  v("old_s", p.old_s, 0.2, 3.0,
    base::lower_is_stricter("an older view stops it; so does a side without a wall for so long"));
  v("wait_s", p.wait_s, 0.0, 600.0, "standing without a wall for so long, the item has failed");
}

struct MarkSettings {
  base::Setting<SightParams> sight{};
  base::Setting<marks::WallParams> walls{};
};

/// What is known of walls at one tick.
struct MarkSight {
  const marks::View* view = nullptr;  ///< null: nothing was looked at yet
  base::Time now;
  marks::Pose2 body;  ///< X_OB now
};

class WallDrive {
 public:
  enum class State { Idle, Seeking, Driving, Done, Failed };

  WallDrive(base::Setting<PathParams> path, MarkSettings params);

  struct Order {
    marks::Side side = marks::Side::Left;
    double distance_m = 0.9;
    std::optional<double> speed_mps{};
    std::optional<double> length_m{};  ///< done after so much way; empty: at its end
    double driven_m = 0.0;             ///< of an item that was interrupted: so much is done already
  };
  void begin(const Order& order) noexcept;
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept;

  /// @param vehicle as everywhere; its place and direction are taken from the sight.
  TrackOutput step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  double driven_m() const noexcept { return driven_m_; }
  /// Positive: the vehicle is left of the way.
  double cross_track_m() const noexcept { return drive_.cross_track_m(); }
  TrackPhase phase() const noexcept;

 private:
  void count(const marks::Pose2& body) noexcept;
  bool look(const MarkSight& sight);
  void seek(const marks::Pose2& body);
  void judge(double dt_s);
  void fail(std::string why);
  std::string wall_text() const;

  base::Setting<PathParams> path_params_;
  MarkSettings params_;
  marks::SightDrive drive_;
  State state_ = State::Idle;
  std::string reason_;
  Order order_;
  std::optional<marks::Pose2> last_;  ///< X_OB of the last step
  std::optional<base::Time> laid_;    ///< by the view of this time
  double driven_m_ = 0.0;
  double unseen_s_ = 0.0;   ///< no wall on that side, or nobody looks
  double stood_s_ = 0.0;    ///< at the end of what is laid
  bool to_length_ = false;  ///< the way that is laid ends where the item does
};

}  // namespace roverd::nav
