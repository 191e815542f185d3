// Nodes on the earth and nodes in the metres of a graph, on one plane.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/graph/route_graph.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {
namespace {

using base::EnuPoint;

/// x by yaw_rad to the left of east.
void place(MapNode& node, EnuPoint at, double yaw_rad) noexcept {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  node.x_m = at.east_m * c + at.north_m * s;
  node.y_m = at.north_m * c - at.east_m * s;
}

bool is_on_earth(const MapNode& node) noexcept {
  return node.on_earth.has_value();
}

/// Links that lead from one kind of node to the other.
bool part(RouteGraph& graph) {
  bool parted = false;
  for (MapNode& node : graph.nodes) {
    const auto crosses = [&graph, &node](std::int64_t to) {
      return graph.find(to)->on_earth.has_value() != node.on_earth.has_value();
    };
    parted = std::erase_if(node.links, crosses) > 0 || parted;
  }
  return parted;
}

}  // namespace

base::Result<void> settle_on_earth(RouteGraph& graph, const MapFrame& frame) {
  if (frame.map || std::ranges::none_of(graph.nodes, is_on_earth)) return {};
  const base::TangentPlane plane(frame.origin.value_or(LatLon{}));
  Problems problems;
  for (MapNode& node : graph.nodes) {
    if (!node.on_earth) continue;
    const std::string name = "node " + std::to_string(node.id);
    if (!frame.origin) {
      problems.add(name,
                   "lies on the earth, and the graph indoors: it needs an origin, or the map that "
                   "its other nodes count from");
    } else if (base::distance_bearing(*frame.origin, *node.on_earth).distance_m >
               base::LocalFrame::kReach_m) {
      problems.add(name, "lies more than 10 km from the origin");
    } else {
      place(node, plane.to_local(*node.on_earth), base::yaw_from_heading(frame.heading_deg));
      node.on_earth.reset();
    }
  }
  if (problems.none()) return {};
  return tl::unexpected<base::Error>(std::move(problems).error("the map"));
}

OnePlane on_one_plane(const RouteGraph& graph, const std::optional<base::MapLies>& lies) {
  OnePlane out{graph, false};
  const auto first = std::ranges::find_if(out.graph.nodes, is_on_earth);
  if (first == out.graph.nodes.end()) return out;
  // Without a map each kind keeps its own plane: no link joins them.
  const base::MapLies by = lies.value_or(base::MapLies{*first->on_earth, 0.0});
  const base::TangentPlane plane(by.at);
  for (MapNode& node : out.graph.nodes) {
    if (node.on_earth) place(node, plane.to_local(*node.on_earth), by.yaw_rad);
  }
  if (!lies) out.parted = part(out.graph);
  return out;
}

}  // namespace roverd::mission
