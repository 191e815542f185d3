#include "store/missions.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <sys/random.h>

#include "mission/json.hpp"
#include "mission/text.hpp"
#include "store/teach.hpp"

namespace roverd::store {
namespace {

using base::Code;
using base::Error;
using base::Result;
using base::WallTime;

std::int64_t ns_from(WallTime time) noexcept {
  return time.time_since_epoch().count();
}
WallTime time_from(std::int64_t ns) noexcept {
  return WallTime(base::Duration(ns));
}

tl::unexpected<Error> not_found(const std::string& id) {
  return base::fail(Code::NotFound, "there is no mission " + mission::clean_name(id, "\"\""));
}

tl::unexpected<Error> bad_cursor() {
  return base::fail(Code::Malformed, "the cursor is not one of ours",
                    {{"cursor", "must be the next_cursor of an earlier answer"}});
}

tl::unexpected<Error> unreadable(const std::string& id, std::int64_t revision,
                                 const Error& problem) {
  return base::fail(Code::Unavailable, "the stored revision " + std::to_string(revision) +
                                           " of mission " + id +
                                           " cannot be read: " + problem.detail);
}

// Written out twice, because only then SQLite uses the partial indexes.
constexpr const char* kPresent =
    "SELECT id, revision, name, items, length_m, updated_ns FROM missions "
    "WHERE deleted = 0 AND (updated_ns, id) < (?, ?) ORDER BY updated_ns DESC, id DESC LIMIT ?";
constexpr const char* kDeleted =
    "SELECT id, revision, name, items, length_m, updated_ns FROM missions "
    "WHERE deleted = 1 AND (updated_ns, id) < (?, ?) ORDER BY updated_ns DESC, id DESC LIMIT ?";

}  // namespace

/// The present row of a mission.
struct Missions::Head {
  std::string id;
  std::int64_t revision = 0;
  std::int64_t created_ns = 0;
  bool deleted = false;
  std::string name;
};

/// A revision to be written.
struct Missions::Entry {
  std::int64_t time_ns = 0;
  std::string author;
  std::string what;
  std::string name;
  int items = 0;
  double length_m = 0.0;
  std::optional<std::string> plan;  ///< empty: a deletion

  Entry(const Change& change, std::string_view usual, WallTime now)
      : time_ns(ns_from(now)),
        author(mission::clean_name(change.author, "")),
        what(mission::clean_name(change.what, usual)) {}

  void hold(const mission::Plan& p) {
    name = p.name;
    items = static_cast<int>(p.items.size());
    length_m = mission::length_m(p);
    plan = mission::plan_to_text(p);
  }
};

std::optional<std::int64_t> number_from(std::string_view text) noexcept {
  std::int64_t value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Result<void> check_limit(int limit) {
  if (limit >= 1 && limit <= kMaxPage) return {};
  const std::string detail =
      "must be from 1 to " + std::to_string(kMaxPage) + ", is " + std::to_string(limit);
  return base::fail(Code::Invalid, "limit " + detail, {{"limit", detail}});
}

std::string random_id() {
  static constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";
  std::array<unsigned char, 12> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the kernel gives no random bytes");
  }
  std::string id;
  for (const unsigned char byte : bytes) id += kDigits[byte % kDigits.size()];
  return id;
}

Result<Page<MissionSummary>> Missions::list(int limit, const std::string& cursor, Which which) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  // A cursor is "<updated_ns>.<id>" of the last row given; the next page starts below it.
  std::int64_t updated_ns = std::numeric_limits<std::int64_t>::max();
  std::string id;
  if (!cursor.empty()) {
    const std::size_t dot = cursor.find('.');
    const auto number = number_from(std::string_view(cursor).substr(0, dot));
    if (dot == std::string::npos || !number) return bad_cursor();
    updated_ns = *number;
    id = cursor.substr(dot + 1);
  }
  SQLite::Statement rows(db_, which == Which::Present ? kPresent : kDeleted);
  rows.bind(1, updated_ns);
  rows.bind(2, id);
  rows.bind(3, limit + 1);  // one more shows whether there is a next page
  Page<MissionSummary> page;
  std::int64_t last_ns = 0;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(last_ns) + '.' + page.items.back().id;
      break;
    }
    last_ns = rows.getColumn(5).getInt64();
    page.items.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getInt64(),
                          rows.getColumn(2).getString(), rows.getColumn(3).getInt(),
                          rows.getColumn(4).getDouble(), time_from(last_ns)});
  }
  return page;
}

