#include "net/server.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/detail/socket_option.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <netinet/in.h>

#include "net/address.hpp"
#include "net/connection.hpp"
#include "net/hub.hpp"
#include "net/peers.hpp"
#include "net/spares.hpp"

namespace roverd::net {

using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr int kBacklog = 1024;
constexpr auto kRetryAccept = std::chrono::milliseconds(100);
/// For a port that the system chose and that is taken at the next address.
constexpr int kOtherPorts = 20;
constexpr const char* kEveryAddress = "::";
constexpr const char* kEveryIpv4 = "0.0.0.0";

/// An address that this computer does not have yet can be listened on.
using FreeBind = boost::asio::detail::socket_option::boolean<IPPROTO_IP, IP_FREEBIND>;

error_code bind_to(tcp::acceptor& acceptor, const tcp::endpoint& endpoint) {
  error_code ec;
  error_code ignored;
  acceptor.open(endpoint.protocol(), ec);
  if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!ec && endpoint.address().is_v6()) {
    acceptor.set_option(boost::asio::ip::v6_only(!endpoint.address().is_unspecified()), ec);
  }
  if (!ec) acceptor.set_option(FreeBind(true), ignored);
  if (!ec) acceptor.bind(endpoint, ec);
  if (!ec) acceptor.listen(kBacklog, ec);
  if (ec) acceptor.close(ignored);
  return ec;
}

}  // namespace

struct Server::Impl : std::enable_shared_from_this<Server::Impl> {
  /// One address on which newcomers come in.
  struct Listener {
    explicit Listener(boost::asio::io_context& io) : acceptor(io), retry_timer(io) {}
    tcp::acceptor acceptor;
    boost::asio::steady_timer retry_timer;
    bool accepting = false;  ///< or waiting to go on
  };

  Impl(boost::asio::io_context& io, Limits limits, Handlers handlers)
      : peers(std::make_shared<Peers>(io, limits, std::move(handlers))),
        sweep_timer(io),
        stop_timer(io) {}

  base::Result<void> open(const std::vector<std::string>& addresses, std::uint16_t port);
  base::Result<void> open_all(const std::vector<std::string>& addresses, std::uint16_t port);
  base::Result<void> open_one(const std::string& address, std::uint16_t port);
  void accept(Listener& at);
  void accepted(Listener& at, error_code ec, tcp::socket socket);
  void accept_failed(Listener& at, error_code why);
  void welcome(tcp::socket socket);
  void sweep();
  void stop(base::Duration grace, std::function<void()> done);
  void shut();
  void close();

  std::shared_ptr<Peers> peers;
  std::vector<std::unique_ptr<Listener>> listeners;  ///< they stay
  boost::asio::steady_timer sweep_timer;
  boost::asio::steady_timer stop_timer;
  Spares spares;
  bool on_spare = false;  ///< whoever is accepted next
  bool sweeping = false;
  std::uint16_t port = 0;
  int sweeps = 0;
};

base::Result<void> Server::Impl::open_one(const std::string& text, std::uint16_t wanted) {
  error_code ec;
  const auto address = boost::asio::ip::make_address(text, ec);
  if (ec) return base::fail(base::Code::Invalid, "\"" + text + "\" is not an IP address");
  auto made = std::make_unique<Listener>(peers->io);
  ec = bind_to(made->acceptor, tcp::endpoint(address, wanted));
  if (ec == boost::asio::error::address_family_not_supported && text == kEveryAddress) {
    return open_one(kEveryIpv4, wanted);
  }
  const std::string name = "port " + std::to_string(wanted);
  if (ec == boost::asio::error::address_in_use) {
    return base::fail(base::Code::Conflict, name + " is in use");
  }
  if (ec) {
    return base::fail(base::Code::Unavailable,
                      "cannot listen on " + text + " " + name + ": " + ec.message());
  }
  port = made->acceptor.local_endpoint(ec).port();
  listeners.push_back(std::move(made));
  return {};
}

/// All at the same port.
base::Result<void> Server::Impl::open_all(const std::vector<std::string>& addresses,
                                          std::uint16_t wanted) {
  listeners.clear();
  for (const std::string& address : addresses) {
    if (auto done = open_one(address, listeners.empty() ? wanted : port); !done) return done;
  }
  return {};
}

base::Result<void> Server::Impl::open(const std::vector<std::string>& addresses,
                                      std::uint16_t wanted) {
  auto done = open_all(addresses, wanted);
  for (int i = 0; i < kOtherPorts && wanted == 0; ++i) {
    if (done || done.error().code != base::Code::Conflict) break;
    done = open_all(addresses, wanted);
  }
  return done;
}

void Server::Impl::accept(Listener& at) {
  at.acceptor.async_accept([self = shared_from_this(), &at](error_code ec, tcp::socket socket) {
    at.accepting = false;
    if (at.acceptor.is_open()) self->accepted(at, ec, std::move(socket));
  });
  at.accepting = true;
}

void Server::Impl::accepted(Listener& at, error_code ec, tcp::socket socket) {
  if (ec) return accept_failed(at, ec);
  try {
    welcome(std::move(socket));
  } catch (const std::bad_alloc&) {
    ++peers->stats.refused;  // and closed
  }
  accept(at);
}

