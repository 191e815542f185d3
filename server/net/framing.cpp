#include "net/framing.hpp"

#include <algorithm>

#include "base/same_word.hpp"

namespace roverd::net {

namespace http = boost::beast::http;

std::optional<FramingFault> framing_fault(const Request& header) {
  const auto lengths = header.count(http::field::content_length);
  const auto codings = header.count(http::field::transfer_encoding);
  if (lengths > 1) return FramingFault{400, "there is more than one Content-Length"};
  if (lengths == 1) {
    if (codings > 0) return FramingFault{400, "there is a Content-Length and a Transfer-Encoding"};
    const auto text = header[http::field::content_length];
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    if (!digits) return FramingFault{400, "Content-Length must be one number"};
  }
  if (codings == 0) return std::nullopt;
  if (header.version() < 11) {
    return FramingFault{400, "HTTP/1.0 has no Transfer-Encoding"};
  }
  const auto coding = header[http::field::transfer_encoding];
  if (codings == 1 && base::same_word(std::string_view(coding.data(), coding.size()), "chunked")) {
    return std::nullopt;
  }
  return FramingFault{501, "the only Transfer-Encoding understood is chunked"};
}

}  // namespace roverd::net
