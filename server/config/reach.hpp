#pragma once
// Who can reach the server: this computer alone, or whoever is in its networks.

#include <string>
#include <vector>

#include "base/result.hpp"
#include "config/settings.hpp"

namespace roverd {

/// The settings that nobody has to write out: whoever can be reached from a network speaks TLS and
/// knows its users. Errors: Invalid, naming the key (somebody said otherwise, or `listen` cannot be
/// read).
base::Result<void> settle_server(Settings& settings);

/// On which addresses to listen; "::" is every one. After settle_server.
std::vector<std::string> addresses_of(const ServerSettings& server);

/// 127.x.y.z or ::1, in these spellings.
bool is_loopback(const std::string& address) noexcept;
/// Others than this computer can come in.
bool reaches_out(const ServerSettings& server);

/// As it stands in a URL: "192.168.4.1:8080", "[fd00::1]:8080".
std::string authority_of(const std::string& address, int port);

}  // namespace roverd