void Server::Impl::accept_failed(Listener& at, error_code why) {
  const bool no_descriptor = why == boost::asio::error::no_descriptors ||
                             why == boost::system::errc::too_many_files_open_in_system;
  if (no_descriptor) {
    if (peers->drop_longest_waiting(false)) return accept(at);
    on_spare = spares.give() || peers->drop_longest_waiting(true);
    if (on_spare) return accept(at);
  }
  // The client was gone already, or nothing helps: go on a little later.
  at.retry_timer.expires_after(kRetryAccept);
  at.retry_timer.async_wait([self = shared_from_this(), &at](error_code cancelled) {
    at.accepting = false;
    if (!cancelled && at.acceptor.is_open()) self->accept(at);
  });
  at.accepting = true;
}

void Server::Impl::welcome(tcp::socket socket) {
  ++peers->stats.accepted;
  const bool spare = std::exchange(on_spare, false);
  error_code gone;
  const From from = counted_as(socket.remote_endpoint(gone).address());
  const bool reserve = spare || !peers->makes_room(from);
  if (reserve) ++peers->stats.refused;
  if (reserve && !peers->makes_room_on_reserve(from)) return;
  const auto connection = std::make_shared<Connection>(peers, Wire(std::move(socket)));
  peers->add(connection.get(), connection, from);
  connection->start(reserve);
}

void Server::Impl::sweep() {
  sweep_timer.expires_after(Peers::kSweep);
  sweep_timer.async_wait([self = shared_from_this()](error_code ec) {
    self->sweeping = false;
    if (ec) return;
    const base::Time now = base::steady_now();
    self->peers->awake(now);
    self->peers->each([now](Peer& peer) { peer.sweep(now); });
    self->spares.refill();
    constexpr int kPerSecond = std::chrono::seconds(1) / Peers::kSweep;
    if (++self->sweeps % kPerSecond == 0 && self->peers->handlers.on_second) {
      self->peers->handlers.on_second();
    }
    self->sweep();
  });
  sweeping = true;
}

/// Nobody comes in any more.
void Server::Impl::shut() {
  error_code ignored;
  for (const auto& at : listeners) {
    at->acceptor.close(ignored);
    at->retry_timer.cancel();
  }
}

void Server::Impl::close() {
  shut();
  sweep_timer.cancel();
  peers->each([](Peer& peer) { peer.force(); });
}

void Server::Impl::stop(base::Duration grace, std::function<void()> done) {
  shut();
  peers->stopping = true;
  peers->each([](Peer& peer) { peer.stop(); });
  const auto end = std::chrono::steady_clock::now() + grace;
  // A short look now and then is simpler than counting, and this happens once.
  const auto look = [self = shared_from_this(), end, done = std::move(done)](const auto& again,
                                                                             error_code) -> void {
    if (self->peers->count() > 0 && std::chrono::steady_clock::now() < end) {
      self->stop_timer.expires_after(std::chrono::milliseconds(10));
      self->stop_timer.async_wait([again](error_code ec) { again(again, ec); });
      return;
    }
    self->close();
    if (done) done();
  };
  look(look, {});
}

Server::Server(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

base::Result<std::unique_ptr<Server>> Server::listen(boost::asio::io_context& io,
                                                     const std::string& address, std::uint16_t port,
                                                     Limits limits, Handlers handlers) {
  return listen(io, std::vector<std::string>{address}, port, limits, std::move(handlers));
}

base::Result<std::unique_ptr<Server>> Server::listen(boost::asio::io_context& io,
                                                     const std::vector<std::string>& addresses,
                                                     std::uint16_t port, Limits limits,
                                                     Handlers handlers) {
  limits.connections = std::min(limits.connections, Spares::descriptors_left(limits.reserve));
  auto impl = std::make_shared<Impl>(io, limits, std::move(handlers));
  if (auto opened = impl->open(addresses, port); !opened) {
    return tl::unexpected<base::Error>(std::move(opened.error()));
  }
  for (const auto& at : impl->listeners) impl->accept(*at);
  impl->sweep();
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

Server::~Server() {
  impl_->close();
  impl_->stop_timer.cancel();
  impl_->peers->handlers = {};
}

void Server::secure(std::shared_ptr<Tls> tls) {
  impl_->peers->tls = std::move(tls);
}

std::uint16_t Server::port() const noexcept {
  return impl_->port;
}

void Server::resume() {
  if (!impl_->sweeping) impl_->sweep();
  for (const auto& at : impl_->listeners) {
    if (!at->accepting && at->acceptor.is_open()) impl_->accept(*at);
  }
}

Hub& Server::hub() noexcept {
  return impl_->peers->hub;
}

Stats Server::stats() const noexcept {
  Stats stats = impl_->peers->stats;
  stats.connections = impl_->peers->count();
  return stats;
}

void Server::stop(base::Duration grace, std::function<void()> done) {
  impl_->stop(grace, std::move(done));
}

}  // namespace roverd::net
