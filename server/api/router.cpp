#include "api/router.hpp"

#include <algorithm>
#include <utility>

namespace roverd::api {

namespace {

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::vector<std::string_view> segments(std::string_view path) {
  std::vector<std::string_view> out;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const auto end = std::min(path.find('/'), path.size());
    out.push_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return out;
}

bool is_parameter(std::string_view segment) noexcept {
  return segment.starts_with('{');
}

/// Does `path` fit `pattern`? Counts the literals, so that "/import" beats "/{id}".
std::optional<std::size_t> fit(const std::vector<std::string_view>& pattern,
                               const std::vector<std::string_view>& path) {
  if (pattern.size() != path.size()) return std::nullopt;
  std::size_t literals = 0;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (is_parameter(pattern[i])) {
      if (path[i].empty()) return std::nullopt;
      continue;
    }
    if (pattern[i] != path[i]) return std::nullopt;
    ++literals;
  }
  return literals;
}

}  // namespace

base::Result<std::string> percent_decoded(std::string_view text, bool plus_is_blank) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_blank) {
      out.push_back(' ');
      continue;
    }
    if (text[i] != '%') {
      out.push_back(text[i]);
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0 || (high == 0 && low == 0)) {
      return base::fail(base::Code::Malformed, "a broken percent sign in the address");
    }
    out.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return out;
}

base::Result<Target> parse_target(std::string_view target) {
  // The absolute form, as a proxy gets it: the Host header was checked already.
  if (const auto scheme = target.find("://");
      scheme != std::string_view::npos && !target.starts_with('/')) {
    const auto path = target.find('/', scheme + 3);
    target = path == std::string_view::npos ? "/" : target.substr(path);
  }
  Target out;
  const auto mark = target.find('?');
  out.path = target.substr(0, mark);
  std::string_view rest = mark == std::string_view::npos ? "" : target.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const auto equals = pair.find('=');
    auto key = percent_decoded(pair.substr(0, equals), true);
    auto value = percent_decoded(
        equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1), true);
    if (!key) return tl::unexpected<base::Error>(std::move(key.error()));
    if (!value) {
      return base::fail(base::Code::Malformed, "a broken percent sign in the parameter " + *key,
                        {{*key, "has a broken percent sign"}});
    }
    if (!key->empty()) out.query[std::move(*key)] = std::move(*value);
  }
  return out;
}

void Router::add(Route route) {
  const auto method = http::to_string(route.method);
  const std::string name = std::string(method.data(), method.size()) + " " + route.pattern;
  route.need = need_of(name).value_or(Need::Admin);
  route.control = needs_control(name);
  if (route.need != Need::Anyone) {
    for (const unsigned refusal : {401U, 403U, 429U}) {
      if (std::find(route.statuses.begin(), route.statuses.end(), refusal) == route.statuses.end())
        route.statuses.push_back(refusal);
    }
  }
  std::sort(route.statuses.begin(), route.statuses.end());
  routes_.push_back(std::move(route));
}

std::variant<Router::Match, Router::NotFound, Router::WrongMethod> Router::find(
    http::verb method, std::string_view path) const {
  if (method == http::verb::head) method = http::verb::get;
  if (!path.starts_with('/')) return NotFound{};
  const auto parts = segments(path);
  std::size_t most = 0;
  const Route* best = nullptr;
  const Route* any = nullptr;
  for (const Route& route : routes_) {
    const auto literals = fit(segments(route.pattern), parts);
    if (!literals) continue;
    if (any == nullptr || *literals > most) {
      any = &route;
      best = nullptr;
      most = *literals;
    }
    if (*literals == most && route.method == method) best = &route;
  }
  if (any == nullptr) return NotFound{};
  if (best == nullptr) {
    WrongMethod wrong;
    for (const Route& route : routes_) {
      if (route.pattern != any->pattern) continue;
      const auto name = http::to_string(route.method);
      wrong.allow += std::string(name.data(), name.size()) + ", ";
      if (route.method == http::verb::get) wrong.allow += "HEAD, ";
    }
    wrong.allow += "OPTIONS";
    return wrong;
  }
  Match match{best, {}};
  const auto pattern = segments(best->pattern);
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (!is_parameter(pattern[i])) continue;
    auto value = percent_decoded(parts[i]);
    if (!value) return NotFound{};
    match.params[std::string(pattern[i].substr(1, pattern[i].size() - 2))] = std::move(*value);
  }
  return match;
}

}  // namespace roverd::api
