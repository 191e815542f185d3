#pragma once
// HTTP/1.1 and WebSocket on Beast. Knows bytes, requests and topics; no word of what they mean.
// Everything runs on one io_context with one thread (the web thread); every call and callback here
// belongs to that thread, unless it says otherwise.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::net {

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;
/// To be called exactly once, on the web thread, at any later time; harmless if the client is gone.
using Respond = std::function<void(Response)>;

struct Limits {
  std::size_t header_bytes = 16 * 1024;
  std::size_t body_bytes = 8 * 1024 * 1024;
  std::size_t message_bytes = 64 * 1024;  ///< one WebSocket message from a client
  int connections = 512;
  base::Duration idle = std::chrono::seconds(30);
  base::Duration request = std::chrono::seconds(30);  ///< header and body must be in by then
};

using ClientId = std::uint64_t;

/// One topic at one rate has one sequence; a text is shared by all its clients.
class Hub;

struct Handlers {
  /// Any request that is not a WebSocket upgrade.
  std::function<void(Request, Respond)> on_request;
  /// An upgrade request: nullopt accepts, a response refuses.
  std::function<std::optional<Response>(const Request&)> on_upgrade;
  std::function<void(ClientId)> on_client;
  std::function<void(ClientId, std::string_view text)> on_text;
  std::function<void(ClientId)> on_gone;
  /// The answer for requests that net itself refuses: 400 malformed, 413, 431, 503 …
  std::function<Response(unsigned status, std::string_view detail)> on_refused;
};

}  // namespace roverd::net
