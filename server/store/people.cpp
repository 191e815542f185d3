#include "store/people.hpp"

#include <sstream>
#include <string>

#include "store/store_impl.hpp"

namespace roverd::store {

namespace {

using people::Device;
using people::Session;
using people::Token;
using people::User;

std::int64_t kept_ns(base::WallTime time) {
  return time.time_since_epoch().count();
}

base::WallTime wall_of(const SQLite::Column& column) {
  return base::WallTime(base::Duration(column.getInt64()));
}

std::optional<base::WallTime> maybe_wall_of(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(wall_of(column));
}

people::Role role_in(const SQLite::Column& column) {
  return people::role_of(column.getString()).value_or(people::Role::Viewer);
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> out;
  for (std::string word; words >> word;) out.push_back(word);
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

void bind_time(SQLite::Statement& row, int at, const std::optional<base::WallTime>& time) {
  if (time) return row.bind(at, kept_ns(*time));
  row.bind(at);
}

void keep(SQLite::Database& db, const User& user) {
  SQLite::Statement row(db,
                        "INSERT INTO users (name, role, password, created_ns) VALUES (?, ?, ?, ?) "
                        "ON CONFLICT (name) DO UPDATE SET role = excluded.role, "
                        "password = excluded.password");
  row.bind(1, user.name);
  row.bind(2, std::string(people::to_string(user.role)));
  row.bind(3, user.password);
  row.bind(4, kept_ns(user.created));
  row.exec();
}

void keep(SQLite::Database& db, const Session& s) {
  SQLite::Statement row(db,
                        "INSERT INTO sessions (id, hash, user, device, address, created_ns, "
                        "seen_ns, paired) VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (id) DO "
                        "UPDATE SET created_ns = excluded.created_ns, seen_ns = excluded.seen_ns, "
                        "paired = excluded.paired");
  row.bind(1, s.id);
  row.bind(2, s.hash);
  row.bind(3, s.user);
  row.bind(4, s.device);
  row.bind(5, s.address);
  row.bind(6, kept_ns(s.created));
  row.bind(7, kept_ns(s.seen));
  if (s.paired.empty())
    row.bind(8);
  else
    row.bind(8, s.paired);
  row.exec();
}

void keep(SQLite::Database& db, const Token& t) {
  SQLite::Statement row(db,
                        "INSERT INTO tokens (id, hash, name, user, role, methods, created_ns, "
                        "expires_ns, used_ns) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) "
                        "ON CONFLICT (id) DO UPDATE SET used_ns = excluded.used_ns");
  row.bind(1, t.id);
  row.bind(2, t.hash);
  row.bind(3, t.name);
  row.bind(4, t.user);
  row.bind(5, std::string(people::to_string(t.role)));
  row.bind(6, joined(t.methods));
  row.bind(7, kept_ns(t.created));
  bind_time(row, 8, t.expires);
  bind_time(row, 9, t.used);
  row.exec();
}

void keep(SQLite::Database& db, const Device& d) {
  SQLite::Statement row(db,
                        "INSERT INTO devices (id, hash, user, name, role, pin, wrong, created_ns, "
                        "used_ns) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (id) DO UPDATE "
                        "SET wrong = excluded.wrong, used_ns = excluded.used_ns");
  row.bind(1, d.id);
  row.bind(2, d.hash);
  row.bind(3, d.user);
  row.bind(4, d.name);
  row.bind(5, std::string(people::to_string(d.role)));
  row.bind(6, d.pin);
  row.bind(7, d.wrong);
  row.bind(8, kept_ns(d.created));
  bind_time(row, 9, d.used);
  row.exec();
}

void read_devices(SQLite::Database& db, std::vector<Device>& out) {
  SQLite::Statement row(db,
                        "SELECT id, hash, user, name, role, pin, wrong, created_ns, used_ns "
                        "FROM devices ORDER BY created_ns, id");
  while (row.executeStep()) {
    out.push_back(
        {row.getColumn(0).getString(), row.getColumn(1).getString(), row.getColumn(2).getString(),
         row.getColumn(3).getString(), role_in(row.getColumn(4)), row.getColumn(5).getString(),
         row.getColumn(6).getInt(), wall_of(row.getColumn(7)), maybe_wall_of(row.getColumn(8))});
  }
}

void drop(SQLite::Database& db, const char* sql, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    SQLite::Statement row(db, sql);
    row.bind(1, key);
    row.exec();
  }
}

}  // namespace

people::Everybody read_people(SQLite::Database& db) {
  people::Everybody out;
  SQLite::Statement users(db, "SELECT name, role, password, created_ns FROM users ORDER BY name");
  while (users.executeStep()) {
    out.users.push_back({users.getColumn(0).getString(), role_in(users.getColumn(1)),
                         users.getColumn(2).getString(), wall_of(users.getColumn(3))});
  }
  SQLite::Statement sessions(db,
                             "SELECT id, hash, user, device, address, created_ns, seen_ns, "
                             "ifnull(paired, '') FROM sessions ORDER BY created_ns, id");
  while (sessions.executeStep()) {
    out.sessions.push_back({sessions.getColumn(0).getString(), sessions.getColumn(1).getString(),
                            sessions.getColumn(2).getString(), sessions.getColumn(3).getString(),
                            sessions.getColumn(4).getString(), wall_of(sessions.getColumn(5)),
                            wall_of(sessions.getColumn(6)), sessions.getColumn(7).getString()});
  }
  SQLite::Statement tokens(db,
                           "SELECT id, hash, name, user, role, methods, created_ns, expires_ns, "
                           "used_ns FROM tokens ORDER BY created_ns, id");
  while (tokens.executeStep()) {
    out.tokens.push_back({tokens.getColumn(0).getString(), tokens.getColumn(1).getString(),
                          tokens.getColumn(2).getString(), tokens.getColumn(3).getString(),
                          role_in(tokens.getColumn(4)), words_of(tokens.getColumn(5).getString()),
                          wall_of(tokens.getColumn(6)), maybe_wall_of(tokens.getColumn(7)),
                          maybe_wall_of(tokens.getColumn(8))});
  }
  read_devices(db, out.devices);
  return out;
}

base::Result<void> change_people(SQLite::Database& db, const people::Change& change) {
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  // First what is gone: a user of the same name may be among the new ones.
  drop(db, "DELETE FROM users WHERE name = ?", change.gone_users);
  drop(db, "DELETE FROM sessions WHERE id = ?", change.gone_sessions);
  drop(db, "DELETE FROM tokens WHERE id = ?", change.gone_tokens);
  drop(db, "DELETE FROM devices WHERE id = ?", change.gone_devices);
  for (const User& user : change.now.users) keep(db, user);
  for (const Device& device : change.now.devices) keep(db, device);
  for (const Session& session : change.now.sessions) keep(db, session);
  for (const Token& token : change.now.tokens) keep(db, token);
  transaction.commit();
  return {};
}

void Store::read_people(Reply<people::Everybody> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get()]() -> base::Result<people::Everybody> {
    return store::read_people(impl->db->connection);
  });
}

void Store::change_people(people::Change change, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), change = std::move(change)] {
    return store::change_people(impl->db->connection, change);
  });
}

}  // namespace roverd::store
