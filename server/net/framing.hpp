#pragma once
// Where a request ends must be understood by everybody in the same way (RFC 9112, section 6.3):
// what two programs may read differently is refused, and the connection closed, before its body is
// read.

#include <optional>

#include "net/server.hpp"

namespace roverd::net {

struct FramingFault {
  unsigned status = 400;    ///< or 501: a coding that is not understood here
  const char* detail = "";  ///< a static text
};
/// Of a header that was read; empty: it is plain. Pure.
std::optional<FramingFault> framing_fault(const Request& header);

}  // namespace roverd::net
