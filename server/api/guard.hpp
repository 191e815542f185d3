#pragma once
// From where a request may come at all, whoever sends it. A page of another site that a user's
// browser shows is on a computer that can reach this one, and is kept out here:
//   - Host must be a name or an address of this computer (else a foreign name was pointed at it:
//     DNS rebinding);
//   - Origin, where a browser sends one, must be this very server, http or https as it is spoken.

#include <functional>
#include <string>
#include <string_view>

#include "api/message.hpp"

namespace roverd::api {

/// Is this computer called so? A bare_name. Empty: it is called as loopback is. An address that the
/// request came to is always right.
using IsOurs = std::function<bool(const std::string& name)>;

/// A Host's name or address: "Rover.local:8080" is "rover.local", "[::1]" is "::1". Empty: it is
/// not well-formed.
std::string bare_name(std::string_view host);

/// "localhost", "127.0.0.1:8080", "[::1]:8080" … any port.
bool is_loopback_host(std::string_view host);

/// Host of every request; Origin of every request that changes something.
/// @param tls it came through TLS: so did the page that sent it
/// @return the refusal, or empty if the request may pass.
std::optional<Response> guard_request(const Request& request, bool tls = false,
                                      const IsOurs& is_ours = {});
/// Host and Origin of a WebSocket upgrade.
std::optional<Response> guard_upgrade(const Request& request, bool tls = false,
                                      const IsOurs& is_ours = {});
/// Version and key of a WebSocket upgrade (RFC 6455, section 4.2).
std::optional<Response> guard_handshake(const Request& request);

}  // namespace roverd::api
