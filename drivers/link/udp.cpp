#include "link/udp.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/udp.hpp>
#include <netinet/in.h>
#include <unistd.h>

#include "link/burst.hpp"

namespace roverd::link {
namespace {

constexpr std::size_t kLargestDatagram = 65'536;
/// Wanted of the kernel, which may give less: a lidar sends 1.8 MB a second, and this thread may be
/// late by a tenth of one.
constexpr int kReceiveBuffer = 1 << 20;

base::Error cannot_bind(std::uint16_t port, int error) {
  return {base::Code::Unavailable,
          "cannot receive on UDP port " + std::to_string(port) + ": " + errno_text(error),
          {}};
}

int bind_to(int fd, const void* address, std::size_t size) noexcept {
  return ::bind(fd, static_cast<const sockaddr*>(address), static_cast<socklen_t>(size));
}

}  // namespace

UdpLink::UdpLink(asio::io_context& io, std::uint16_t port, std::optional<Peer> peer)
    : port_(port), peer_(std::move(peer)), socket_(io) {}

UdpLink::~UdpLink() {
  close();
}

/// One IPv6 socket that also takes IPv4; a kernel without IPv6 gets a plain IPv4 one.
base::Result<int> UdpLink::bind_socket() {
  constexpr int kType = SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK;
  int fd = ::socket(AF_INET6, kType, 0);
  int failed = -1;
  if (fd >= 0) {
    const int off = 0;
    ::setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
    sockaddr_in6 any{};
    any.sin6_family = AF_INET6;
    any.sin6_addr = in6addr_any;
    any.sin6_port = htons(port_);
    failed = bind_to(fd, &any, sizeof any);
  }
  if (fd < 0 || (failed != 0 && errno == EADDRNOTAVAIL)) {
    if (fd >= 0) ::close(fd);
    fd = ::socket(AF_INET, kType, 0);
    if (fd < 0) return tl::unexpected(cannot_bind(port_, errno));
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_port = htons(port_);
    failed = bind_to(fd, &any, sizeof any);
  }
  if (failed != 0) {
    const int error = errno;
    ::close(fd);
    return tl::unexpected(cannot_bind(port_, error));
  }
  ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  return fd;
}

base::Result<void> UdpLink::open() {
  close();
  const auto fd = bind_socket();
  if (!fd) return tl::unexpected(fd.error());
  Address local;
  local.size = sizeof local.storage;
  ::getsockname(*fd, reinterpret_cast<sockaddr*>(&local.storage), &local.size);
  const bool v6 = local.storage.ss_family == AF_INET6;
  // sin_port and sin6_port lie at the same place.
  bound_port_ = ntohs(reinterpret_cast<const sockaddr_in*>(&local.storage)->sin_port);
  Address target;
  if (peer_) {
    boost::system::error_code ec;
    auto address = asio::ip::make_address(peer_->address, ec);
    if (ec) {
      ::close(*fd);
      return base::fail(base::Code::Invalid, "UDP peer " + peer_->address + ": " + ec.message());
    }
    if (v6 && address.is_v4()) {
      address = asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4());
    }
    const asio::ip::udp::endpoint endpoint(address, peer_->port);
    std::memcpy(&target.storage, endpoint.data(), endpoint.size());
    target.size = static_cast<socklen_t>(endpoint.size());
  }
  {
    std::lock_guard lock(mutex_);
    target_ = target;
  }
  return socket_.open(*fd, [this] { read(); });
}

void UdpLink::close() noexcept {
  socket_.close();
}

SendResult UdpLink::write(Bytes bytes) noexcept {
  Address target;
  {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return SendResult::Busy;
    target = target_;
  }
  if (target.size == 0) return SendResult::Closed;
  return socket_.use([&](int fd) {
    return write_result(::sendto(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                                 reinterpret_cast<const sockaddr*>(&target.storage), target.size),
                        bytes.size());
  });
}

void UdpLink::read() {
  std::array<std::uint8_t, kLargestDatagram> buffer;
  for (int i = 0; i < kReadBurst && socket_.is_open(); ++i) {
    Address sender;
    sender.size = sizeof sender.storage;
    const ssize_t n = ::recvfrom(socket_.fd(), buffer.data(), buffer.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&sender.storage), &sender.size);
    if (n < 0) {
      // An earlier answer met a closed port (ICMP): no reason to stop listening.
      if (errno == ECONNREFUSED || errno == EHOSTUNREACH || errno == ENETUNREACH) continue;
      if (errno != EAGAIN && errno != EINTR) lost(errno_text(errno));
      return;
    }
    if (!peer_) {
      remember(sender);
    } else if (!is_peer(sender)) {
      ++strangers_;
      continue;
    }
    if (n > 0 && on_bytes) {
      heard_ = sender;
      on_bytes({buffer.data(), static_cast<std::size_t>(n)}, base::steady_now());
    }
  }
}

/// Address and port; a scope or flow label of IPv6 says nothing of who it is.
bool UdpLink::is_peer(const Address& sender) const noexcept {
  if (sender.storage.ss_family != target_.storage.ss_family) return false;
  if (sender.storage.ss_family == AF_INET) {
    const auto& a = reinterpret_cast<const sockaddr_in&>(sender.storage);
    const auto& b = reinterpret_cast<const sockaddr_in&>(target_.storage);
    return a.sin_port == b.sin_port && a.sin_addr.s_addr == b.sin_addr.s_addr;
  }
  const auto& a = reinterpret_cast<const sockaddr_in6&>(sender.storage);
  const auto& b = reinterpret_cast<const sockaddr_in6&>(target_.storage);
  return a.sin6_port == b.sin6_port &&
         std::memcmp(&a.sin6_addr, &b.sin6_addr, sizeof a.sin6_addr) == 0;
}

Ends UdpLink::ends() const noexcept {
  Ends out;
  out.port = bound_port_;
  const auto* v4 = reinterpret_cast<const sockaddr_in*>(&heard_.storage);
  const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&heard_.storage);
  if (heard_.storage.ss_family == AF_INET) {
    std::memcpy(out.peer.data(), &v4->sin_addr, out.peer.size());
    out.peer_port = ntohs(v4->sin_port);
  } else if (heard_.storage.ss_family == AF_INET6 && IN6_IS_ADDR_V4MAPPED(&v6->sin6_addr)) {
    std::memcpy(out.peer.data(), v6->sin6_addr.s6_addr + 12, out.peer.size());
    out.peer_port = ntohs(v6->sin6_port);
  }
  return out;
}

std::string UdpLink::describe() const {
  if (!peer_) return "udp:" + std::to_string(port_);
  const bool v6 = peer_->address.find(':') != std::string::npos;
  return "udp:" + (port_ == 0 ? "" : std::to_string(port_) + ":") +
         (v6 ? "[" + peer_->address + "]" : peer_->address) + ":" + std::to_string(peer_->port);
}

void UdpLink::remember(const Address& sender) {
  // Only this thread changes target_, so it may read it without the lock.
  const bool same = sender.size == target_.size &&
                    std::memcmp(&sender.storage, &target_.storage, sender.size) == 0;
  if (same) return;
  std::lock_guard lock(mutex_);
  target_ = sender;
}

void UdpLink::lost(const std::string& reason) {
  close();
  if (on_closed) on_closed("lost " + describe() + ": " + reason);
}

}  // namespace roverd::link
