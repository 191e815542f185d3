#pragma once
// Where an IP camera's pictures are, and how they are asked for.
//
//   http://USER:PASSWORD@HOST:PORT/PATH?QUERY     https:// is the same through TLS
//
// Login, port (80, with TLS 443) and path may be missing. A login never leaves this file but in
// what is asked: neither errors nor `name` hold it. Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "ntrip/digest.hpp"

namespace roverd::camera {

struct Source {
  bool tls = false;
  std::string host;  ///< IPv6 in brackets
  std::uint16_t port = 80;
  std::string path = "/";  ///< with its query
  std::string login;       ///< "user:password"; empty: none

  /// "http://host:80/path": without the login, and without the query, which may hold one, too.
  std::string name() const;
  /// "tcp:host:80" or "tls:host:443", for the link.
  std::string address() const;
};

/// @return Invalid: what it must be; the address is never quoted.
base::Result<Source> parse_source(std::string_view text);

/// How a camera wants the login. Nothing is told before it asks.
struct Wish {
  bool basic = false;
  std::optional<ntrip::Challenge> digest{};
  friend bool operator==(const Wish&, const Wish&) = default;
};

/// The whole request. @param cnonce any word, another one each time. Empty: the camera wants a
/// digest by an algorithm that is not known here.
std::optional<std::string> request(const Source& source, const Wish& wish, std::string_view cnonce);

}  // namespace roverd::camera
