// node maps: whatever the bytes, a map is refused or all its links lead to nodes that are there.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/graph/route_graph.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = graph_from_text(text);
  if (!read) return read.error().detail.empty() ? std::abort(), 0 : 0;
  const RouteGraph& graph = read->graph;
  if (graph.nodes.empty()) std::abort();
  for (const MapNode& node : graph.nodes) {
    for (const std::int64_t to : node.links) {
      if (to == node.id || graph.find(to) == nullptr) std::abort();
    }
  }
  const auto way = shortest_way(graph, graph.nodes.front().id, graph.nodes.back().id);
  if (way && items_along(graph, {}, *way).size() != way->size()) std::abort();
  return 0;
}
