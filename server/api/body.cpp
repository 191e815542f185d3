#include "api/body.hpp"

#include <charconv>

#include "base/same_word.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

base::Result<void> check_json_type(const Request& request) {
  std::string_view type = header(request, http::field::content_type);
  type = type.substr(0, type.find(';'));
  while (type.ends_with(' ')) type.remove_suffix(1);
  if (!base::same_word(type, "application/json")) {
    return base::fail(base::Code::Unsupported, "the body must be sent as application/json");
  }
  return {};
}

base::Result<Json> json_body(const Request& request, bool optional) {
  if (optional && request.body().empty()) return Json::object();
  if (auto ok = check_json_type(request); !ok) return tl::unexpected<base::Error>(ok.error());
  return mission::parse_json(request.body());
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
