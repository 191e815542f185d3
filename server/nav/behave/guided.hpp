#pragma once
// GUIDED: goes where it is told, one goal after the other.
//
//   Enter: armed, position known, nothing that would hold a mission; a goal.
//
//   Waiting ──goal──▶ Driving ──there──▶ Reached ──goal──▶ Driving
//      ▲               │ ▲  └──missed, stuck──▶ Failed ──goal──▶ Driving
//      │               └─┘ another goal replaces it, without a stop where its way goes on ahead
//      │  heading and speed
//      ├──────────────────▶ Steered ──newer ones──▶ Steered
//      └──3 s without a newer one (brakes, stands)──┘
//
//   Exit: any other mode; a condition that holds; the fence. It stands wherever it ends.
//
// A goal is a point, a pose (turned to on the spot; a steered vehicle drives through it on a
// straight), a move by metres along the present heading, or a turn by an angle. Where the
// parameters ask for it, a goal farther than goal_cut_m is cut to that distance and looked at anew
// every goal_cut_s, as sensor maps of that size need it.
// Control thread.

#include <optional>
#include <string>
#include <utility>

#include "base/setting.hpp"
#include "nav/behave/mode_params.hpp"
#include "nav/behave/trip.hpp"

namespace roverd::nav {

/// Exactly one of: a point (with or without a yaw), a move, a turn (by or to), heading and speed.
struct GuidedGoal {
  enum class Kind { Point, Move, Turn, Steer } kind = Kind::Point;
  EnuPoint at;                      ///< Point
  std::optional<double> yaw_rad;    ///< Point: at its end. Turn: to. Steer: the way to go
  std::optional<double> turn_rad;   ///< Turn: by, left positive
  double forward_m = 0.0;           ///< Move; negative: backwards
  std::optional<double> speed_mps;  ///< empty: the default; Steer: negative is backwards
  bool reverse = false;             ///< Point: driven backwards
};

class Guided {
 public:
  enum class State { Waiting, Driving, Steered, Reached, Failed };

  Guided(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
         base::Setting<ModeParams> modes)
      : path_(std::move(path)), modes_(std::move(modes)), trip_(path_, std::move(behave)) {}

  /// Why this vehicle cannot do it; empty: it can. Pure.
  std::string refusal(const GuidedGoal& goal) const;
  /// @param goal that `refusal` has nothing against
  void go(const GuidedGoal& goal, const Vehicle& vehicle);
  void reset() noexcept;
  /// Somebody else drives: a goal waits, a heading and speed are over.
  void interrupt() noexcept;

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  std::string reason() const;
  const GuidedGoal& goal() const noexcept { return goal_; }
  /// Where it goes: of a move the place at its end; empty: none.
  std::optional<EnuPoint> place() const noexcept { return place_; }
  std::optional<double> distance_left_m(EnuPoint here) const noexcept;
  const Trip& trip() const noexcept { return trip_; }

 private:
  void lay(const Vehicle& vehicle, bool smoothly);
  bool cut(const Vehicle& vehicle, double dt_s);
  TrackOutput steer(const Vehicle& vehicle, double limit_mps, double dt_s) noexcept;

  base::Setting<PathParams> path_;
  base::Setting<ModeParams> modes_;
  Trip trip_;
  GuidedGoal goal_;
  std::optional<EnuPoint> place_;
  State state_ = State::Waiting;
  bool timed_out_ = false;
  double age_s_ = 0.0;      ///< of a heading and speed
  double looked_s_ = 0.0;   ///< since a cut goal was looked at
  double speed_mps_ = 0.0;  ///< Steered: last told, over ground
  double rate_radps_ = 0.0;
};

}  // namespace roverd::nav
