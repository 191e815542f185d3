#include "net/wire.hpp"

#include <array>
#include <cerrno>
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

namespace roverd::net {

/// OpenSSL's way to the socket. Its own one raises SIGPIPE, and would use a number that the system
/// has given to somebody else since the socket was closed.
struct WireBio {
  static Wire* wire(BIO* bio) { return static_cast<Wire*>(BIO_get_data(bio)); }

  static int read(BIO* bio, char* into, int size) {
    BIO_clear_retry_flags(bio);
    Wire* const to = wire(bio);
    if (!to->is_open() || size <= 0) return -1;
    const auto n = ::recv(to->handle(), into, static_cast<std::size_t>(size), MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
      BIO_set_retry_read(bio);
      to->drained_ = true;
    }
    return static_cast<int>(n);
  }
  static int write(BIO* bio, const char* from, int size) {
    BIO_clear_retry_flags(bio);
    Wire* const to = wire(bio);
    if (!to->is_open() || size <= 0) return -1;
    const auto n =
        ::send(to->handle(), from, static_cast<std::size_t>(size), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_write(bio);
    return static_cast<int>(n);
  }
  static long control(BIO*, int what, long, void*) { return what == BIO_CTRL_FLUSH ? 1 : 0; }

  static BIO_METHOD* method() {
    static BIO_METHOD* const made = [] {
      BIO_METHOD* m = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "wire");
      if (m == nullptr) return m;
      BIO_meth_set_read(m, &WireBio::read);
      BIO_meth_set_write(m, &WireBio::write);
      BIO_meth_set_ctrl(m, &WireBio::control);
      return m;
    }();
    return made;
  }
};

Wire::Wire(Socket socket) : socket_(std::move(socket)) {}

Wire::Wire(Wire&& other) noexcept
    : socket_(std::move(other.socket_)),
      secret_(std::move(other.secret_)),
      shaken_after_(other.shaken_after_),
      drained_(other.drained_),
      shaken_(other.shaken_),
      broken_(other.broken_) {
  if (secret_) BIO_set_data(SSL_get_rbio(secret_.get()), this);
}

Wire::~Wire() = default;

char* Wire::scratch() noexcept {
  static thread_local std::array<char, kRecord> bytes;
  return bytes.data();
}

Wire::First Wire::first() {
  constexpr unsigned char kHandshakeRecord = 0x16;
  unsigned char byte = 0;
  const auto n = ::recv(handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return First::None;
  if (n <= 0) return First::Gone;
  return byte == kHandshakeRecord ? First::Tls : First::Plain;
}

void Wire::shake(Tls& tls, std::function<void(error_code)> done) {
  auto secret = tls.connection();
  BIO* bio = secret && WireBio::method() != nullptr ? BIO_new(WireBio::method()) : nullptr;
  if (bio == nullptr) {
    return done(boost::asio::error::no_memory);
  }
  BIO_set_data(bio, this);
  BIO_set_init(bio, 1);
  SSL_set_bio(secret.get(), bio, bio);
  SSL_set_accept_state(secret.get());
  secret_ = std::move(secret);
  shaken_after_ = base::steady_now();
  shake_on(std::move(done));
}

void Wire::shake_on(std::function<void(error_code)> done) {
  ERR_clear_error();
  drained_ = false;  // the first request may come with the client's last word of it
  const int result = SSL_do_handshake(secret_.get());
  if (result == 1) {
    shaken_ = true;
    // A client that gathers small pieces (Nagle) sends its request only when its last word of the
    // handshake is acknowledged; the kernel would take 40 ms for that.
    const int now = 1;
    ::setsockopt(handle(), IPPROTO_TCP, TCP_QUICKACK, &now, sizeof now);
    return done({});
  }
  const int what = SSL_get_error(secret_.get(), result);
  if (what != SSL_ERROR_WANT_READ && what != SSL_ERROR_WANT_WRITE) return done(why(result));
  // What comes after this was sent after it: the client has to wait for our answer.
  shaken_after_ = base::steady_now();
  const auto ready = what == SSL_ERROR_WANT_READ ? Socket::wait_read : Socket::wait_write;
  socket_.async_wait(ready, [this, done = std::move(done)](error_code ec) mutable {
    if (ec) return done(ec);
    shake_on(std::move(done));
  });
}

Wire::error_code Wire::why(int result) {
  const int what = SSL_get_error(secret_.get(), result);
  if (what == SSL_ERROR_WANT_READ || what == SSL_ERROR_WANT_WRITE) {
    return boost::asio::error::would_block;
  }
  if (what == SSL_ERROR_ZERO_RETURN) return boost::asio::error::eof;
  broken_ = true;
  ERR_clear_error();
  return boost::asio::error::connection_reset;
}

std::size_t Wire::read_some(void* into, std::size_t size, error_code& ec) {
  if (!secret_) return socket_.read_some(boost::asio::buffer(into, size), ec);
  ERR_clear_error();
  drained_ = false;
  std::size_t n = 0;
  const int result = SSL_read_ex(secret_.get(), into, size, &n);
  ec = result == 1 ? error_code{} : why(result);
  return result == 1 ? n : 0;
}

std::size_t Wire::write_some(const void* from, std::size_t size, error_code& ec) {
  if (!secret_) return socket_.write_some(boost::asio::buffer(from, size), ec);
  ERR_clear_error();
  std::size_t n = 0;
  const int result = SSL_write_ex(secret_.get(), from, size, &n);
  ec = result == 1 ? error_code{} : why(result);
  if (result != 1 &&
      SSL_want_read(secret_.get())) {  // only a new handshake would, and there is none
    broken_ = true;
    ec = boost::asio::error::connection_reset;
  }
  return result == 1 ? n : 0;
}

bool Wire::holds_input() const noexcept {
  return secret_ && !drained_ && !broken_ && SSL_has_pending(secret_.get()) == 1;
}

void Wire::say_goodbye() noexcept {
  if (!secret_ || !shaken_ || broken_ || !is_open()) return;
  ERR_clear_error();
  SSL_shutdown(secret_.get());
  ERR_clear_error();
}

void Wire::close() noexcept {
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace roverd::net
