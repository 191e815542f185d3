#include "net/server.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

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

}  // namespace

Response Peers::refusal(unsigned status, std::string_view detail) const {
  if (handlers.on_refused) return handlers.on_refused(status, detail);
  Response response{boost::beast::http::int_to_status(status), 11};
  response.set(boost::beast::http::field::content_type, "text/plain; charset=utf-8");
  response.body() = std::string(detail) + "\n";
  return response;
}

struct Server::Impl : std::enable_shared_from_this<Server::Impl> {
  Impl(boost::asio::io_context& io, Limits limits, Handlers handlers)
      : peers(std::make_shared<Peers>(io, limits, std::move(handlers))),
        acceptor(io),
        sweep_timer(io),
        retry_timer(io),
        stop_timer(io) {}

  base::Result<void> open(const std::string& address, std::uint16_t port);
  void accept();
  void accepted(error_code ec, tcp::socket socket);
  void accept_failed(error_code why);
  void welcome(tcp::socket socket);
  void sweep();
  void stop(base::Duration grace, std::function<void()> done);
  void close();

  std::shared_ptr<Peers> peers;
  tcp::acceptor acceptor;
  boost::asio::steady_timer sweep_timer;
  boost::asio::steady_timer retry_timer;
  boost::asio::steady_timer stop_timer;
  Spares spares;
  bool on_spare = false;   ///< whoever is accepted next
  bool accepting = false;  ///< or waiting to go on
  bool sweeping = false;
  std::uint16_t port = 0;
  int sweeps = 0;
};

base::Result<void> Server::Impl::open(const std::string& text, std::uint16_t wanted) {
  error_code ec;
  const auto address = boost::asio::ip::make_address(text, ec);
  if (ec) return base::fail(base::Code::Invalid, "\"" + text + "\" is not an IP address");
  const tcp::endpoint endpoint(address, wanted);
  const std::string name = "port " + std::to_string(wanted);
  acceptor.open(endpoint.protocol(), ec);
  if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!ec) acceptor.bind(endpoint, ec);
  if (!ec) acceptor.listen(kBacklog, ec);
  if (ec == boost::asio::error::address_in_use) {
    return base::fail(base::Code::Conflict, name + " is in use");
  }
  if (ec)
    return base::fail(base::Code::Unavailable,
                      "cannot listen on " + text + " " + name + ": " + ec.message());
  port = acceptor.local_endpoint(ec).port();
  return {};
}

void Server::Impl::accept() {
  acceptor.async_accept([self = shared_from_this()](error_code ec, tcp::socket socket) {
    self->accepting = false;
    if (self->acceptor.is_open()) self->accepted(ec, std::move(socket));
  });
  accepting = true;
}

void Server::Impl::accepted(error_code ec, tcp::socket socket) {
  if (ec) return accept_failed(ec);
  try {
    welcome(std::move(socket));
  } catch (const std::bad_alloc&) {
    ++peers->stats.refused;  // and closed
  }
  accept();
}

void Server::Impl::accept_failed(error_code why) {
  const bool no_descriptor = why == boost::asio::error::no_descriptors ||
                             why == boost::system::errc::too_many_files_open_in_system;
  if (no_descriptor) {
    if (peers->drop_longest_waiting(false)) return accept();
    on_spare = spares.give() || peers->drop_longest_waiting(true);
    if (on_spare) return accept();
  }
  // The client was gone already, or nothing helps: go on a little later.
  retry_timer.expires_after(kRetryAccept);
  retry_timer.async_wait([self = shared_from_this()](error_code cancelled) {
    self->accepting = false;
    if (!cancelled && self->acceptor.is_open()) self->accept();
  });
  accepting = true;
}

void Server::Impl::welcome(tcp::socket socket) {
  ++peers->stats.accepted;
  const bool spare = std::exchange(on_spare, false);
  const int reserved = peers->on_reserve();
  const bool full =
      peers->count() - reserved >= peers->limits.connections && !peers->drop_longest_waiting(false);
  const bool reserve = spare || full;
  if (reserve) ++peers->stats.refused;
  if (reserve && reserved >= peers->limits.reserve && !peers->drop_longest_waiting(true)) return;
  const auto connection = std::make_shared<Connection>(peers, Wire(std::move(socket)));
  peers->add(connection.get(), connection);
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

void Server::Impl::close() {
  error_code ignored;
  acceptor.close(ignored);
  sweep_timer.cancel();
  retry_timer.cancel();
  peers->each([](Peer& peer) { peer.force(); });
}

void Server::Impl::stop(base::Duration grace, std::function<void()> done) {
  error_code ignored;
  acceptor.close(ignored);
  retry_timer.cancel();
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
  limits.connections = std::min(limits.connections, Spares::descriptors_left(limits.reserve));
  auto impl = std::make_shared<Impl>(io, limits, std::move(handlers));
  if (auto opened = impl->open(address, port); !opened) {
    return tl::unexpected<base::Error>(std::move(opened.error()));
  }
  impl->accept();
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
  if (!impl_->accepting && impl_->acceptor.is_open()) impl_->accept();
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
