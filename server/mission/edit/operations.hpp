#pragma once
// What one can do with a whole mission: each operation is a value, `perform` maps plan to plan.
//
// Items keep their settings. Jumps go on leading to the same item; one to an item that goes leads
// to what comes in its place, and goes too if that would be itself. Home moves by SetHome and Clear
// alone.
//
// Shapes (offset, scale, rotate, mirror) are moved as rigid or similar figures in the tangent plane
// of the WGS84 ellipsoid at their centre: within 1 mm for figures and ways of 1 km (the plane's
// error is d³/6R²: 4 µm at 1 km, 0.1 mm at 3 km, 4 mm at 10 km; farther is refused). The opposite
// operation gives the start back within 1 mm:
//   offset by d        offset by −d, at any latitude. North is that of the middle of the way of the
//                      figure's centroid, so it is the same one for both; a way of 1 km to the east
//                      at 58° north turns by 0.007° against the direction at its start. Nearer to a
//                      pole than half of d there may be no such middle: refused.
//   rotate by a        rotate by −a  ╮ about the same point: Done::about names it, because
//   scale by f         scale by 1/f  │ the middle of the extremes (Middle) is another one after
//   mirror about a     mirror about a╯ a turn. Centroid turns with the figure.
// Headings of items turn with the figure, `move` grows with it; a mirror changes left and right.
// `local` items are measured from home: without a home they can be moved but not turned.
//
// Pure, any thread. Errors name the members of the operation by JSON pointer ("/item", "/factor")
// or a value of the result ("/items/3/east_m").

#include <optional>
#include <string>
#include <variant>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

/// Items by number, from 1, both included.
struct Numbers {
  int first = 1;
  int last = 1;
};

struct AddWaypoint {
  Waypoint waypoint;
  std::optional<int> after;  ///< 0: before the first; empty: at the end
};
/// Empty: the last one.
struct RemoveItems {
  std::optional<Numbers> which;
};
/// @param home where home is from then on; empty: it stays
struct Clear {
  std::optional<Home> home;
};
/// The same items in the opposite order.
struct Reverse {};
struct Offset {
  base::EnuPoint by;
  std::optional<Numbers> which;  ///< empty: all
};

struct Middle {};    ///< of the extremes of latitude and longitude
struct Centroid {};  ///< mean of the positions
struct AtHome {};
using About = std::variant<Middle, Centroid, AtHome, LatLon>;

struct ScaleRotate {
  double factor = 1.0;    ///< kMinFactor … kMaxFactor
  double turn_deg = 0.0;  ///< clockwise
  About about = Middle{};
};
struct Mirror {
  double axis_deg = 0.0;  ///< compass direction of the axis
  About about = Middle{};
};
struct SetHome {
  Home home;
};
/// Ramer-Douglas-Peucker: takes waypoints out as long as the way stays within the tolerance. A
/// waypoint stays where it holds, is a jump's target or is driven to otherwise (speed, direction,
/// kind of turn, radius) than the next one.
struct Simplify {
  double tolerance_m = 0.0;
  std::optional<Numbers> which;
};
/// Puts waypoints on the legs between waypoints, evenly, so that none are farther apart.
struct Densify {
  double at_most_m = 0.0;
  std::optional<Numbers> which;
};
/// Appends the other's items. If they count from a map, this mission counts from the same or none.
struct Join {
  Plan other;
};
/// Moves a run of items so that its first one has the number `to` afterwards.
struct Renumber {
  Numbers which;
  int to = 1;
};

/// An item with a position, and where that place is by today's measure.
struct Anchor {
  int item = 1;
  LatLon at;
};
/// Moves the whole mission so that the first item falls on its anchor, and, with a second one,
/// turns it about there so that the way to the second points to its anchor. Nothing is stretched:
/// Done::what tells how far the second then is from where it should be.
struct Align {
  Anchor first;
  std::optional<Anchor> second;
};

using Operation = std::variant<AddWaypoint, RemoveItems, Clear, Reverse, Offset, ScaleRotate,
                               Mirror, SetHome, Simplify, Densify, Join, Renumber, Align>;

inline constexpr double kMinFactor = 0.001;
inline constexpr double kMaxFactor = 1000.0;
inline constexpr double kMaxTolerance_m = 1000.0;

struct Done {
  Plan plan;                    ///< satisfies check_plan
  std::string what;             ///< for the list of revisions: "moved all items 3.2 m north"
  std::optional<int> item;      ///< number of the item that was added or removed
  std::optional<LatLon> about;  ///< of a turn, a scale, a mirror
};

/// @param plan satisfies check_plan
base::Result<Done> perform(Plan plan, const Operation& operation);

struct Parts {
  Plan first;  ///< keeps the name
  Plan rest;   ///< "… (2)"; the same home, settings and map
};
/// The items up to `after` and those that follow. A jump across the cut is Invalid.
/// @param shared the item `after` is the first one of the rest, too: no gap in the way
base::Result<Parts> split(Plan plan, int after, bool shared = false);

}  // namespace roverd::mission
