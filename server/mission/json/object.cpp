#include "mission/json/object.hpp"

#include <algorithm>
#include <cmath>

#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

const nlohmann::json* Members::known(std::string_view name) {
  if (!object_.is_object()) return nullptr;
  const auto found = object_.find(name);
  if (found == object_.end()) return nullptr;
  if (asked_count_ < asked_.size()) {
    asked_[asked_count_++] = &*found;
  } else {
    more_asked_.push_back(&*found);
  }
  return &*found;
}

const nlohmann::json* Members::any(std::string_view name) {
  const nlohmann::json* value = known(name);
  return value == nullptr || value->is_null() ? nullptr : value;
}

const nlohmann::json* Members::required(std::string_view name) {
  const nlohmann::json* value = known(name);
  if (value == nullptr) complain(name, "is required");
  return value;
}

void Members::complain(std::string_view name, std::string detail) {
  problems_.add(where_.text() + '/' + escaped_key(name), std::move(detail));
}

void Members::complain_of_header(std::string_view name, std::string detail) {
  problems_.add(std::string(name), std::move(detail));
}

void Members::complain_inside(std::string_view name, const base::Error& inner) {
  const std::string front = where_.text() + '/' + escaped_key(name);
  for (const auto& [pointer, detail] : inner.fields) problems_.add(front + pointer, detail);
}

void Members::require(std::string_view name) {
  if (object_.is_object() && any(name) == nullptr) complain(name, "is required");
}

std::optional<double> Members::number(std::string_view name, double min, double max) {
  const nlohmann::json* value = any(name);
  double number = 0.0;
  if (value == nullptr || !read(name, *value, number, {min, max})) return std::nullopt;
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
  const nlohmann::json* value = any(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) return value->get<std::string>();
  complain(name, "must be text");
  return std::nullopt;
}

std::optional<bool> Members::flag(std::string_view name) {
  const nlohmann::json* value = any(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_boolean()) return value->get<bool>();
  complain(name, "must be true or false");
  return std::nullopt;
}

void Members::name(std::string_view name, std::string& out) {
  const nlohmann::json* value = required(name);
  if (value == nullptr) return;
  if (!value->is_string()) return complain(name, "must be text");
  out = value->get_ref<const std::string&>();
  if (std::string problem = name_problem(out); !problem.empty()) complain(name, problem);
}

void Members::rest(nlohmann::json& out) {
  out = nlohmann::json::object();
  for (const auto& [key, value] : object_.items()) {
    if (!was_asked(value)) out.emplace(key, value);
  }
  all_known_ = true;
}

bool Members::read(std::string_view name, const nlohmann::json& value, double& out,
                   const Range& range) {
  if (!value.is_number()) {
    complain(name, "must be a number");
    return false;
  }
  out = value.get<double>();
  if (range.holds(out)) return true;
  complain(name, range_problem(range, out));
  return false;
}

void Members::read_whole(std::string_view name, const nlohmann::json& value, int& out, int min,
                         int max) {
  double number = 0.0;
  if (!read(name, value, number, {double(min), double(max)})) return;
  if (std::nearbyint(number) != number) {
    complain(name, "must be a whole number");
  } else {
    out = static_cast<int>(number);
  }
}

void Members::read_count(std::string_view name, const nlohmann::json& value, int& out, int max) {
  if (!value.is_string()) return read_whole(name, value, out, 0, max);
  out = 0;
  if (value != "forever") complain(name, "must be a number of times, or \"forever\" (0)");
}

bool Members::was_asked(const nlohmann::json& value) const {
  const auto end = asked_.begin() + static_cast<std::ptrdiff_t>(asked_count_);
  return std::find(asked_.begin(), end, &value) != end ||
         std::find(more_asked_.begin(), more_asked_.end(), &value) != more_asked_.end();
}

void Members::refuse_unknown() {
  if (all_known_ || !object_.is_object()) return;
  for (const auto& [key, value] : object_.items()) {
    if (!was_asked(value)) complain(key, "is not a known member");
  }
}

base::Result<void> Members::finish(std::string_view subject) {
  if (!object_.is_object()) {
    const std::string what = pointer_.empty() ? std::string(subject) : pointer_;
    return base::fail(base::Code::Invalid, what + " must be a JSON object",
                      {{pointer_, "must be an object"}});
  }
  refuse_unknown();
  if (problems_.none()) return {};
  return tl::unexpected<base::Error>(std::move(problems_).error());
}

}  // namespace roverd::mission
