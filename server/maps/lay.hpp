#pragma once
// Where a map that was driven lies on the earth, by where the satellites saw the robot meanwhile.

#include <optional>
#include <span>

#include "base/geo.hpp"
#include "maps/words.hpp"

namespace roverd::maps {

/// One moment of the drive.
struct SeenAt {
  Corner in_map;  ///< where the robot was in M
  base::LatLon at;
  double sigma_m = 0.0;  ///< of the satellites, 1 sigma
};

/// Fewer, or all of them nearer to their middle (rms): nothing is said.
inline constexpr std::size_t kLeastSeen = 8;
inline constexpr double kLeastSpread_m = 3.0;

/// Turned and moved such that the squares of what is left are least (Umeyama 1991, in the plane,
/// without scale). As sure as what is left, and never surer than the satellites are: their error is
/// one and the same for a whole drive, so their number does not help. Empty: too few, too near to
/// each other, or less sure than an anchor may be. Pure.
std::optional<Anchor> laid(std::span<const SeenAt> seen);

}  // namespace roverd::maps
