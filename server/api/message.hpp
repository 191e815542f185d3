#pragma once
// HTTP messages as values: what comes in, what goes out. No sockets.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <nlohmann/json.hpp>

#include "base/result.hpp"
#include "base/time.hpp"
#include "people/book.hpp"

namespace roverd::api {

namespace http = boost::beast::http;

using Json = nlohmann::json;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
/// Called once with the answer, at once or later, on the web thread.
using Respond = std::function<void(Response)>;
using ClientId = std::uint64_t;

/// One request on its way through a handler.
struct Call {
  Request request;
  base::Time begun;                                          ///< when its first byte was there
  std::map<std::string, std::string, std::less<>> params{};  ///< from the path, decoded
  std::map<std::string, std::string, std::less<>> query{};   ///< decoded
  Respond respond;
  std::optional<people::Who> who{};  ///< empty: nobody known, or access control is off
  bool acts = false;                 ///< on the robot: control must be held
  std::string operation{};           ///< "/missions/{id}"; empty: none of ours
  std::string named{};               ///< the user that a log-in is for, if there is such a one
  std::string named_by{};  ///< "device 1f…": what it showed to be named so; opens nothing
};
using CallPtr = std::shared_ptr<Call>;

/// For the events, which tell people who did it. @param who empty: nobody is known by name
inline std::string words_for(const std::optional<people::Who>& who) {
  return who ? who->user : "the page or a script";
}

/// Empty if it is not there.
inline std::string_view header(const Request& request, http::field name) {
  const auto value = request[name];
  return {value.data(), value.size()};
}
inline std::string_view header(const Request& request, std::string_view name) {
  const auto value = request[boost::beast::string_view(name.data(), name.size())];
  return {value.data(), value.size()};
}
inline std::string_view target(const Request& request) {
  return {request.target().data(), request.target().size()};
}

/// A JSON answer that no cache keeps.
Response json_response(http::status status, const Json& body);
Response text_response(http::status status, std::string_view content_type, std::string body);

}  // namespace roverd::api
