#include "mission/graph/route_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"

namespace roverd::mission {
namespace {

using base::EnuPoint;

std::size_t place_in(const RouteGraph& graph, std::int64_t id) noexcept {
  const auto at = std::lower_bound(graph.nodes.begin(), graph.nodes.end(), id,
                                   [](const MapNode& n, std::int64_t k) { return n.id < k; });
  return static_cast<std::size_t>(at - graph.nodes.begin());
}

double apart_m(const MapNode& a, const MapNode& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// x along the heading, y to its left.
EnuPoint enu_of(const MapNode& node, double heading_deg) noexcept {
  const double yaw = base::yaw_from_heading(heading_deg);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {node.x_m * c - node.y_m * s, node.x_m * s + node.y_m * c};
}

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Empty: none is nearer than `most_m`.
template <class Far>
std::optional<std::int64_t> nearest_of(const RouteGraph& graph, double most_m, Far far_m) {
  std::optional<std::int64_t> best;
  for (const MapNode& node : graph.nodes) {
    const double this_m = far_m(node);
    if (this_m >= most_m) continue;
    most_m = this_m;
    best = node.id;
  }
  return best;
}

std::optional<std::int64_t> nearest_on_earth(const RouteGraph& graph, LatLon at) {
  return nearest_of(graph, base::LocalFrame::kReach_m, [at](const MapNode& node) {
    return node.on_earth ? base::distance_bearing(*node.on_earth, at).distance_m : kFar;
  });
}

}  // namespace

const MapNode* RouteGraph::find(std::int64_t id) const noexcept {
  const std::size_t at = place_in(*this, id);
  return at < nodes.size() && nodes[at].id == id ? &nodes[at] : nullptr;
}

std::size_t RouteGraph::links() const noexcept {
  std::size_t sum = 0;
  for (const MapNode& node : nodes) sum += node.links.size();
  return sum;
}

base::Result<std::vector<std::int64_t>> shortest_way(const RouteGraph& graph, std::int64_t from,
                                                     std::int64_t to) {
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  struct Open {
    double cost_m;  ///< so far, and straight to the end
    std::size_t node;
    bool operator>(const Open& other) const noexcept {
      return cost_m != other.cost_m ? cost_m > other.cost_m : node > other.node;
    }
  };
  const std::size_t first = place_in(graph, from);
  const std::size_t last = place_in(graph, to);
  const MapNode& end = graph.nodes[last];
  std::vector<double> so_far_m(graph.nodes.size(), kFar);
  std::vector<std::size_t> before(graph.nodes.size(), kNone);
  std::vector<bool> done(graph.nodes.size(), false);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  so_far_m[first] = 0.0;
  open.push({apart_m(graph.nodes[first], end), first});
  while (!open.empty() && !done[last]) {
    const std::size_t at = open.top().node;
    open.pop();
    if (done[at]) continue;
    done[at] = true;
    for (const std::int64_t id : graph.nodes[at].links) {
      const std::size_t next = place_in(graph, id);
      const double way_m = so_far_m[at] + apart_m(graph.nodes[at], graph.nodes[next]);
      if (way_m >= so_far_m[next]) continue;
      so_far_m[next] = way_m;
      before[next] = at;
      open.push({way_m + apart_m(graph.nodes[next], end), next});
    }
  }
  if (!done[last]) {
    return base::fail(base::Code::Conflict, "no way leads from node " + std::to_string(from) +
                                                " to node " + std::to_string(to));
  }
  std::vector<std::int64_t> way;
  for (std::size_t at = last; at != kNone; at = before[at]) way.push_back(graph.nodes[at].id);
  std::reverse(way.begin(), way.end());
  return way;
}

double way_length_m(const RouteGraph& graph, const std::vector<std::int64_t>& way) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    sum_m +=
        apart_m(graph.nodes[place_in(graph, way[i - 1])], graph.nodes[place_in(graph, way[i])]);
  }
  return sum_m;
}

LatLon position_of(const MapNode& node, const MapFrame& frame) {
  return base::TangentPlane(frame.origin.value_or(LatLon{}))
      .to_global(enu_of(node, frame.heading_deg));
}

std::optional<std::int64_t> nearest_node(const RouteGraph& graph, const MapFrame& frame,
                                         LatLon at) {
  if (frame.map) return nearest_on_earth(graph, at);
  if (!frame.origin) return std::nullopt;
  if (base::distance_bearing(*frame.origin, at).distance_m > base::LocalFrame::kReach_m) {
    return std::nullopt;
  }
  const EnuPoint here = base::TangentPlane(*frame.origin).to_local(at);
  return nearest_of(graph, kFar, [&](const MapNode& node) {
    return base::distance_m(here, enu_of(node, frame.heading_deg));
  });
}

std::optional<std::int64_t> nearest_node(const RouteGraph& graph, double x_m, double y_m) {
  return nearest_of(graph, kFar, [x_m, y_m](const MapNode& node) {
    return node.on_earth ? kFar : std::hypot(node.x_m - x_m, node.y_m - y_m);
  });
}

std::vector<Item> items_along(const RouteGraph& graph, const MapFrame& frame,
                              const std::vector<std::int64_t>& way) {
  std::vector<Item> items;
  items.reserve(way.size());
  for (const std::int64_t id : way) {
    const MapNode& node = graph.nodes[place_in(graph, id)];
    const bool last = items.size() + 1 == way.size();
    if (node.on_earth) {
      Waypoint w;
      w.at = *node.on_earth;
      items.emplace_back(w);
      continue;
    }
    if (frame.map) {
      MapPoint point{.x_m = node.x_m, .y_m = node.y_m};
      if (last) point.yaw_deg = base::deg_from_rad(base::wrap_rad(node.theta_rad));
      items.emplace_back(point);
      continue;
    }
    if (frame.origin) {
      Waypoint w;
      w.at = position_of(node, frame);
      items.emplace_back(w);
      continue;
    }
    const EnuPoint at = enu_of(node, frame.heading_deg);
    Local local{at.east_m, at.north_m, std::nullopt};
    if (last) {
      const double x_yaw = base::yaw_from_heading(frame.heading_deg);
      local.heading_deg = base::heading_from_yaw(x_yaw + node.theta_rad);
    }
    items.emplace_back(local);
  }
  return items;
}

}  // namespace roverd::mission
