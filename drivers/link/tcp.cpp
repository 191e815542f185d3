#include "link/tcp.hpp"

#include <array>
#include <cerrno>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/steady_timer.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace roverd::link {
namespace {

using asio::ip::tcp;

/// Reads at one wake-up, so that a fast stream cannot starve the other links.
constexpr int kTcpBurst = 16;
constexpr std::size_t kChunk = 4096;

void set_option(int fd, int level, int name, int value) noexcept {
  ::setsockopt(fd, level, name, &value, sizeof value);
}

/// The stream works without any of these; a kernel that refuses one is no reason to fail.
void tune(int fd) noexcept {
  set_option(fd, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(fd, IPPROTO_TCP, TCP_KEEPIDLE, 5);
  set_option(fd, IPPROTO_TCP, TCP_KEEPINTVL, 5);
  set_option(fd, IPPROTO_TCP, TCP_KEEPCNT, 3);
}

}  // namespace

/// One try to connect. Its handlers share it and look whether it is still the link's.
struct TcpLink::Attempt {
  explicit Attempt(asio::io_context& io) : resolver(io), socket(io), timer(io) {}
  tcp::resolver resolver;
  tcp::socket socket;
  asio::steady_timer timer;
  bool given_up = false;

  void give_up() noexcept {
    given_up = true;
    boost::system::error_code ignored;
    resolver.cancel();
    socket.close(ignored);
    timer.cancel();
  }
};

TcpLink::TcpLink(asio::io_context& io, std::string host, std::uint16_t port)
    : io_(io), host_(std::move(host)), port_(port), socket_(io) {}

TcpLink::~TcpLink() {
  close();
}

std::string TcpLink::describe() const {
  const bool v6 = host_.find(':') != std::string::npos;
  return "tcp:" + (v6 ? "[" + host_ + "]" : host_) + ":" + std::to_string(port_);
}

base::Result<void> TcpLink::open() {
  close();
  const auto attempt = std::make_shared<Attempt>(io_);
  attempt_ = attempt;
  attempt->timer.expires_after(kConnectTimeout);
  attempt->timer.async_wait([this, attempt](const boost::system::error_code& ec) {
    if (ec || attempt->given_up) return;
    lost("no answer within " + std::to_string(base::seconds(kConnectTimeout)).substr(0, 3) + " s");
  });
  attempt->resolver.async_resolve(
      host_, std::to_string(port_),
      [this, attempt](const boost::system::error_code& ec, const tcp::resolver::results_type& all) {
        if (attempt->given_up) return;
        if (ec) {
          lost(ec.message());
        } else {
          connect(attempt, all);
        }
      });
  return {};
}

void TcpLink::connect(const std::shared_ptr<Attempt>& attempt,
                      const tcp::resolver::results_type& found) {
  asio::async_connect(attempt->socket, found,
                      [this, attempt](const boost::system::error_code& ec, const tcp::endpoint&) {
                        if (attempt->given_up) return;
                        if (ec) {
                          lost(ec.message());
                        } else {
                          connected(*attempt);
                        }
                      });
}

void TcpLink::connected(Attempt& attempt) {
  boost::system::error_code ec;
  const int fd = attempt.socket.release(ec);
  attempt.give_up();
  attempt_.reset();
  if (ec) {
    lost(ec.message());
    return;
  }
  tune(fd);
  const auto opened = socket_.open(fd, [this] { read(); });
  if (!opened) lost(opened.error().detail);
}

void TcpLink::close() noexcept {
  if (attempt_) attempt_->give_up();
  attempt_.reset();
  socket_.close();
}

SendResult TcpLink::write(Bytes bytes) noexcept {
  return socket_.use([&](int fd) {
    return write_result(::send(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL),
                        bytes.size());
  });
}

void TcpLink::read() {
  std::array<std::uint8_t, kChunk> buffer;
  for (int i = 0; i < kTcpBurst && socket_.is_open(); ++i) {
    const ssize_t n = ::recv(socket_.fd(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n > 0) {
      if (on_bytes) on_bytes({buffer.data(), static_cast<std::size_t>(n)}, base::steady_now());
    } else if (n == 0) {
      lost("closed by the other end");
    } else if (errno == EAGAIN || errno == EINTR) {
      return;
    } else {
      lost(errno_text(errno));
    }
  }
}

void TcpLink::lost(const std::string& reason) {
  const bool connecting = !socket_.is_open();
  close();
  if (!on_closed) return;
  on_closed((connecting ? "cannot connect to " : "lost ") + describe() + ": " + reason);
}

}  // namespace roverd::link
