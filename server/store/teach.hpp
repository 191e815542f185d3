#pragma once
// The SQL of the recording that is being made. On the store's thread; throws SQLite::Exception (see
// guarded) and changes nothing then.

#include <optional>
#include <vector>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// Conflict if there is one already.
base::Result<void> begin_teach(SQLite::Database& db, const TeachRecord& record);
/// Behind those that are there. Conflict if no recording was begun.
base::Result<void> add_teach_points(SQLite::Database& db,
                                    const std::vector<mission::TaughtPoint>& points);
std::optional<TeachRecord> read_teach(SQLite::Database& db);
/// Without a transaction of its own.
void clear_teach(SQLite::Database& db);

}  // namespace roverd::store
