#pragma once
// A byte stream over TCP: a client for devices that listen, and a broadcasting server for programs
// that play a device.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// Client. open() only starts to resolve and connect, because the device thread must not wait for a
/// host that does not answer; a failure comes as on_closed, at most connect_timeout later. Until
/// connected, write() says Closed.
///
///   Closed --open--> Connecting --connected--> Open
///   Connecting --refused | time-out--> Closed (on_closed)     Open --end | error--> Closed
///   (on_closed)
///
/// Small writes leave at once (TCP_NODELAY); a peer that vanished without a word is noticed within
/// about 20 s (keep-alive).
class TcpLink final : public ByteLink {
 public:
  static constexpr base::Duration kConnectTimeout = std::chrono::seconds(3);

  /// @param host name or address, IPv6 without brackets. @param port 1..65535.
  TcpLink(asio::io_context& io, std::string host, std::uint16_t port);
  ~TcpLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override;

  /// Device thread.
  bool is_connected() const noexcept { return socket_.is_open(); }

 private:
  struct Attempt;
  void connect(const std::shared_ptr<Attempt>& attempt,
               const asio::ip::tcp::resolver::results_type& found);
  void connected(Attempt& attempt);
  void read();
  void lost(const std::string& reason);

  asio::io_context& io_;
  const std::string host_;
  const std::uint16_t port_;
  Descriptor socket_;
  std::shared_ptr<Attempt> attempt_;  ///< while connecting; shared with its handlers
};

/// Server: write() goes to every client, on_bytes hears every client. A client that is slow loses
/// whole writes (never parts of one) once kMaxWaiting bytes wait for it, counted in dropped(); one
/// that is larger alone, an image, goes when nothing waits.
/// on_closed is never called: a server stays when clients come and go.
class TcpServer final : public ByteLink {
 public:
  static constexpr std::size_t kMaxClients = 32;
  static constexpr std::size_t kMaxWaiting = 64 * 1024;

  /// @param address numeric, to bind to: "127.0.0.1". @param port 0: the kernel chooses.
  /// @param most_clients 1..kMaxClients; further ones are turned away and counted (strangers): 1
  /// where what two of them say must not be mixed.
  TcpServer(asio::io_context& io, std::string address, std::uint16_t port,
            std::size_t most_clients = kMaxClients);
  ~TcpServer() override;

  base::Result<void> open() override;
  void close() noexcept override;
  /// Any thread; the bytes are copied and sent on the device thread. Sent also without a client.
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override;
  std::uint64_t strangers() const noexcept override { return turned_away_; }

  /// Device thread, after open(): the port listened on.
  std::uint16_t port() const noexcept { return port_; }
  /// Device thread.
  std::size_t clients() const noexcept { return clients_.size(); }
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Client;
  using Message = std::shared_ptr<const std::vector<std::uint8_t>>;

  base::Result<void> listen();
  void accept();
  void read(const std::shared_ptr<Client>& client);
  void offer(const std::shared_ptr<Client>& client, const Message& message);
  void flush(const std::shared_ptr<Client>& client);
  void drop(const std::shared_ptr<Client>& client);

  asio::io_context& io_;
  const std::string address_;
  std::uint16_t port_;
  const std::size_t most_clients_;
  std::uint64_t turned_away_ = 0;  ///< device thread
  asio::ip::tcp::acceptor acceptor_;
  std::vector<std::shared_ptr<Client>> clients_;
  /// Held by nobody else; handlers hold it weakly and do nothing once it is gone.
  std::shared_ptr<TcpServer*> self_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace roverd::link
