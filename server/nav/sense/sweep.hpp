#pragma once
// When does the body, driving on as commanded, first touch a point? Exact, for straight lines, arcs
// and turns on the spot, ahead and in reverse.
//
// The body drives with a constant twist (v, ω) in B. Seen from the body, a point of the world moves
// on a straight line (ω = 0) or on a circle about the centre of rotation C = (0, v/ω), with −ω. It
// touches the body that is grown by r when that path enters the polygon's edges moved outwards by
// r, or the discs of radius r about its corners.

#include <optional>

#include "base/geo.hpp"
#include "nav/sense/footprint.hpp"

namespace roverd::nav::sense {

/// Seconds of the twist until the point p (in B, now) comes to r_m from the body: the first such
/// time in [0, horizon_s]; 0 if it is there already. Empty: never within the horizon.
/// @param twist finite. @param r_m 0 or more.
std::optional<double> touch_s(const Footprint& body, Vec2 p, double r_m,
                              const base::BodyTwist& twist, double horizon_s) noexcept;

/// The point seen from the body after t_s of the twist.
Vec2 seen_after(Vec2 p, const base::BodyTwist& twist, double t_s) noexcept;

}  // namespace roverd::nav::sense
