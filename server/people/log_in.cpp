// Who comes in: log-in, cookies, tokens, and when they are over.

#include <algorithm>
#include <utility>

#include "base/network.hpp"
#include "people/book.hpp"
#include "people/secret.hpp"

namespace roverd::people {

namespace {

/// A clock that is set a little back is still the same clock.
constexpr base::Duration kSlack = std::chrono::minutes(5);
constexpr std::size_t kDeviceLength = 80;

bool is_known(base::WallTime time) noexcept {
  return time >= base::kYoungest;
}

/// Printable ASCII: it is shown on pages and in terminals.
std::string short_text(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, kDeviceLength)) out += c >= ' ' && c <= '~' ? c : '?';
  return out;
}

}  // namespace

std::string Book::make_code() {
  return code_ = spoken_code();
}

bool Book::is_code(std::string_view typed, const std::string& address, Now now) {
  tried(door_of({}, address), address, now);
  if (!needs_setup() || code_.empty()) return false;
  return same(digest(plain_code(typed)), digest(code_));
}

bool Book::was_here(const std::string& user, const std::string& address) const {
  return std::any_of(sessions_.begin(), sessions_.end(),
                     [&](const Live& s) { return s.row.user == user && s.row.address == address; });
}

void Book::tried(const std::string& door, const std::string& address, Now now) {
  users_wait_.tried(door, now.mono);
  addresses_wait_.tried(address, now.mono);
  const std::string network = base::network_of(address);
  if (!network.empty()) networks_wait_.tried(network, now.mono);
}

void Book::tried_rightly(const std::string& door, const std::string& address) {
  users_wait_.clear(door);
  addresses_wait_.clear(address);
  networks_wait_.clear(base::network_of(address));
}

/// Whoever has been here before from that address is not kept out by others' guesses. Names that do
/// not exist share few entries, and wait alike.
std::string Book::door_of(const std::string& user, const std::string& address) const {
  // Of one-time codes: nobody's guesses keep others waiting.
  if (user.empty()) return "code@" + address;
  if (this->user(user) == nullptr) return "?" + digest(user).substr(0, 1);
  return was_here(user, address) ? user + "@" + address : user;
}

base::Duration Book::login_wait(const std::string& user, const std::string& address,
                                Now now) const {
  const auto of_network = was_here(user, address)
                              ? base::Duration::zero()
                              : networks_wait_.wait(base::network_of(address), now.mono);
  return std::max({users_wait_.wait(door_of(user, address), now.mono),
                   addresses_wait_.wait(address, now.mono), of_network});
}

Attempt Book::begin_login(const std::string& user, const std::string& address, Now now) {
  tried(door_of(user, address), address, now);
  const User* const known = this->user(user);
  return {user, address, known != nullptr ? known->password : nobodys_hash()};
}

std::optional<Opened<Session>> Book::end_login(const Attempt& attempt, bool right,
                                               const std::string& device, Now now) {
  const User* const known = user(attempt.user);
  if (!right || known == nullptr || known->password != attempt.hash) return std::nullopt;
  clear_login(attempt);
  return open_session(attempt.user, attempt.address, device, now);
}

void Book::clear_login(const Attempt& attempt) {
  tried_rightly(door_of(attempt.user, attempt.address), attempt.address);
}

Opened<Session> Book::open_session(const std::string& user, const std::string& address,
                                   const std::string& device, Now now, const std::string& paired) {
  while (sessions_of(user).size() >= kSessionsEach) {
    const Live* oldest = nullptr;
    for (const Live& s : sessions_) {
      if (s.row.user != user) continue;
      const bool older = oldest == nullptr || (s.earlier && !oldest->earlier) ||
                         (s.earlier == oldest->earlier && s.seen < oldest->seen);
      if (older) oldest = &s;
    }
    const std::string id = oldest->row.id;
    drop_sessions([&id](const Live& s) { return s.row.id == id; });
  }
  std::string secret = random_secret();
  Session row{random_id(), digest(secret), user,     short_text(device),
              address,     now.wall,       now.wall, paired};
  sessions_.push_back({row, now.mono, now.mono, now.mono, false});
  change_.now.sessions.push_back(row);
  return {std::move(secret), std::move(row)};
}

Book::State Book::judge(Live& live, Now now) {
  if (live.earlier) {
    if (!is_known(live.row.created) || !is_known(live.row.seen)) return State::Over;
    if (!is_known(now.wall)) return State::Unknown;
    if (now.wall + kSlack < live.row.seen) return State::Over;  // one of the clocks was wrong
    if (now.wall - live.row.created > kAbsolute || now.wall - live.row.seen > kIdle) {
      return State::Over;
    }
    live.begun = now.mono - (now.wall - live.row.created);
    live.seen = now.mono - (now.wall - live.row.seen);
    live.kept = live.seen;
    live.earlier = false;
  }
  const bool over = now.mono - live.begun > kAbsolute || now.mono - live.seen > kIdle;
  return over ? State::Over : State::Good;
}

Book::State Book::judge(const Token& token, Now now) const {
  if (!token.expires) return State::Good;
  if (!is_known(now.wall)) return State::Unknown;
  if (is_known(token.created) && now.wall + kSlack < token.created) return State::Unknown;
  return now.wall >= *token.expires ? State::Over : State::Good;
}

void Book::see(Live& live, Now now) {
  live.seen = now.mono;
  if (!is_known(now.wall)) return;
  live.row.seen = now.wall;
  // The clock was set after the log-in.
  if (!is_known(live.row.created)) live.row.created = now.wall - (now.mono - live.begun);
}

std::optional<Who> Book::who_of(const Live& live) const {
  const User* const known = user(live.row.user);
  if (known == nullptr) return std::nullopt;
  Role role = known->role;
  if (!live.row.paired.empty()) {
    const Device* const device = const_cast<Book*>(this)->find_device(live.row.paired);
    if (device == nullptr) return std::nullopt;
    role = std::min(role, device->role);
  }
  return Who{known->name, role, Who::By::Session, live.row.id};
}

std::optional<Who> Book::who_of(const Token& token) const {
  const User* const known = user(token.user);
  if (known == nullptr) return std::nullopt;
  return Who{known->name, std::min(known->role, token.role), Who::By::Token, token.id,
             token.methods};
}

std::optional<Who> Book::by_session(std::string_view secret, Now now) {
  const std::string hash = digest(secret);
  for (Live& live : sessions_) {
    if (!same(live.row.hash, hash)) continue;
    if (judge(live, now) != State::Good) return std::nullopt;
    see(live, now);
    return who_of(live);
  }
  return std::nullopt;
}

std::optional<Who> Book::by_token(std::string_view secret, Now now) {
  const std::string hash = digest(secret);
  for (Shown& shown : tokens_) {
    if (!same(shown.row.hash, hash)) continue;
    if (judge(shown.row, now) != State::Good) return std::nullopt;
    shown.row.used = now.wall;
    if (shown.kept == base::Time::max()) shown.kept = now.mono;
    return who_of(shown.row);
  }
  return std::nullopt;
}

std::optional<Who> Book::still(const Who& who, Now now) {
  if (who.by == Who::By::Session) {
    for (Live& live : sessions_) {
      if (live.row.id == who.id) {
        return judge(live, now) == State::Good ? who_of(live) : std::nullopt;
      }
    }
    return std::nullopt;
  }
  for (const Shown& shown : tokens_) {
    if (shown.row.id == who.id) {
      return judge(shown.row, now) == State::Good ? who_of(shown.row) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace roverd::people
