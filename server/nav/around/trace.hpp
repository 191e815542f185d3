#pragma once
// Pieces to places a hand's breadth apart, and what is told of them.

#include <cstddef>
#include <span>
#include <vector>

#include "nav/around/field.hpp"
#include "nav/around/pieces.hpp"

namespace roverd::nav::around {

class Trace {
 public:
  /// @param path begins with `start`
  static void lay(const Pose2& start, std::span<const Piece> pieces, std::vector<Place>& path);
  /// How many of them, from the first on, keep the body over what was seen, and end with a stop
  /// from which it can be looked further. All: path.size(). @param ahead_too else only what is
  /// driven backwards counts
  static std::size_t seen(const sense::Patch& patch, const Question& q, const Field& field,
                          std::span<const Place> path, bool ahead_too = true);
  static double length_m(std::span<const Place> path) noexcept;
  /// It turns on the spot by more than a little.
  static bool turns(std::span<const Place> path) noexcept;
  /// Where it leaves the route, and on which side it passes.
  static void tell(const Lane& lane, Answer& a);
};

}  // namespace roverd::nav::around
