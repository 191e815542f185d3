#pragma once
// One reader of JSON objects for requests and files: strict, every offending member named by JSON
// pointer (RFC 6901), at most kMaxFieldErrors unknown ones. (The items of a mission have their own
// lists in fields.hpp, which also check and write them.)

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.hpp"

namespace roverd::mission {

/// Reads the members of one object, and complains about those nobody asked for.
class Members {
 public:
  /// The object must outlive it. @param pointer of the object in its document: "/courses/3"
  explicit Members(const nlohmann::json& object, std::string pointer = {})
      : object_(object), pointer_(std::move(pointer)) {}

  /// Absent and null: empty. Wrong type or out of range: empty, and noted.
  std::optional<double> number(std::string_view name, double min, double max);
  std::optional<std::int64_t> whole(std::string_view name, std::int64_t min, std::int64_t max);
  std::optional<std::string> text(std::string_view name);
  std::optional<bool> flag(std::string_view name);
  /// For members whose form the caller judges. Null if absent.
  const nlohmann::json* any(std::string_view name);
  void require(std::string_view name);
  void complain(std::string_view name, std::string detail);
  /// What is wrong beside the object: the name stands as it is.
  void complain_of_header(std::string_view name, std::string detail);
  /// What is wrong with the members of a member: "/front/mode".
  void complain_inside(std::string_view name, const base::Error& inner);

  bool complained() const noexcept { return !errors_.empty(); }

  /// Call last: Invalid, with all that was found, or fine.
  base::Result<void> finish();

 private:
  const nlohmann::json* find(std::string_view name);

  const nlohmann::json& object_;
  const std::string pointer_;
  std::set<std::string, std::less<>> asked_;
  std::vector<base::FieldError> errors_;
};

}  // namespace roverd::mission
