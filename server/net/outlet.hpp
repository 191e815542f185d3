#pragma once
// The stream under a WebSocket. Beast reads through it, and writes through it what it has to say
// itself (handshake, pong, close); our ready-made frames go straight to the socket. Both meet here,
// so that frames never mix: what Beast hands over is taken as a whole, whatever the socket takes.
//
//   idle ──send──▶ idle            (the usual case: the kernel takes all of it at once)
//   idle ──send──▶ blocked ──flush, when writable──▶ idle
//
// What a client says is read ahead of Beast, and a lookout sees it first.
//
// Never waits; the owner waits for the socket to become writable when on_blocked was called.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "base/time.hpp"
#include "net/frame.hpp"
#include "net/lookout.hpp"
#include "net/wire.hpp"

namespace roverd::net {

class Outlet {
 public:
  using next_layer_type = Wire;
  using executor_type = next_layer_type::executor_type;
  using error_code = boost::beast::error_code;

  /// @param early bytes that came after the upgrade request, read already.
  Outlet(next_layer_type wire, std::string early)
      : wire_(std::move(wire)), ahead_(std::move(early)) {}

  /// Each short text as soon as it is here, whatever was said before it.
  std::function<void(std::string_view)> on_early_text;

  /// The socket is full: call flush() when it is writable. Called once until that flush.
  std::function<void()> on_blocked;

  executor_type get_executor() { return wire_.get_executor(); }
  next_layer_type& next_layer() noexcept { return wire_; }
  const next_layer_type& next_layer() const noexcept { return wire_; }

  /// Nothing waits to be sent.
  bool idle() const noexcept { return current_ == nullptr && own_.empty(); }
  /// A close frame went out or the socket broke: data frames are not wanted any more.
  bool finished() const noexcept { return finished_; }
  /// Only when idle.
  void send(Frame frame) {
    if (finished_) return;
    current_ = std::move(frame);
    offset_ = 0;
    flush();
  }
  /// Sends what waits. @return true if idle then.
  bool flush();

  /// Since when a part of a message has been here, if it came in parts.
  std::optional<base::Time> partial_since() const noexcept { return partial_since_; }
  /// A frame was read to its end.
  void frame_ended() noexcept {
    reads_ = 0;
    partial_since_.reset();
  }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(error_code, std::size_t)>(
        [this](auto&& done, const auto& into) {
          if (reads_++ > 0 && !partial_since_) partial_since_ = base::steady_now();
          if (!looked_) look(ahead_);
          looked_ = true;
          if (taken_ < ahead_.size()) {
            const std::size_t n = take_ahead(into);
            complete(std::forward<decltype(done)>(done), error_code{}, n);
            return;
          }
          wait_readable(into, std::forward<decltype(done)>(done));
        },
        handler, buffers);
  }

  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(error_code, std::size_t)>(
        [this](auto&& done, const auto& from) {
          const std::size_t n = boost::asio::buffer_size(from);
          if (own_.size() + n > kOwnBytes) {  // it pings and never reads
            complete(std::forward<decltype(done)>(done),
                     error_code(boost::asio::error::no_buffer_space), 0);
            return;
          }
          take(from, n);
          complete(std::forward<decltype(done)>(done), error_code{}, n);
        },
        handler, buffers);
  }

 private:
  static constexpr std::size_t kOwnBytes = 8 * 1024;
  static constexpr std::size_t kAheadBytes = 64 * 1024;

  template <class Handler>
  void complete(Handler&& handler, error_code ec, std::size_t n) {
    boost::asio::post(get_executor(),
                      boost::beast::bind_front_handler(std::forward<Handler>(handler), ec, n));
  }

  template <class Buffers, class Handler>
  void wait_readable(const Buffers& into, Handler&& handler) {
    wire_.when_readable([this, into, done = std::forward<Handler>(handler)](error_code ec) mutable {
      if (!ec) ec = read_ahead();
      if (ec == boost::asio::error::would_block) {
        return wait_readable(into, std::move(done));
      }
      const std::size_t n = ec ? 0 : take_ahead(into);
      std::move(done)(ec, n);
    });
  }
  template <class Buffers>
  std::size_t take_ahead(const Buffers& into) {
    const std::size_t n = boost::asio::buffer_copy(
        into, boost::asio::buffer(ahead_.data() + taken_, ahead_.size() - taken_));
    taken_ += n;
    return n;
  }
  /// Only when all of what was read ahead is taken.
  error_code read_ahead();
  void look(std::string_view bytes) {
    lookout_.feed(bytes, [this](std::string_view text) {
      if (on_early_text) on_early_text(text);
    });
  }

  template <class Buffers>
  void take(const Buffers& from, std::size_t n) {
    const std::size_t begin = own_.size();
    own_.resize(begin + n);
    boost::asio::buffer_copy(boost::asio::buffer(own_.data() + begin, n), from);
    if (n > 0 && static_cast<unsigned char>(own_[begin]) == 0x88) closing_ = true;
    if (!blocked_) flush();
    if (closing_) finished_ = true;  // RFC 6455, 5.5.1: no data after a close frame
  }

  bool write(const std::string& bytes);  ///< from offset_; true if all of it went

  next_layer_type wire_;
  std::string ahead_;  ///< read, and from taken_ on not yet given to Beast
  std::size_t taken_ = 0;
  Lookout lookout_;
  bool looked_ = false;  ///< at the first of it
  Frame current_;
  std::string own_;  ///< Beast's frames
  std::size_t offset_ = 0;
  int reads_ = 0;  ///< begun since the last frame's end
  std::optional<base::Time> partial_since_;
  bool blocked_ = false;
  bool closing_ = false;
  bool finished_ = false;
};

inline void teardown(boost::beast::role_type role, Outlet& outlet, Outlet::error_code& ec) {
  outlet.next_layer().say_goodbye();
  boost::beast::websocket::teardown(role, outlet.next_layer().socket(), ec);
}
template <class Handler>
void async_teardown(boost::beast::role_type role, Outlet& outlet, Handler&& handler) {
  outlet.next_layer().say_goodbye();
  boost::beast::websocket::async_teardown(role, outlet.next_layer().socket(),
                                          std::forward<Handler>(handler));
}

}  // namespace roverd::net
