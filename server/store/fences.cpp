#include "store/fences.hpp"

#include <utility>

#include "mission/fence/fence_json.hpp"
#include "mission/text.hpp"
#include "store/mission_entry.hpp"
#include "store/packed.hpp"

namespace roverd::store {

using base::Code;
using base::Error;
using base::Result;
using base::WallTime;

namespace {

tl::unexpected<Error> no_such_fence(const std::string& id) {
  return base::fail(Code::NotFound, "there is no fence " + mission::clean_name(id, "\"\""));
}

}  // namespace

/// The present row of a fence.
struct Fences::Head {
  std::string id;
  std::int64_t revision = 0;
  std::int64_t created_ns = 0;
  bool deleted = false;
  bool active = false;
  std::string name;
};

/// A revision to be written. @param fence null: the deletion
struct Fences::Entry {
  const Change& change;
  std::string_view usual;
  WallTime now;
  const mission::Fence* fence = nullptr;
};

Result<Fences::Head> Fences::head(const std::string& id, std::int64_t expected, bool deleted_too) {
  SQLite::Statement row(
      db_, "SELECT revision, created_ns, deleted, active, name FROM fences WHERE id = ?");
  row.bind(1, id);
  if (!row.executeStep()) return no_such_fence(id);
  Head found{id,
             row.getColumn(0).getInt64(),
             row.getColumn(1).getInt64(),
             row.getColumn(2).getInt() != 0,
             row.getColumn(3).getInt() != 0,
             row.getColumn(4).getString()};
  if (found.deleted && !deleted_too) return no_such_fence(id);
  if (expected != kAnyRevision && found.revision != expected) {
    return base::fail(Code::RevisionMismatch,
                      "the fence is at revision " + std::to_string(found.revision) +
                          ", the change was made to revision " + std::to_string(expected));
  }
  return found;
}

Result<void> Fences::check_spared(const Head& head, const Change& change) {
  if (!head.active || !change.spares_active) return {};
  return base::fail(Code::Conflict, "the fence is the active one: it acts on the robot");
}

void Fences::add_revision(const Head& head, const Entry& entry) {
  const std::string& name = entry.fence != nullptr ? entry.fence->name : head.name;
  SQLite::Statement revision(db_,
                             "INSERT INTO fence_revisions (fence_id, revision, time_ns, author, "
                             "what, name, packed) VALUES (?, ?, ?, ?, ?, ?, ?)");
  revision.bind(1, head.id);
  revision.bind(2, head.revision);
  revision.bind(3, ns_from(entry.now));
  revision.bind(4, mission::clean_name(entry.change.author, ""));
  revision.bind(5, mission::clean_name(entry.change.what, entry.usual));
  revision.bind(6, name);
  if (entry.fence != nullptr) {
    const std::string packed = pack(mission::fence_to_json(*entry.fence).dump());
    revision.bind(7, packed.data(), static_cast<int>(packed.size()));
  }
  revision.exec();
  SQLite::Statement present(
      db_,
      "INSERT INTO fences (id, revision, created_ns, updated_ns, name, areas, rally, deleted) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT (id) DO UPDATE SET revision = ?2, "
      "updated_ns = ?4, name = ?5, areas = ?6, rally = ?7, deleted = ?8");
  present.bind(1, head.id);
  present.bind(2, head.revision);
  present.bind(3, head.created_ns);
  present.bind(4, ns_from(entry.now));
  present.bind(5, name);
  present.bind(6, entry.fence != nullptr ? static_cast<int>(entry.fence->areas.size()) : 0);
  present.bind(7, entry.fence != nullptr ? static_cast<int>(entry.fence->rally.size()) : 0);
  present.bind(8, entry.fence != nullptr ? 0 : 1);
  present.exec();
}

Result<Page<FenceSummary>> Fences::list(int limit, const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  const auto from = below(cursor);
  if (!from) return tl::unexpected<Error>(from.error());
  SQLite::Statement rows(db_,
                         "SELECT id, revision, name, areas, rally, active, updated_ns FROM fences "
                         "WHERE deleted = 0 AND (updated_ns, id) < (?, ?) "
                         "ORDER BY updated_ns DESC, id DESC LIMIT ?");
  rows.bind(1, from->updated_ns);
  rows.bind(2, from->id);
  rows.bind(3, limit + 1);
  Page<FenceSummary> page;
  std::int64_t last_ns = 0;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(last_ns) + '.' + page.items.back().id;
      break;
    }
    last_ns = rows.getColumn(6).getInt64();
    page.items.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getInt64(),
                          rows.getColumn(2).getString(), rows.getColumn(3).getInt(),
                          rows.getColumn(4).getInt(), rows.getColumn(5).getInt() != 0,
                          time_from(last_ns)});
  }
  return page;
}

Result<StoredFence> Fences::create(mission::Fence fence, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto made = add(std::move(fence), change, now);
  if (made) transaction.commit();
  return made;
}

