#include "store/teach.hpp"

namespace roverd::store {

using base::Code;
using base::Result;

namespace {

bool has_teach(SQLite::Database& db) {
  return db.execAndGet("SELECT count(*) FROM teach").getInt() > 0;
}

}  // namespace

Result<void> begin_teach(SQLite::Database& db, const TeachRecord& record) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  if (has_teach(db)) return base::fail(Code::Conflict, "a recording is there already");
  SQLite::Statement row(db,
                        "INSERT INTO teach (id, started_ns, name, step_m, heading_deg, "
                        "tolerance_m, sigma_max_m) VALUES (1, ?, ?, ?, ?, ?, ?)");
  row.bind(1, std::int64_t{record.started.time_since_epoch().count()});
  row.bind(2, record.name);
  row.bind(3, record.settings.step_m);
  row.bind(4, record.settings.heading_deg);
  row.bind(5, record.settings.tolerance_m);
  row.bind(6, record.settings.sigma_max_m);
  row.exec();
  transaction.commit();
  return {};
}

Result<void> add_teach_points(SQLite::Database& db,
                              const std::vector<mission::TaughtPoint>& points) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  if (!has_teach(db)) return base::fail(Code::Conflict, "no recording was begun");
  SQLite::Statement row(db,
                        "INSERT INTO teach_points (lat, lon, heading_deg, speed_mps, reverse, gap) "
                        "VALUES (?, ?, ?, ?, ?, ?)");
  for (const mission::TaughtPoint& p : points) {
    row.bind(1, p.at.lat);
    row.bind(2, p.at.lon);
    row.bind(3, p.heading_deg);
    row.bind(4, p.speed_mps);
    row.bind(5, p.reverse ? 1 : 0);
    row.bind(6, p.gap ? 1 : 0);
    row.exec();
    row.reset();
  }
  transaction.commit();
  return {};
}

std::optional<TeachRecord> read_teach(SQLite::Database& db) {
  SQLite::Statement head(db,
                         "SELECT started_ns, name, step_m, heading_deg, tolerance_m, sigma_max_m "
                         "FROM teach");
  if (!head.executeStep()) return std::nullopt;
  TeachRecord record;
  record.started = base::WallTime(base::Duration(head.getColumn(0).getInt64()));
  record.name = head.getColumn(1).getString();
  record.settings = {head.getColumn(2).getDouble(), head.getColumn(3).getDouble(),
                     head.getColumn(4).getDouble(), head.getColumn(5).getDouble()};
  SQLite::Statement rows(db,
                         "SELECT lat, lon, heading_deg, speed_mps, reverse, gap FROM teach_points "
                         "ORDER BY number");
  while (rows.executeStep()) {
    record.points.push_back({{rows.getColumn(0).getDouble(), rows.getColumn(1).getDouble()},
                             rows.getColumn(2).getDouble(),
                             rows.getColumn(3).getDouble(),
                             rows.getColumn(4).getInt() != 0,
                             rows.getColumn(5).getInt() != 0});
  }
  return record;
}

void clear_teach(SQLite::Database& db) {
  db.exec("DELETE FROM teach_points");
  db.exec("DELETE FROM teach");
}

}  // namespace roverd::store
