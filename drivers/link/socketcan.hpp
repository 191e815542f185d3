#pragma once
// A CAN interface of the Linux kernel (SocketCAN, raw sockets).

#include <atomic>
#include <cstdint>
#include <string>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// Classic CAN frames of one interface. Hears every frame but its own, error message frames of the
/// controller too (CanFrame::error). Frames are stamped when the kernel took them from the
/// controller, not when this program came round to reading them.
///
/// open() names what is wrong: the interface does not exist, is not CAN, is down, or the kernel has
/// no CAN. It does not configure the interface: bit rate and "up" are the system's business.
/// on_closed comes when the interface goes down or is removed (an unplugged adapter).
class SocketCanLink final : public FrameLink {
 public:
  /// @param interface name as in `ip link`: "can0", "vcan0".
  SocketCanLink(asio::io_context& io, std::string interface);
  ~SocketCanLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  /// Busy: the controller's queue is full (ENOBUFS; nobody acknowledges on the bus), or the frame
  /// is not valid (can_wire.hpp; counted in refused()).
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "can:" + interface_; }

  /// Packets that are not a classic CAN frame, in either direction. Any thread.
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Frames the kernel dropped because we did not read fast enough. Any thread.
  std::uint64_t overrun() const noexcept { return overrun_.load(std::memory_order_relaxed); }

 private:
  base::Result<void> check_interface(int fd) const;
  base::Result<void> configure(int fd) const;
  void read();
  bool read_one();
  void lost(int error);

  const std::string interface_;
  Descriptor socket_;
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> overrun_{0};
};

/// The monotonic time of something the kernel stamped with the wall clock: as long ago as the wall
/// clock says, if that is between 0 and 1 s; otherwise (the clock was set meanwhile) just now.
/// Pure.
Time monotonic_stamp(base::WallTime stamped, base::WallTime wall_now, Time now) noexcept;

}  // namespace roverd::link
