#pragma once
// A way through a few points, then perhaps a turn: what GUIDED, RTL, SMART_RTL, DOCK and single
// moves have in common.
//
//   Idle ──a way──▶ Way ──stands at its end──▶ Face ──turned──▶ There
//     └─only a turn─────────────────────────▶ Face
//   Way ──stopped beside the end, no progress──▶ Failed ◀──time over── Face
//
// Another order may come at any time. If the new way goes on ahead, it is joined without a stop:
//
//      old goal                     the new way begins where the robot is, leads a little ahead,
//   ──▶ · · · ○                     and bends to the new goal; what lies farther to the side than
//        ╲                          the pivot angle is turned to on the spot instead
//         ╰──▶ new goal
//
// The lead ends before the first new point. What is told to begin with a turn is not joined.
//
// Control thread; allocates when an order comes, and when the robot goes on after somebody else
// drove it.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/setting.hpp"
#include "nav/behave/params.hpp"
#include "nav/behave/rotate_in_place.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

class Trip {
 public:
  enum class State { Idle, Way, Face, There, Failed };

  struct Order {
    std::vector<Vertex> way;               ///< points to drive to; empty: none
    std::optional<double> face_yaw_rad{};  ///< then turn to this
    std::optional<double> turn_rad{};      ///< or by this, left positive
    double turn_radps = 0.5;               ///< at most
    double within_m = 0.5;                 ///< an end missed by more is failed
    bool turns_first = false;              ///< on the spot to the way's begin, from 5 degrees on
  };

  Trip(base::Setting<PathParams> path, base::Setting<BehaveParams> behave)
      : path_params_(std::move(path)), behave_(std::move(behave)), tracker_(path_params_) {}

  void begin(Order order, const Vehicle& vehicle, bool smoothly);
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept { interrupted_ = state_ == State::Way || state_ == State::Face; }

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s);
  /// The way goes round, and repeats after so many points: back by them, as soon as that leads to
  /// one of `first` or later. @return whether it did
  bool again(std::size_t first, std::size_t points) noexcept;

  State state() const noexcept { return state_; }
  bool busy() const noexcept { return state_ == State::Way || state_ == State::Face; }
  /// On its way, it turns on the spot to where that leads on.
  bool turns_onto() const noexcept {
    const TrackPhase phase = tracker_.phase();
    return state_ == State::Way && (phase == TrackPhase::Pivot || phase == TrackPhase::Turn);
  }
  const std::string& reason() const noexcept { return reason_; }  ///< why Failed
  std::optional<double> distance_left_m() const noexcept;
  std::optional<double> turn_left_rad() const noexcept;
  double cross_track_m() const noexcept { return tracker_.cross_track_m(); }
  /// The way from where it began; empty before the first.
  const Path& path() const noexcept { return paths_[slot_]; }
  double s_m() const noexcept { return tracker_.s_m(); }

 private:
  void lay(const Vehicle& vehicle, bool smoothly);
  std::optional<double> lead_m(const Vehicle& v, const Vertex& first) const noexcept;
  mission::Turn turn_first() const noexcept;
  void face();
  void fail(std::string why);
  void watch(const Vehicle& vehicle, double dt_s);

  base::Setting<PathParams> path_params_;
  base::Setting<BehaveParams> behave_;
  Tracker tracker_;
  RotateInPlace rotation_;
  Order order_;
  std::array<Path, 2> paths_;  ///< the one that is driven, and the one before it
  std::size_t slot_ = 0;
  std::size_t lead_ = 1;   ///< vertices of the path before the order's first one
  std::size_t first_ = 0;  ///< of the order's points: the first one on the path
  std::size_t next_ = 0;   ///< of the order's points: not yet passed
  State state_ = State::Idle;
  std::string reason_;
  bool interrupted_ = false;
  double stuck_s_ = 0.0;
  Vehicle stuck_at_;
};

}  // namespace roverd::nav
