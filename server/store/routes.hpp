#pragma once
// The SQL of node maps. On the store's thread; throws SQLite::Exception (see guarded) and changes
// nothing then.

#include <string>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// @param map without id and time
base::Result<RouteMap> create_route_map(SQLite::Database& db, RouteMap map, base::WallTime now);
base::Result<Page<RouteMapSummary>> list_route_maps(SQLite::Database& db, int limit,
                                                    const std::string& cursor);
base::Result<RouteMap> read_route_map(SQLite::Database& db, const std::string& id);
base::Result<void> delete_route_map(SQLite::Database& db, const std::string& id);

}  // namespace roverd::store
