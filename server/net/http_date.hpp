#pragma once
// The Date header (RFC 9110, section 5.6.7), made anew once a second.

#include <string>

namespace roverd::net {

/// "Sun, 06 Nov 1994 08:49:37 GMT". Web thread only. @return valid until the next call.
const std::string& http_date_now();

}  // namespace roverd::net
