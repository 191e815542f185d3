#pragma once
// How this computer can be called in its networks.

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "trust/certificate.hpp"

namespace roverd::trust {

/// A DNS name: letters, digits, hyphens, dots; at most 253 characters, 63 between two dots.
bool is_host_name(std::string_view text) noexcept;

/// Names and addresses in a fixed order, each once. Pure.
/// @param host this computer's own name, whatever was set; left out where it is no host name
/// @param addresses of all interfaces
/// @param configured more names and addresses, with blanks between them. Error Invalid.
base::Result<Names> all_names(std::string_view host, std::vector<std::string> addresses,
                              std::string_view configured);

/// As the system says now. Link-local IPv6 addresses are left out: no browser takes them.
std::string host_name();
std::vector<std::string> interface_addresses();
/// The one that faces the rest of the world, by the routes; empty: there is no way there. Nothing
/// is sent.
std::string outward_address();

}  // namespace roverd::trust
