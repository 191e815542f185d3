#pragma once
// Users, sessions, tokens and paired devices in the file. The store's thread.

#include <SQLiteCpp/SQLiteCpp.h>

#include "base/result.hpp"
#include "people/words.hpp"

namespace roverd::store {

people::Everybody read_people(SQLite::Database& db);
/// All of it or nothing.
base::Result<void> change_people(SQLite::Database& db, const people::Change& change);

}  // namespace roverd::store
