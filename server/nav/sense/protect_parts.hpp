#pragma once
// What the two halves of protect() share: the taken, cell by cell, and the unseen, by looks along
// the outline. For protect.cpp, unseen.cpp and skid.cpp alone.

#include <optional>

#include "nav/sense/protect.hpp"

namespace roverd::nav::sense {

/// The commanded motion, once per verdict.
struct Drive {
  base::BodyTwist twist;
  double horizon_s = 0.0;
  bool turning = false;  ///< on the spot
  Vec2 centre{};         ///< of the turn, in B; of no use when straight
  bool straight = false;
  double margin_m = 0.0;  ///< side_m and the size of a cell
  double grown_m = 0.0;   ///< that, or what is left of it now
  double clear_m = 0.0;   ///< to the nearest thing now; the margin, if that is farther
  double least2 = 0.0;    ///< of the ring that the grown body sweeps about the centre
  double most2 = 0.0;
};

/// What it is asked about: the patch, and its marks.
struct Picture {
  const Patch& patch;
  const Marks* marks;  ///< null: there are none
};

struct Nearest {
  std::optional<double> touch_s;
  Vec2 at{};
  Patch::Cell cell;
};

inline void nearer(Nearest& best, double t, Vec2 at, const Patch::Cell& cell) noexcept {
  if (best.touch_s && t >= *best.touch_s) return;
  best = {t, at, cell};
}

/// Or nearly so: its corners go about it more than five times as fast as it goes.
bool turns_on_the_spot(const base::BodyTwist& twist, const Footprint& body) noexcept;

/// It is where the robot wants to be. @param spared null: nothing is
bool is_spared(const Spared* spared, Vec2 p, Known known) noexcept;

/// The unseen, by looking along the body's outline at steps of a cell: the first place that it
/// comes to. To a cell's accuracy. @param dock the nearest that is spared
Nearest nearest_unseen(const Picture& seen, const Pose2& pose, const Footprint& body,
                       const Drive& d, const Spared* spared, Nearest& dock) noexcept;

}  // namespace roverd::nav::sense
