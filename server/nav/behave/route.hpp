#pragma once
// A mission made ready to drive: steps in order, and the path through its waypoints. Immutable.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/geo.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"
#include "nav/marks/params.hpp"
#include "nav/rows/view.hpp"
#include "nav/track/path.hpp"

namespace roverd::nav {

/// Face, Act and Stay belong to the waypoint before them.
enum class StepKind {
  Go,
  Wait,
  Home,
  Jump,
  Face,
  Turn,
  Move,
  Act,
  Stay,
  Row,
  Wall,
  Landmarks,
  Dock
};

/// A row to drive along by sight.
struct RowToDrive {
  rows::RowOrder order;
  std::optional<double> speed_mps;   ///< empty: the default of rows
  std::optional<double> distance_m;  ///< empty: to its end
  std::optional<EnuPoint> until{};   ///< at the latest beside this place
};

/// A wall to drive along by sight.
struct WallToDrive {
  marks::Side side = marks::Side::Left;
  std::optional<double> distance_m{};  ///< empty: the default of walls
  std::optional<double> speed_mps;     ///< empty: the default of what is driven by sight
  std::optional<double> length_m;      ///< empty: to its end
  std::optional<marks::By> by{};       ///< by whose word; empty: as the parameters say
  bool landmarks_first = false;        ///< those that stand along it are driven past first
  std::optional<EnuPoint> until{};     ///< at the latest beside this place
};

/// Landmarks to drive past by sight.
struct LandmarksToPass {
  marks::Side side = marks::Side::Left;  ///< of the vehicle, where they are
  std::optional<double> offset_m{};      ///< empty: the default of landmarks
  std::string name;                      ///< empty: all
  std::optional<double> speed_mps;       ///< empty: the default of what is driven by sight
  std::optional<int> count;              ///< empty: to the last one that is seen
  std::optional<marks::By> by{};         ///< by whose word; empty: as the parameters say
};

/// A tag to stand before.
struct DockToCome {
  int tag = 0;
  std::optional<double> stand_off_m;  ///< empty: the default of tag_dock
};

/// One thing to do. `item` is the number people see (from 1).
struct RouteStep {
  StepKind kind = StepKind::Go;
  int item = 0;
  std::size_t node = 0;    ///< Go: index of the waypoint. Jump: how many jumps come before it
  double seconds = 0.0;    ///< Wait, Stay: how long. Go: how long to hold there
  std::size_t target = 0;  ///< Jump: index of the step to go on with
  int times = 0;           ///< Jump: repetitions; 0 = for ever
  double by = 0.0;         ///< Move: m, negative backwards. Turn: rad, left positive
  std::optional<double> yaw_rad{};    ///< Face: to this; Turn: to this instead of by an angle
  double radius_m = 0.0;              ///< Turn: forwards on such an arc; 0: on the spot
  bool silent = false;                ///< Go: a point on the way to the item's own
  std::optional<EnuPoint> place{};    ///< Stay: here; empty: where the robot stands
  double within_m = 0.0;              ///< Stay: farther from there it drives back
  bool endless = false;               ///< Stay: until somebody says to go on
  std::string action{};               ///< Act: its name
  std::string arguments{};            ///< Act: JSON
  std::optional<RowToDrive> row{};    ///< Row
  std::optional<WallToDrive> wall{};  ///< Wall
  std::optional<LandmarksToPass> landmarks{};  ///< Landmarks
  std::optional<DockToCome> dock{};            ///< Dock

  /// Away from where it stands, to a place that no plan tells.
  bool moves_on() const noexcept {
    return kind == StepKind::Move || (kind == StepKind::Turn && radius_m > 0.0);
  }
  /// Along what is seen: where it leads shows on the way.
  bool by_sight() const noexcept {
    return kind == StepKind::Row || kind == StepKind::Wall || kind == StepKind::Landmarks ||
           kind == StepKind::Dock;
  }
};

/// A waypoint of the route, in metres.
struct RouteNode {
  EnuPoint at;
  double speed_mps = 0.0;
  double radius_m = 0.0;  ///< counts as reached within; 0: at its place on the path
  bool reverse = false;
  mission::Turn turn = mission::Turn::Auto;
  int item = 0;
  double curvature_1pm = 0.0;  ///< of the way that leads here, left positive
  bool tangent = false;        ///< the way goes on without a corner
  bool halt = false;           ///< stop here, whatever comes next
};

/// One direction through the mission.
struct Course {
  std::vector<RouteNode> nodes;
  std::vector<RouteStep> steps;
  Path path;  ///< through all nodes in order; vertex i is node i
  /// With a tool (nav/track/tool.hpp): its point's own way, and the nodes are where the vehicle is
  /// when the point is at theirs. Empty without one.
  Path point_path{};
  /// Of each step, and one more: what holds, waits, moves and turns take from it to the end, s;
  /// infinite before a stay without end.
  std::vector<double> pauses_s;
};

/// The other end of a straight way to home or from it.
struct HomeEnd {
  EnuPoint at;
  int item = 0;  ///< that asks for the way; 0: the end of the mission does
};

struct Route {
  Course forth;
  Course back;  ///< empty unless at_end is back_and_forth
  mission::AtEnd at_end = mission::AtEnd::Hold;
  int times = 0;          ///< of Repeat and BackAndForth: ways that are driven; 0: for ever
  std::size_t jumps = 0;  ///< steps of that kind
  std::vector<HomeEnd> home_ends;    ///< empty: it never goes there
  std::optional<EnuPoint> home;      ///< the mission's own; the driver of the route decides on it
  double speed_mps = 0.0;            ///< default, for ways outside of the path
  std::optional<double> corridor_m;  ///< half width that the mission allows itself
  int items = 0;
};

/// Checks and lays out a plan. What ends beside a known place has its position already
/// (mission::Until::lat); by its name alone it ends without it. Items of types that this robot
/// cannot do yet, positions farther than 10 km from the frame's origin, jumps to nowhere, a plan
/// without anything to drive: Invalid, every such item named in `fields` ("/items/3", from 0 as a
/// JSON pointer counts). `local` items count from the mission's home, or, if it has none, from the
/// frame's origin. A steered vehicle comes to a heading on a straight before it, and does not turn
/// on the spot. A circle is a row of waypoints on it (mission/circle.hpp), of which the last one
/// counts. Pure; linear in the number of items and the length of circles.
base::Result<Route> lay_route(const mission::Plan& plan, const base::LocalFrame& frame,
                              const PathParams& params);

}  // namespace roverd::nav