Result<Missions::Head> Missions::head(const std::string& id) {
  SQLite::Statement row(db_,
                        "SELECT revision, created_ns, deleted, name FROM missions WHERE id = ?");
  row.bind(1, id);
  if (!row.executeStep()) return not_found(id);
  return Head{id, row.getColumn(0).getInt64(), row.getColumn(1).getInt64(),
              row.getColumn(2).getInt() != 0, row.getColumn(3).getString()};
}

Result<Missions::Head> Missions::live_head(const std::string& id, std::int64_t expected) {
  auto found = head(id);
  if (!found) return found;
  if (found->deleted) return not_found(id);
  if (found->revision != expected) {
    return base::fail(Code::RevisionMismatch,
                      "the mission is at revision " + std::to_string(found->revision) +
                          ", the change was made to revision " + std::to_string(expected));
  }
  return found;
}

void Missions::add_revision(const Head& head, const Entry& entry) {
  SQLite::Statement revision(db_,
                             "INSERT INTO revisions (mission_id, revision, time_ns, author, what, "
                             "name, items, length_m, plan) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  revision.bind(1, head.id);
  revision.bind(2, head.revision);
  revision.bind(3, entry.time_ns);
  revision.bind(4, entry.author);
  revision.bind(5, entry.what);
  revision.bind(6, entry.name);
  revision.bind(7, entry.items);
  revision.bind(8, entry.length_m);
  if (entry.plan) revision.bindNoCopy(9, *entry.plan);
  revision.exec();
  SQLite::Statement present(
      db_,
      "INSERT INTO missions (id, revision, created_ns, updated_ns, name, items, length_m, deleted) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT (id) DO UPDATE SET revision = ?2, "
      "updated_ns = ?4, name = ?5, items = ?6, length_m = ?7, deleted = ?8");
  present.bind(1, head.id);
  present.bind(2, head.revision);
  present.bind(3, head.created_ns);
  present.bind(4, entry.time_ns);
  present.bind(5, entry.name);
  present.bind(6, entry.items);
  present.bind(7, entry.length_m);
  present.bind(8, entry.plan ? 0 : 1);
  present.exec();
}

Result<StoredMission> Missions::create(mission::Plan plan, const Change& change, WallTime now,
                                       Teach teach) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto made = add_mission(std::move(plan), change, now);
  if (made && teach == Teach::Ends) clear_teach(db_);
  if (made) transaction.commit();
  return made;
}

Result<StoredMission> Missions::add_mission(mission::Plan plan, const Change& change,
                                            WallTime now) {
  if (auto ok = mission::check_plan(plan); !ok) return tl::unexpected<Error>(ok.error());
  Entry entry(change, "created", now);
  entry.hold(plan);
  Head made{random_id(), 1, entry.time_ns, false, {}};
  while (head(made.id)) made.id = random_id();  // once in 2^60 missions
  add_revision(made, entry);
  return StoredMission{made.id, made.revision, now, now, std::move(plan)};
}

Result<StoredMission> Missions::read(const std::string& id) {
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (found->deleted) return not_found(id);
  return read_revision(id, found->revision);
}

Result<StoredMission> Missions::read_revision(const std::string& id, std::int64_t revision) {
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  SQLite::Statement row(
      db_, "SELECT time_ns, plan FROM revisions WHERE mission_id = ? AND revision = ?");
  row.bind(1, id);
  row.bind(2, revision);
  if (!row.executeStep()) {
    return base::fail(Code::NotFound,
                      "mission " + id + " has no revision " + std::to_string(revision));
  }
  const SQLite::Column text = row.getColumn(1);
  if (text.isNull()) {
    return base::fail(Code::NotFound, "revision " + std::to_string(revision) + " of mission " + id +
                                          " is its deletion and has no plan");
  }
  auto plan = mission::plan_from_text(
      std::string_view(text.getText(), static_cast<std::size_t>(text.getBytes())));
  if (!plan) return unreadable(id, revision, plan.error());
  return StoredMission{id, revision, time_from(found->created_ns),
                       time_from(row.getColumn(0).getInt64()), std::move(*plan)};
}

