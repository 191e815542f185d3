#include "store/slips.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/angle.hpp"
#include "store/missions.hpp"

namespace roverd::store {
namespace {

constexpr double kDegree_m = 111'000.0;  // of latitude, rather too short than too long

std::int64_t ns_of(base::WallTime t) noexcept {
  return t.time_since_epoch().count();
}

/// Of the same kind and near enough; 0: none.
std::int64_t known_near(SQLite::Database& db, const Slip& slip) {
  const double lat = kSlipsMerge_m / kDegree_m;
  const double lon = lat / std::max(0.01, std::cos(base::rad_from_deg(slip.at.lat)));
  SQLite::Statement rows(db,
                         "SELECT id, lat, lon FROM slips WHERE kind = ? AND lat BETWEEN ? AND ? "
                         "AND lon BETWEEN ? AND ?");
  rows.bind(1, static_cast<int>(slip.kind));
  rows.bind(2, slip.at.lat - lat);
  rows.bind(3, slip.at.lat + lat);
  rows.bind(4, slip.at.lon - lon);
  rows.bind(5, slip.at.lon + lon);
  std::int64_t best = 0;
  double best_m = kSlipsMerge_m;
  while (rows.executeStep()) {
    const base::LatLon at{rows.getColumn(1).getDouble(), rows.getColumn(2).getDouble()};
    const double far_m = base::distance_bearing(slip.at, at).distance_m;
    if (far_m > best_m) continue;
    best_m = far_m;
    best = rows.getColumn(0).getInt64();
  }
  return best;
}

struct Cursor {
  std::int64_t time_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t id = std::numeric_limits<std::int64_t>::max();
};

std::optional<Cursor> cursor_from(const std::string& text) {
  Cursor c;
  if (text.empty()) return c;
  const char* end = text.data() + text.size();
  const auto [dot, bad] = std::from_chars(text.data(), end, c.time_ns);
  if (bad != std::errc{} || dot == end || *dot != '.') return std::nullopt;
  const auto [stop, wrong] = std::from_chars(dot + 1, end, c.id);
  if (wrong != std::errc{} || stop != end) return std::nullopt;
  return c;
}

}  // namespace

std::string_view to_string(SlipKind kind) noexcept {
  switch (kind) {
    case SlipKind::Slip:
      return "slip";
    case SlipKind::Side:
      return "side";
    case SlipKind::Dug:
      return "dug";
  }
  return "slip";
}

void note_slip(SQLite::Database& db, const Slip& slip) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  if (const std::int64_t id = known_near(db, slip); id != 0) {
    SQLite::Statement row(db,
                          "UPDATE slips SET time_ns = max(time_ns, ?), percent = max(percent, ?), "
                          "times = times + 1 WHERE id = ?");
    row.bind(1, ns_of(slip.time));
    row.bind(2, slip.percent);
    row.bind(3, id);
    row.exec();
  } else {
    SQLite::Statement row(
        db,
        "INSERT INTO slips (lat, lon, time_ns, kind, percent, times) VALUES (?, ?, ?, ?, ?, 1)");
    row.bind(1, slip.at.lat);
    row.bind(2, slip.at.lon);
    row.bind(3, ns_of(slip.time));
    row.bind(4, static_cast<int>(slip.kind));
    row.bind(5, slip.percent);
    row.exec();
    SQLite::Statement trim(db,
                           "DELETE FROM slips WHERE id IN (SELECT id FROM slips ORDER BY time_ns "
                           "DESC, id DESC LIMIT -1 OFFSET ?)");
    trim.bind(1, kMaxSlips);
    trim.exec();
  }
  transaction.commit();
}

base::Result<Page<Slip>> list_slips(SQLite::Database& db, const SlipFilter& filter, int limit,
                                    const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<base::Error>(ok.error());
  const auto from = cursor_from(cursor);
  if (!from) return base::fail(base::Code::Malformed, "the cursor is not one of ours");
  const Box box = filter.box.value_or(Box{});
  SQLite::Statement rows(db,
                         "SELECT id, lat, lon, time_ns, kind, percent, times FROM slips WHERE "
                         "(time_ns < ?1 OR (time_ns = ?1 AND id < ?2)) AND time_ns > ?3 AND lat "
                         "BETWEEN ?4 AND ?5 AND CASE WHEN ?6 <= ?7 THEN lon BETWEEN ?6 AND ?7 ELSE "
                         "lon >= ?6 OR lon <= ?7 END ORDER BY time_ns DESC, id DESC LIMIT ?8");
  rows.bind(1, from->time_ns);
  rows.bind(2, from->id);
  rows.bind(3, filter.since ? ns_of(*filter.since) : std::numeric_limits<std::int64_t>::min());
  rows.bind(4, box.south);
  rows.bind(5, box.north);
  rows.bind(6, box.west);
  rows.bind(7, box.east);
  rows.bind(8, limit + 1);
  Page<Slip> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      const Slip& last = page.items.back();
      page.next_cursor = std::to_string(ns_of(last.time)) + "." + std::to_string(last.id);
      break;
    }
    page.items.push_back({rows.getColumn(0).getInt64(),
                          {rows.getColumn(1).getDouble(), rows.getColumn(2).getDouble()},
                          base::WallTime(base::Duration(rows.getColumn(3).getInt64())),
                          static_cast<SlipKind>(rows.getColumn(4).getInt()),
                          rows.getColumn(5).getDouble(),
                          rows.getColumn(6).getInt()});
  }
  return page;
}

void clear_slips(SQLite::Database& db) {
  db.exec("DELETE FROM slips");
}

}  // namespace roverd::store
