#pragma once
// How a circle of a mission lies on the ground.
//
//      A ───────────── E ╮        from outside: along the tangent, so that it is entered without
//                    ╱    ╲       a stop
//                   │  C   │      from inside, or from nowhere known: at the nearest place, or in
//                    ╲    ╱       the north; there it stops and turns
//                      ╰─╯
//
// Metres in one plane; angles rad about the centre, counter-clockwise from east. Pure.

#include <cstddef>
#include <optional>

#include "base/geo.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

using base::EnuPoint;

struct CircleWay {
  EnuPoint centre;
  double radius_m = 0.0;
  double from_rad = 0.0;   ///< where it is entered
  double sweep_rad = 0.0;  ///< the whole way round; left positive, whole turns counted
  bool tangent = false;    ///< the way to it goes on along it

  EnuPoint at(double along_rad) const noexcept;  ///< after so much of the sweep
  EnuPoint entry() const noexcept { return at(0.0); }
  EnuPoint end() const noexcept { return at(sweep_rad); }
  double length_m() const noexcept;
};

/// @param before where the way to it begins; empty: not known
CircleWay circle_way(const Circle& circle, EnuPoint centre,
                     std::optional<EnuPoint> before) noexcept;

/// How many stations there are on its way: the first is a station's way from the entry, and of a
/// whole number of turns the last is its end.
std::size_t stations_of(const Circle& circle) noexcept;

}  // namespace roverd::mission
