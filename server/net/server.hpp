#pragma once
// HTTP/1.1 and WebSocket on Beast, plain or over TLS. Knows bytes, requests and topics; no word of
// what they mean. Everything runs on one io_context with one thread (the web thread); every call
// and callback here belongs to that thread, unless it says otherwise. Make that io_context with
// kWebConcurrency.
//
//   Server (listener) ─accept─▶ Connection (HTTP) ─upgrade─▶ Session (WebSocket) ◀─frames─ Hub
//
// Every connection is bounded: header, body and message bytes, the time for a request, idle time,
// the time a client may refuse to read, the number of connections. What is beyond a bound is
// refused with a status, or closed.
//
// What is urgent always gets in. A full house makes room by letting those go that wait or have sent
// half a header, the oldest first. Are all busy, newcomers sit on a reserve: they have a second to
// say what they want, and only what is urgent is served (on a WebSocket: all of that second). For
// want of descriptors it is the same: some are held back and opened for the reserve (spares.hpp).
//
// So it is with one address, too: beyond its share its own waiting ones go, then it sits on the
// reserve, of which it may have a quarter. A /64 of IPv6 may have four times an address's share,
// and half of the reserve.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/detail/concurrency_hint.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::net {

/// One thread runs the io_context; posting to it from other threads is fine.
inline constexpr int kWebConcurrency = BOOST_ASIO_CONCURRENCY_HINT_UNSAFE_IO;

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;
/// To be called exactly once, on the web thread, at any later time; harmless if the client is gone.
/// Dropping it uncalled closes the connection.
using Respond = std::function<void(Response)>;

/// The slowest client that may send a long body.
inline constexpr std::size_t kSlowest_Bps = 64 * 1024;

struct Limits {
  std::size_t header_bytes = 16 * 1024;
  std::size_t body_bytes = 8 * 1024 * 1024;  ///< where Handlers::body_limit says nothing else
  /// Of all bodies that are read and worked on at the same time, together.
  std::size_t all_bodies_bytes = 192 * 1024 * 1024;
  /// Of all large answers on their way, together.
  std::size_t all_answers_bytes = 192 * 1024 * 1024;
  std::size_t message_bytes = 64 * 1024;  ///< one WebSocket message from a client
  int connections = 512;                  ///< fewer where the system allows fewer descriptors
  int kept = 0;                           ///< of those, at most an eighth, for whom Handlers::knows
  int reserve = 32;                       ///< more than those, for what is urgent
  /// Of one address, but 127.0.0.1 and ::1; 0: as many as there may be.
  int per_address = 0;
  base::Duration reserve_time = std::chrono::seconds(1);
  base::Duration idle = std::chrono::seconds(30);
  /// TLS's handshake must be over by then. Header and body must be in by then (a long body may take
  /// longer: kSlowest_Bps); a client that reads nothing of its answer for so long is closed, too.
  base::Duration request = std::chrono::seconds(30);
};

using ClientId = std::uint64_t;

/// See tls.hpp.
class Tls;

/// Whole: among the first, with its body. AtHeader: it needs no body and does not wait for one.
enum class Urgency { None, Whole, AtHeader };

/// One topic at one rate has one sequence; a text is shared by all its clients. See hub.hpp.
class Hub;

/// Of every request that a handler sees, set here, whatever was sent: the address it came from, and
/// the one it came to. Those of IPv4 as such, also where they come in through IPv6.
inline constexpr std::string_view kPeerHeader = "Roverd-Peer";
inline constexpr std::string_view kHereHeader = "Roverd-Here";

struct Handlers {
  /// Any request that is not a WebSocket upgrade. `begun`: it cannot have been sent before; at the
  /// latest when its first byte was there (see connection.hpp). HEAD comes as it is; answer as for
  /// GET, net leaves out the body.
  std::function<void(Request, base::Time begun, Respond)> on_request;
  /// The largest body of a request with this header. May be empty.
  std::function<std::size_t(const Request& header)> body_limit{};
  /// What is served on the reserve, too. May be empty: nothing is.
  std::function<Urgency(const Request& header)> urgency{};
  /// Somebody from this address belongs here. May be empty: nobody is told apart.
  std::function<bool(const std::string& address)> knows{};
  /// Frees what is large where it holds up nobody. May be empty.
  std::function<void(std::string)> discard{};
  /// An upgrade request: nullopt accepts, a response refuses.
  std::function<std::optional<Response>(const Request&)> on_upgrade;
  /// @param upgrade the request that on_upgrade accepted
  std::function<void(ClientId, const Request& upgrade)> on_client;
  /// `begun`: when its first byte was there.
  std::function<void(ClientId, base::Time begun, std::string_view text)> on_text;
  /// Of a short text: it goes to on_text before all that its client said earlier and that still
  /// waits (64 KiB of it are looked through). May be empty.
  std::function<bool(std::string_view text)> urgent_text{};
  std::function<void(ClientId)> on_gone;
  /// Where TLS is spoken: the answer to a request without, at its header. May be empty.
  std::function<Response(const Request& header)> on_plain{};
  /// The answer for requests that net itself refuses: 400 malformed, 413, 417, 431, 501, 503.
  std::function<Response(unsigned status, std::string_view detail)> on_refused;
  /// Once a second. May be empty.
  std::function<void()> on_second;
};

struct Stats {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;    ///< beyond the number of connections, in all or of one address
  std::uint64_t timed_out = 0;  ///< too slow or silent for too long
  std::uint64_t requests = 0;
  int connections = 0;  ///< open now, WebSockets included
  int clients = 0;      ///< WebSockets open now
};

class Server {
 public:
  /// Binds and starts accepting. @param port 0: the system chooses one. Errors: Invalid (not an IP
  /// address), Conflict ("port 8080 is in use"), Unavailable (the system's reason).
  static base::Result<std::unique_ptr<Server>> listen(boost::asio::io_context& io,
                                                      const std::string& address,
                                                      std::uint16_t port, Limits limits,
                                                      Handlers handlers);
  /// On several addresses, at one port. "::" is every address that this computer has or will have,
  /// of IPv4, too (and only of IPv4 where there is no IPv6). Others need not be there yet.
  static base::Result<std::unique_ptr<Server>> listen(boost::asio::io_context& io,
                                                      const std::vector<std::string>& addresses,
                                                      std::uint16_t port, Limits limits,
                                                      Handlers handlers);
  /// Closes everything at once; no handler is called any more.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Every connection speaks TLS. Before the io_context runs.
  void secure(std::shared_ptr<Tls> tls);

  std::uint16_t port() const noexcept;
  /// Lives as long as the server.
  Hub& hub() noexcept;
  Stats stats() const noexcept;
  /// An exception (no memory) has left the io_context's run(): whatever it may have cut off goes
  /// on.
  void resume();

  /// Stops accepting, says goodbye to the WebSocket clients, lets running answers go out, and after
  /// `grace` closes what is left. `done` is called once, then or earlier.
  void stop(base::Duration grace, std::function<void()> done);

 private:
  struct Impl;
  explicit Server(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> impl_;
};

}  // namespace roverd::net
