#pragma once
// How far it went between two times, by its positions and by its velocity alone. Pure.

#include <array>
#include <cstddef>
#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"
#include "nav/vote/compare.hpp"

namespace roverd::nav {

struct Stretch {
  base::EnuPoint m;
  double sigma_m = 0.0;
  base::EnuPoint faster_mps{};  ///< at its end than at its begin; of velocities
};

/// Most that a receiver's velocity is taken to follow the motion by.
inline constexpr double kLagMost_s = 0.15;

/// Between positions and what velocities add up to, a velocity that lags τ behind leaves
/// τ·`faster_mps`: the τ of 0 to kLagMost_s that leaves least of `off_m`.
double lag_s(base::EnuPoint off_m, base::EnuPoint faster_mps) noexcept;
/// What it leaves.
base::EnuPoint without_lag(base::EnuPoint off_m, base::EnuPoint faster_mps) noexcept;

/// From a position to a position: at other times there is none.
std::optional<Stretch> by_position(const Facts& f, Time begin, Time end) noexcept;

/// None: it was not told all the while.
std::optional<Stretch> by_velocity(const Facts& f, Time begin, Time end) noexcept;

/// Positions less the way that velocities add up to, as they run apart: the line through all of
/// both since `begin`, which neither the ground nor a slide is in. Windows that end with the newest
/// position grow back in time as it is asked for, each position counted once.
///
///   position − ∫velocity:   ·  ·· · ·  · ··──  honest: noise, and what the velocity's own adds up
///   to
///                          ·· · ·  ╱╱          it runs away: e = e₀ + t·drift
///
/// A velocity that lags τ behind leaves τ·Δv between the two at a start and round a corner: the
/// rise is the least that a τ of 0 to kLagMost_s leaves of it. A step of the positions is no line:
/// a_step() tells them apart.
///
/// With n positions of σ_p, Sxx = Σ(t−t̄)²: σ² of the line's rise over w seconds is
/// w²·σ_p²/Sxx, and of the velocity's noise of σ_v every dt, added up: 6/5·σ_v²·dt·w.
class RunApart {
 public:
  explicit RunApart(const Facts& facts) noexcept;

  /// Over at least so many seconds, more than it was asked for before. None: there are too few for
  /// a line in so short a window, or farther back it was not told, or was another run.
  std::optional<Stretch> over(double window_s) noexcept;
  /// Of the last one: a step somewhere in it explains it no worse than the line does.
  bool a_step() const noexcept;
  /// Of the last one that was asked for.
  double window_s() const noexcept { return -oldest_s_; }

 private:
  /// At one position.
  struct Apart {
    double t_s = 0.0;
    base::EnuPoint m;
    base::EnuPoint mps;
  };

  bool take_next() noexcept;
  base::EnuPoint freed(const Apart& a) const noexcept;
  base::EnuPoint slope(base::EnuPoint sum, base::EnuPoint by_t) const noexcept;

  const Facts& f_;
  std::optional<Time> from_;
  std::array<Apart, decltype(Facts::spots)::kMost> all_{};  ///< newest first
  std::size_t next_ = 0;                                    ///< spot
  std::size_t pace_ = 0;                                    ///< not later than it
  double oldest_s_ = 0.0;
  double n_ = 0.0, t_ = 0.0, tt_ = 0.0;
  base::EnuPoint e_, te_, first_;
  base::EnuPoint v_, tv_;
  double lag_s_ = 0.0;  ///< that leaves least
  bool ended_ = false;  ///< farther back there is nothing
  double sigma_m_ = 0.0;
};

/// The moment of the position at or before `t`, not much before.
std::optional<Time> spot_before(const Facts& f, Time t) noexcept;

}  // namespace roverd::nav
