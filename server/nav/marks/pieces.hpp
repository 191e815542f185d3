#pragma once
// Walls as pieces that a way is laid along: doors closed, corners where two of them meet. Frame O.
// Pure.

#include <span>
#include <vector>

#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

/// A piece of wall, doors closed.
struct Piece {
  Vec2 a{};
  Vec2 b{};
  Vec2 normal{};
  base::Time seen_at;
  bool a_open = false;  ///< the edge of what was looked at: no end of the wall
  bool b_open = false;
  bool a_ends = false;  ///< something told that the wall ends there
  bool b_ends = false;
  base::Time scanned_at{};  ///< a scan told its wall last
  base::Time imaged_at{};   ///< a vision program did
};

/// Of those that are believed.
std::vector<Piece> pieces_of(std::span<const Wall> walls, double door_m);

/// Two walls that nearly meet have one corner: where their lines cross.
void close_corners(std::vector<Piece>& pieces);

}  // namespace roverd::nav::marks
