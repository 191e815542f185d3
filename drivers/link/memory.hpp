#pragma once
// Links without a kernel, for tests in simulated time: two ends of one wire in one thread.
//
//   auto wire = memory_frame_pair();
//   wire.a->send(frame);          queued
//   wire.b->deliver(now);         on_frame of b, stamped now
//
// deliver hands over what was sent before the call; an answer given inside a callback waits for the
// next deliver, so a test decides when time passes. With a clock (immediate), send calls the other
// end's callback at once instead. Not thread-safe: both ends belong to one thread.
// An end may be destroyed before the other; what is sent to it is then Closed.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "link/link.hpp"

namespace roverd::link {

namespace detail {
template <class Unit>
struct MemoryWire;  // the queues of both directions
}

/// One end of a CAN wire.
class MemoryFrameLink final : public FrameLink {
 public:
  MemoryFrameLink(std::shared_ptr<detail::MemoryWire<CanFrame>> wire, int side);
  ~MemoryFrameLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  /// Closed unless both ends are open; Busy when the queue is full (the frame is dropped, counted).
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "memory"; }

  /// Calls on_frame for each frame that the other end sent before. @return how many.
  std::size_t deliver(Time now);
  /// Frames sent from this end for which `lose` is true vanish (the sender hears Sent).
  void set_loss(std::function<bool(const CanFrame&)> lose);
  /// Frames sent from this end arrive at once, stamped with clock(). Empty: queued again.
  void set_immediate(std::function<Time()> clock);
  /// The wire breaks at this end: closes it and calls its on_closed.
  void fail(const std::string& reason);
  /// open() answers with this error until it is taken back with an empty text.
  void refuse_open(std::string reason) { refusal_ = std::move(reason); }

  std::size_t waiting() const noexcept;    ///< frames that deliver would hand over
  std::uint64_t dropped() const noexcept;  ///< sent from this end, no room
  bool is_open() const noexcept;

 private:
  std::shared_ptr<detail::MemoryWire<CanFrame>> wire_;
  const int side_;
  std::string refusal_;
};

/// One end of a byte stream. Chunks arrive as they were written.
class MemoryByteLink final : public ByteLink {
 public:
  using Chunk = std::vector<std::uint8_t>;

  MemoryByteLink(std::shared_ptr<detail::MemoryWire<Chunk>> wire, int side);
  ~MemoryByteLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override { return "memory"; }

  std::size_t deliver(Time now);
  void set_loss(std::function<bool(const Chunk&)> lose);
  void set_immediate(std::function<Time()> clock);
  void fail(const std::string& reason);
  void refuse_open(std::string reason) { refusal_ = std::move(reason); }

  std::size_t waiting() const noexcept;
  std::uint64_t dropped() const noexcept;
  bool is_open() const noexcept;

 private:
  std::shared_ptr<detail::MemoryWire<Chunk>> wire_;
  const int side_;
  std::string refusal_;
};

struct MemoryFramePair {
  std::unique_ptr<MemoryFrameLink> a;
  std::unique_ptr<MemoryFrameLink> b;
};
struct MemoryBytePair {
  std::unique_ptr<MemoryByteLink> a;
  std::unique_ptr<MemoryByteLink> b;
};

/// @param capacity frames or chunks that may wait in each direction.
MemoryFramePair memory_frame_pair(std::size_t capacity = 1024);
MemoryBytePair memory_byte_pair(std::size_t capacity = 1024);

}  // namespace roverd::link
