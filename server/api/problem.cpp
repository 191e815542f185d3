#include "api/problem.hpp"

#include <algorithm>

#include "api/json/plain_json.hpp"

namespace roverd::api {

Response json_response(http::status status, const Json& body) {
  return text_response(status, "application/json", plain_json(body));
}

Response text_response(http::status status, std::string_view content_type, std::string body) {
  Response response{status, 11};
  response.set(http::field::content_type,
               boost::beast::string_view(content_type.data(), content_type.size()));
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.body() = std::move(body);
  return response;
}

unsigned status_of(base::Code code) noexcept {
  switch (code) {
    case base::Code::Malformed:
      return 400;
    case base::Code::Invalid:
      return 422;
    case base::Code::NotFound:
      return 404;
    case base::Code::Conflict:
    case base::Code::Late:
      return 409;
    case base::Code::RevisionMismatch:
      return 412;
    case base::Code::PreconditionMissing:
      return 428;
    case base::Code::TooLarge:
      return 413;
    case base::Code::Unsupported:
      return 415;
    case base::Code::Unavailable:
      return 503;
  }
  return 503;
}

const std::vector<ProblemKind>& problem_kinds() {
  static const std::vector<ProblemKind> kKinds = {
      {400, "malformed", "Malformed request", "The request, or the JSON in it, cannot be read."},
      {401, "unauthorized", "Not logged in",
       "Log in, or show a token that is valid; or what was shown is wrong or over."},
      {403, "forbidden", "Forbidden",
       "Host or Origin is not this server, or the role is too low for this."},
      {403, "control", "Control is not held",
       "This acts on the robot, and another has control, or nobody: `holder` says who. Take it, "
       "or ask for it."},
      {404, "not-found", "Not found", "There is no such thing."},
      {405, "method-not-allowed", "Method not allowed", "Allow names the methods of this path."},
      {409, "conflict", "Conflict with the present state",
       "The detail says which state; nothing was changed."},
      {409, "late", "Too late",
       "The command is older than it is good for, or the robot was stopped after what its "
       "sender had seen; nothing was done. Its age counts from Roverd-Seen, or, without that "
       "header, from the first sign of the request."},
      {412, "revision-mismatch", "Somebody else changed it",
       "If-Match does not name the present revision; `current` holds that."},
      {413, "too-large", "Too large", "The body is larger than the server takes."},
      {415, "unsupported-type", "Unsupported type",
       "The Content-Type or the file's format is not understood here."},
      {417, "expectation-failed", "Expectation failed", "Only 100-continue is understood."},
      {422, "invalid", "Invalid values", "Well-formed, but `errors` names values that cannot be."},
      {426, "upgrade-required", "Upgrade required", "This address is a WebSocket."},
      {428, "precondition-missing", "Precondition missing",
       "If-Match with the ETag of the revision that the change is based on is needed."},
      {429, "too-many-requests", "Too many requests",
       "Too many requests wait, or too many log-ins were wrong; Retry-After says when to try "
       "again."},
      {431, "header-too-large", "Header too large", "The header is larger than the server takes."},
      {501, "not-implemented", "Not implemented",
       "The request's body is coded in a way that is not understood here."},
      {503, "unavailable", "Unavailable", "Busy, starting or closing; try again."},
  };
  return kKinds;
}

Json problem_json(unsigned status, std::string_view detail) {
  const auto& kinds = problem_kinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                 [status](const ProblemKind& k) { return k.status == status; });
  Json out = {{"status", status}, {"detail", detail}};
  out["type"] = kind == kinds.end() ? "about:blank" : "/docs#problem-" + std::string(kind->slug);
  out["title"] = kind == kinds.end()
                     ? std::string(http::obsolete_reason(http::int_to_status(status)))
                     : std::string(kind->title);
  return out;
}

Json problem_json(const base::Error& error) {
  Json out = problem_json(status_of(error.code), error.detail);
  if (error.code == base::Code::Late) {
    out["type"] = "/docs#problem-late";
    out["title"] = "Too late";
  }
  if (!error.fields.empty()) {
    Json& errors = out["errors"] = Json::array();
    for (const auto& [pointer, detail] : error.fields) {
      errors.push_back({{"pointer", pointer}, {"detail", detail}});
    }
  }
  return out;
}

Response problem_response(unsigned status, const Json& body) {
  Response response = json_response(http::int_to_status(status), body);
  response.set(http::field::content_type, "application/problem+json");
  if (status == 429 || status == 503) response.set(http::field::retry_after, "1");
  return response;
}

Response problem(const base::Error& error) {
  return problem_response(status_of(error.code), problem_json(error));
}

Response problem(unsigned status, std::string_view detail) {
  return problem_response(status, problem_json(status, detail));
}

}  // namespace roverd::api
