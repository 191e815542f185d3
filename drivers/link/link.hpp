#pragma once
// Transports: bytes or CAN frames in and out, stamped on arrival. A link knows nothing of what it
// carries. Links live on one io_context (the device thread); callbacks come on that thread.
// send/write may be called from one other thread (the control loop): they write the raw handle,
// never wait, and never touch an Asio object.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::link {

using base::Bytes;
using base::CanFrame;
using base::Time;

/// Sent: handed to the kernel whole. Busy: no room now, dropped. Closed: the link is down.
enum class SendResult { Sent, Busy, Closed };

/// Between whom a datagram went, by IPv4. Zeros: not known, or by IPv6.
struct Ends {
  std::array<std::uint8_t, 4> peer{};  ///< 192.168.1.201: {192, 168, 1, 201}
  std::uint16_t peer_port = 0;
  std::uint16_t port = 0;  ///< ours
};

/// A stream or datagram transport.
class ByteLink {
 public:
  virtual ~ByteLink() = default;
  ByteLink(const ByteLink&) = delete;
  ByteLink& operator=(const ByteLink&) = delete;

  /// Device thread. Starts receiving; opening again an open link is an error of the caller.
  virtual base::Result<void> open() = 0;
  /// Device thread. Idempotent; no callback comes after it.
  virtual void close() noexcept = 0;
  /// Any one thread; a short write counts as Busy and the rest is dropped.
  virtual SendResult write(Bytes bytes) noexcept = 0;
  /// For messages and the driver list: "serial:/dev/ttyUSB0:115200".
  virtual std::string describe() const = 0;
  /// Device thread. What came from somebody else than the peer and was not handed over.
  virtual std::uint64_t strangers() const noexcept { return 0; }

  /// Device thread. What was heard and could not be handed over, in words.
  virtual std::map<std::string, std::uint64_t> troubles() const { return {}; }

  /// Device thread, within on_bytes: whose datagram this is. Zeros of a stream.
  virtual Ends ends() const noexcept { return {}; }

  /// Device thread, not from a callback. What comes makes no sense to the driver: tries the next
  /// way of listening (a serial port's next baud rate, the next port). @return false: there is
  /// none.
  virtual bool retune() { return false; }

  std::function<void(Bytes, Time)> on_bytes;                 ///< never empty spans
  std::function<void(const std::string& reason)> on_closed;  ///< lost; not after close()
  /// Another peer than before speaks from now on: what comes begins anew. Of links that stay open
  /// while their peers change; the first one is told as well.
  std::function<void()> on_peer;
  /// Links that play a recording: what the recording program sent then. Others never call it.
  std::function<void(Bytes, Time)> on_sent;

 protected:
  ByteLink() = default;
};

/// What a bus tells about itself, in words for the driver list.
struct BusReport {
  std::map<std::string, std::string> facts;     ///< "can_state": "error active"
  std::map<std::string, std::uint64_t> counts;  ///< "CAN error: no acknowledgement"; none is 0
};

/// A CAN bus.
class FrameLink {
 public:
  virtual ~FrameLink() = default;
  FrameLink(const FrameLink&) = delete;
  FrameLink& operator=(const FrameLink&) = delete;

  /// Device thread, before open(). The standard ids that the driver lives on, its own commands
  /// among them. A link that can hears these apart from all others, so that a bus full of somebody
  /// else's frames does not delay them; of the others it then hears as many as it has time for.
  virtual void attend(const std::vector<std::uint32_t>& ids) { static_cast<void>(ids); }
  virtual base::Result<void> open() = 0;
  virtual void close() noexcept = 0;
  virtual SendResult send(const CanFrame& frame) noexcept = 0;
  virtual std::string describe() const = 0;
  /// Device thread, open or not, about as often as a driver reports. A link that can lose its bus
  /// also looks after it here. Empty for one that knows nothing (memory, cansock, replay).
  virtual BusReport report(Time now) {
    static_cast<void>(now);
    return {};
  }

  std::function<void(const CanFrame&, Time)> on_frame;
  std::function<void(const std::string& reason)> on_closed;

 protected:
  FrameLink() = default;
};

}  // namespace roverd::link
