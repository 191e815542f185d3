#pragma once
// Small limits, a handler that answers with what it was asked, and requests as a client writes
// them.

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "net_house.hpp"

namespace roverd::test {

inline net::Limits small() {
  net::Limits limits;
  limits.header_bytes = 2048;
  limits.body_bytes = 10'000;
  limits.connections = 3;
  limits.idle = std::chrono::seconds(20);
  limits.request = std::chrono::seconds(20);
  return limits;
}

/// Answers with the target, "+" and the body's size.
inline net::Handlers echo() {
  net::Handlers h;
  h.on_request = [](net::Request request, base::Time, const net::Respond& respond) {
    net::Response response{boost::beast::http::status::ok, 11};
    response.body() = std::string(request.target().data(), request.target().size()) + "+" +
                      std::to_string(request.body().size());
    respond(std::move(response));
  };
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  return h;
}

inline std::string get(const std::string& path, const std::string& more = "") {
  return "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n";
}

}  // namespace roverd::test
