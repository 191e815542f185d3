#pragma once
// How far it went between two times, by its positions and by its velocity alone. Pure.

#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"
#include "nav/vote/compare.hpp"

namespace roverd::nav {

struct Stretch {
  base::EnuPoint m;
  double sigma_m = 0.0;
};

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
/// With n positions of σ_p, Sxx = Σ(t−t̄)²: σ² of the line's rise over w seconds is
/// w²·σ_p²/Sxx, and of the velocity's noise of σ_v every dt, added up: 6/5·σ_v²·dt·w.
class RunApart {
 public:
  explicit RunApart(const Facts& facts, std::optional<Time> from) noexcept;

  /// Over at least so many seconds, more than it was asked for before. None: not all of it was
  /// told, or it was another run.
  std::optional<Stretch> over(double window_s) noexcept;
  /// Of the last one that was asked for.
  double window_s() const noexcept { return -oldest_s_; }

 private:
  const Facts& f_;
  std::optional<Time> from_;
  std::size_t next_ = 0;  ///< spot
  std::size_t pace_ = 0;  ///< not later than it
  double oldest_s_ = 0.0;
  double n_ = 0.0, t_ = 0.0, tt_ = 0.0;
  base::EnuPoint e_, te_, first_;
  double sigma_m_ = 0.0;
};

/// The moment of the position at or before `t`, not much before.
std::optional<Time> spot_before(const Facts& f, Time t) noexcept;

}  // namespace roverd::nav
