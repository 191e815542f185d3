#pragma once
// Certificates as values: PEM texts in and out, EC keys on P-256. Pure but for the random numbers
// of keys and serial numbers; time is an argument. A key takes well under 2 ms, yet keep all of
// this off the web thread and away from the control loop.
//
//   authority (CA)  made once, trusted once by each phone   2020 .. 2049, whatever this clock says
//      └─ server    names and addresses of this computer    397 days, made again by itself
//
// The authority's time is fixed because this computer's clock may be unset or jump, and a phone
// that trusts it must never have to be asked again for that. The server's begins some weeks ago,
// because the phone's clock and this one may differ.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::trust {

/// Apple's systems take no longer ones.
inline constexpr base::Duration kServerLives = std::chrono::hours(24) * 397;
/// So long ago the server's certificate begins when it is made.
inline constexpr base::Duration kBackdated = std::chrono::hours(24) * 30;
/// Nearer than this to either end it is made again.
inline constexpr base::Duration kRenewBeforeEnd = std::chrono::hours(24) * 60;
inline constexpr base::Duration kRenewAfterBegin = std::chrono::hours(24) * 7;

/// What a client may call the server.
struct Names {
  std::vector<std::string> hosts;      ///< DNS names, lower case
  std::vector<std::string> addresses;  ///< IPv4 and IPv6, as inet_ntop writes them
  friend bool operator==(const Names&, const Names&) = default;
};

/// A certificate (its chain may follow it) and its private key, both PEM.
struct Credential {
  std::string certificate;
  std::string key;
};

/// What a certificate says of itself.
struct Facts {
  std::string subject;  ///< its common name
  Names names;
  base::WallTime not_before{};
  base::WallTime not_after{};
  bool authority = false;
  std::string fingerprint;  ///< SHA-256 of its DER: "0A:1B:…", 32 pairs
};

/// A new authority: CA:TRUE, path length 0, signs certificates only.
/// @param host for people who see several of them in a list
base::Result<Credential> make_authority(std::string_view host);

/// A new server's certificate, followed by the authority's.
/// @param now never mind how wrong; see kBackdated
base::Result<Credential> make_server(const Credential& authority, const Names& names,
                                     base::WallTime now);

/// Of the first certificate in a PEM text. Error Malformed.
base::Result<Facts> read_certificate(std::string_view pem);
/// The first certificate alone, as DER. Error Malformed.
base::Result<std::string> der_of(std::string_view pem);
/// The last certificate of a PEM text, as PEM: of a chain its top. Error Malformed.
base::Result<std::string> last_certificate(std::string_view pem);

/// Do key and (first) certificate belong together? Errors: Malformed (which of the two cannot be
/// read; a key with a pass phrase cannot), Invalid (they do not match).
base::Result<void> check_pair(const Credential& credential);
/// The first certificate was signed by that authority.
bool signed_by(std::string_view certificate, std::string_view authority);

/// Why a server's certificate is to be made again; empty: it will do.
/// @param now empty: this computer's clock was never set, then no time is judged
std::optional<std::string> reason_to_renew(const Facts& server, const Names& wanted,
                                           std::optional<base::WallTime> now);

/// Those of `wanted` that the certificate does not name; *.example.org names a.example.org.
std::vector<std::string> names_missing(const Facts& server, const Names& wanted);

}  // namespace roverd::trust
