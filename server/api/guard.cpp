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

/// The name without the port; empty if it is not "name" or "name:port".
std::string_view host_name(std::string_view host) noexcept {
  const auto from = host.starts_with('[') ? host.find(']') : 0;
  if (from == std::string_view::npos) return {};
  const auto colon = host.find(':', from);
  if (colon == std::string_view::npos) return host;
  return is_port(host.substr(colon + 1)) ? host.substr(0, colon) : std::string_view{};
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

std::optional<Response> check_host(const Request& request) {
  if (request.count(http::field::host) != 1) {
    return problem(400, "exactly one Host header is needed");
  }
  const std::string_view host = header(request, http::field::host);
  if (is_loopback_host(host)) return std::nullopt;
  return problem(403, "the host \"" + std::string(host) +
                          "\" is not served: only 127.0.0.1, localhost and [::1] are");
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

base::Result<void> check_bind_address(std::string_view address, bool lan) {
  if (lan) {
    return base::fail(base::Code::Invalid,
                      "cannot listen in the network: access control is not there yet, so anybody "
                      "in it could drive; on this computer --tls shows what it will be");
  }
  const bool v4 = address.starts_with("127.") && address.size() <= 15 &&
                  std::all_of(address.begin(), address.end(),
                              [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
  if (v4 || address == "::1") return {};
  return base::fail(base::Code::Invalid,
                    "cannot listen on \"" + std::string(address) +
                        "\": access control is not there yet, so only loopback addresses "
                        "(127.0.0.1, ::1) are allowed");
}

bool is_loopback_host(std::string_view host) noexcept {
  const std::string_view name = host_name(host);
  return same_text(name, "localhost") || name == "127.0.0.1" || name == "[::1]";
}

std::optional<Response> guard_request(const Request& request, bool tls) {
  if (auto refusal = check_host(request)) return refusal;
  return changes_something(request) ? check_origin(request, tls) : std::nullopt;
}

std::optional<Response> guard_upgrade(const Request& request, bool tls) {
  if (auto refusal = check_host(request)) return refusal;
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
