#pragma once
// Bodies of multipart/form-data, as `curl -F file=@field.plan` and HTML forms send them. Pure.
// Sources: RFC 7578, and RFC 2046, section 5.1, for the frame:
//
//   preamble CRLF --boundary CRLF headers CRLF CRLF content CRLF --boundary … --boundary-- epilogue

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace roverd::api {

inline constexpr std::size_t kMostFormParts = 32;

struct FormPart {
  std::string name;
  std::optional<std::string> file_name;  ///< as it came, a path perhaps; empty: it is no file
  std::string_view content;              ///< of the body that was read
};

/// The boundary in a Content-Type. Empty: it is another type. Malformed: there is none, or one
/// that cannot be (1 to 70 characters of RFC 2046's).
base::Result<std::optional<std::string>> form_boundary(std::string_view content_type);

/// In the order in which they stand there. Malformed, naming the part: the frame is broken or
/// breaks off, a part has no name; Unsupported: its content is encoded; TooLarge: too many parts.
/// @param body outlives the parts
base::Result<std::vector<FormPart>> form_parts(std::string_view body, std::string_view boundary);

}  // namespace roverd::api
