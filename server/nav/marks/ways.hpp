#pragma once
// From what is seen to a way that the tracker drives (nav/track/path.hpp), in the odometry's
// frame O.
//
// Along a wall: the curve at a distance d from everything that is believed to be wall.
//
//            ╭────────────   outer corner: an arc of radius d about the wall's end, at most 108°
//            │ ┌══════════
//   ═════════│ │      ┌──   inner corner: where the way would come nearer to the next wall,
//   ─────────╯ │══════╡      rounded as far as corner_m allows
//   ──────────────────╯     door: a gap up to door_m is driven past as if it were wall
//
// It is gone about an end only where something tells that the wall ends: what stands behind its
// line close beyond, its face, or the next wall (walls.hpp). Elsewhere the wall may give no echo,
// and is gone on along for door_m, where it may show again.
//
// Where the wall begins ahead of the vehicle, at the edge of what was looked at, it is the wall
// beside it, too: a camera that looks ahead never sees what is abeam. It is gone back along its
// line until there; not where a wall is known beside the vehicle, nor where one was seen to begin.
//
//     ─▶───────
//   · · · · ·════ ▸ seen
//
// Past landmarks: the chain of landmarks, each passed at the offset on the same side; where the
// chain turns around one of them the way is an arc about it.
//
// A way ends where what is known ends: who drives it brakes for its end, and stands there if
// nothing more was seen by then. Pure; O(pieces of wall · way).

#include <optional>
#include <span>
#include <vector>

#include "nav/marks/landmarks.hpp"
#include "nav/marks/params.hpp"
#include "nav/marks/walls.hpp"
#include "nav/track/path.hpp"

namespace roverd::nav::marks {

/// Why a way ends where it does. NotSeen: the wall beside it is remembered only; it is gone on
/// along for door_m. NoEcho: nothing told that it ends, but it does not show again within door_m.
enum class WayEnd { Horizon, WallEnds, TooNarrow, NotSeen, NoEcho, LastLandmark };

struct Way {
  std::vector<Vertex> vertices;      ///< in O; the first lies behind the vehicle
  std::vector<std::size_t> corners;  ///< which of them are rounded corners
  double here_m = 0.0;               ///< the vehicle's place along it, about
  double offset_m = 0.0;             ///< the vehicle is so far left of it
  WayEnd end = WayEnd::Horizon;
  base::Time scanned_at{};  ///< a scan told the wall beside the vehicle last
  base::Time imaged_at{};   ///< a vision program did
};

/// @param pose X_OB. @param side where the wall is. @return empty: no believed wall on that side
/// within 3 distances and a metre, nor one so far aside that is seen from max_range_m ahead on.
std::optional<Way> wall_way(std::span<const Wall> walls, const Pose2& pose, Side side,
                            double distance_m, double speed_mps, base::Time now,
                            const WallParams& params);

/// @param chain the landmarks that are ahead, in the order in which they are passed; may be empty.
/// @param behind where the way came from: two points at least, the last ones passed.
/// @param side where the landmarks are passed: Left means that they are on the vehicle's left.
Way landmark_way(std::span<const Vec2> chain, std::span<const Vec2> behind, const Pose2& pose,
                 Side side, double speed_mps, const LandmarkParams& params);

}  // namespace roverd::nav::marks
