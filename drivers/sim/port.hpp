#pragma once
// Where a simulated device listens: a UDP port, a TCP port on 127.0.0.1, or a pseudo-terminal.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>

#include "base/result.hpp"
#include "link/link.hpp"

namespace roverd::sim {

struct PortSpec {
  enum class Kind { Udp, Tcp, Pty };
  Kind kind = Kind::Udp;
  std::uint16_t port = 0;  ///< udp, tcp; 0: the kernel chooses
  std::string path;        ///< pty: of a symbolic link to it; empty: none
};

/// "udp[:PORT]", "tcp[:PORT]", "pty[:PATH]"; anything else is an error that says so.
base::Result<PortSpec> read_port(const std::string& text);

/// One thread, the io_context's.
class Port {
 public:
  Port(boost::asio::io_context& io, const PortSpec& spec);

  base::Result<void> open();
  void close() noexcept;
  void write(base::Bytes bytes) noexcept;
  /// As a configuration names it: "udp:127.0.0.1:40123". After open().
  std::string address() const;

  /// Set before open(): one datagram, or some bytes of a stream.
  std::function<void(base::Bytes)> on_bytes;

  /// A dead connection: over TCP the peers are thrown out and nobody is let in, until it is over.
  /// Elsewhere nothing is to be seen of it but silence.
  void cut(bool off);

 private:
  const PortSpec spec_;
  std::unique_ptr<link::ByteLink> link_;
  std::string address_;
  bool cut_ = false;
};

}  // namespace roverd::sim
