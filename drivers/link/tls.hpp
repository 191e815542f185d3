#pragma once
// A byte stream over TLS: a client that checks whom it speaks to, by the certificates that the
// system trusts (SSL_CERT_FILE and SSL_CERT_DIR name others) and the host's name.

#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>

#include "link/link.hpp"

namespace roverd::link {

namespace asio = boost::asio;

/// As TcpLink: open() only starts to connect, a failure comes as on_closed, at most kTlsTimeout
/// later; until connected write() says Closed. Device thread only, write() too: one write at a time
/// is on its way, another one meanwhile is Busy.
class TlsLink final : public ByteLink {
 public:
  static constexpr base::Duration kTlsTimeout = std::chrono::seconds(5);

  /// @param host name as in its certificate. @param port 1..65535.
  TlsLink(asio::io_context& io, std::string host, std::uint16_t port);
  ~TlsLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override { return "tls:" + host_ + ":" + std::to_string(port_); }

 private:
  struct Session;  // from open() to close()
  using SessionPtr = std::shared_ptr<Session>;

  void connect(const SessionPtr& session);
  void shake_hands(const SessionPtr& session);
  void read(const SessionPtr& session);
  void lost(const std::string& reason);

  asio::io_context& io_;
  const std::string host_;
  const std::uint16_t port_;
  SessionPtr session_;  ///< handlers compare theirs: another one means closed meanwhile
};

}  // namespace roverd::link
