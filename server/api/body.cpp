#include "api/body.hpp"

#include <charconv>
#include <cmath>

#include <boost/beast/core/string.hpp>

#include "mission/json/json.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::api {

namespace {

std::string bounds(double min, double max) {
  return "must lie in " + Json(min).dump() + " .. " + Json(max).dump();
}

}  // namespace

base::Result<void> check_json_type(const Request& request) {
  std::string_view type = header(request, http::field::content_type);
  type = type.substr(0, type.find(';'));
  while (type.ends_with(' ')) type.remove_suffix(1);
  if (!boost::beast::iequals({type.data(), type.size()}, "application/json")) {
    return base::fail(base::Code::Unsupported, "the body must be sent as application/json");
  }
  return {};
}

base::Result<Json> json_body(const Request& request, bool optional) {
  if (optional && request.body().empty()) return Json::object();
  if (auto ok = check_json_type(request); !ok) return tl::unexpected<base::Error>(ok.error());
  return mission::parse_json(request.body());
}

const Json* Members::find(std::string_view name) {
  asked_.emplace(name);
  if (!object_.is_object()) return nullptr;
  const auto found = object_.find(std::string(name));
  return found == object_.end() || found->is_null() ? nullptr : &*found;
}

void Members::complain(std::string_view name, std::string detail) {
  errors_.push_back({"/" + mission::escaped_key(name), std::move(detail)});
}

void Members::complain_of_header(std::string_view name, std::string detail) {
  errors_.push_back({std::string(name), std::move(detail)});
}

void Members::complain_inside(std::string_view name, const base::Error& inner) {
  for (const auto& [pointer, detail] : inner.fields) {
    errors_.push_back({"/" + mission::escaped_key(name) + pointer, detail});
  }
}

void Members::require(std::string_view name) {
  if (object_.is_object() && find(name) == nullptr) complain(name, "is missing");
}

const Json* Members::any(std::string_view name) {
  return find(name);
}

std::optional<double> Members::number(std::string_view name, double min, double max) {
  const Json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_number()) {
    complain(name, "must be a number");
    return std::nullopt;
  }
  const double number = value->get<double>();
  if (!(number >= min && number <= max)) {
    complain(name, bounds(min, max));
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
  const Json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) {
    complain(name, "must be text");
    return std::nullopt;
  }
  return value->get<std::string>();
}

std::optional<bool> Members::flag(std::string_view name) {
  const Json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (!value->is_boolean()) {
    complain(name, "must be true or false");
    return std::nullopt;
  }
  return value->get<bool>();
}

base::Result<void> Members::finish() {
  if (!object_.is_object()) {
    return base::fail(base::Code::Invalid, "the body must be a JSON object",
                      {{"", "must be an object"}});
  }
  for (const auto& [name, value] : object_.items()) {
    if (!asked_.contains(name) && errors_.size() < mission::kMaxFieldErrors) {
      complain(name, "unknown member");
    }
  }
  if (errors_.empty()) return {};
  std::string detail = errors_.front().pointer + " " + errors_.front().detail;
  return base::fail(base::Code::Invalid, std::move(detail), std::move(errors_));
}

std::optional<std::int64_t> whole_number(std::string_view text) noexcept {
  std::int64_t value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size() || text.empty() || value < 0) {
    return std::nullopt;
  }
  return value;
}

base::Result<int> limit_of(const Call& call) {
  constexpr int kDefault = 100;
  constexpr int kMost = 1000;
  const auto found = call.query.find("limit");
  if (found == call.query.end()) return kDefault;
  const auto value = whole_number(found->second);
  if (value && *value >= 1 && *value <= kMost) return static_cast<int>(*value);
  return base::fail(base::Code::Invalid, "limit must be a whole number in 1 .. 1000",
                    {{"limit", "must be a whole number in 1 .. 1000"}});
}

std::string query_text(const Call& call, std::string_view name) {
  const auto found = call.query.find(name);
  return found == call.query.end() ? std::string{} : found->second;
}

}  // namespace roverd::api
