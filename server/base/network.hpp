#pragma once
// Who may be one computer: of IPv6 each has as many addresses as it likes in its /64.

#include <string>
#include <string_view>

namespace roverd::base {

/// The first half of an address of IPv6 as it is usually written, "2001:db8:0:1/64", with the
/// interface if it names one: "fe80:0:0:0/64%2". Empty: IPv4 (also as ::ffff:10.0.0.1), ::1, or no
/// address. Pure.
std::string network_of(std::string_view address);

}  // namespace roverd::base
