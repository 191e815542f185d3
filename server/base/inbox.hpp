#pragma once
// Inbox<T>: a bounded queue from any threads to one reader. When full, the oldest is dropped and
// counted. try_take never waits: if a writer is inside, the reader comes back at its next turn.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

namespace roverd::base {

template <class T>
class Inbox {
 public:
  explicit Inbox(std::size_t capacity) : capacity_(capacity) {}

  /// Any thread. @return false if the oldest entry had to go to make room.
  bool put(T value) {
    std::lock_guard lock(mutex_);
    const bool full = queue_.size() >= capacity_;
    if (full) {
      queue_.pop_front();
      dropped_.fetch_add(1, std::memory_order_relaxed);
    }
    queue_.push_back(std::move(value));
    return !full;
  }

  /// Any thread, all or nothing: refuses instead of dropping another entry. For commands, whose
  /// sender must hear that there was no room. @param more beyond the capacity, for what must get in
  bool offer(T value, std::size_t more = 0) {
    std::lock_guard lock(mutex_);
    if (queue_.size() >= capacity_ + more) return false;
    queue_.push_back(std::move(value));
    return true;
  }

  /// Writer that must not wait (the control loop): @return false if the lock was taken or the
  /// queue is full; `value` is then untouched.
  bool try_offer(T& value) {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || queue_.size() >= capacity_) return false;
    queue_.push_back(std::move(value));
    return true;
  }

  /// Reader thread. Appends everything to `out` in order of arrival. Never waits.
  /// @return false if a writer held the lock.
  bool try_take(std::vector<T>& out) {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return false;
    for (auto& value : queue_) out.push_back(std::move(value));
    queue_.clear();
    return true;
  }

  /// Reader thread that may wait briefly.
  void take(std::vector<T>& out) {
    std::lock_guard lock(mutex_);
    for (auto& value : queue_) out.push_back(std::move(value));
    queue_.clear();
  }

  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;  // leaf
  std::deque<T> queue_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace roverd::base
