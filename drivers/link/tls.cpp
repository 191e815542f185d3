#include "link/tls.hpp"

#include <array>
#include <utility>
#include <vector>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

namespace roverd::link {

namespace ssl = asio::ssl;
using asio::ip::tcp;
using boost::system::error_code;

struct TlsLink::Session {
  explicit Session(asio::io_context& io)
      : context(ssl::context::tls_client), stream(io, context), resolver(io), timer(io) {}
  ssl::context context;
  ssl::stream<tcp::socket> stream;
  tcp::resolver resolver;
  asio::steady_timer timer;
  bool up = false;
  std::array<std::uint8_t, 4096> input{};
  std::vector<std::uint8_t> output{};  ///< on its way; empty: none
};

TlsLink::TlsLink(asio::io_context& io, std::string host, std::uint16_t port)
    : io_(io), host_(std::move(host)), port_(port) {}

TlsLink::~TlsLink() {
  close();
}

base::Result<void> TlsLink::open() {
  close();
  const auto session = session_ = std::make_shared<Session>(io_);
  error_code ec;
  session->context.set_default_verify_paths(ec);
  session->stream.set_verify_mode(ssl::verify_peer, ec);
  session->stream.set_verify_callback(ssl::host_name_verification(host_), ec);
  // The server may hold certificates for several names.
  if (ec || SSL_set_tlsext_host_name(session->stream.native_handle(), host_.c_str()) != 1) {
    close();
    return base::fail(base::Code::Unavailable, "TLS cannot be set up for " + host_);
  }
  session->timer.expires_after(kTlsTimeout);
  session->timer.async_wait([this, session](const error_code& late) {
    if (!late && session == session_ && !session->up) lost("no answer within 5 s");
  });
  connect(session);
  return {};
}

void TlsLink::connect(const SessionPtr& session) {
  session->resolver.async_resolve(
      host_, std::to_string(port_),
      [this, session](const error_code& ec, const tcp::resolver::results_type& found) {
        if (session != session_) return;
        if (ec) return lost(ec.message());
        asio::async_connect(session->stream.next_layer(), found,
                            [this, session](const error_code& refused, const tcp::endpoint&) {
                              if (session != session_) return;
                              if (refused) return lost(refused.message());
                              shake_hands(session);
                            });
      });
}

void TlsLink::shake_hands(const SessionPtr& session) {
  session->stream.async_handshake(ssl::stream_base::client, [this, session](const error_code& ec) {
    if (session != session_) return;
    if (ec) return lost("TLS: " + ec.message());
    session->up = true;
    session->timer.cancel();
    read(session);
  });
}

void TlsLink::read(const SessionPtr& session) {
  session->stream.async_read_some(
      asio::buffer(session->input), [this, session](const error_code& ec, std::size_t n) {
        if (session != session_) return;
        if (ec) {
          const bool end = ec == asio::error::eof || ec == ssl::error::stream_truncated;
          return lost(end ? "closed by the other end" : ec.message());
        }
        if (n > 0 && on_bytes) on_bytes({session->input.data(), n}, base::steady_now());
        if (session == session_) read(session);
      });
}

void TlsLink::close() noexcept {
  if (!session_) return;
  const auto session = std::exchange(session_, nullptr);
  error_code ignored;
  session->resolver.cancel();
  session->timer.cancel();
  session->stream.next_layer().close(ignored);
}

SendResult TlsLink::write(Bytes bytes) noexcept {
  const auto session = session_;
  if (!session || !session->up) return SendResult::Closed;
  if (!session->output.empty()) return SendResult::Busy;
  session->output.assign(bytes.begin(), bytes.end());
  asio::async_write(session->stream, asio::buffer(session->output),
                    [this, session](const error_code& ec, std::size_t) {
                      session->output.clear();
                      if (ec && session == session_) lost(ec.message());
                    });
  return SendResult::Sent;
}

void TlsLink::lost(const std::string& reason) {
  close();
  if (on_closed) on_closed(reason);
}

}  // namespace roverd::link
