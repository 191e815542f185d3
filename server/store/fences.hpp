#pragma once
// The SQL of fences and their revisions; see missions.hpp. Store's thread.

#include <cstdint>
#include <optional>
#include <string>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

class Fences {
 public:
  explicit Fences(SQLite::Database& db) : db_(db) {}

  base::Result<Page<FenceSummary>> list(int limit, const std::string& cursor);
  base::Result<StoredFence> create(mission::Fence fence, const Change& change, base::WallTime now);
  /// Inside a transaction of the caller.
  base::Result<StoredFence> add(mission::Fence fence, const Change& change, base::WallTime now);
  base::Result<StoredFence> read(const std::string& id);
  base::Result<StoredFence> read_revision(const std::string& id, std::int64_t revision);
  base::Result<StoredFence> replace(const std::string& id, std::int64_t expected,
                                    mission::Fence fence, const Change& change, base::WallTime now);
  base::Result<void> remove(const std::string& id, std::int64_t expected, const Change& change,
                            base::WallTime now);
  base::Result<StoredFence> revert(const std::string& id, std::int64_t expected,
                                   std::int64_t to_revision, const Change& change,
                                   base::WallTime now);
  base::Result<Page<RevisionSummary>> list_revisions(const std::string& id, int limit,
                                                     const std::string& cursor);
  base::Result<std::optional<StoredFence>> activate(const std::optional<std::string>& id);
  base::Result<std::optional<StoredFence>> active();

 private:
  struct Head;
  struct Entry;
  base::Result<Head> head(const std::string& id, std::int64_t expected, bool deleted_too);
  static base::Result<void> check_spared(const Head& head, const Change& change);
  void add_revision(const Head& head, const Entry& entry);
  SQLite::Database& db_;
};

}  // namespace roverd::store
