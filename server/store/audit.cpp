#include "store/audit.hpp"

#include <algorithm>
#include <string>

#include "store/store_impl.hpp"

namespace roverd::store {

namespace {

constexpr const char* kColumns =
    "id, time_ns, user, credential, address, call, target, status, detail, times, hash";

struct Link {
  std::int64_t id = 0;
  std::string hash;
};

Link cut_of(SQLite::Database& db) {
  SQLite::Statement row(db, "SELECT id, hash FROM audit_cut");
  if (!row.executeStep()) return {};
  return {row.getColumn(0).getInt64(), row.getColumn(1).getString()};
}

Link last_of(SQLite::Database& db) {
  SQLite::Statement row(db, "SELECT id, hash FROM audit ORDER BY id DESC LIMIT 1");
  if (row.executeStep()) return {row.getColumn(0).getInt64(), row.getColumn(1).getString()};
  return cut_of(db);
}

people::KeptDeed kept_in(SQLite::Statement& row) {
  people::KeptDeed out;
  out.id = row.getColumn(0).getInt64();
  out.deed.time = base::WallTime(base::Duration(row.getColumn(1).getInt64()));
  out.deed.user = row.getColumn(2).getString();
  out.deed.credential = row.getColumn(3).getString();
  out.deed.address = row.getColumn(4).getString();
  out.deed.call = row.getColumn(5).getString();
  out.deed.target = row.getColumn(6).getString();
  out.deed.status = row.getColumn(7).getInt();
  out.deed.detail = row.getColumn(8).getString();
  out.deed.times = row.getColumn(9).getInt();
  out.hash = row.getColumn(10).getString();
  return out;
}

}  // namespace

void write_audit(SQLite::Database& db, std::span<const people::Deed> deeds) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  Link last = last_of(db);
  SQLite::Statement row(db, std::string("INSERT INTO audit (") + kColumns +
                                ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const people::Deed& raw : deeds) {
    const people::Deed deed = people::tidied(raw);
    ++last.id;
    last.hash = people::chained(last.hash, last.id, deed);
    row.bind(1, last.id);
    row.bind(2, std::int64_t{deed.time.time_since_epoch().count()});
    row.bind(3, deed.user);
    row.bind(4, deed.credential);
    row.bind(5, deed.address);
    row.bind(6, deed.call);
    row.bind(7, deed.target);
    row.bind(8, deed.status);
    row.bind(9, deed.detail);
    row.bind(10, deed.times);
    row.bind(11, last.hash);
    row.exec();
    row.reset();
  }
  transaction.commit();
}

void cut_audit(SQLite::Database& db, std::int64_t max_bytes) {
  // What a row has beside its texts: numbers, hash, its place in the page.
  constexpr const char* kSize =
      "(120 + length(user) + length(credential) + length(address) + length(call) + "
      "length(target) + length(detail))";
  SQLite::Statement all(db, std::string("SELECT ifnull(sum(") + kSize + "), 0) FROM audit");
  all.executeStep();
  if (all.getColumn(0).getInt64() <= max_bytes) return;
  SQLite::Statement newest(db, std::string("SELECT id, hash, sum(") + kSize +
                                   ") OVER (ORDER BY id DESC) AS held FROM audit "
                                   "ORDER BY id DESC");
  Link cut;
  while (newest.executeStep()) {
    if (newest.getColumn(2).getInt64() <= max_bytes / 4 * 3) continue;
    cut = {newest.getColumn(0).getInt64(), newest.getColumn(1).getString()};
    break;
  }
  newest.reset();
  if (cut.id == 0) return;
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement mark(db, "UPDATE audit_cut SET id = ?, hash = ?");
  mark.bind(1, cut.id);
  mark.bind(2, cut.hash);
  mark.exec();
  SQLite::Statement gone(db, "DELETE FROM audit WHERE id <= ?");
  gone.bind(1, cut.id);
  gone.exec();
  transaction.commit();
}

