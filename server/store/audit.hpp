#pragma once
// The audit in the file. The store's thread.

#include <span>

#include <SQLiteCpp/SQLiteCpp.h>

#include "store/store.hpp"

namespace roverd::store {

/// All of them or none, behind those that are there.
void write_audit(SQLite::Database& db, std::span<const people::Deed> deeds);
/// The oldest go until what is left has at most three quarters of so many bytes, about; nothing
/// happens while it has at most `max_bytes`.
void cut_audit(SQLite::Database& db, std::int64_t max_bytes);
base::Result<Page<people::KeptDeed>> list_audit(SQLite::Database& db, const AuditFilter& filter,
                                                std::int64_t before_id, int limit);
AuditStretch read_audit(SQLite::Database& db, std::int64_t after_id, int limit);

}  // namespace roverd::store