Result<StoredFence> Fences::add(mission::Fence fence, const Change& change, WallTime now) {
  if (auto ok = mission::check_fence(fence); !ok) return tl::unexpected<Error>(ok.error());
  Head made{random_id(), 1, ns_from(now), false, false, {}};
  while (head(made.id, kAnyRevision, true)) made.id = random_id();
  add_revision(made, {change, "created", now, &fence});
  return StoredFence{made.id, 1, now, now, false, std::move(fence)};
}

Result<StoredFence> Fences::read(const std::string& id) {
  const auto found = head(id, kAnyRevision, false);
  if (!found) return tl::unexpected<Error>(found.error());
  return read_revision(id, found->revision);
}

Result<StoredFence> Fences::read_revision(const std::string& id, std::int64_t revision) {
  const auto found = head(id, kAnyRevision, true);
  if (!found) return tl::unexpected<Error>(found.error());
  const std::string which = "revision " + std::to_string(revision) + " of fence " + id;
  SQLite::Statement row(
      db_, "SELECT packed, time_ns FROM fence_revisions WHERE fence_id = ? AND revision = ?");
  row.bind(1, id);
  row.bind(2, revision);
  if (!row.executeStep()) return base::fail(Code::NotFound, "there is no " + which);
  const SQLite::Column packed = row.getColumn(0);
  if (packed.isNull()) return base::fail(Code::NotFound, which + " is its deletion");
  const auto text = unpack(
      {static_cast<const char*>(packed.getBlob()), static_cast<std::size_t>(packed.getBytes())});
  auto fence = text ? mission::fence_from_text(*text) : tl::unexpected<Error>(text.error());
  if (!fence) {
    return base::fail(Code::Unavailable, which + " cannot be read: " + fence.error().detail);
  }
  return StoredFence{id,
                     revision,
                     time_from(found->created_ns),
                     time_from(row.getColumn(1).getInt64()),
                     found->active,
                     std::move(*fence)};
}

Result<StoredFence> Fences::replace(const std::string& id, std::int64_t expected,
                                    mission::Fence fence, const Change& change, WallTime now) {
  if (auto ok = mission::check_fence(fence); !ok) return tl::unexpected<Error>(ok.error());
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto found = head(id, expected, false);
  if (!found) return tl::unexpected<Error>(found.error());
  if (auto ok = check_spared(*found, change); !ok) return tl::unexpected<Error>(ok.error());
  found->revision += 1;
  add_revision(*found, {change, "replaced", now, &fence});
  transaction.commit();
  return StoredFence{id,  found->revision, time_from(found->created_ns),
                     now, found->active,   std::move(fence)};
}

Result<void> Fences::remove(const std::string& id, std::int64_t expected, const Change& change,
                            WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto found = head(id, expected, false);
  if (!found) return tl::unexpected<Error>(found.error());
  if (found->active) {
    return base::fail(Code::Conflict, "the fence is the active one: make another one active first");
  }
  found->revision += 1;
  add_revision(*found, {change, "deleted", now, nullptr});
  transaction.commit();
  return {};
}

Result<StoredFence> Fences::revert(const std::string& id, std::int64_t expected,
                                   std::int64_t to_revision, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto found = head(id, expected, true);
  if (!found) return tl::unexpected<Error>(found.error());
  if (auto ok = check_spared(*found, change); !ok) return tl::unexpected<Error>(ok.error());
  auto old = read_revision(id, to_revision);
  if (!old) return old;
  found->revision += 1;
  add_revision(*found, {change, "reverted to " + std::to_string(to_revision), now, &old->fence});
  transaction.commit();
  old->revision = found->revision;
  old->updated = now;
  return old;
}

Result<Page<RevisionSummary>> Fences::list_revisions(const std::string& id, int limit,
                                                     const std::string& cursor) {
  if (const auto known = head(id, kAnyRevision, true); !known) {
    return tl::unexpected<Error>(known.error());
  }
  SQLite::Statement rows(db_,
                         "SELECT revision, time_ns, author, what, packed IS NULL, name, 0, 0.0 "
                         "FROM fence_revisions WHERE fence_id = ? AND revision < ? "
                         "ORDER BY revision DESC LIMIT ?");
  return revision_page(rows, id, limit, cursor);
}

Result<std::optional<StoredFence>> Fences::activate(const std::optional<std::string>& id) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  if (id) {
    if (const auto found = head(*id, kAnyRevision, false); !found) {
      return tl::unexpected<Error>(found.error());
    }
  }
  db_.exec("UPDATE fences SET active = 0 WHERE active = 1");
  if (id) {
    SQLite::Statement row(db_, "UPDATE fences SET active = 1 WHERE id = ?");
    row.bind(1, *id);
    row.exec();
  }
  transaction.commit();
  return active();
}

Result<std::optional<StoredFence>> Fences::active() {
  SQLite::Statement row(db_, "SELECT id FROM fences WHERE active = 1");
  if (!row.executeStep()) return std::nullopt;
  auto fence = read(row.getColumn(0).getString());
  if (!fence) return tl::unexpected<Error>(fence.error());
  return std::move(*fence);
}

}  // namespace roverd::store
