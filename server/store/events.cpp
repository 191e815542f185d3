#include "store/events.hpp"

#include <limits>
#include <string>

#include "store/missions.hpp"

namespace roverd::store {
namespace {

using base::Severity;

/// Written out, because only then SQLite uses the partial indexes.
const char* level_condition(Severity least) noexcept {
  switch (least) {
    case Severity::Info:
      return "";
    case Severity::Warning:
      return "AND level >= 1 ";
    case Severity::Error:
      return "AND level >= 2 ";
  }
  return "";
}

Severity severity_from(int level) noexcept {
  if (level <= 0) return Severity::Info;
  return level == 1 ? Severity::Warning : Severity::Error;
}

}  // namespace

void write_events(SQLite::Database& db, std::span<const base::Event> events,
                  std::int64_t max_events) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement row(db,
                        "INSERT INTO events (time_ns, level, kind, detail) VALUES (?, ?, ?, ?)");
  for (const base::Event& event : events) {
    row.bind(1, std::int64_t{event.wall.time_since_epoch().count()});
    row.bind(2, static_cast<int>(event.level));
    row.bind(3, event.kind);
    row.bind(4, event.detail);
    row.exec();
    row.reset();
  }
  SQLite::Statement trim(db, "DELETE FROM events WHERE id <= (SELECT max(id) FROM events) - ?");
  trim.bind(1, max_events);
  trim.exec();
  transaction.commit();
}

void forget_events(SQLite::Database& db, base::WallTime before) {
  const auto ns = [](base::WallTime t) { return std::int64_t{t.time_since_epoch().count()}; };
  SQLite::Statement rows(db,
                         "DELETE FROM events WHERE id <= (SELECT max(id) FROM events WHERE "
                         "time_ns >= ?1 AND time_ns < ?2 AND id < ifnull((SELECT min(id) FROM "
                         "events WHERE time_ns >= ?2), ?3))");
  rows.bind(1, ns(base::kYoungest));
  rows.bind(2, ns(before));
  rows.bind(3, std::numeric_limits<std::int64_t>::max());
  rows.exec();
}

base::Result<Page<StoredEvent>> list_events(SQLite::Database& db, std::int64_t after_id,
                                            Severity level, int limit) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<base::Error>(ok.error());
  SQLite::Statement rows(db,
                         std::string("SELECT id, time_ns, level, kind, detail FROM events WHERE "
                                     "id > ? ") +
                             level_condition(level) + "ORDER BY id LIMIT ?");
  rows.bind(1, after_id);
  rows.bind(2, limit + 1);
  Page<StoredEvent> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(page.items.back().id);
      break;
    }
    page.items.push_back({rows.getColumn(0).getInt64(),
                          {base::WallTime(base::Duration(rows.getColumn(1).getInt64())),
                           severity_from(rows.getColumn(2).getInt()), rows.getColumn(3).getString(),
                           rows.getColumn(4).getString()}});
  }
  return page;
}

}  // namespace roverd::store
