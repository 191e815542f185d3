#pragma once
// Looks through what a WebSocket client has sent before its turn comes: a short text that is urgent
// must not wait behind all that the same client said before it.
//
//   socket ─bytes─▶ Lookout ─short whole texts─▶ is it urgent?
//             └───▶ Beast: checks everything, in order
//
// Reads frames as RFC 6455, section 5.2 has them, and judges nothing: at the first byte that cannot
// be it sees nothing any more, and Beast ends the connection when it comes to it. Only unfragmented
// texts of kLongest bytes at most are shown. Pure.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace roverd::net {

class Lookout {
 public:
  static constexpr std::size_t kLongest = 125;  ///< the one length that needs no more bytes

  /// What came next on the socket, in any pieces. @param see for each short text, unmasked
  void feed(std::string_view bytes, const std::function<void(std::string_view)>& see);

 private:
  enum class Phase { Head, Length, Mask, Payload, Blind };
  void byte(std::uint8_t b, const std::function<void(std::string_view)>& see);
  void begin_payload(const std::function<void(std::string_view)>& see);
  void end_frame(const std::function<void(std::string_view)>& see);

  Phase phase_ = Phase::Head;
  std::array<std::uint8_t, 4> mask_{};
  std::string text_;        ///< of a frame that may be shown
  std::uint64_t left_ = 0;  ///< of length, mask or payload
  std::uint64_t length_ = 0;
  std::size_t at_ = 0;  ///< in the payload
  int head_bytes_ = 0;
  bool shown_ = false;  ///< the frame is a short whole text
};

}  // namespace roverd::net
