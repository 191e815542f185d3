#include "api/guard.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "api/problem.hpp"

namespace roverd::api {

namespace {

bool same_text(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

bool is_port(std::string_view text) noexcept {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_loopback_name(std::string_view name) noexcept {
  return name == "localhost" || name == "127.0.0.1" || name == "::1";
}

bool changes_something(const Request& request) {
  switch (request.method()) {
    case http::verb::get:
    case http::verb::head:
    case http::verb::options:
      return false;
    default:
      return true;
  }
}

std::optional<Response> check_host(const Request& request, const IsOurs& is_ours) {
  if (request.count(http::field::host) != 1) {
    return problem(400, "exactly one Host header is needed");
  }
  const std::string_view host = header(request, http::field::host);
  const std::string name = bare_name(host);
  // A page under a foreign name that was pointed here has that name as its host. An address cannot
  // be pointed elsewhere: the one that the client came to is ours.
  const bool served = is_loopback_name(name) || (is_ours && !name.empty() && is_ours(name)) ||
                      (!name.empty() && name == header(request, "Roverd-Here"));
  if (served) return std::nullopt;
  return problem(403, "the host \"" + std::string(host) + "\" is not served: " +
                          (is_ours ? "it is none of this computer's names and addresses; "
                                     "server.names adds some"
                                   : "only 127.0.0.1, localhost and [::1] are"));
}

std::optional<Response> check_origin(const Request& request, bool tls) {
  if (request.count(http::field::origin) == 0) return std::nullopt;  // not a browser
  const std::string_view origin = header(request, http::field::origin);
  const std::string_view host = header(request, http::field::host);
  const std::string_view scheme = tls ? "https://" : "http://";
  if (request.count(http::field::origin) == 1 && origin.starts_with(scheme) &&
      same_text(origin.substr(scheme.size()), host)) {
    return std::nullopt;
  }
  return problem(403, "a page of \"" + std::string(origin) + "\" may not command this server");
}

}  // namespace

std::string bare_name(std::string_view host) {
  const bool v6 = host.starts_with('[');
  const auto end = v6 ? host.find(']') : host.find(':');
  if (v6 && end == std::string_view::npos) return {};
  const std::string_view name = host.substr(v6, end - v6);
  const std::string_view rest = host.substr(std::min(host.size(), v6 ? end + 1 : end));
  const bool whole = rest.empty() || (rest.starts_with(':') && is_port(rest.substr(1)));
  // Only an address of IPv6 has brackets and colons.
  if (!whole || v6 != (name.find(':') != std::string_view::npos)) return {};
  std::string bare(name);
  std::transform(bare.begin(), bare.end(), bare.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return bare;
}

bool is_loopback_host(std::string_view host) {
  return is_loopback_name(bare_name(host));
}

std::optional<Response> guard_request(const Request& request, bool tls, const IsOurs& is_ours) {
  if (auto refusal = check_host(request, is_ours)) return refusal;
  return changes_something(request) ? check_origin(request, tls) : std::nullopt;
}

std::optional<Response> guard_upgrade(const Request& request, bool tls, const IsOurs& is_ours) {
  if (auto refusal = check_host(request, is_ours)) return refusal;
  return check_origin(request, tls);
}

std::optional<Response> guard_handshake(const Request& request) {
  if (header(request, http::field::sec_websocket_version) != "13") {
    Response refusal = problem(426, "the stream speaks version 13 of the WebSocket protocol");
    refusal.set(http::field::upgrade, "websocket");
    refusal.set(http::field::sec_websocket_version, "13");
    return refusal;
  }
  constexpr std::size_t kKey = 24;  // 16 bytes in base64
  const std::string_view key = header(request, http::field::sec_websocket_key);
  if (key.size() == kKey && key.ends_with("==")) return std::nullopt;
  return problem(400, "Sec-WebSocket-Key must be 16 bytes in base64");
}

}  // namespace roverd::api
