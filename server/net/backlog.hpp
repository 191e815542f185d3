#pragma once
// What one client has still to be sent while its connection is busy. Bounded in two ways:
// a slot keeps only its newest frame; the queue keeps the newest kQueue frames.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "net/frame.hpp"

namespace roverd::net {

class Backlog {
 public:
  static constexpr std::size_t kQueue = 256;

  /// Newest wins: replaces what waits in that slot. @return false if an older frame was dropped.
  bool offer(std::uint64_t slot, Frame frame) {
    for (auto& [name, waiting] : slots_) {
      if (name != slot) continue;
      waiting = std::move(frame);
      ++dropped_;
      return false;
    }
    slots_.emplace_back(slot, std::move(frame));
    return true;
  }

  /// Every frame counts; when full the oldest goes. @return false if one was dropped.
  bool push(Frame frame) {
    const bool full = queue_.size() >= kQueue;
    if (full) {
      queue_.pop_front();
      ++dropped_;
    }
    queue_.push_back(std::move(frame));
    return !full;
  }

  /// Queue first, then the slots in the order in which they were filled. Null when empty.
  Frame next() {
    if (!queue_.empty()) {
      Frame frame = std::move(queue_.front());
      queue_.pop_front();
      return frame;
    }
    if (slots_.empty()) return nullptr;
    Frame frame = std::move(slots_.front().second);
    slots_.erase(slots_.begin());
    return frame;
  }

  bool empty() const noexcept { return queue_.empty() && slots_.empty(); }
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::vector<std::pair<std::uint64_t, Frame>> slots_;
  std::deque<Frame> queue_;
  std::uint64_t dropped_ = 0;
};

}  // namespace roverd::net
