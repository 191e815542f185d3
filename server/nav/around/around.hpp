#pragma once
// A way around what stands on the route.
//
//                  ╭───────────╮            leave: the robot stands on the route, or on its way
//   route ═══▭═════╯    ▓▓▓    ╰═════▶      to it; rejoin: the body points along the route again
//           leave      blocked    rejoin    and the route is free there
//
// Within the corridor and the fence, through what the grid knows, with the vehicle's own
// kinematics. The robot's outline keeps `least_m` from everything that stands there, and pays for
// being nearer than `wanted_m`. What ends at the edge of what is seen is told as `partial`: drive
// it, look, ask again. Where the robot stands nearer than `least_m` already, it may leave that
// place as long as it comes no nearer; turning where it stands it may come by 3 cm nearer.
//
// Frame O of the odometry for everything (nav/sense/odometry.hpp): the route, the fence and the
// answer. Metres, radians left positive. Deterministic: equal questions, equal answers.
// Sources: Dolgov et al., Practical search techniques in path planning for autonomous driving, 2008
// (hybrid A*); Dubins, On curves of minimal length, 1957; Reeds and Shepp, 1990 (backing off is
// searched step by step, not by their words).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::around {

using sense::Vec2;
/// Corners in order, either way round; the last one is joined to the first.
using Ring = std::vector<Vec2>;

struct Kinematics {
  double min_radius_m = 0.0;  ///< of the body's origin; 0: none, for one that pivots
  bool pivots = true;         ///< turns on the spot
  bool may_reverse = false;
};

/// Which way it passes what blocks, seen along the route.
enum class Side : std::uint8_t { None, Left, Right };
std::string_view to_string(Side side) noexcept;  // none left right

/// The body's pose somewhere on the way.
struct Place {
  sense::Pose2 pose;           ///< X_OB; the heading is the body's, in reverse as well
  bool reverse = false;        ///< the way that leads here is driven backwards
  bool pivot = false;          ///< the turn that leads here is one on the spot: x, y as before
  double curvature_1pm = 0.0;  ///< of the way that leads here, left positive; 0 for a pivot
};

struct Question {
  sense::Pose2 pose;  ///< X_OB now
  sense::Footprint body = sense::Footprint::box(1.0, 0.8, 0.5);
  Kinematics kinematics;

  /// The route as a polyline, from behind the robot or from its nearest point on to as far as is
  /// known; what lies beyond the patch is not looked at. Two points at least, 4,000 at most.
  std::vector<Vec2> route;
  double here_m = 0.0;   ///< how far along it the robot is; it is left and joined after that
  bool at_end = false;   ///< its last point is where the mission wants to stand: join there, too
  double left_m = 5.0;   ///< corridor: so far left of the route every part of the body may be
  double right_m = 5.0;  ///< and right of it; 0.1 to 1,000
  /// Inside of one of these, if there are any, and of none of those, with the margin. Areas that
  /// shall be one must overlap by twice the margin. 10,000 corners at most altogether.
  std::vector<Ring> keep_in;
  std::vector<Ring> keep_out;
  double fence_margin_m = 0.1;

  double least_m = 0.12;              ///< between the body and what stands there; 0.02 to 1
  double wanted_m = 0.30;             ///< nearer than that is driven only where it saves way
  bool keeps_ahead = false;           ///< least_m ahead also where it stands nearer: it was refused
  bool through_unknown = false;       ///< at creep speed: a metre counts as unknown_cost of them
  bool back_through_unknown = false;  ///< and backwards; counts with through_unknown only
  double unknown_cost = 3.0;          ///< 1 to 10
  double rejoin_within_m = 6.0;       ///< behind the blocked stretch

  /// What was answered last, if it is being driven: another way must be better by a sixth.
  std::vector<Place> before;
};

/// Why there is no way, or only a part of it.
enum class Why : std::uint8_t {
  None,
  Gap,       ///< no gap is wide enough
  Reach,     ///< as far as the window goes there is none; there may be one beyond
  Corridor,  ///< there is one outside of the corridor
  Fence,     ///< there is one outside of the fence
  Unseen,    ///< it leads through what no sensor has seen
  Turning,   ///< the vehicle cannot turn as narrowly
  Touching,  ///< the body stands in something
  Target,    ///< the route's end, where the mission wants to stand, lies in something
  Effort     ///< the search was given up
};
std::string_view to_string(Why why) noexcept;  // none gap reach corridor fence unseen …
/// For people: "no gap is wide enough".
std::string_view sentence(Why why) noexcept;

enum class Found : std::uint8_t {
  Clear,  ///< the robot is on the route, and nothing stands there as far as is known; no path.
          ///< Beside a clear route: a way back to it
  Way,
  Part,  ///< as far as is seen, and good to drive: ask again on the way
  None
};
std::string_view to_string(Found found) noexcept;  // clear way part none

struct Answer {
  Found found = Found::None;
  Why why = Why::None;
  /// Way and Part: from the pose of the question on, at most 0.1 m and 5° apart.
  std::vector<Place> path;
  double length_m = 0.0;
  double leave_m = 0.0;   ///< along the route, where the path departs from it by 5 cm or 10°
  double rejoin_m = 0.0;  ///< along the route; Way only
  Side side = Side::None;
  double blocked_from_m = 0.0;  ///< along the route: the first stretch that cannot be driven
  double blocked_to_m = 0.0;
  bool unseen = false;       ///< the path leads through what no sensor has seen
  std::size_t expanded = 0;  ///< effort: places that were looked at
};

/// Owns all the memory it needs (some 5 MB), allocated once. Not shared between threads; no clock.
class Planner {
 public:
  struct Effort {
    std::size_t expand = 3000;  ///< places at most; 1,000 to 100,000
  };

  Planner();
  explicit Planner(Effort effort);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Typically 3 to 6 ms for 20 x 20 m at 5 cm, 15 ms where it finds none, bounded by the effort.
  /// @param patch square, cells of 2 to 20 cm, at most 1024 x 1024, the robot inside it
  /// @return Invalid or TooLarge: which field of the question is out of its range
  base::Result<void> plan(const sense::Patch& patch, const Question& question, Answer& answer);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roverd::nav::around
