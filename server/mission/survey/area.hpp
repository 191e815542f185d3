#pragma once
// Areas in metres as sets of rings, and what a plan for a field needs of them: smaller, larger,
// without another. The work is Clipper's, on a grid of 0.1 mm, so that it is exact and never fails
// for want of digits. Pure.

#include <vector>

#include "base/geo.hpp"

namespace roverd::mission::survey {

using base::EnuPoint;

/// Not closed: the last point is not the first one again. Outer rings run counter-clockwise, rings
/// of holes clockwise.
using Ring = std::vector<EnuPoint>;
/// Any number of parts with their holes, flat; rings do not cross.
using Area = std::vector<Ring>;

/// One connected piece.
struct Part {
  Ring outer;
  std::vector<Ring> holes;

  Area area() const;
};

/// All that is within `by_m` of the area; `by_m` below 0: all that is at least so far inside.
/// @param sagitta_m how far the chords of round corners may leave their arcs, > 0
Area offset(const Area& area, double by_m, double sagitta_m);

/// What of `area` is not in `other`.
Area without(const Area& area, const Area& other);

/// Largest first.
std::vector<Part> parts_of(const Area& area);

double square_m2(const Ring& ring) noexcept;  ///< of a hole: negative
double square_m2(const Area& area) noexcept;

/// Fewer points, none of the old ones farther than the tolerance from the new line.
Ring simplified(const Ring& ring, double tolerance_m);

struct Box {
  EnuPoint low;
  EnuPoint high;
};
/// @param area not empty
Box box_of(const Area& area) noexcept;

}  // namespace roverd::mission::survey
