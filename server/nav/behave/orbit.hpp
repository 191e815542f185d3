#pragma once
// CIRCLE: around a place, some turns or without end.
//
//   Idle ──begin──▶ Driving ──its turns are driven──▶ Done (HOLD follows)
//                      └──stuck, lost──▶ Failed (HOLD follows)
//
//   Exit: any other mode; a condition that holds; the fence.
// A few turns are laid at a time (mission/circle.hpp); driven round once, the same way serves
// again. Control thread; allocates when it begins, and when it goes on after somebody else drove.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "base/setting.hpp"
#include "mission/circle.hpp"
#include "nav/behave/trip.hpp"

namespace roverd::nav {

struct OrbitGoal {
  EnuPoint centre;
  double radius_m = 5.0;
  bool clockwise = false;
  std::optional<double> turns;      ///< empty: without end
  std::optional<double> speed_mps;  ///< empty: the default
};

class Orbit {
 public:
  enum class State { Idle, Driving, Done, Failed };

  Orbit(base::Setting<PathParams> path, base::Setting<BehaveParams> behave)
      : path_(path), trip_(std::move(path), std::move(behave)) {}

  /// Why this vehicle cannot do it; empty: it can. Pure.
  std::string refusal(const OrbitGoal& goal) const;
  /// How it would lie. @param here where the way to it begins. Pure.
  static mission::CircleWay way_of(const OrbitGoal& goal, EnuPoint here);
  /// Where a steered vehicle, which cannot turn on the spot, comes straight onto it from. Empty: it
  /// need not. Pure.
  static std::optional<EnuPoint> lead_of(const mission::CircleWay& way, const VehicleParams& v);
  void begin(const OrbitGoal& goal, const Vehicle& vehicle);
  void reset() noexcept {
    trip_.reset();
    state_ = State::Idle;
  }
  void interrupt() noexcept;
  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const OrbitGoal& goal() const noexcept { return goal_; }
  const std::string& reason() const noexcept { return trip_.reason(); }
  /// Of the whole way; empty: it has no end.
  std::optional<double> distance_left_m() const noexcept;

 private:
  base::Setting<PathParams> path_;
  Trip trip_;
  OrbitGoal goal_;
  std::optional<std::size_t> more_turns_;  ///< than are laid; empty: without end
  std::size_t first_ = 0;                  ///< of the way's points: on the circle
  State state_ = State::Idle;
};

}  // namespace roverd::nav
