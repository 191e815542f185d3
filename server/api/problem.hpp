#pragma once
// Refusals as application/problem+json (RFC 9457). The one place that turns an Error into a status.
//
//   Malformed 400   Invalid 422   NotFound 404   Conflict, Late 409   RevisionMismatch 412
//   PreconditionMissing 428   TooLarge 413   Unsupported 415   Unavailable 503

#include <string_view>

#include "api/message.hpp"

namespace roverd::api {

unsigned status_of(base::Code code) noexcept;

/// The members of a problem; `type` points at the explanation in /docs.
Json problem_json(const base::Error& error);
Response problem(const base::Error& error);
/// For refusals that are no Error of a room: 403, 405, 417, 426, 429, 431 … and net's.
Json problem_json(unsigned status, std::string_view detail);
Response problem(unsigned status, std::string_view detail);
/// For members of its own.
Response problem_response(unsigned status, const Json& body);

/// A status's short name, as in `type` and `title`: {"conflict", "Conflict with the present
/// state"}.
struct ProblemKind {
  unsigned status;
  std::string_view slug;
  std::string_view title;
  std::string_view meaning;  ///< one sentence, for /docs
};
/// All of them, in ascending order of status.
const std::vector<ProblemKind>& problem_kinds();

}  // namespace roverd::api
