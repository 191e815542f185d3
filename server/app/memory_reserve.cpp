#include "app/memory_reserve.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace roverd {

namespace {

/// Never touched, so that it takes room only where room is counted when it is asked for; so large
/// that malloc takes it from the system, and gives it back there.
constexpr std::size_t kReserve = std::size_t{48} << 20U;

std::atomic<void*> reserve{nullptr};

[[noreturn]] void give_and_fail() {
  std::free(reserve.exchange(nullptr));
  throw std::bad_alloc();
}

}  // namespace

void hold_memory_back() {
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
