#include "app/memory_reserve.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace roverd {

namespace {

/// Never touched, so that it takes room only where room is counted when it is asked for; so large
/// that malloc takes it from the system, and gives it back there.
constexpr std::size_t kReserve = std::size_t{48} << 20U;

/// From here on a block is the system's own, and so much that is free goes back to it.
constexpr int kLargeBlock = 256 << 10;

std::atomic<void*> reserve{nullptr};

[[noreturn]] void give_and_fail() {
  std::free(reserve.exchange(nullptr));
  throw std::bad_alloc();
}

}  // namespace

void hold_memory_back() {
  // Else the first large block that is freed moves both limits up to its size, and more of what a
  // large request needed stays with its thread's heap: after a file of 20,000 points 31 MB, not 12.
  ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  ::mallopt(M_TRIM_THRESHOLD, kLargeBlock);
  refill_memory_reserve();
  std::set_new_handler(give_and_fail);
}

void refill_memory_reserve() noexcept {
  if (reserve.load() != nullptr) return;
  void* more = std::malloc(kReserve);
  void* none = nullptr;
  if (!reserve.compare_exchange_strong(none, more)) std::free(more);
}

}  // namespace roverd
