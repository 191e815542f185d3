#pragma once
// The SQL of missions and their revisions. Each function is one transaction on the store's thread;
// they throw SQLite::Exception (see guarded) and change nothing then.

#include <cstdint>
#include <string>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// What the tables answer to; `now` is the time of the change.
class Missions {
 public:
  explicit Missions(SQLite::Database& db) : db_(db) {}

  base::Result<Page<MissionSummary>> list(int limit, const std::string& cursor, Which which);
  /// Ends: the recording that became this mission is forgotten with it.
  enum class Teach { Stays, Ends };
  base::Result<StoredMission> create(mission::Plan plan, const Change& change, base::WallTime now,
                                     Teach teach = Teach::Stays);
  base::Result<StoredMission> read(const std::string& id);
  base::Result<StoredMission> read_revision(const std::string& id, std::int64_t revision);
  base::Result<StoredMission> replace(const std::string& id, std::int64_t expected,
                                      mission::Plan plan, const Change& change, base::WallTime now);
  base::Result<Halves> split(const std::string& id, std::int64_t expected, mission::Plan first,
                             mission::Plan rest, const Change& change, base::WallTime now);
  base::Result<void> remove(const std::string& id, std::int64_t expected, const Change& change,
                            base::WallTime now);
  base::Result<StoredMission> restore(const std::string& id, const Change& change,
                                      base::WallTime now);
  /// Takes the missions that were deleted before `then` out of the file, with their revisions.
  void forget_deleted(base::WallTime then);
  base::Result<Page<RevisionSummary>> list_revisions(const std::string& id, int limit,
                                                     const std::string& cursor);
  base::Result<StoredMission> revert(const std::string& id, std::int64_t to_revision,
                                     const Change& change, base::WallTime now);

 private:
  struct Head;
  struct Entry;
  base::Result<Head> head(const std::string& id);
  base::Result<Head> live_head(const std::string& id, std::int64_t expected);
  void add_revision(const Head& head, const Entry& entry);
  // Inside a transaction of the caller.
  base::Result<StoredMission> add_mission(mission::Plan plan, const Change& change,
                                          base::WallTime now);
  base::Result<StoredMission> bring_back(const Head& head, std::int64_t revision, Entry entry);
  base::Result<StoredMission> change_mission(const std::string& id, std::int64_t expected,
                                             mission::Plan plan, const Change& change,
                                             base::WallTime now);
  SQLite::Database& db_;
};

/// 12 characters of Crockford's base 32: 60 random bits from the kernel, safe in a URL.
std::string random_id();

/// Invalid unless 1..kMaxPage.
base::Result<void> check_limit(int limit);

/// Whole text as a number; empty if it is anything else.
std::optional<std::int64_t> number_from(std::string_view text) noexcept;

}  // namespace roverd::store
