#pragma once
// Nothing is touched: how much of a commanded twist may be driven, from what the grid knows.
//
//         gap_m                 The footprint, grown by side_m beside and gap_m along, is swept
//   ▭ ─ ─ ─ ─ ─ ─ ▭│▪           along the commanded curve. With t the time of the twist until it
//     stopping way              would touch, the part λ of the twist that still stops before is
//
//       λ·delay + λ²·b = t,     b = max(|v| / 2a, |ω| / 2α)      (1)
//
// since a part of a twist drives the same curve, only slower: v and ω shrink together. So the
// allowed speed falls with the root of the way that is left and is 0 at the margin. What is nearer
// than the margin already does not hold the robot that drives away from it, only one that comes
// nearer still.
//
// What no sensor has seen is driven at a creep speed of its own, or not at all; turning on the spot
// and reversing by default only where it was seen.
//
// Pure; reads a Patch, allocates nothing: for the control tick. The patch says how the world was at
// its stamp; what moved since is not known, its age is in the verdict.

#include <cstdint>
#include <string_view>

#include "base/geo.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/marks.hpp"
#include "nav/sense/params.hpp"

namespace roverd::nav::sense {

enum class Limit : std::uint8_t {
  None,      ///< drive on as commanded
  Obstacle,  ///< something stands there
  Drop,      ///< the ground ends there
  Unseen,    ///< no sensor has seen it
};
std::string_view to_string(Limit limit) noexcept;  // none obstacle drop unseen

struct Verdict {
  double part = 1.0;  ///< of the commanded twist that may be driven, 0..1
  Limit limit = Limit::None;
  bool found = false;        ///< something lies on the way at all, also where it does not limit yet
  double touch_s = 0.0;      ///< time of the commanded twist until its margin is touched
  double distance_m = 0.0;   ///< way of the body's origin until then (turns on the spot: 0)
  double turn_rad = 0.0;     ///< and its turn
  Vec2 at{};                 ///< what limits, in B now
  double bearing_rad = 0.0;  ///< of it, from the origin, left positive
  std::uint8_t sensor = 0;
  double age_s = 0.0;  ///< since it was seen, at the patch's stamp
};

/// What is within reach of this stretch (in B, now) and behind it is where the robot wants to be,
/// and in nobody's way: a dock. What stands before it stops, and where the ground ends is never
/// spared.
struct Spared {
  Vec2 from{};
  Vec2 to{};
  double within_m = 0.0;
  Vec2 ahead{1.0, 0.0};   ///< across the stretch, the way in which it is come to; of length 1
  double most_mps = 0.1;  ///< while something that is spared lies on the way, no faster than this
};

/// @param spared null: nothing is.
/// @param twist commanded, finite. @param pose X_OB now. @param body its footprint.
/// @param marks of the patch; null, or of another: the same word, more slowly
/// O(cells within reach): about 30 us for 3 m; with marks O(taken cells within reach), 2 us.
Verdict protect(const Patch& patch, const Pose2& pose, const Footprint& body,
                const base::BodyTwist& twist, const ProtectParams& params,
                const Spared* spared = nullptr, const Marks* marks = nullptr) noexcept;

/// λ of (1), 0..1. @param touch_s 0 or more.
double part_for(double touch_s, const base::BodyTwist& twist, const ProtectParams& params) noexcept;

}  // namespace roverd::nav::sense
