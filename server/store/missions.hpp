#pragma once
// The SQL of missions and their revisions. Each function is one transaction on the store's thread;
// they throw SQLite::Exception (see guarded) and change nothing then.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// What the tables answer to; `now` is the time of the change.
class Missions {
 public:
  explicit Missions(SQLite::Database& db) : db_(db) {}

  base::Result<Page<MissionSummary>> list(int limit, const std::string& cursor,
                                          const Filter& filter);
  /// Ends: the recording that became this mission is forgotten with it.
  enum class Teach { Stays, Ends };
  base::Result<StoredMission> create(mission::Plan plan, const Change& change, base::WallTime now,
                                     Teach teach = Teach::Stays);
  /// Inside a transaction of the caller.
  base::Result<StoredMission> add(mission::Plan plan, const Change& change, base::WallTime now);
  base::Result<StoredMission> read(const std::string& id);
  base::Result<StoredMission> read_revision(const std::string& id, std::int64_t revision);
  base::Result<StoredMission> replace(const std::string& id, std::int64_t expected,
                                      mission::Plan plan, const Change& change, base::WallTime now);
  base::Result<Halves> split(const std::string& id, std::int64_t expected, mission::Plan first,
                             mission::Plan rest, const Change& change, base::WallTime now);
  base::Result<void> remove(const std::string& id, std::int64_t expected, const Change& change,
                            base::WallTime now);
  base::Result<StoredMission> restore(const std::string& id, std::int64_t expected,
                                      const Change& change, base::WallTime now);
  base::Result<StoredMission> describe(const std::string& id, std::int64_t expected,
                                       const Description& description, const Change& change,
                                       base::WallTime now);
  base::Result<StoredMission> copy(const std::string& id, const std::optional<std::string>& name,
                                   const Change& change, base::WallTime now);
  base::Result<Page<TagCount>> list_tags(int limit, const std::string& cursor);
  /// Takes the missions that were deleted before `then` out of the file, with their revisions.
  void forget_deleted(base::WallTime then);
  base::Result<Page<RevisionSummary>> list_revisions(const std::string& id, int limit,
                                                     const std::string& cursor);
  base::Result<StoredMission> revert(const std::string& id, std::int64_t expected,
                                     std::int64_t to_revision, const Change& change,
                                     base::WallTime now);

 private:
  struct Head;
  struct Entry;
  struct Text;
  base::Result<Head> head(const std::string& id);
  base::Result<Head> matching_head(const std::string& id, std::int64_t expected);
  base::Result<Head> live_head(const std::string& id, std::int64_t expected);
  std::vector<std::string> tags_of(const std::string& id);
  base::Result<Text> text_of(const std::string& id, std::int64_t revision);
  base::Result<mission::Plan> plan_of(const std::string& id, std::int64_t revision,
                                      std::int64_t& time_ns);
  void add_revision(const Head& head, const Entry& entry);
  void bind_plan(SQLite::Statement& row, const Head& head, const Entry& entry);
  void keep_tags(const Head& head, const Entry& entry);
  // Inside a transaction of the caller.
  base::Result<StoredMission> add_mission(mission::Plan plan, const Entry& entry);
  base::Result<StoredMission> bring_back(const Head& head, std::int64_t revision, Entry entry);
  base::Result<StoredMission> change_mission(const std::string& id, std::int64_t expected,
                                             mission::Plan plan, Entry entry);
  SQLite::Database& db_;
};

/// 12 characters of Crockford's base 32: 60 random bits from the kernel, safe in a URL.
std::string random_id();

/// The statement for a page: ?1, ?2 the cursor, ?3 how many, ?4 the tag, ?5 the folded name.
std::string list_sql(const Filter& filter);

/// A page of the revisions of a mission or a fence. @param rows asks for revision, time_ns, author,
/// what, whether it is the deletion, name, items and length_m; ?1 the id, ?2 the revision that they
/// are below, ?3 how many. Invalid limit, Malformed cursor.
base::Result<Page<RevisionSummary>> revision_page(SQLite::Statement& rows, const std::string& id,
                                                  int limit, const std::string& cursor);

/// Invalid unless 1..kMaxPage.
base::Result<void> check_limit(int limit);

/// A cursor is "<updated_ns>.<id>" of the last row given; the next page starts below it.
struct Below {
  std::int64_t updated_ns = std::numeric_limits<std::int64_t>::max();
  std::string id;
};
/// Malformed if it is not one of ours; empty: from the start.
base::Result<Below> below(const std::string& cursor);
base::Error bad_cursor();
/// Of lists that go down by a number; empty: from the greatest.
base::Result<std::int64_t> below_number(const std::string& cursor);
base::Error no_such_mission(const std::string& id);

/// Whole text as a number; empty if it is anything else.
std::optional<std::int64_t> number_from(std::string_view text) noexcept;

}  // namespace roverd::store
