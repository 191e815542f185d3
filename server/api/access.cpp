#include "api/access.hpp"

#include <algorithm>

#include "api/problem.hpp"

namespace roverd::api {

namespace {

using people::Role;
using people::Who;

constexpr std::string_view kBearer = "Bearer ";
/// Longer than any secret of ours: it is not looked at.
constexpr std::size_t kLongestSecret = 128;
constexpr std::size_t kKnown = 256;
constexpr base::Duration kLately = std::chrono::hours(12);

Response unknown_caller(std::string_view detail) {
  Response out = problem(401, detail);
  out.set(http::field::www_authenticate, "Bearer realm=\"roverd\"");
  return out;
}

/// The value of a cookie in "a=1; roverd_session=x; b=2"; empty: it is not there.
std::string_view cookie_in(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view one = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) {
      return one.substr(name.size() + 1);
    }
  }
  return {};
}

bool only_reads(const Request& request) {
  switch (request.method()) {
    case http::verb::get:
    case http::verb::head:
    case http::verb::options:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string_view to_string(Need need) noexcept {
  switch (need) {
    case Need::Anyone:
      return "anyone";
    case Need::Viewer:
      return "viewer";
    case Need::Operator:
      return "operator";
    case Need::Admin:
      return "admin";
  }
  return "";
}

bool suffices(Role role, Need need) noexcept {
  switch (need) {
    case Need::Anyone:
    case Need::Viewer:
      return true;
    case Need::Operator:
      return role != Role::Viewer;
    case Need::Admin:
      return role == Role::Admin;
  }
  return false;
}

std::string peer_of(const Request& request) {
  return std::string(header(request, "Roverd-Peer"));
}

people::Now Access::now() {
  return {base::steady_now(), base::wall_now()};
}

/// Those that were seen longest ago make room.
void Access::note(const std::string& address) {
  if (!known_.contains(address) && known_.size() >= kKnown) {
    known_.erase(std::min_element(known_.begin(), known_.end(), [](const auto& a, const auto& b) {
      return a.second < b.second;
    }));
  }
  known_[address] = base::steady_now();
}

bool Access::knows(const std::string& address) const {
  const auto found = known_.find(address);
  return found != known_.end() && base::steady_now() - found->second < kLately;
}

/// A token goes before a cookie: whoever sends one means it. Refused here: what is forged or over,
/// and a foreign page that uses somebody's cookie.
std::optional<Response> Access::identify(const Request& request, std::optional<Who>& who) {
  const std::string_view shown = header(request, http::field::authorization);
  if (!shown.empty()) {
    const bool fits = request.count(http::field::authorization) == 1 &&
                      shown.starts_with(kBearer) && shown.size() <= kLongestSecret;
    if (fits) who = book_->by_token(shown.substr(kBearer.size()), now());
    if (who) return std::nullopt;
    return unknown_caller("the token is not valid: unknown, ended or expired");
  }
  const std::string_view cookie =
      cookie_in(header(request, http::field::cookie), cookie_name(kCookie));
  if (cookie.empty() || cookie.size() > kLongestSecret) return std::nullopt;
  who = book_->by_session(cookie, now());
  // guard.cpp looks whether Origin is ours, where there is one; every browser sends one with these.
  if (who && !only_reads(request) && request.count(http::field::origin) != 1) {
    who.reset();
    return problem(403,
                   "a change with a cookie needs the Origin that every browser sends; "
                   "scripts use a token");
  }
  return std::nullopt;
}

std::optional<Response> Access::judge(const std::optional<Who>& who, std::string_view method,
                                      Need need) const {
  if (!book_->loaded()) {
    return problem({base::Code::Unavailable, "the users have not been read yet"});
  }
  if (!who) return unknown_caller("log in first");
  if (!suffices(who->role, need)) {
    return problem(403, "the role " + std::string(to_string(who->role)) +
                            " is too low: this needs " + std::string(to_string(need)));
  }
  if (who->may(method)) return std::nullopt;
  return problem(403, "this token is not good for " + std::string(method));
}

std::optional<Response> Access::check(const Request& request, Need need, std::optional<Who>& who) {
  if (!on()) return std::nullopt;
  auto refusal = identify(request, who);
  if (who) note(peer_of(request));
  if (need == Need::Anyone) return std::nullopt;
  if (refusal) return refusal;
  const auto method = request.method_string();
  return judge(who, {method.data(), method.size()}, need);
}

std::optional<Response> Access::check_upgrade(const Request& request, std::optional<Who>& who) {
  if (!on()) return std::nullopt;
  auto refusal = check(request, need_of("GET /stream").value_or(Need::Admin), who);
  if (refusal) return refusal;
  if (who && who->by == Who::By::Session && request.count(http::field::origin) != 1) {
    return problem(403, "a stream with a cookie needs the Origin that every browser sends");
  }
  return std::nullopt;
}

bool Access::would_pass(const Request& request, Need need) {
  std::optional<Who> who;
  return !check(request, need, who);
}

std::string Access::cookie_name(std::string_view name) const {
  return (secure_ ? "__Host-" : "") + std::string(name);
}

std::string Access::set_cookie(std::string_view name, std::string_view secret,
                               base::Duration age) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(age);
  return cookie_name(name) + "=" + std::string(secret) + "; Path=/; HttpOnly; SameSite=Strict" +
         (secure_ ? "; Secure" : "") +
         "; Max-Age=" + std::to_string(secret.empty() ? 0 : seconds.count());
}

std::string Access::cookie(std::string_view secret) const {
  return set_cookie(kCookie, secret, people::Book::kAbsolute);
}

std::string Access::device_cookie(std::string_view secret) const {
  return set_cookie(kDeviceCookie, secret, people::Book::kPaired);
}

std::string Access::device_secret(const Request& request) const {
  const auto value = cookie_in(header(request, http::field::cookie), cookie_name(kDeviceCookie));
  return value.size() > kLongestSecret ? std::string() : std::string(value);
}

}  // namespace roverd::api
