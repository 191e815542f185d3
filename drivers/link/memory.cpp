#include "link/memory.hpp"

#include <array>
#include <deque>
#include <utility>

namespace roverd::link {
namespace detail {

/// Both ends share it. `ends[i]` is what end i is to the other one.
template <class Unit>
struct MemoryWire {
  struct End {
    bool open = false;
    std::deque<Unit> queue;                       // on its way to this end
    std::function<void(const Unit&, Time)> hear;  // set while this end exists
    std::function<bool(const Unit&)> lose;        // of what this end sends
    std::function<Time()> clock;                  // of what this end sends
    std::uint64_t dropped = 0;                    // of what this end sent
  };
  explicit MemoryWire(std::size_t limit) : capacity(limit) {}

  SendResult send(int side, Unit unit) {
    End& from = ends.at(static_cast<std::size_t>(side));
    End& to = ends.at(static_cast<std::size_t>(1 - side));
    if (!from.open || !to.open) return SendResult::Closed;
    if (from.lose && from.lose(unit)) return SendResult::Sent;
    if (from.clock) {
      to.hear(unit, from.clock());
      return SendResult::Sent;
    }
    if (to.queue.size() >= capacity) {
      ++from.dropped;
      return SendResult::Busy;
    }
    to.queue.push_back(std::move(unit));
    return SendResult::Sent;
  }

  std::size_t deliver(int side, Time now) {
    End& to = ends.at(static_cast<std::size_t>(side));
    std::size_t delivered = 0;
    for (std::size_t due = to.queue.size(); due > 0 && !to.queue.empty(); --due) {
      const Unit unit = std::move(to.queue.front());
      to.queue.pop_front();
      to.hear(unit, now);
      ++delivered;
    }
    return delivered;
  }

  base::Result<void> open(int side, const std::string& refusal) {
    if (!refusal.empty()) return base::fail(base::Code::Unavailable, refusal);
    ends.at(static_cast<std::size_t>(side)).open = true;
    return {};
  }

  void close(int side) noexcept {
    End& end = ends[static_cast<std::size_t>(side)];
    end.open = false;
    end.queue.clear();
  }

  const std::size_t capacity;
  std::array<End, 2> ends;
};

}  // namespace detail

namespace {
std::size_t index(int side) noexcept {
  return static_cast<std::size_t>(side);
}
}  // namespace

MemoryFrameLink::MemoryFrameLink(std::shared_ptr<detail::MemoryWire<CanFrame>> wire, int side)
    : wire_(std::move(wire)), side_(side) {
  wire_->ends[index(side_)].hear = [this](const CanFrame& frame, Time t) {
    if (on_frame) on_frame(frame, t);
  };
}
MemoryFrameLink::~MemoryFrameLink() {
  close();
}
base::Result<void> MemoryFrameLink::open() {
  return wire_->open(side_, refusal_);
}
void MemoryFrameLink::close() noexcept {
  wire_->close(side_);
}
SendResult MemoryFrameLink::send(const CanFrame& frame) noexcept {
  return wire_->send(side_, frame);
}
std::size_t MemoryFrameLink::deliver(Time now) {
  return wire_->deliver(side_, now);
}
void MemoryFrameLink::set_loss(std::function<bool(const CanFrame&)> lose) {
  wire_->ends[index(side_)].lose = std::move(lose);
}
void MemoryFrameLink::set_immediate(std::function<Time()> clock) {
  wire_->ends[index(side_)].clock = std::move(clock);
}
void MemoryFrameLink::fail(const std::string& reason) {
  close();
  if (on_closed) on_closed(reason);
}
std::size_t MemoryFrameLink::waiting() const noexcept {
  return wire_->ends[index(side_)].queue.size();
}
std::uint64_t MemoryFrameLink::dropped() const noexcept {
  return wire_->ends[index(side_)].dropped;
}
bool MemoryFrameLink::is_open() const noexcept {
  return wire_->ends[index(side_)].open;
}

MemoryByteLink::MemoryByteLink(std::shared_ptr<detail::MemoryWire<Chunk>> wire, int side)
    : wire_(std::move(wire)), side_(side) {
  wire_->ends[index(side_)].hear = [this](const Chunk& chunk, Time t) {
    if (on_bytes) on_bytes(chunk, t);
  };
}
MemoryByteLink::~MemoryByteLink() {
  close();
}
base::Result<void> MemoryByteLink::open() {
  return wire_->open(side_, refusal_);
}
void MemoryByteLink::close() noexcept {
  wire_->close(side_);
}
SendResult MemoryByteLink::write(Bytes bytes) noexcept {
  if (bytes.empty()) return SendResult::Sent;  // on_bytes never sees an empty span
  return wire_->send(side_, Chunk(bytes.begin(), bytes.end()));
}
std::size_t MemoryByteLink::deliver(Time now) {
  return wire_->deliver(side_, now);
}
void MemoryByteLink::set_loss(std::function<bool(const Chunk&)> lose) {
  wire_->ends[index(side_)].lose = std::move(lose);
}
void MemoryByteLink::set_immediate(std::function<Time()> clock) {
  wire_->ends[index(side_)].clock = std::move(clock);
}
void MemoryByteLink::fail(const std::string& reason) {
  close();
  if (on_closed) on_closed(reason);
}
std::size_t MemoryByteLink::waiting() const noexcept {
  return wire_->ends[index(side_)].queue.size();
}
std::uint64_t MemoryByteLink::dropped() const noexcept {
  return wire_->ends[index(side_)].dropped;
}
bool MemoryByteLink::is_open() const noexcept {
  return wire_->ends[index(side_)].open;
}

MemoryFramePair memory_frame_pair(std::size_t capacity) {
  auto wire = std::make_shared<detail::MemoryWire<CanFrame>>(capacity);
  return {std::make_unique<MemoryFrameLink>(wire, 0), std::make_unique<MemoryFrameLink>(wire, 1)};
}

MemoryBytePair memory_byte_pair(std::size_t capacity) {
  auto wire = std::make_shared<detail::MemoryWire<MemoryByteLink::Chunk>>(capacity);
  return {std::make_unique<MemoryByteLink>(wire, 0), std::make_unique<MemoryByteLink>(wire, 1)};
}

}  // namespace roverd::link
