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

#include "mission/json/json.hpp"
#include "mission/text.hpp"
#include "store/mission_entry.hpp"
#include "store/packed.hpp"
#include "store/teach.hpp"

namespace roverd::store {
namespace {

using base::Code;
using base::Error;
using base::Result;
using base::WallTime;

tl::unexpected<Error> not_found(const std::string& id) {
  return tl::unexpected<Error>(no_such_mission(id));
}

tl::unexpected<Error> unreadable(const std::string& id, std::int64_t revision,
                                 const Error& problem) {
  return base::fail(Code::Unavailable, "the stored revision " + std::to_string(revision) +
                                           " of mission " + id +
                                           " cannot be read: " + problem.detail);
}

}  // namespace

Error bad_cursor() {
  return {Code::Malformed,
          "the cursor is not one of ours",
          {{"cursor", "must be the next_cursor of an earlier answer"}}};
}

Result<std::int64_t> below_number(const std::string& cursor) {
  if (cursor.empty()) return std::numeric_limits<std::int64_t>::max();
  const auto number = number_from(cursor);
  if (!number) return tl::unexpected<Error>(bad_cursor());
  return *number;
}

Error no_such_mission(const std::string& id) {
  return {Code::NotFound, "there is no mission " + mission::clean_name(id, "\"\""), {}};
}

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

Result<Missions::Head> Missions::head(const std::string& id) {
  SQLite::Statement row(
      db_, "SELECT revision, created_ns, deleted, archived, name FROM missions WHERE id = ?");
  row.bind(1, id);
  if (!row.executeStep()) return not_found(id);
  return Head{id,
              row.getColumn(0).getInt64(),
              row.getColumn(1).getInt64(),
              row.getColumn(2).getInt() != 0,
              row.getColumn(3).getInt() != 0,
              row.getColumn(4).getString()};
}

Result<Missions::Head> Missions::matching_head(const std::string& id, std::int64_t expected) {
  auto found = head(id);
  if (found && expected != kAnyRevision && found->revision != expected) {
    return base::fail(Code::RevisionMismatch,
                      "the mission is at revision " + std::to_string(found->revision) +
                          ", the change was made to revision " + std::to_string(expected));
  }
  return found;
}

Result<Missions::Head> Missions::live_head(const std::string& id, std::int64_t expected) {
  const auto present = head(id);
  if (present && present->deleted) return not_found(id);
  return matching_head(id, expected);
}

std::vector<std::string> Missions::tags_of(const std::string& id) {
  SQLite::Statement rows(db_, "SELECT tag FROM mission_tags WHERE mission_id = ? ORDER BY tag");
  rows.bind(1, id);
  std::vector<std::string> tags;
  while (rows.executeStep()) tags.push_back(rows.getColumn(0).getString());
  return tags;
}

Result<Missions::Text> Missions::text_of(const std::string& id, std::int64_t revision) {
  SQLite::Statement row(
      db_,
      "SELECT plan, packed, base, time_ns FROM revisions WHERE mission_id = ? AND revision = ?");
  row.bind(1, id);
  row.bind(2, revision);
  if (!row.executeStep()) {
    return base::fail(Code::NotFound,
                      "mission " + id + " has no revision " + std::to_string(revision));
  }
  const auto bytes = [&row](int column) {
    const SQLite::Column value = row.getColumn(column);
    const void* begin = value.getBlob();
    return std::string_view(static_cast<const char*>(begin),
                            begin == nullptr ? 0 : static_cast<std::size_t>(value.getBytes()));
  };
  Text out;
  out.time_ns = row.getColumn(3).getInt64();
  if (!row.getColumn(0).isNull()) {
    out.text = bytes(0);
    out.kept_bytes = out.text.size();
    return out;
  }
  out.deletion = row.getColumn(1).isNull();
  if (out.deletion) return out;
  out.kept_bytes = bytes(1).size();
  out.whole = row.getColumn(2).isNull();
  std::string prefix;
  if (!out.whole) {
    auto other = text_of(id, row.getColumn(2).getInt64());
    if (!other) return unreadable(id, revision, other.error());
    prefix = std::move(other->text);
  }
  auto text = unpack(bytes(1), prefix);
  if (!text) return unreadable(id, revision, text.error());
  out.text = std::move(*text);
  return out;
}

/// As it is, or, if that is much shorter, against the last whole revision.
void Missions::bind_plan(SQLite::Statement& row, const Head& head, const Entry& entry) {
  SQLite::Statement last(db_,
                         "SELECT revision FROM revisions WHERE mission_id = ? AND (plan IS NOT "
                         "NULL OR (packed IS NOT NULL AND base IS NULL)) "
                         "ORDER BY revision DESC LIMIT 1");
  last.bind(1, head.id);
  if (last.executeStep()) {
    const std::int64_t base_revision = last.getColumn(0).getInt64();
    // What cannot be read is no base; the new revision stands for itself then.
    const auto whole = text_of(head.id, base_revision);
    const std::string packed = whole ? pack(*entry.plan, whole->text) : std::string();
    constexpr std::size_t kFew = 256;
    if (whole && packed.size() * 2 < std::max(whole->kept_bytes, kFew)) {
      row.bind(9, packed.data(), static_cast<int>(packed.size()));
      row.bind(10, base_revision);
      return;
    }
  }
  const std::string packed = pack(*entry.plan);
  row.bind(9, packed.data(), static_cast<int>(packed.size()));
}

void Missions::add_revision(const Head& head, const Entry& entry) {
  SQLite::Statement revision(db_,
                             "INSERT INTO revisions (mission_id, revision, time_ns, author, what, "
                             "name, items, length_m, packed, base) "
                             "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  revision.bind(1, head.id);
  revision.bind(2, head.revision);
  revision.bind(3, entry.time_ns);
  revision.bind(4, entry.author);
  revision.bind(5, entry.what);
  revision.bind(6, entry.name);
  revision.bind(7, entry.items);
  revision.bind(8, entry.length_m);
  if (entry.plan) bind_plan(revision, head, entry);
  revision.exec();
  SQLite::Statement present(
      db_,
      "INSERT INTO missions (id, revision, created_ns, updated_ns, name, items, length_m, deleted, "
      "archived, search) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) "
      "ON CONFLICT (id) DO UPDATE SET revision = ?2, updated_ns = ?4, name = ?5, items = ?6, "
      "length_m = ?7, deleted = ?8, archived = ?9, search = ?10");
  present.bind(1, head.id);
  present.bind(2, head.revision);
  present.bind(3, head.created_ns);
  present.bind(4, entry.time_ns);
  present.bind(5, entry.name);
  present.bind(6, entry.items);
  present.bind(7, entry.length_m);
  present.bind(8, entry.plan ? 0 : 1);
  present.bind(9, head.archived ? 1 : 0);
  present.bind(10, mission::folded(entry.name));
  present.exec();
  keep_tags(head, entry);
}

void Missions::keep_tags(const Head& head, const Entry& entry) {
  const auto tags = entry.tags ? *entry.tags : tags_of(head.id);
  SQLite::Statement old(db_, "DELETE FROM mission_tags WHERE mission_id = ?");
  old.bind(1, head.id);
  old.exec();
  for (const std::string& tag : tags) {
    SQLite::Statement row(
        db_, "INSERT INTO mission_tags (tag, updated_ns, mission_id) VALUES (?, ?, ?)");
    row.bind(1, tag);
    row.bind(2, entry.time_ns);
    row.bind(3, head.id);
    row.exec();
  }
}

Result<StoredMission> Missions::create(mission::Plan plan, const Change& change, WallTime now,
                                       Teach teach) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto made = add_mission(std::move(plan), {change, "created", now});
  if (made && teach == Teach::Ends) clear_teach(db_);
  if (made) transaction.commit();
  return made;
}

Result<StoredMission> Missions::add(mission::Plan plan, const Change& change, WallTime now) {
  return add_mission(std::move(plan), {change, "created", now});
}

Result<StoredMission> Missions::add_mission(mission::Plan plan, const Entry& given) {
  if (auto ok = mission::check_plan(plan); !ok) return tl::unexpected<Error>(ok.error());
  Entry entry = given;
  entry.hold(plan);
  Head made{random_id(), 1, entry.time_ns, false, false, {}};
  while (head(made.id)) made.id = random_id();  // once in 2^60 missions
  add_revision(made, entry);
  const WallTime now = time_from(entry.time_ns);
  return StoredMission{made.id,
                       made.revision,
                       now,
                       now,
                       std::move(plan),
                       false,
                       entry.tags.value_or(std::vector<std::string>{})};
}

Result<StoredMission> Missions::read(const std::string& id) {
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (found->deleted) return not_found(id);
  return read_revision(id, found->revision);
}

Result<mission::Plan> Missions::plan_of(const std::string& id, std::int64_t revision,
                                        std::int64_t& time_ns) {
  const auto text = text_of(id, revision);
  if (!text) return tl::unexpected<Error>(text.error());
  if (text->deletion) {
    return base::fail(Code::NotFound, "revision " + std::to_string(revision) + " of mission " + id +
                                          " is its deletion and has no plan");
  }
  time_ns = text->time_ns;
  auto plan = mission::plan_from_text(text->text);
  if (!plan) return unreadable(id, revision, plan.error());
  return plan;
}

Result<StoredMission> Missions::read_revision(const std::string& id, std::int64_t revision) {
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  std::int64_t time_ns = 0;
  auto plan = plan_of(id, revision, time_ns);
  if (!plan) return tl::unexpected<Error>(plan.error());
  return StoredMission{id,
                       revision,
                       time_from(found->created_ns),
                       time_from(time_ns),
                       std::move(*plan),
                       found->archived,
                       tags_of(id)};
}

Result<StoredMission> Missions::replace(const std::string& id, std::int64_t expected,
                                        mission::Plan plan, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto changed = change_mission(id, expected, std::move(plan), {change, "replaced", now});
  if (changed) transaction.commit();
  return changed;
}

Result<StoredMission> Missions::change_mission(const std::string& id, std::int64_t expected,
                                               mission::Plan plan, Entry entry) {
  if (auto ok = mission::check_plan(plan); !ok) return tl::unexpected<Error>(ok.error());
  entry.hold(plan);
  auto found = live_head(id, expected);
  if (!found) return tl::unexpected<Error>(found.error());
  found->revision += 1;
  add_revision(*found, entry);
  return StoredMission{id,
                       found->revision,
                       time_from(found->created_ns),
                       time_from(entry.time_ns),
                       std::move(plan),
                       found->archived,
                       tags_of(id)};
}

Result<Halves> Missions::split(const std::string& id, std::int64_t expected, mission::Plan first,
                               mission::Plan rest, const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const std::string from = first.name;
  auto changed = change_mission(id, expected, std::move(first), {change, "replaced", now});
  if (!changed) return tl::unexpected<Error>(changed.error());
  Entry part({change.author, "split from " + from}, "", now);
  part.tags = changed->tags;
  auto made = add_mission(std::move(rest), part);
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

Result<StoredMission> Missions::revert(const std::string& id, std::int64_t expected,
                                       std::int64_t to_revision, const Change& change,
                                       WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const auto found = matching_head(id, expected);
  if (!found) return tl::unexpected<Error>(found.error());
  auto back =
      bring_back(*found, to_revision, {change, "reverted to " + std::to_string(to_revision), now});
  if (back) transaction.commit();
  return back;
}

Result<StoredMission> Missions::restore(const std::string& id, std::int64_t expected,
                                        const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  const auto found = head(id);
  if (!found) return tl::unexpected<Error>(found.error());
  if (!found->deleted) return base::fail(Code::Conflict, "the mission is not deleted");
  if (auto ok = matching_head(id, expected); !ok) return tl::unexpected<Error>(ok.error());
  auto back = bring_back(*found, found->revision - 1, {change, "restored", now});
  if (back) transaction.commit();
  return back;
}

void Missions::forget_deleted(WallTime then) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  for (const char* sql : {"DELETE FROM mission_tags WHERE mission_id IN "
                          "(SELECT id FROM missions WHERE deleted = 1 AND updated_ns < ?)",
                          "DELETE FROM revisions WHERE mission_id IN "
                          "(SELECT id FROM missions WHERE deleted = 1 AND updated_ns < ?)",
                          "DELETE FROM missions WHERE deleted = 1 AND updated_ns < ?"}) {
    SQLite::Statement rows(db_, sql);
    rows.bind(1, ns_from(then));
    rows.exec();
  }
  transaction.commit();
}

}  // namespace roverd::store
