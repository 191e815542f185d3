#pragma once
// A mission: an ordered list of items, a home kept apart, and settings. Plain values; an edit makes
// a new Plan. Item numbers shown to people start at 1; indices here start at 0.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/geo.hpp"
#include "base/measurements.hpp"

namespace roverd::mission {

using base::LatLon;

enum class Turn { Auto, Pivot, Arc, Through };
enum class Side { Left, Right };
enum class RowSide { Both, Left, Right };
enum class RowSeeing { Line, Rays };
enum class AtEnd { Hold, Return, Repeat, BackAndForth };

struct Waypoint {
  LatLon at;
  std::optional<double> alt_m;
  std::optional<double> speed_mps;  ///< for the leg that leads here
  std::optional<double> radius_m;   ///< counts as reached within
  std::optional<double> hold_s;
  bool reverse = false;
  Turn turn = Turn::Auto;
  friend bool operator==(const Waypoint&, const Waypoint&) = default;
};
struct Local {
  double east_m = 0.0;
  double north_m = 0.0;
  std::optional<double> heading_deg;
  friend bool operator==(const Local&, const Local&) = default;
};
struct Move {
  double forward_m = 0.0;
  friend bool operator==(const Move&, const Move&) = default;
};
/// A place of the map that the mission counts from (Plan::frame).
struct MapPoint {
  double x_m = 0.0;  ///< in the map's own frame
  double y_m = 0.0;
  std::optional<double> yaw_deg{};  ///< to point there: from the x axis, left positive; empty: any
  std::optional<double> speed_mps{};
  std::optional<double> radius_m{};
  std::optional<double> hold_s{};
  bool reverse = false;
  friend bool operator==(const MapPoint&, const MapPoint&) = default;
};
/// Exactly one of the first two.
struct TurnBy {
  std::optional<double> turn_deg;     ///< relative, clockwise positive (as compass)
  std::optional<double> heading_deg;  ///< absolute
  std::optional<double> radius_m{};   ///< forwards on an arc of this; empty: on the spot
  friend bool operator==(const TurnBy&, const TurnBy&) = default;
};
struct Wait {
  double seconds = 0.0;
  friend bool operator==(const Wait&, const Wait&) = default;
};
struct Speed {
  double speed_mps = 0.0;  ///< for the items that follow
  friend bool operator==(const Speed&, const Speed&) = default;
};
/// Where what is driven by sight ends at the latest: where a place is passed beside it. Neither:
/// nowhere. Not both.
struct Until {
  std::optional<double> lat{};
  std::optional<double> lon{};
  std::optional<std::string> place{};  ///< the name of a known place (base/known_place.hpp)
  friend bool operator==(const Until&, const Until&) = default;
};
/// Along plants to both sides, in the middle, or along those of one side.
struct Row {
  RowSide side = RowSide::Both;
  std::optional<double> gap_m{};       ///< of one side: from its plants to the vehicle's middle
  std::optional<double> speed_mps{};   ///< empty: as the profile says for rows
  std::optional<double> distance_m{};  ///< done after so much way; empty: at the row's end
  RowSeeing seeing = RowSeeing::Line;
  Until until{};
  friend bool operator==(const Row&, const Row&) = default;
};
/// By whose word a wall or landmarks are driven along: all that see them, scanners, or cameras.
enum class SightSource { Auto, Scan, Vision };
/// Along a wall, around its corners and past its doors.
struct Wall {
  Side side = Side::Left;              ///< of the vehicle, where the wall is
  std::optional<double> distance_m{};  ///< from it to the vehicle's middle; empty: the profile's
  std::optional<double> speed_mps{};   ///< empty: as the profile says for walls
  std::optional<double> length_m{};    ///< done after so much way; empty: at the wall's end
  Until until{};
  std::optional<SightSource> source{};  ///< empty: as the profile says
  bool landmarks_first = false;         ///< those that stand along it are driven past first
  friend bool operator==(const Wall&, const Wall&) = default;
};
/// Past landmarks, one after the other, all on the same side.
struct Landmarks {
  std::string name;  ///< only those that are called so; kAnyLandmark: whatever stands like one
  /// The vehicle's middle passes them so far to their left; < 0: right.
  std::optional<double> offset_m{};
  std::optional<double> speed_mps{};  ///< empty: as the profile says
  std::optional<int> count{};         ///< done behind so many; empty or 0: behind the last one
  /// Instead of offset_m: of the vehicle, where they are; so far from them as the profile says.
  std::optional<Side> side{};
  std::optional<SightSource> source{};  ///< empty: as the profile says
  friend bool operator==(const Landmarks&, const Landmarks&) = default;
};
inline constexpr std::string_view kAnyLandmark = "any";
/// Before a tag, by sight.
struct Dock {
  int tag = 0;                          ///< its number
  std::optional<double> stand_off_m{};  ///< from the tag to the vehicle's origin; empty: as the
                                        ///< profile says
  friend bool operator==(const Dock&, const Dock&) = default;
};
inline constexpr int kMostTag = 586;  ///< of the family tag36h11
struct Jump {
  int item = 0;   ///< number, from 1
  int times = 0;  ///< repetitions; 0 = for ever
  friend bool operator==(const Jump&, const Jump&) = default;
};
struct ReturnHome {
  friend bool operator==(const ReturnHome&, const ReturnHome&) = default;
};
struct Action {
  std::string name;
  nlohmann::json arguments = nlohmann::json::object();  ///< the other members, kept as they came
  friend bool operator==(const Action&, const Action&) = default;
};

/// Stay at a place, or where the robot stands; driven away from it, drive back.
struct Loiter {
  std::optional<double> lat;  ///< both or none
  std::optional<double> lon;
  std::optional<double> seconds;   ///< empty: until somebody says to go on
  std::optional<double> radius_m;  ///< farther away it drives back; empty: kLoiterRadius_m
  std::optional<LatLon> at() const {
    return lat && lon ? std::optional(LatLon{*lat, *lon}) : std::nullopt;
  }
  double within_m() const;
  friend bool operator==(const Loiter&, const Loiter&) = default;
};
inline constexpr double kLoiterRadius_m = 1.0;
inline double Loiter::within_m() const {
  return radius_m.value_or(kLoiterRadius_m);
}
/// Around a place, entered along its tangent (mission/circle.hpp).
struct Circle {
  LatLon at;  ///< its centre
  double radius_m = 0.0;
  std::optional<double> turns;  ///< empty: one
  bool clockwise = false;
  std::optional<double> speed_mps;
  std::optional<int> stations;   ///< a turn: there it stops and turns to face the centre
  std::optional<double> hold_s;  ///< and holds
  double whole_turns() const { return turns.value_or(1.0); }
  friend bool operator==(const Circle&, const Circle&) = default;
};

using Item = std::variant<Waypoint, Local, Move, TurnBy, Wait, Speed, Row, Wall, Landmarks, Dock,
                          Jump, ReturnHome, Action, Loiter, Circle, MapPoint>;

/// Where an item with a position of its own lies: a waypoint, a loiter at a place, a circle's
/// centre.
std::optional<LatLon> place_of(const Item& item) noexcept;

/// The word of the public interface: "waypoint", "local", "move", "turn", "wait", …
std::string_view type_name(const Item& item) noexcept;

struct Home {
  LatLon at;
  std::optional<double> alt_m;
  friend bool operator==(const Home&, const Home&) = default;
};

struct Settings {
  AtEnd at_end = AtEnd::Hold;
  std::optional<double> speed_mps;  ///< default speed of the mission
  /// Of Repeat and BackAndForth: how often the way is driven, in either direction; 0 or empty: for
  /// ever. Without meaning otherwise.
  std::optional<int> times{};
  /// Half width of the way that it may use: how exact the position must be, and how far off the
  /// route the robot may be at most.
  std::optional<double> corridor_m{};
  friend bool operator==(const Settings&, const Settings&) = default;
};

/// The map of the plane that the mission's map points count from.
struct MissionMap {
  std::string map;  ///< its name
  /// Where it lies, as the robot knew when the mission was loaded. In no file, and no part of what
  /// the mission is.
  std::optional<base::MapLies> lies{};
  friend bool operator==(const MissionMap& a, const MissionMap& b) { return a.map == b.map; }
};
/// On the earth.
LatLon place_on_earth(const base::MapLies& lies, const MapPoint& point) noexcept;

struct Plan {
  std::string name;
  std::optional<Home> home;
  Settings settings;
  std::vector<Item> items;
  std::optional<MissionMap> frame{};  ///< needed where there are map points
  /// What the items were drawn as (a field, a block of rows): kept for whoever draws, and read by
  /// nothing here. An object of at most kMaxDrawing bytes as text with a word `kind`; null: none.
  nlohmann::json drawing{};
  friend bool operator==(const Plan&, const Plan&) = default;
};

/// Sum of the geodesic legs between consecutive waypoints, and of those between consecutive points
/// of the map, metres. A leg from one kind to the other is not counted: where the map lies is not
/// known.
double length_m(const Plan& plan) noexcept;

/// Its points of the map as waypoints, where the map lies; it counts from no map any more. What a
/// point wants of the heading is lost: a waypoint has none.
Plan laid_on_earth(Plan plan, const base::MapLies& lies);

}  // namespace roverd::mission
