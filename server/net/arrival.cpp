#include "net/arrival.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <optional>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace roverd::net {

namespace {

std::optional<tcp_info> kernel_word(int socket) noexcept {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return std::nullopt;
  return info;
}

/// The kernel counts in ticks of its own, 1 to 10 ms: two moments of one tick may seem one tick
/// apart. An age that is told too great would place what came after a stop before it.
base::Duration kernel_tick() noexcept {
  timespec tick{};
  if (::clock_getres(CLOCK_MONOTONIC_COARSE, &tick) != 0) return std::chrono::milliseconds(10);
  return std::chrono::seconds(tick.tv_sec) + std::chrono::nanoseconds(tick.tv_nsec);
}

base::Time before(base::Time now, std::uint32_t age_ms) noexcept {
  static const base::Duration kTick = kernel_tick();
  return now - std::max(base::Duration{}, std::chrono::milliseconds(age_ms) - kTick);
}

}  // namespace

base::Time newest_arrival(int socket, base::Time now) noexcept {
  const auto info = kernel_word(socket);
  return info ? before(now, info->tcpi_last_data_recv) : now;
}

base::Time opened_at(int socket, base::Time now) noexcept {
  // The kernel counts the opening as the first sending.
  const auto info = kernel_word(socket);
  return info ? before(now, info->tcpi_last_data_sent) : now;
}

}  // namespace roverd::net
