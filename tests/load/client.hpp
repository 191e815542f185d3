#pragma once
// One connection of the load: bytes in and out without waiting, HTTP answers and WebSocket frames
// cut out of the stream. Kept apart from the product's own code: a shared mistake would cancel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roverd::load {

struct Address {
  std::string host;
  std::uint16_t port = 0;
};

/// Throws std::runtime_error naming the cause, in everything below.
class Connection {
 public:
  explicit Connection(const Address& to);  ///< connected when it returns
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int handle() const noexcept { return handle_; }
  /// Asks for a WebSocket and waits for the server's yes.
  void upgrade(const Address& at, const std::string& path);
  /// The whole text; the requests of this load fit into the socket's buffer.
  void send(std::string_view bytes);
  /// Takes in what there is. @return false when the peer has closed.
  bool receive();
  /// The status of the next whole HTTP answer, which is then consumed.
  std::optional<int> take_answer();

  struct Frame {
    int opcode = 0;         ///< 1 text, 8 close, 9 ping, 10 pong
    std::string_view text;  ///< valid until the next receive()
  };
  /// The next whole WebSocket frame, which is then consumed.
  std::optional<Frame> take_frame();

 private:
  std::string_view pending() const noexcept { return std::string_view(buffer_).substr(begin_); }

  int handle_ = -1;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< what lies before is consumed
};

/// A client's frame, masked as the protocol demands (with zeros: nothing is hidden on loopback).
std::string masked_frame(int opcode, std::string_view text);

}  // namespace roverd::load
