#pragma once
// Latest<T>: the newest value of something, from one writer to many readers.
// The critical section is one pointer swap. The writer is the control loop: it only tries the lock,
// so a reader that is preempted inside it costs the loop one missed publication (counted), never a
// wait. Values are immutable once published.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace roverd::base {

template <class T>
class Latest {
 public:
  /// Writer thread only. @return false if a reader held the lock; the value is then dropped.
  bool publish(std::shared_ptr<const T> value) noexcept {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) {
      missed_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    value_.swap(value);
    lock.unlock();  // the old value is freed outside the lock
    return true;
  }

  /// Any thread. Null until the first publication.
  std::shared_ptr<const T> get() const {
    std::lock_guard lock(mutex_);
    return value_;
  }

  std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }

 private:
  mutable std::mutex mutex_;  // leaf: nothing else is locked while it is held
  std::shared_ptr<const T> value_;
  std::atomic<std::uint64_t> missed_{0};
};

}  // namespace roverd::base
