#pragma once
// A plain client over a real socket: sends any bytes, right or wrong, and reads answers with a
// deadline. Its own reading, so that a mistake shared with the server would not cancel.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace roverd::test {

struct Answer {
  unsigned status = 0;
  std::map<std::string, std::string>
      headers;  ///< names in lower case; what is said twice, line by line
  std::string body;

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string{} : found->second;
  }
};

struct Secret;  // TLS over the socket

/// Where ROVERD_TEST_TLS is set ("1.2", "1.3"), all clients speak that TLS from their first sending
/// on, and NetHouse expects it: the same tests hold for both.
const char* tls_version();

class Client {
 public:
  static constexpr std::chrono::milliseconds kPatience{120'000};

  /// Throws std::runtime_error if nobody listens.
  /// @param source from which of this computer's addresses; empty: whichever the system takes
  explicit Client(std::uint16_t port, const std::string& address = "127.0.0.1",
                  const std::string& source = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// @return false if the server closed before all of it went.
  bool send(std::string_view bytes);
  /// The next whole answer; empty if the connection ends or nothing comes for kPatience.
  /// @param no_body to a HEAD request.
  std::optional<Answer> answer(bool no_body = false);
  /// Waits until the server closes. @return false if it does not within `time`.
  bool closed_within(std::chrono::milliseconds time);

  struct Frame {
    int opcode = 0;
    std::string payload;
    /// Of a close frame; 0 without one.
    unsigned close_code() const;
  };
  /// Asks for a WebSocket. @return the status: 101 if it is one now.
  unsigned upgrade(const std::string& path, const std::string& more_headers = "");
  std::optional<Frame> frame(std::chrono::milliseconds time = kPatience);
  bool send_frame(int opcode, std::string_view payload);

  int handle() const noexcept { return handle_; }

 private:
  bool receive(std::chrono::steady_clock::time_point until);

  int handle_ = -1;
  std::unique_ptr<Secret> secret_;
  std::string in_;
  bool closed_ = false;
};

}  // namespace roverd::test
