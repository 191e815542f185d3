#pragma once
// A map of nodes and links between them, and the shortest way along the links. Pure.
//
// The text, one node a line; lines may come in any order:
//
//   Node id=1000 pose=1.5 -2.0 1.5708 links=1005 1025 ~
//   Node id=2000 latlon=58.378 26.729 links=1000 ~
//   Home id=1000 ~                       the home node; it may have pose and links itself
//
// pose is x, y in metres and theta in radians, counter-clockwise from x. Links lead one way; most
// maps name each one at both ends. Blank lines and lines that begin with # say nothing.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

inline constexpr std::size_t kMaxMapNodes = 100'000;
inline constexpr std::size_t kMaxMapLinks = 1'000'000;

struct MapNode {
  std::int64_t id = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double theta_rad = 0.0;
  std::vector<std::int64_t> links{};  ///< ids of nodes that are there, each once, none itself
  /// It was given by latitude and longitude, in a graph that counts from a map; its metres mean
  /// something after on_one_plane().
  std::optional<LatLon> on_earth{};
  friend bool operator==(const MapNode&, const MapNode&) = default;
};

struct RouteGraph {
  std::vector<MapNode> nodes;  ///< by ascending id
  std::optional<std::int64_t> home;
  friend bool operator==(const RouteGraph&, const RouteGraph&) = default;

  /// Null if there is none.
  const MapNode* find(std::int64_t id) const noexcept;
  std::size_t links() const noexcept;
};

/// Where a graph lies. Without an origin and a map it is indoors: positions are local ones.
struct MapFrame {
  std::optional<LatLon> origin;
  double heading_deg = 90.0;  ///< compass, of the graph's x; 90: x is east, y is north
  /// Its nodes are metres of the map of the plane of this name; it has no origin of its own.
  std::optional<std::string> map{};
};

/// Something worth knowing about a line: a link that leads one way only, a part that nothing leads
/// to, what was passed over.
struct MapNote {
  std::size_t line = 0;  ///< from 1
  std::string detail;
};

struct ReadGraph {
  RouteGraph graph;
  std::vector<MapNote> notes;  ///< at most 100
};

/// Invalid, with "line 12" for each: what is damaged, a node twice, a link to a node that is not
/// there, values out of range (±10 km). TooLarge beyond the limits.
base::Result<ReadGraph> graph_from_text(std::string_view text);

/// Nodes that were given by latitude and longitude become metres of a graph with an origin; in one
/// that counts from a map they stay as they are. Invalid, with "node 12" for each: the graph lies
/// indoors, or the node more than 10 km from the origin.
base::Result<void> settle_on_earth(RouteGraph& graph, const MapFrame& frame);

/// For ways through it: all nodes in the metres of the map it counts from.
struct OnePlane {
  RouteGraph graph;
  /// Nobody knows where on the earth the map lies: the links between its nodes and those on the
  /// earth are not in the graph, as nobody knows how long they are, or whether they can be driven.
  bool parted = false;
};
/// @param lies the map; empty: nobody knows
OnePlane on_one_plane(const RouteGraph& graph, const std::optional<base::MapLies>& lies);

/// Ids from `from` to `to`, both included; A* by the straight distance. Conflict: no way leads
/// there. @param from, to ids of nodes that are there
base::Result<std::vector<std::int64_t>> shortest_way(const RouteGraph& graph, std::int64_t from,
                                                     std::int64_t to);

/// Metres between the nodes of a way.
double way_length_m(const RouteGraph& graph, const std::vector<std::int64_t>& way);

/// The node nearest to a place; in a graph that counts from a map, of those that lie on the earth.
/// Empty: the graph has neither these nor an origin, no nodes, or the place is more than 10 km from
/// the origin or the nearest of these.
std::optional<std::int64_t> nearest_node(const RouteGraph& graph, const MapFrame& frame, LatLon at);

/// Of those in the graph's own metres. Empty: there are none.
std::optional<std::int64_t> nearest_node(const RouteGraph& graph, double x_m, double y_m);

/// Of a graph with an origin.
LatLon position_of(const MapNode& node, const MapFrame& frame);

/// One waypoint a node; in a map its points, indoors local items: the last of these has the node's
/// heading. A mission with points of a map needs that map as its frame.
std::vector<Item> items_along(const RouteGraph& graph, const MapFrame& frame,
                              const std::vector<std::int64_t>& way);

}  // namespace roverd::mission
