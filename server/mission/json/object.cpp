#include "mission/json/object.hpp"

#include <cmath>

#include "mission/json/json.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

namespace {

std::string must_lie_in(double min, double max) {
  return "must lie in " + nlohmann::json(min).dump() + " .. " + nlohmann::json(max).dump();
}

}  // namespace

const nlohmann::json* Members::find(std::string_view name) {
  asked_.emplace(name);
  if (!object_.is_object()) return nullptr;
  const auto found = object_.find(std::string(name));
  return found == object_.end() || found->is_null() ? nullptr : &*found;
}

void Members::complain(std::string_view name, std::string detail) {
  errors_.push_back({pointer_ + "/" + escaped_key(name), std::move(detail)});
}

void Members::complain_of_header(std::string_view name, std::string detail) {
  errors_.push_back({std::string(name), std::move(detail)});
}

void Members::complain_inside(std::string_view name, const base::Error& inner) {
  for (const auto& [pointer, detail] : inner.fields) {
    errors_.push_back({pointer_ + "/" + escaped_key(name) + pointer, detail});
  }
}

void Members::require(std::string_view name) {
  if (object_.is_object() && find(name) == nullptr) complain(name, "is missing");
}

const nlohmann::json* Members::any(std::string_view name) {
  return find(name);
}

std::optional<double> Members::number(std::string_view name, double min, double max) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_number()) {
    complain(name, "must be a number");
    return std::nullopt;
  }
  const double number = value->get<double>();
  if (!(number >= min && number <= max)) {
    complain(name, must_lie_in(min, max));
    return std::nullopt;
  }
  return number;
}

std::optional<std::int64_t> Members::whole(std::string_view name, std::int64_t min,
                                           std::int64_t max) {
  const auto value = number(name, static_cast<double>(min), static_cast<double>(max));
  if (value && std::nearbyint(*value) != *value) {
    complain(name, "must be a whole number");
    return std::nullopt;
  }
  return value ? std::optional(static_cast<std::int64_t>(*value)) : std::nullopt;
}

std::optional<std::string> Members::text(std::string_view name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) {
    complain(name, "must be text");
    return std::nullopt;
  }
  return value->get<std::string>();
}

std::optional<bool> Members::flag(std::string_view name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_boolean()) {
    complain(name, "must be true or false");
    return std::nullopt;
  }
  return value->get<bool>();
}

base::Result<void> Members::finish() {
  if (!object_.is_object()) {
    const std::string what = pointer_.empty() ? "the body" : pointer_;
    return base::fail(base::Code::Invalid, what + " must be a JSON object",
                      {{pointer_, "must be an object"}});
  }
  for (const auto& [name, value] : object_.items()) {
    if (!asked_.contains(name) && errors_.size() < kMaxFieldErrors) {
      complain(name, "unknown member");
    }
  }
  if (errors_.empty()) return {};
  std::string detail = errors_.front().pointer + " " + errors_.front().detail;
  return base::fail(base::Code::Invalid, std::move(detail), std::move(errors_));
}

}  // namespace roverd::mission
