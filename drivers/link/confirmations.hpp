#pragma once
// Frames sent against frames confirmed by the bus, and how long the oldest one waits. One thread
// sends, one hears the confirmations; they come in the order of sending, or nearly so: only the
// number counts.

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "base/time.hpp"

namespace roverd::link {

class Confirmations {
 public:
  /// Sending thread, before the frame goes out: its confirmation may come at once.
  void sending(base::Time now) noexcept {
    const std::uint64_t n = sent_.load(std::memory_order_relaxed);
    stamps_[n % kRemembered].store(now.time_since_epoch().count(), std::memory_order_relaxed);
    sent_.store(n + 1, std::memory_order_release);
  }
  /// Sending thread: the frame announced last did not go out.
  void not_sent() noexcept { sent_.fetch_sub(1, std::memory_order_relaxed); }

  /// Device thread.
  void confirmed() noexcept { confirmed_.fetch_add(1, std::memory_order_relaxed); }
  /// Device thread: the bus said no.
  void lose() noexcept { ++lost_; }
  /// Device thread, no sending in progress: what waits now will not be confirmed any more.
  void forget() noexcept {
    const std::uint64_t sent = sent_.load(std::memory_order_acquire);
    const std::uint64_t settled = lost_ + confirmed_.load(std::memory_order_relaxed);
    if (sent > settled) lost_ += sent - settled;
  }

  /// Device thread.
  std::uint64_t sent_count() const noexcept { return sent_.load(std::memory_order_acquire); }
  std::uint64_t confirmed_count() const noexcept {
    return confirmed_.load(std::memory_order_relaxed);
  }
  std::uint64_t lost_count() const noexcept { return lost_; }
  /// Age of the oldest frame that still waits, or of the oldest remembered of very many.
  std::optional<base::Duration> oldest_waiting(base::Time now) const noexcept {
    const std::uint64_t sent = sent_.load(std::memory_order_acquire);
    std::uint64_t next = lost_ + confirmed_.load(std::memory_order_relaxed);
    if (next >= sent) return {};
    if (sent - next > kRemembered) next = sent - kRemembered;
    const base::Time since{
        base::Duration(stamps_[next % kRemembered].load(std::memory_order_relaxed))};
    return now - since;
  }

 private:
  static constexpr std::uint64_t kRemembered = 256;
  std::array<std::atomic<std::int64_t>, kRemembered> stamps_{};
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> confirmed_{0};
  std::uint64_t lost_ = 0;
};

}  // namespace roverd::link
