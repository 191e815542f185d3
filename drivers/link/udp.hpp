#pragma once
// Datagrams received on a port, from anybody or from one peer only; on_bytes gets one datagram at a
// time.

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include <sys/socket.h>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// Listens on all addresses, IPv4 and IPv6. Without a peer, write() goes to whoever sent last and
/// is Closed as long as there is nobody. With one, write() goes there, and a datagram from any
/// other address or port is counted (strangers) and never handed over.
class UdpLink final : public ByteLink {
 public:
  struct Peer {
    std::string address;  ///< numeric, IPv4 or IPv6
    std::uint16_t port = 0;
  };

  /// @param port to receive on; 0: the kernel chooses (see port()).
  UdpLink(asio::io_context& io, std::uint16_t port, std::optional<Peer> peer = {});
  ~UdpLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override;
  std::uint64_t strangers() const noexcept override { return strangers_; }
  Ends ends() const noexcept override;

  /// Device thread, after open(): the port received on.
  std::uint16_t port() const noexcept { return bound_port_; }

 private:
  struct Address {
    sockaddr_storage storage{};
    socklen_t size = 0;  ///< 0: nobody yet
  };

  base::Result<int> bind_socket();
  void read();
  void remember(const Address& sender);
  bool is_peer(const Address& sender) const noexcept;
  void lost(const std::string& reason);

  const std::uint16_t port_;
  const std::optional<Peer> peer_;
  std::uint16_t bound_port_ = 0;
  std::uint64_t strangers_ = 0;  ///< device thread
  Address heard_;                ///< device thread: who sent the datagram that is handed over
  Descriptor socket_;
  std::mutex mutex_;  // leaf; guards target_, taken by the device thread when the sender changes
  Address target_;
};

}  // namespace roverd::link
