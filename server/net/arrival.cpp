#include "net/arrival.hpp"

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

}  // namespace

base::Time newest_arrival(int socket, base::Time now) noexcept {
  const auto info = kernel_word(socket);
  return info ? now - std::chrono::milliseconds(info->tcpi_last_data_recv) : now;
}

base::Time opened_at(int socket, base::Time now) noexcept {
  // The kernel counts the opening as the first sending.
  const auto info = kernel_word(socket);
  return info ? now - std::chrono::milliseconds(info->tcpi_last_data_sent) : now;
}

}  // namespace roverd::net
