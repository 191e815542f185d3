#include "people/book.hpp"

#include <algorithm>
#include <utility>

#include "people/secret.hpp"

namespace roverd::people {

using base::Code;
using base::Result;

namespace {

Result<void> no_such(std::string_view what) {
  return base::fail(Code::NotFound, "there is no such " + std::string(what));
}

}  // namespace

bool Who::may(std::string_view method) const {
  if (methods.empty()) return true;
  const std::string_view meant = method == "HEAD" ? "GET" : method;
  return std::find(methods.begin(), methods.end(), meant) != methods.end();
}

void Book::load(Everybody kept, Now now) {
  users_ = std::move(kept.users);
  sessions_.clear();
  for (Session& row : kept.sessions) {
    sessions_.push_back({std::move(row), now.mono, now.mono, now.mono, true});
  }
  tokens_.clear();
  for (Token& row : kept.tokens) tokens_.push_back({std::move(row), now.mono});
  devices_ = std::move(kept.devices);
  invited_.clear();
  loaded_ = true;
}

// ---- users

User* Book::find(std::string_view name) noexcept {
  const auto at =
      std::find_if(users_.begin(), users_.end(), [&](const User& u) { return u.name == name; });
  return at == users_.end() ? nullptr : &*at;
}

const User* Book::user(std::string_view name) const noexcept {
  return const_cast<Book*>(this)->find(name);
}

bool Book::is_last_admin(const User& user) const noexcept {
  return user.role == Role::Admin && std::count_if(users_.begin(), users_.end(), [](const User& u) {
                                       return u.role == Role::Admin;
                                     }) == 1;
}

Result<void> Book::add_user(const std::string& name, Role role, std::string password_hash,
                            Now now) {
  if (!loaded_) return base::fail(Code::Unavailable, "the users are not read yet");
  if (find(name) != nullptr) {
    return base::fail(Code::Conflict, "there is a user \"" + name + "\" already");
  }
  if (users_.size() >= kUsers) {
    return base::fail(Code::Conflict,
                      "there are " + std::to_string(kUsers) + " users: no more are kept");
  }
  users_.push_back({name, role, std::move(password_hash), now.wall});
  change_.now.users.push_back(users_.back());
  code_.clear();
  return {};
}

Result<void> Book::change_user(const std::string& name, std::optional<Role> role,
                               std::optional<std::string> password_hash, const std::string& keep,
                               const std::string& keep_device) {
  User* const user = find(name);
  if (user == nullptr) return no_such("user");
  if (role && *role != Role::Admin && is_last_admin(*user)) {
    return base::fail(Code::Conflict, "\"" + name + "\" is the only admin, and one is needed");
  }
  if (role) user->role = *role;
  if (password_hash) {
    user->password = std::move(*password_hash);
    drop_invitations(name);
    drop_sessions([&](const Live& s) { return s.row.user == name && s.row.id != keep; });
    drop_devices([&](const Device& d) { return d.user == name && d.id != keep_device; });
  }
  change_.now.users.push_back(*user);
  return {};
}

Result<void> Book::remove_user(const std::string& name) {
  const User* const user = find(name);
  if (user == nullptr) return no_such("user");
  if (is_last_admin(*user) && users_.size() > 1) {
    return base::fail(Code::Conflict, "\"" + name + "\" is the only admin, and one is needed");
  }
  drop_invitations(name);
  drop_sessions([&](const Live& s) { return s.row.user == name; });
  drop_devices([&](const Device& d) { return d.user == name; });
  drop_tokens([&](const Token& t) { return t.user == name; });
  std::erase_if(users_, [&](const User& u) { return u.name == name; });
  std::erase_if(change_.now.users, [&](const User& u) { return u.name == name; });
  change_.gone_users.push_back(name);
  return {};
}

// ---- sessions

void Book::drop_sessions(const std::function<bool(const Live&)>& which) {
  std::erase_if(sessions_, [&](const Live& live) {
    if (!which(live)) return false;
    std::erase_if(change_.now.sessions, [&](const Session& s) { return s.id == live.row.id; });
    change_.gone_sessions.push_back(live.row.id);
    return true;
  });
}

std::vector<Session> Book::sessions_of(const std::string& user) const {
  std::vector<Session> out;
  for (const Live& live : sessions_) {
    if (live.row.user == user) out.push_back(live.row);
  }
  return out;
}

Result<void> Book::end_session(const std::string& user, const std::string& id) {
  const std::size_t before = sessions_.size();
  drop_invitations(user);
  drop_sessions([&](const Live& s) { return s.row.user == user && s.row.id == id; });
  return sessions_.size() < before ? Result<void>{} : no_such("session");
}

std::size_t Book::end_other_sessions(const std::string& user, const std::string& keep) {
  const std::size_t before = sessions_.size();
  drop_invitations(user);
  drop_sessions([&](const Live& s) { return s.row.user == user && s.row.id != keep; });
  return before - sessions_.size();
}

// ---- tokens

void Book::drop_tokens(const std::function<bool(const Token&)>& which) {
  std::erase_if(tokens_, [&](const Shown& shown) {
    if (!which(shown.row)) return false;
    std::erase_if(change_.now.tokens, [&](const Token& t) { return t.id == shown.row.id; });
    change_.gone_tokens.push_back(shown.row.id);
    return true;
  });
}

Result<Opened<Token>> Book::add_token(Token wanted, Now now) {
  if (find(wanted.user) == nullptr) return tl::unexpected(no_such("user").error());
  if (tokens_.size() >= kTokens) {
    return base::fail(Code::Conflict, "there are " + std::to_string(kTokens) +
                                          " tokens: end one that is not needed any more");
  }
  std::string secret = random_secret();
  wanted.id = random_id();
  wanted.hash = digest(secret);
  wanted.created = now.wall;
  tokens_.push_back({wanted, now.mono});
  change_.now.tokens.push_back(wanted);
  return Opened<Token>{std::move(secret), std::move(wanted)};
}

std::vector<Token> Book::tokens_of(const std::string& user) const {
  std::vector<Token> out;
  for (const Shown& shown : tokens_) {
    if (user.empty() || shown.row.user == user) out.push_back(shown.row);
  }
  return out;
}

Result<void> Book::end_token(const std::string& user, const std::string& id) {
  const std::size_t before = tokens_.size();
  drop_tokens([&](const Token& t) { return t.id == id && (user.empty() || t.user == user); });
  return tokens_.size() < before ? Result<void>{} : no_such("token");
}

// ---- what is kept

void Book::sweep(Now now) {
  drop_sessions([&](const Live& live) {
    Live copy = live;
    return judge(copy, now) == State::Over;
  });
  // Of a row, only its last state is of interest.
  for (Live& live : sessions_) {
    if (live.earlier || live.seen == live.kept || now.mono - live.kept < kKeepSeen) continue;
    live.kept = live.seen;
    change_.now.sessions.push_back(live.row);
  }
  for (Shown& shown : tokens_) {
    if (!shown.row.used || now.mono - shown.kept < kKeepSeen) continue;
    shown.kept = base::Time::max();  // until it is used again
    change_.now.tokens.push_back(shown.row);
  }
}

Change Book::take_change() {
  return std::exchange(change_, {});
}

}  // namespace roverd::people
