#pragma once
// The one stream under Connection and Outlet: a plain TCP socket, or TLS on it. Plain, every call
// is the socket's own.
//
//   plain ──shake()──▶ handshake ──done──▶ TLS          any ──close()──▶ closed
//
// OpenSSL works on the socket itself, without waiting: what it cannot do now is tried again when
// the socket is ready. (Asio's stream keeps 68 kB of buffers for each connection, and loses what a
// write that may not wait could not send.)
//
// Moved only while nothing is awaited. Handlers must keep its owner alive.

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>

#include "base/time.hpp"
#include "net/tls.hpp"

namespace roverd::net {

class Wire {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using executor_type = Socket::executor_type;
  using error_code = boost::system::error_code;

  explicit Wire(Socket socket);
  Wire(Wire&& other) noexcept;
  Wire& operator=(Wire&&) = delete;
  ~Wire();

  executor_type get_executor() { return socket_.get_executor(); }
  /// For options, and for what goes past TLS: throwing away what comes after the end.
  Socket& socket() noexcept { return socket_; }
  int handle() noexcept { return socket_.native_handle(); }
  bool is_open() const noexcept { return socket_.is_open(); }
  bool secure() const noexcept { return secret_ != nullptr; }

  enum class First { None, Tls, Plain, Gone };
  /// What the first byte in the socket begins; it stays there. Never waits.
  First first();
  /// TLS from here on: the server's side of the handshake. `done` may be called before this
  /// returns. The time that it takes is the owner's to bound, by close().
  void shake(Tls& tls, std::function<void(error_code)> done);
  /// What the client has sent through TLS cannot have been sent before.
  base::Time shaken_after() const noexcept { return shaken_after_; }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(error_code, std::size_t)>(
        [this](auto&& done, const auto& into) {
          if (!secret_) return socket_.async_read_some(into, std::forward<decltype(done)>(done));
          read_secret(into, std::forward<decltype(done)>(done));
        },
        handler, buffers);
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(error_code, std::size_t)>(
        [this](auto&& done, const auto& from) {
          if (!secret_) return socket_.async_write_some(from, std::forward<decltype(done)>(done));
          write_secret(from, std::forward<decltype(done)>(done));
        },
        handler, buffers);
  }

  /// Without waiting, as far as it goes; would_block if it does not. The socket is non-blocking.
  /// A write that blocked must be tried again with the same bytes, more may follow them.
  std::size_t read_some(void* into, std::size_t size, error_code& ec);
  std::size_t write_some(const void* from, std::size_t size, error_code& ec);

  /// There is something to read, or the end.
  template <class Handler>
  void when_readable(Handler&& handler) {
    if (holds_input()) {
      boost::asio::post(get_executor(), boost::beast::bind_front_handler(
                                            std::forward<Handler>(handler), error_code{}));
      return;
    }
    drained_ = false;
    socket_.async_wait(Socket::wait_read, std::forward<Handler>(handler));
  }
  template <class Handler>
  void when_writable(Handler&& handler) {
    socket_.async_wait(Socket::wait_write, std::forward<Handler>(handler));
  }
  /// Bytes that left the socket already, and may be a whole record.
  bool holds_input() const noexcept;

  /// TLS's own goodbye, if it can be sent at once. Nothing is written after it.
  void say_goodbye() noexcept;
  void close() noexcept;

 private:
  static constexpr std::size_t kRecord = 16 * 1024;
  friend struct WireBio;

  template <class Handler>
  void complete(Handler&& handler, error_code ec, std::size_t n) {
    boost::asio::post(get_executor(),
                      boost::beast::bind_front_handler(std::forward<Handler>(handler), ec, n));
  }
  template <class Buffers>
  std::size_t read_first(const Buffers& into, error_code& ec) {
    for (auto one = boost::asio::buffer_sequence_begin(into);
         one != boost::asio::buffer_sequence_end(into); ++one) {
      const boost::asio::mutable_buffer buffer(*one);
      if (buffer.size() > 0) return read_some(buffer.data(), buffer.size(), ec);
    }
    return 0;
  }
  template <class Buffers, class Handler>
  void read_secret(const Buffers& into, Handler&& handler) {
    if (holds_input()) {
      error_code ec;
      const std::size_t n = read_first(into, ec);
      if (ec != boost::asio::error::would_block) {
        return complete(std::forward<Handler>(handler), ec, n);
      }
    }
    when_readable([this, into, done = std::forward<Handler>(handler)](error_code ec) mutable {
      const std::size_t n = ec ? 0 : read_first(into, ec);
      if (ec == boost::asio::error::would_block) return read_secret(into, std::move(done));
      std::move(done)(ec, n);
    });
  }
  /// One record, so that others have their turn in between.
  template <class Buffers>
  std::size_t write_record(const Buffers& from, error_code& ec) {
    char* record = scratch();
    const std::size_t n = boost::asio::buffer_copy(boost::asio::buffer(record, kRecord), from);
    return n == 0 ? 0 : write_some(record, n, ec);
  }
  template <class Buffers, class Handler>
  void write_secret(const Buffers& from, Handler&& handler) {
    error_code ec;
    const std::size_t n = write_record(from, ec);
    if (ec != boost::asio::error::would_block) {
      return complete(std::forward<Handler>(handler), ec, n);
    }
    when_writable([this, from, done = std::forward<Handler>(handler)](error_code refused) mutable {
      if (refused) return std::move(done)(refused, 0);
      write_secret(from, std::move(done));
    });
  }
  static char* scratch() noexcept;  ///< kRecord bytes, this thread's
  void shake_on(std::function<void(error_code)> done);
  error_code why(int result);

  Socket socket_;
  std::unique_ptr<ssl_st, FreeTls> secret_;
  base::Time shaken_after_{};
  bool drained_ = false;  ///< the socket has no more; what OpenSSL still holds is no whole record
  bool shaken_ = false;
  bool broken_ = false;
};

/// Beast asks for it by this name.
inline void beast_close_socket(Wire& wire) {
  wire.close();
}

}  // namespace roverd::net
