#pragma once
// Frames of a raw CAN socket, as many as wait, with one system call: on a full bus each call costs
// more than what it brings.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <linux/can.h>
#include <sys/socket.h>

#include "base/bytes.hpp"
#include "base/time.hpp"

namespace roverd::link {

/// One of what was read.
struct CanArrival {
  base::Bytes packet{};                    ///< until the next read; 72 bytes: a CAN FD frame
  std::optional<base::WallTime> stamp{};   ///< when the kernel took it from the controller
  std::optional<std::uint32_t> overrun{};  ///< frames that the socket had no room for, until then
  bool own = false;                        ///< sent by this very socket
};

class CanBatch {
 public:
  static constexpr std::size_t kMost = 32;

  CanBatch() noexcept;
  CanBatch(const CanBatch&) = delete;
  CanBatch& operator=(const CanBatch&) = delete;

  /// Does not wait. @return frames read; 0: none waits; below 0: −errno.
  int read(int fd) noexcept;
  /// @param i below what read() returned.
  CanArrival at(std::size_t i) noexcept;

 private:
  struct alignas(cmsghdr) Extras {
    std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> bytes;
  };
  std::array<mmsghdr, kMost> messages_{};
  std::array<iovec, kMost> parts_{};
  std::array<std::array<std::uint8_t, CANFD_MTU>, kMost> packets_;
  std::array<Extras, kMost> extras_;
};

}  // namespace roverd::link