Result<StoredMission> Missions::replace(const std::string& id, std::int64_t expected,
                                        mission::Plan plan, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto changed = change_mission(id, expected, std::move(plan), change, now);
  if (changed) transaction.commit();
  return changed;
}

Result<StoredMission> Missions::change_mission(const std::string& id, std::int64_t expected,
                                               mission::Plan plan, const Change& change,
                                               WallTime now) {
  if (auto ok = mission::check_plan(plan); !ok) return tl::unexpected<Error>(ok.error());
  Entry entry(change, "replaced", now);
  entry.hold(plan);
  auto found = live_head(id, expected);
  if (!found) return tl::unexpected<Error>(found.error());
  found->revision += 1;
  add_revision(*found, entry);
  return StoredMission{id, found->revision, time_from(found->created_ns), now, std::move(plan)};
}

Result<Halves> Missions::split(const std::string& id, std::int64_t expected, mission::Plan first,
                               mission::Plan rest, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const std::string from = first.name;
  auto changed = change_mission(id, expected, std::move(first), change, now);
  if (!changed) return tl::unexpected<Error>(changed.error());
  auto made = add_mission(std::move(rest), {change.author, "split from " + from}, now);
  if (!made) return tl::unexpected<Error>(made.error());
  transaction.commit();
  return Halves{std::move(*changed), std::move(*made)};
}

Result<void> Missions::remove(const std::string& id, std::int64_t expected, const Change& change,
                              WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto found = live_head(id, expected);
  if (!found) return tl::unexpected<Error>(found.error());
  Entry entry(change, "deleted", now);
  entry.name = found->name;
  found->revision += 1;
  add_revision(*found, entry);
  transaction.commit();
  return {};
}

Result<Page<RevisionSummary>> Missions::list_revisions(const std::string& id, int limit,
                                                       const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  std::int64_t below = std::numeric_limits<std::int64_t>::max();
  if (!cursor.empty()) {
    const auto number = number_from(cursor);
    if (!number) return bad_cursor();
    below = *number;
  }
  if (const auto found = head(id); !found) return tl::unexpected<Error>(found.error());
  SQLite::Statement rows(db_,
                         "SELECT revision, time_ns, author, what, plan IS NULL, name, items, "
                         "length_m FROM revisions WHERE mission_id = ? AND revision < ? "
                         "ORDER BY revision DESC LIMIT ?");
  rows.bind(1, id);
  rows.bind(2, below);
  rows.bind(3, limit + 1);
  Page<RevisionSummary> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(page.items.back().revision);
      break;
    }
    page.items.push_back({rows.getColumn(0).getInt64(), time_from(rows.getColumn(1).getInt64()),
                          rows.getColumn(2).getString(), rows.getColumn(3).getString(),
                          rows.getColumn(4).getInt() != 0, rows.getColumn(5).getString(),
                          rows.getColumn(6).getInt(), rows.getColumn(7).getDouble()});
  }
  return page;
}

Result<StoredMission> Missions::bring_back(const Head& head, std::int64_t revision, Entry entry) {
  auto old = read_revision(head.id, revision);
  if (!old) return old;
  entry.hold(old->plan);
  Head next = head;
  next.revision += 1;
  add_revision(next, entry);
  old->revision = next.revision;
  old->updated = time_from(entry.time_ns);
  return old;
}

Result<StoredMission> Missions::revert(const std::string& id, std::int64_t to_revision,
                                       const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  auto back =
      bring_back(*found, to_revision, {change, "reverted to " + std::to_string(to_revision), now});
  if (back) transaction.commit();
  return back;
}

Result<StoredMission> Missions::restore(const std::string& id, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (!found->deleted) return base::fail(Code::Conflict, "the mission is not deleted");
  auto back = bring_back(*found, found->revision - 1, {change, "restored", now});
  if (back) transaction.commit();
  return back;
}

void Missions::forget_deleted(WallTime then) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  for (const char* sql : {"DELETE FROM revisions WHERE mission_id IN "
                          "(SELECT id FROM missions WHERE deleted = 1 AND updated_ns < ?)",
                          "DELETE FROM missions WHERE deleted = 1 AND updated_ns < ?"}) {
    SQLite::Statement rows(db_, sql);
    rows.bind(1, ns_from(then));
    rows.exec();
  }
  transaction.commit();
}

}  // namespace roverd::store
