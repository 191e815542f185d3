#pragma once
// Errors as values. Nothing thrown crosses a door; one function in api turns an Error into
// problem+json.

#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace roverd::base {

enum class Code {
  Malformed,  ///< not parseable: bytes or JSON
  Invalid,    ///< well-formed, but a value is out of its range
  NotFound,
  Conflict,          ///< the present state does not allow it; detail says which state
  RevisionMismatch,  ///< somebody else changed it
  PreconditionMissing,
  TooLarge,
  Unsupported,  ///< media type or format
  Unavailable,  ///< try again later: busy, closed, disk full
  Late,         ///< arrived after its validity: never carried out
};

/// One offending field. `pointer` is a JSON pointer ("/items/3/lat"), "line 12" in a text file, or
/// "byte 40" in a binary one.
struct FieldError {
  std::string pointer;
  std::string detail;
  friend bool operator==(const FieldError&, const FieldError&) = default;
};

struct Error {
  Code code = Code::Invalid;
  std::string detail;
  std::vector<FieldError> fields{};
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Code code, std::string detail,
                                  std::vector<FieldError> fields = {}) {
  return tl::unexpected<Error>(Error{code, std::move(detail), std::move(fields)});
}

}  // namespace roverd::base
