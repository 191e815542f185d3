#pragma once
// Who may talk to a server without log-in: programs and pages of this machine only. A page of
// another site that the user's browser shows is on this machine, too, and is kept out here:
//   - Host must be a loopback name (else a foreign name was pointed at 127.0.0.1: DNS rebinding);
//   - Origin, where a browser sends one, must be this very server, http or https as it is spoken.

#include <string_view>

#include "api/message.hpp"

namespace roverd::api {

/// What roverd may listen on until access control exists. Error Invalid with the reason.
/// @param lan it shall be reached from the network, whatever the address
base::Result<void> check_bind_address(std::string_view address, bool lan = false);

/// "localhost", "127.0.0.1:8080", "[::1]:8080" … any port.
bool is_loopback_host(std::string_view host) noexcept;

/// Host of every request; Origin of every request that changes something.
/// @param tls it came through TLS: so did the page that sent it
/// @return the refusal, or empty if the request may pass.
std::optional<Response> guard_request(const Request& request, bool tls = false);
/// Host and Origin of a WebSocket upgrade.
std::optional<Response> guard_upgrade(const Request& request, bool tls = false);
/// Version and key of a WebSocket upgrade (RFC 6455, section 4.2).
std::optional<Response> guard_handshake(const Request& request);

}  // namespace roverd::api
