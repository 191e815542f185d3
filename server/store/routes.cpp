#include "store/routes.hpp"

#include <algorithm>
#include <utility>

#include "mission/text.hpp"
#include "store/missions.hpp"

namespace roverd::store {

using base::Code;
using base::Result;

namespace {

tl::unexpected<base::Error> no_map(const std::string& id) {
  return base::fail(Code::NotFound, "there is no node map " + mission::clean_name(id, "\"\""));
}

std::optional<base::LatLon> place_of(SQLite::Statement& row, int column) {
  if (row.getColumn(column).isNull()) return std::nullopt;
  return base::LatLon{row.getColumn(column).getDouble(), row.getColumn(column + 1).getDouble()};
}

constexpr const char* kSummary =
    "SELECT number, id, name, created_ns, origin_lat, origin_lon, heading_deg, home, nodes, links, "
    "frame_map FROM route_maps ";

RouteMapSummary summary_of(SQLite::Statement& row) {
  RouteMapSummary s;
  s.id = row.getColumn(1).getString();
  s.name = row.getColumn(2).getString();
  s.created = base::WallTime(base::Duration(row.getColumn(3).getInt64()));
  s.frame = {place_of(row, 4), row.getColumn(6).getDouble(), std::nullopt};
  if (!row.getColumn(7).isNull()) s.home = row.getColumn(7).getInt64();
  s.nodes = row.getColumn(8).getInt();
  s.links = row.getColumn(9).getInt();
  if (!row.getColumn(10).isNull()) s.frame.map = row.getColumn(10).getString();
  return s;
}

void write_nodes(SQLite::Database& db, std::int64_t map, const mission::RouteGraph& graph) {
  SQLite::Statement node(db,
                         "INSERT INTO route_nodes (map, node, x_m, y_m, theta_rad, lat, lon) "
                         "VALUES (?, ?, ?, ?, ?, ?, ?)");
  SQLite::Statement link(db, "INSERT INTO route_links (map, from_node, to_node) VALUES (?, ?, ?)");
  for (const mission::MapNode& n : graph.nodes) {
    node.bind(1, map);
    node.bind(2, n.id);
    node.bind(3, n.x_m);
    node.bind(4, n.y_m);
    node.bind(5, n.theta_rad);
    if (n.on_earth) {
      node.bind(6, n.on_earth->lat);
      node.bind(7, n.on_earth->lon);
    }
    node.exec();
    node.reset();
    node.clearBindings();
    for (const std::int64_t to : n.links) {
      link.bind(1, map);
      link.bind(2, n.id);
      link.bind(3, to);
      link.exec();
      link.reset();
    }
  }
}

}  // namespace

Result<RouteMap> create_route_map(SQLite::Database& db, RouteMap map, base::WallTime now) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  map.about.id = random_id();
  map.about.created = now;
  map.about.home = map.graph.home;
  map.about.nodes = static_cast<int>(map.graph.nodes.size());
  map.about.links = static_cast<int>(map.graph.links());
  SQLite::Statement row(db,
                        "INSERT INTO route_maps (id, name, created_ns, origin_lat, origin_lon, "
                        "heading_deg, home, nodes, links, frame_map) "
                        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  row.bind(1, map.about.id);
  row.bind(2, map.about.name);
  row.bind(3, std::int64_t{now.time_since_epoch().count()});
  if (const auto& origin = map.about.frame.origin) {
    row.bind(4, origin->lat);
    row.bind(5, origin->lon);
  }
  row.bind(6, map.about.frame.heading_deg);
  if (map.graph.home) row.bind(7, *map.graph.home);
  row.bind(8, map.about.nodes);
  row.bind(9, map.about.links);
  if (map.about.frame.map) row.bind(10, *map.about.frame.map);
  row.exec();
  write_nodes(db, db.getLastInsertRowid(), map.graph);
  transaction.commit();
  return map;
}

Result<Page<RouteMapSummary>> list_route_maps(SQLite::Database& db, int limit,
                                              const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<base::Error>(ok.error());
  const auto before = below_number(cursor);
  if (!before) return tl::unexpected<base::Error>(before.error());
  SQLite::Statement rows(db,
                         std::string(kSummary) + "WHERE number < ? ORDER BY number DESC LIMIT ?");
  rows.bind(1, *before);
  rows.bind(2, limit + 1);
  Page<RouteMapSummary> page;
  std::int64_t last = 0;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(last);
      break;
    }
    last = rows.getColumn(0).getInt64();
    page.items.push_back(summary_of(rows));
  }
  return page;
}

Result<RouteMap> read_route_map(SQLite::Database& db, const std::string& id) {
  SQLite::Statement head(db, std::string(kSummary) + "WHERE id = ?");
  head.bind(1, id);
  if (!head.executeStep()) return no_map(id);
  RouteMap map;
  map.about = summary_of(head);
  map.graph.home = map.about.home;
  const std::int64_t number = head.getColumn(0).getInt64();
  SQLite::Statement nodes(
      db,
      "SELECT node, x_m, y_m, theta_rad, lat, lon FROM route_nodes WHERE map = ? ORDER BY node");
  nodes.bind(1, number);
  while (nodes.executeStep()) {
    map.graph.nodes.push_back({nodes.getColumn(0).getInt64(),
                               nodes.getColumn(1).getDouble(),
                               nodes.getColumn(2).getDouble(),
                               nodes.getColumn(3).getDouble(),
                               {},
                               place_of(nodes, 4)});
  }
  SQLite::Statement links(db,
                          "SELECT from_node, to_node FROM route_links WHERE map = ? "
                          "ORDER BY from_node, to_node");
  links.bind(1, number);
  auto at = map.graph.nodes.begin();
  while (links.executeStep()) {
    const std::int64_t from = links.getColumn(0).getInt64();
    while (at != map.graph.nodes.end() && at->id < from) ++at;
    if (at != map.graph.nodes.end()) at->links.push_back(links.getColumn(1).getInt64());
  }
  return map;
}

Result<void> delete_route_map(SQLite::Database& db, const std::string& id) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement row(db, "DELETE FROM route_maps WHERE id = ?");
  row.bind(1, id);
  if (row.exec() == 0) return no_map(id);
  transaction.commit();
  return {};
}

}  // namespace roverd::store
