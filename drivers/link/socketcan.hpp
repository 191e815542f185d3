#pragma once
// A CAN interface of the Linux kernel (SocketCAN, raw sockets).

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/steady_timer.hpp>

#include "link/can_batch.hpp"
#include "link/can_error.hpp"
#include "link/can_options.hpp"
#include "link/can_state.hpp"
#include "link/confirmations.hpp"
#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// Frames of one interface. Hears every frame but its own: remote and extended ones and the
/// controller's error message frames, flagged, so that a codec can count what is not for it. CAN FD
/// frames are counted and dropped. Frames are stamped when the kernel took them from the
/// controller, not when this program came round to reading them.
///
/// open() names what is wrong: the interface does not exist, is not CAN, is down, or the kernel has
/// no CAN. With a bit rate or `up` among the options it brings the interface up first, and says so
/// if it may not. on_closed comes when the interface goes down or is removed (an unplugged
/// adapter).
///
/// The kernel gives a socket its own frames back once they were sent (on hardware: acknowledged by
/// another node). They are counted, not heard. With a filter (`only`) there are no confirmations:
/// it would have to let our own ids through, and then the foreign ones of the same id too.
///
/// With attended ids there are two sockets. One hears these alone, and error message frames: the
/// kernel sorts the others out before they cost anything. The second hears all others, at most
/// kReadBurst every kOthersPause: enough for a full bus of 500 kbit/s. What is more, the kernel
/// drops; it is counted. Their stamps never go back behind the last attended frame.
///
/// A bus that is off is restarted by the kernel (restart_ms), else by report() after a second, if
/// the interface is ours to configure.
class SocketCanLink final : public FrameLink {
 public:
  /// @param interface name as in `ip link`: "can0", "vcan0".
  SocketCanLink(asio::io_context& io, std::string interface, CanOptions options = {});
  ~SocketCanLink() override;

  void attend(const std::vector<std::uint32_t>& ids) override { attended_ = ids; }
  base::Result<void> open() override;
  void close() noexcept override;
  /// Busy: the controller's queue is full (ENOBUFS; nobody acknowledges on the bus), or the frame
  /// is not valid (can_wire.hpp; counted in refused()).
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "can:" + interface_ + to_string(options_); }
  /// Reads the kernel's state at most once a second.
  BusReport report(Time now) override;

  /// As report() read it last.
  const CanState& state() const noexcept { return state_; }
  const Confirmations& confirmations() const noexcept { return confirmations_; }
  /// Packets that are not a classic CAN frame, in either direction. Any thread.
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Frames the kernel dropped because we did not read fast enough. Any thread.
  std::uint64_t overrun() const noexcept { return overrun_.load(std::memory_order_relaxed); }

  static constexpr base::Duration kOthersPause = std::chrono::milliseconds(16);

 private:
  /// Which frames a socket is for.
  enum class Share { All, Attended, Others };
  /// A second socket for the others: its number is closed with it.
  struct Others {
    Others(asio::io_context& io, int number) : fd(number), timer(io) {}
    ~Others();
    Others(const Others&) = delete;
    Others& operator=(const Others&) = delete;
    const int fd;
    asio::steady_timer timer;
    std::uint32_t dropped = 0;  ///< by the kernel
  };

  base::Result<void> prepare();
  base::Result<int> make_socket(Share share) const;
  base::Result<void> check_interface(int fd) const;
  base::Result<void> configure(int fd, Share share) const;
  bool set_filter(int fd, Share share) const;
  void read();
  void wait_for_others();
  void read_others(Others& others);
  void take(const CanArrival& arrival, Time now, base::WallTime wall);
  void take_other(const CanArrival& arrival, Time now, base::WallTime wall);
  /// Counts what is no classic CAN frame.
  std::optional<CanFrame> frame_of(const CanArrival& arrival);
  void count_errors(const CanFrame& frame) noexcept;
  void refresh(Time now);
  void care_for_bus_off(Time now);
  void lost(int error);

  const std::string interface_;
  const CanOptions options_;
  asio::io_context& io_;
  std::vector<std::uint32_t> attended_;
  Descriptor socket_;
  std::shared_ptr<Others> others_;  ///< its timer holds it weakly: empty means closed meanwhile
  CanBatch batch_;
  Confirmations confirmations_;
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> overrun_{0};

  // Device thread.
  Time last_stamp_{};
  base::Duration slowest_{};          ///< from the kernel's stamp to here, since the last report
  std::uint64_t others_dropped_ = 0;  ///< by the sockets before this one
  std::uint64_t fd_frames_ = 0;
  std::array<std::uint64_t, kCanFaultWords.size()> faults_{};
  CanFaults last_faults_ = 0;
  CanState state_;
  std::optional<Time> refreshed_;
  std::optional<Time> off_since_;
  std::uint64_t restarts_ = 0;
  std::string problem_;  ///< of bringing up or restarting
};

/// The monotonic time of something the kernel stamped with the wall clock: as long ago as the wall
/// clock says, if that is between 0 and 1 s; otherwise (the clock was set meanwhile) just now.
/// Pure.
Time monotonic_stamp(base::WallTime stamped, base::WallTime wall_now, Time now) noexcept;

}  // namespace roverd::link
