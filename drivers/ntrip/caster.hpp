#pragma once
// Which casters there are, and what is said to one.
//
//   ntrip://USER:PASSWORD@HOST:PORT/MOUNTPOINT     ntrips:// is the same through TLS
//
// Login, port (2101, with TLS 443) and mountpoint may be missing; without a mountpoint only the
// table of what there is is read. A login never leaves this file but in `request`: neither errors
// nor `name` hold it. Pure.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"

namespace roverd::ntrip {

struct Caster {
  bool tls = false;
  std::string host;
  std::uint16_t port = 2101;
  std::string mountpoint;
  std::string login;  ///< "user:password"; empty: none

  /// "ntrip://host:2101/MOUNT": without the login.
  std::string name() const;
  /// "tcp:host:2101" or "tls:host:443", for the link.
  std::string address() const;
};

/// @param text addresses with blanks between them, in the order in which they are to be tried.
/// Errors count the address ("the 2nd caster") and never quote it.
base::Result<std::vector<Caster>> parse_casters(std::string_view text);

/// The whole request, to be sent with one write: simple casters read no further.
/// @param version 1 or 2. @param authorization value of that header; empty: the login by Basic.
std::string request(const Caster& caster, int version, const std::string& authorization = {});

std::string base64(std::string_view text);

/// A GGA line with CR and LF, talker GP. Empty without a position.
std::string gga_of(const base::GnssFix& fix);

}  // namespace roverd::ntrip
