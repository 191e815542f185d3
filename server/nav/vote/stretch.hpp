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

/// The moment of the position at or before `t`, not much before.
std::optional<Time> spot_before(const Facts& f, Time t) noexcept;

}  // namespace roverd::nav