base::Result<Page<people::KeptDeed>> list_audit(SQLite::Database& db, const AuditFilter& filter,
                                                std::int64_t before_id, int limit) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<base::Error>(ok.error());
  const auto ns = [](base::WallTime t) { return std::int64_t{t.time_since_epoch().count()}; };
  std::string sql = std::string("SELECT ") + kColumns + " FROM audit WHERE id < :before ";
  if (filter.user) sql += "AND user = :user ";
  if (filter.address) sql += "AND address = :address ";
  if (filter.call) sql += "AND instr(call, :call) > 0 ";
  if (filter.from) sql += "AND time_ns >= :from ";
  if (filter.to) sql += "AND time_ns < :to ";
  if (filter.refused) sql += *filter.refused ? "AND status >= 400 " : "AND status < 400 ";
  SQLite::Statement rows(db, sql + "ORDER BY id DESC LIMIT :limit");
  rows.bind(":before", before_id);
  if (filter.user) rows.bind(":user", *filter.user);
  if (filter.address) rows.bind(":address", *filter.address);
  if (filter.call) rows.bind(":call", *filter.call);
  if (filter.from) rows.bind(":from", ns(*filter.from));
  if (filter.to) rows.bind(":to", ns(*filter.to));
  rows.bind(":limit", limit + 1);
  Page<people::KeptDeed> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(page.items.back().id);
      break;
    }
    page.items.push_back(kept_in(rows));
  }
  return page;
}

AuditStretch read_audit(SQLite::Database& db, std::int64_t after_id, int limit) {
  AuditStretch out;
  Link before = cut_of(db);
  if (after_id > before.id) {
    SQLite::Statement row(db, "SELECT id, hash FROM audit WHERE id = ?");
    row.bind(1, after_id);
    // A row that is missing is a break: what follows it hangs on nothing.
    before = {after_id, row.executeStep() ? row.getColumn(1).getString() : "missing"};
  }
  out.before_id = before.id;
  out.before_hash = before.hash;
  SQLite::Statement rows(
      db, std::string("SELECT ") + kColumns + " FROM audit WHERE id > ? ORDER BY id LIMIT ?");
  rows.bind(1, before.id);
  rows.bind(2, limit);
  while (rows.executeStep()) out.rows.push_back(kept_in(rows));
  return out;
}

void Store::Impl::write_deeds(const std::vector<people::Deed>& list) {
  const auto done = kept([&]() -> base::Result<void> {
    store::write_audit(db->connection, list);
    return {};
  });
  if (!done) {
    for (const people::Deed& deed : list) lost_deeds += static_cast<std::uint64_t>(deed.times);
    return;
  }
  deeds_since_cut += list.size();
  if (deeds_since_cut < kCutEvery) return;
  deeds_since_cut = 0;
  (void)kept([&]() -> base::Result<void> {
    cut_audit(db->connection, options.max_audit_bytes);
    return {};
  });
}

void Store::add_deed(people::Deed deed) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->deeds.size() >= impl_->options.queue) {
      impl_->lost_deeds += static_cast<std::uint64_t>(deed.times);
      return;
    }
    // Told with the next one that is kept.
    if (const std::uint64_t lost = impl_->lost_deeds.exchange(0); lost > 0) {
      people::Deed told;
      told.time = deed.time;
      told.call = "LOST";
      told.status = 503;
      told.detail = "calls that could not be written down: too many at once, or the disk refused";
      told.times = static_cast<int>(std::min<std::uint64_t>(lost, 1'000'000'000));
      impl_->deeds.push_back(std::move(told));
    }
    impl_->deeds.push_back(std::move(deed));
  }
  impl_->news.notify_one();
}

void Store::list_audit(AuditFilter filter, std::int64_t before_id, int limit,
                       Reply<Page<people::KeptDeed>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), filter = std::move(filter), before_id, limit] {
               return store::list_audit(impl->db->connection, filter, before_id, limit);
             });
}

void Store::read_audit(std::int64_t after_id, int limit, Reply<AuditStretch> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), after_id, limit]() -> base::Result<AuditStretch> {
               return store::read_audit(impl->db->connection, after_id, limit);
             });
}

}  // namespace roverd::store
