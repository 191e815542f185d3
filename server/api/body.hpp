#pragma once
// Request bodies and parameters: strict reading, every offending field named.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "api/message.hpp"

namespace roverd::api {

/// The JSON of a body. Unsupported: the Content-Type is not application/json (a foreign page's
/// simple form cannot send that); Malformed: not JSON. @param optional an empty body is {}.
base::Result<Json> json_body(const Request& request, bool optional = false);

/// Unsupported unless the body is sent as application/json.
base::Result<void> check_json_type(const Request& request);

/// Reads the members of one object, and complains about those nobody asked for.
class Members {
 public:
  explicit Members(const Json& object) : object_(object) {}

  /// Absent and null: empty. Wrong type or out of range: empty, and noted.
  std::optional<double> number(std::string_view name, double min, double max);
  std::optional<std::int64_t> whole(std::string_view name, std::int64_t min, std::int64_t max);
  std::optional<std::string> text(std::string_view name);
  std::optional<bool> flag(std::string_view name);
  /// For members whose form the caller judges. Null if absent.
  const Json* any(std::string_view name);
  void require(std::string_view name);
  void complain(std::string_view name, std::string detail);
  /// What is wrong beside the body.
  void complain_of_header(std::string_view name, std::string detail);
  /// What is wrong with the members of a member: "/front/mode".
  void complain_inside(std::string_view name, const base::Error& inner);

  /// Call last: Invalid, with all that was found, or fine.
  base::Result<void> finish();

 private:
  const Json* find(std::string_view name);

  const Json& object_;
  std::set<std::string, std::less<>> asked_;
  std::vector<base::FieldError> errors_;
};

/// ?limit=, 1..1000, default 100. Invalid otherwise.
base::Result<int> limit_of(const Call& call);
/// Empty if it is not there.
std::string query_text(const Call& call, std::string_view name);
/// A decimal number without sign; empty if it is anything else or does not fit.
std::optional<std::int64_t> whole_number(std::string_view text) noexcept;

}  // namespace roverd::api
