#include <algorithm>
#include <array>
#include <deque>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "link/tcp.hpp"

namespace roverd::link {
namespace {

using asio::ip::tcp;

}  // namespace

struct TcpServer::Client {
  explicit Client(tcp::socket s) : socket(std::move(s)) {}
  tcp::socket socket;
  std::array<std::uint8_t, 4096> buffer{};
  std::deque<Message> waiting;  // the front one is being written
  std::size_t waiting_bytes = 0;
};

TcpServer::TcpServer(asio::io_context& io, std::string address, std::uint16_t port,
                     std::size_t most_clients)
    : io_(io),
      address_(std::move(address)),
      port_(port),
      most_clients_(std::min(most_clients, kMaxClients)),
      acceptor_(io),
      self_(std::make_shared<TcpServer*>(this)) {}

TcpServer::~TcpServer() {
  close();
}

std::string TcpServer::describe() const {
  const bool v6 = address_.find(':') != std::string::npos;
  return "tcp:" + (v6 ? "[" + address_ + "]" : address_) + ":" + std::to_string(port_);
}

base::Result<void> TcpServer::open() {
  auto result = listen();
  if (!result) {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    return result;
  }
  accept();
  return {};
}

base::Result<void> TcpServer::listen() {
  boost::system::error_code ec;
  const auto fail = [&] {
    return base::fail(base::Code::Unavailable,
                      "cannot listen on " + describe() + ": " + ec.message());
  };
  const auto address = asio::ip::make_address(address_, ec);
  if (ec) return fail();
  const tcp::endpoint endpoint(address, port_);
  if (acceptor_.open(endpoint.protocol(), ec)) return fail();
  if (acceptor_.set_option(tcp::acceptor::reuse_address(true), ec)) return fail();
  if (acceptor_.bind(endpoint, ec)) return fail();
  if (acceptor_.listen(static_cast<int>(kMaxClients), ec)) return fail();
  const auto local = acceptor_.local_endpoint(ec);
  if (ec) return fail();
  port_ = local.port();
  return {};
}

void TcpServer::close() noexcept {
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  for (const auto& client : clients_) client->socket.close(ignored);
  clients_.clear();
}

void TcpServer::accept() {
  acceptor_.async_accept(
      [this, weak = std::weak_ptr(self_)](const boost::system::error_code& ec, tcp::socket socket) {
        if (weak.expired() || ec == asio::error::operation_aborted || !acceptor_.is_open()) return;
        if (!ec && clients_.size() >= most_clients_) {
          ++turned_away_;
        } else if (!ec) {
          boost::system::error_code ignored;
          socket.set_option(tcp::no_delay(true), ignored);
          clients_.push_back(std::make_shared<Client>(std::move(socket)));
          if (on_peer) on_peer();
          read(clients_.back());
        }
        accept();
      });
}

void TcpServer::read(const std::shared_ptr<Client>& client) {
  client->socket.async_read_some(asio::buffer(client->buffer),
                                 [this, weak = std::weak_ptr(self_), client](
                                     const boost::system::error_code& ec, std::size_t n) {
                                   if (weak.expired() || !client->socket.is_open()) return;
                                   if (ec) {
                                     drop(client);
                                     return;
                                   }
                                   if (on_bytes && n > 0)
                                     on_bytes({client->buffer.data(), n}, base::steady_now());
                                   if (client->socket.is_open()) read(client);
                                 });
}

SendResult TcpServer::write(Bytes bytes) noexcept {
  if (bytes.empty()) return SendResult::Sent;
  auto message = std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end());
  asio::post(io_, [this, weak = std::weak_ptr(self_), message = std::move(message)] {
    if (weak.expired()) return;
    const auto clients = clients_;  // a failing write drops from the list
    for (const auto& client : clients) offer(client, message);
  });
  return SendResult::Sent;
}

void TcpServer::offer(const std::shared_ptr<Client>& client, const Message& message) {
  if (!client->waiting.empty() && client->waiting_bytes + message->size() > kMaxWaiting) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  client->waiting.push_back(message);
  client->waiting_bytes += message->size();
  if (client->waiting.size() == 1) flush(client);
}

void TcpServer::flush(const std::shared_ptr<Client>& client) {
  asio::async_write(client->socket, asio::buffer(*client->waiting.front()),
                    [this, weak = std::weak_ptr(self_), client](const boost::system::error_code& ec,
                                                                std::size_t) {
                      if (weak.expired() || !client->socket.is_open()) return;
                      if (ec) {
                        drop(client);
                        return;
                      }
                      client->waiting_bytes -= client->waiting.front()->size();
                      client->waiting.pop_front();
                      if (!client->waiting.empty()) flush(client);
                    });
}

void TcpServer::drop(const std::shared_ptr<Client>& client) {
  boost::system::error_code ignored;
  client->socket.close(ignored);
  std::erase(clients_, client);
}

}  // namespace roverd::link
