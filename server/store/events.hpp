#pragma once
// The SQL of the events table. On the store's thread; throws SQLite::Exception (see guarded).

#include <cstdint>
#include <span>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// All or none, in one transaction; afterwards at most `max_events` are kept, the newest.
void write_events(SQLite::Database& db, std::span<const base::Event> events,
                  std::int64_t max_events);

/// The oldest, up to the first that is younger. One from before the clock was set is of unknown
/// age: it goes with those after it.
void forget_events(SQLite::Database& db, base::WallTime before);

base::Result<Page<StoredEvent>> list_events(SQLite::Database& db, std::int64_t after_id,
                                            base::Severity level, int limit);

}  // namespace roverd::store
