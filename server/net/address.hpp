#pragma once
// Addresses as they are told and counted.

#include <string>
#include <utility>

#include <boost/asio/ip/address.hpp>

#include "base/network.hpp"

namespace roverd::net {

/// A client of IPv4 is one, also where a socket of IPv6 takes it in.
inline std::string address_text(const boost::asio::ip::address& address) {
  namespace ip = boost::asio::ip;
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return ip::make_address_v4(ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

/// By what connections are counted; empty: they are not.
struct From {
  std::string address;
  std::string
      network;  ///< its /64, of IPv6 only: one computer has as many addresses there as it likes
};

/// Whoever is on this computer under its usual addresses could do worse than to open connections.
inline From counted_as(const boost::asio::ip::address& address) {
  std::string text = address_text(address);
  if (text == "127.0.0.1" || text == "::1") text.clear();
  std::string network = base::network_of(text);
  return {std::move(text), std::move(network)};
}

}  // namespace roverd::net
