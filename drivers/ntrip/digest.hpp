#pragma once
// A login that is proved without being told. Source: RFC 7616 (and 2617), for GET without a body.

#include <optional>
#include <string>
#include <string_view>

namespace roverd::ntrip {

/// What a caster asks for in "WWW-Authenticate: Digest …".
struct Challenge {
  std::string realm;
  std::string nonce;
  std::string opaque;
  std::string algorithm;  ///< as sent: "MD5", "SHA-256", "MD5-sess" …; empty: MD5
  bool auth = false;      ///< qop "auth" is offered
  friend bool operator==(const Challenge&, const Challenge&) = default;
};

/// @param value of the header. Empty: it is no Digest, or has no nonce.
std::optional<Challenge> parse_challenge(std::string_view value);

/// The value of "Authorization". @param login "user:password". @param path "/MOUNT".
/// @param cnonce any word, another one each time. Empty: an algorithm that is not known here.
std::optional<std::string> digest_answer(const Challenge& challenge, std::string_view login,
                                         std::string_view path, std::string_view cnonce);

}  // namespace roverd::ntrip
