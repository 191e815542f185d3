#pragma once
// What was told lately, newest first. No allocation.

#include <array>
#include <cstddef>

#include "base/time.hpp"

namespace roverd::nav {

/// The newest N of them; the oldest goes first. @tparam T has a member `t`, growing.
template <class T, std::size_t N>
class Ring {
 public:
  static constexpr std::size_t kMost = N;

  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }

  void push(const T& value) noexcept {
    head_ = (head_ + 1) % N;
    ring_[head_] = value;
    if (size_ < N) ++size_;
  }

  /// @param back 0 is the newest; less than size().
  const T& operator[](std::size_t back) const noexcept { return ring_[(head_ + N - back) % N]; }
  const T& newest() const noexcept { return (*this)[0]; }
  const T& oldest() const noexcept { return (*this)[size_ - 1]; }

  /// How far back the newest one lies that is not later than `t`; size() if none is.
  std::size_t not_after(base::Time t) const noexcept {
    std::size_t low = 0;
    std::size_t high = size_;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if ((*this)[middle].t <= t) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low;
  }

 private:
  std::array<T, N> ring_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
};

}  // namespace roverd::nav
