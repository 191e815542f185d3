#include "link/socketcan.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "link/burst.hpp"
#include "link/can_control.hpp"
#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

/// What one read may bring: a CAN FD frame is longer, and told by that.
using Packet = std::array<std::uint8_t, CANFD_MTU>;
static_assert(sizeof(can_frame) == kCanPacketSize && offsetof(can_frame, data) == 8);

/// Asked for. Without CAP_NET_ADMIN the kernel cuts it to net.core.rmem_max, usually 200 kB: that
/// is about 50 ms of a full 1 Mbit/s bus, for a frame takes about half a kilobyte there.
constexpr int kReceiveBuffer = 1'000'000;

ifreq request_for(const std::string& interface) noexcept {
  ifreq request{};
  std::memcpy(request.ifr_name, interface.c_str(), interface.size());  // length checked by open()
  return request;
}

struct Extras {
  std::optional<base::WallTime> stamp;
  std::optional<std::uint32_t> overrun;
};

Extras read_extras(msghdr& message) noexcept {
  Extras out;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec t{};
      std::memcpy(&t, CMSG_DATA(c), sizeof t);
      out.stamp =
          base::WallTime(std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec));
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t count = 0;
      std::memcpy(&count, CMSG_DATA(c), sizeof count);
      out.overrun = count;
    }
  }
  return out;
}

}  // namespace

Time monotonic_stamp(base::WallTime stamped, base::WallTime wall_now, Time now) noexcept {
  const base::Duration ago = wall_now - stamped;
  if (ago < base::Duration::zero() || ago > std::chrono::seconds(1)) return now;
  return now - ago;
}

SocketCanLink::SocketCanLink(asio::io_context& io, std::string interface, CanOptions options)
    : interface_(std::move(interface)), options_(std::move(options)), socket_(io) {}

SocketCanLink::~SocketCanLink() {
  close();
}

base::Result<void> SocketCanLink::open() {
  auto ready = prepare();
  if (!ready) return ready;
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) {
    const std::string why = errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT
                                ? "this kernel has no CAN (modules can, can-raw)"
                                : errno_text(errno);
    return base::fail(base::Code::Unavailable, "CAN interface " + interface_ + ": " + why);
  }
  ready = check_interface(fd);
  if (ready) ready = configure(fd);
  if (!ready) {
    ::close(fd);
    return ready;
  }
  close();
  refreshed_.reset();
  return socket_.open(fd, [this] { read(); });
}

base::Result<void> SocketCanLink::prepare() {
  const std::string name = "CAN interface " + interface_;
  if (interface_.empty() || interface_.size() >= IFNAMSIZ) {
    return base::fail(base::Code::Invalid, name + ": a name has 1 to 15 letters");
  }
  // Asked before the socket: also on a kernel without CAN, the missing interface is the reason.
  if (::if_nametoindex(interface_.c_str()) == 0) {
    return base::fail(base::Code::NotFound, name + " does not exist");
  }
  if (!options_.configures()) return {};
  auto brought = bring_up(interface_, options_);
  problem_ = brought ? "" : brought.error().detail;
  return brought;
}

base::Result<void> SocketCanLink::check_interface(int fd) const {
  const std::string name = "CAN interface " + interface_;
  ifreq request = request_for(interface_);
  if (::ioctl(fd, SIOCGIFHWADDR, &request) == 0 && request.ifr_hwaddr.sa_family != ARPHRD_CAN) {
    return base::fail(base::Code::Invalid, name + " is not a CAN interface");
  }
  request = request_for(interface_);
  if (::ioctl(fd, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) == 0) {
    return base::fail(
        base::Code::Unavailable,
        name + " is down (set the bit rate, then: ip link set " + interface_ + " up)");
  }
  return {};
}

base::Result<void> SocketCanLink::configure(int fd) const {
  const can_err_mask_t every_error = CAN_ERR_MASK;
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &every_error, sizeof every_error);
  const int on = 1;
  const int own = options_.only.empty() ? 1 : 0;
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &own, sizeof own);
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);  // to count them
  ::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);      // without: stamped when read
  ::setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  if (::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBuffer, sizeof kReceiveBuffer) != 0) {
    ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  }
  set_filter(fd);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface_.c_str()));
  if (address.can_ifindex == 0 ||  // 0 would mean every interface
      ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return base::fail(base::Code::Unavailable,
                      "CAN interface " + interface_ + ": " +
                          errno_text(address.can_ifindex == 0 ? ENODEV : errno));
  }
  return {};
}

void SocketCanLink::set_filter(int fd) const {
  if (options_.only.empty()) return;
  std::vector<can_filter> filters;
  for (const CanId& wanted : options_.only) {
    filters.push_back({wanted.id | (wanted.extended ? CAN_EFF_FLAG : 0U),
                       CAN_EFF_FLAG | (wanted.extended ? CAN_EFF_MASK : CAN_SFF_MASK)});
  }
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
               static_cast<socklen_t>(filters.size() * sizeof(can_filter)));
}

void SocketCanLink::close() noexcept {
  socket_.close();
  confirmations_.forget();
}

SendResult SocketCanLink::send(const CanFrame& frame) noexcept {
  if (!is_valid(frame)) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return SendResult::Busy;
  }
  const CanPacket packet = to_packet(frame);
  return socket_.use([&](int fd) {
    confirmations_.sending(base::steady_now());
    const SendResult result = write_result(
        ::send(fd, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL), packet.size());
    if (result != SendResult::Sent) confirmations_.not_sent();
    return result;
  });
}

void SocketCanLink::read() {
  for (int i = 0; i < kReadBurst && socket_.is_open(); ++i) {
    if (!read_one()) return;
  }
}

bool SocketCanLink::read_one() {
  Packet packet;
  iovec part{packet.data(), packet.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(int))> control;
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t n = ::recvmsg(socket_.fd(), &message, MSG_DONTWAIT);
  if (n < 0) {
    if (errno == EAGAIN || errno == EINTR) return false;
    lost(errno);
    return false;
  }
  if (n == CANFD_MTU) {
    ++fd_frames_;
    return true;
  }
  const auto frame = from_packet(Bytes(packet.data(), static_cast<std::size_t>(n)));
  if (!frame) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
  const Extras extras = read_extras(message);
  if (extras.overrun) overrun_.store(*extras.overrun, std::memory_order_relaxed);
  if ((message.msg_flags & MSG_CONFIRM) != 0) {  // sent by this very socket
    confirmations_.confirmed();
    return true;
  }
  const Time now = base::steady_now();
  // Interrupted between the two clocks, a frame would seem to come before the one ahead of it.
  last_stamp_ = std::max(
      last_stamp_, extras.stamp ? monotonic_stamp(*extras.stamp, base::wall_now(), now) : now);
  heard(*frame, last_stamp_);
  return true;
}

void SocketCanLink::heard(const CanFrame& frame, Time stamp) {
  if (frame.error) count_errors(frame);
  if (on_frame) on_frame(frame, stamp);
}

void SocketCanLink::lost(int error) {
  close();
  if (!on_closed) return;
  const std::string name = "CAN interface " + interface_;
  if (::if_nametoindex(interface_.c_str()) == 0) {  // it goes down first, which may be all we hear
    on_closed(name + " was removed");
  } else if (error == ENETDOWN) {
    on_closed(name + " went down");
  } else {
    on_closed(name + ": " + errno_text(error));
  }
}

}  // namespace roverd::link
