#include "link/socketcan.hpp"

#include <algorithm>
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

using boost::system::error_code;

static_assert(sizeof(can_frame) == kCanPacketSize && offsetof(can_frame, data) == 8);

/// Asked for. Without CAP_NET_ADMIN the kernel cuts it to net.core.rmem_max, usually 200 kB: that
/// is about 50 ms of a full 1 Mbit/s bus, for a frame takes about half a kilobyte there.
constexpr int kReceiveBuffer = 1'000'000;
/// Of the socket that hears what nobody waits for: a few hundred frames.
constexpr int kSmallBuffer = 100'000;

ifreq request_for(const std::string& interface) noexcept {
  ifreq request{};
  std::memcpy(request.ifr_name, interface.c_str(), interface.size());  // length checked by open()
  return request;
}

}  // namespace

Time monotonic_stamp(base::WallTime stamped, base::WallTime wall_now, Time now) noexcept {
  const base::Duration ago = wall_now - stamped;
  if (ago < base::Duration::zero() || ago > std::chrono::seconds(1)) return now;
  return now - ago;
}

SocketCanLink::SocketCanLink(asio::io_context& io, std::string interface, CanOptions options)
    : interface_(std::move(interface)), options_(std::move(options)), io_(io), socket_(io) {}

SocketCanLink::~SocketCanLink() {
  close();
}

SocketCanLink::Others::~Others() {
  ::close(fd);
}

base::Result<void> SocketCanLink::open() {
  if (auto ready = prepare(); !ready) return ready;
  const bool apart = options_.only.empty() && !attended_.empty();
  const auto fd = make_socket(apart ? Share::Attended : Share::All);
  if (!fd) return tl::unexpected(fd.error());
  close();
  refreshed_.reset();
  if (auto opened = socket_.open(*fd, [this] { read(); }); !opened || !apart) return opened;
  const auto second = make_socket(Share::Others);
  if (!second) {
    close();
    return tl::unexpected(second.error());
  }
  others_ = std::make_shared<Others>(io_, *second);
  wait_for_others();
  return {};
}

base::Result<int> SocketCanLink::make_socket(Share share) const {
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) {
    const std::string why = errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT
                                ? "this kernel has no CAN (modules can, can-raw)"
                                : errno_text(errno);
    return base::fail(base::Code::Unavailable, "CAN interface " + interface_ + ": " + why);
  }
  auto ready = check_interface(fd);
  if (ready) ready = configure(fd, share);
  if (ready) return fd;
  ::close(fd);
  return tl::unexpected(ready.error());
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

base::Result<void> SocketCanLink::configure(int fd, Share share) const {
  const int on = 1;
  if (share != Share::Others) {
    const can_err_mask_t every_error = CAN_ERR_MASK;
    ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &every_error, sizeof every_error);
    const int own = options_.only.empty() ? 1 : 0;
    ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &own, sizeof own);
  }
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);  // to count them
  ::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);      // without: stamped when read
  ::setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  const int room = share == Share::Others ? kSmallBuffer : kReceiveBuffer;
  if (::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room) != 0) {
    ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
  }
  if (!set_filter(fd, share)) {
    return base::fail(
        base::Code::Unavailable,
        "CAN interface " + interface_ + ": the kernel takes no filters: " + errno_text(errno));
  }
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

bool SocketCanLink::set_filter(int fd, Share share) const {
  std::vector<can_filter> filters;
  if (share == Share::All) {
    for (const CanId& wanted : options_.only) {
      filters.push_back({wanted.id | (wanted.extended ? CAN_EFF_FLAG : 0U),
                         CAN_EFF_FLAG | (wanted.extended ? CAN_EFF_MASK : CAN_SFF_MASK)});
    }
    if (filters.empty()) return true;
  }
  const canid_t inverse = share == Share::Others ? CAN_INV_FILTER : 0U;
  if (share != Share::All) {
    for (const std::uint32_t id : attended_) {
      filters.push_back({id | inverse, CAN_EFF_FLAG | CAN_SFF_MASK});
    }
  }
  // One frame passes when one filter lets it; of the others, when all do.
  const int join = 1;
  if (inverse != 0 &&
      ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_JOIN_FILTERS, &join, sizeof join) != 0) {
    return false;
  }
  return ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                      static_cast<socklen_t>(filters.size() * sizeof(can_filter))) == 0;
}

void SocketCanLink::close() noexcept {
  if (others_) others_dropped_ += others_->dropped;
  others_.reset();
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
  for (std::size_t had = 0; had < kReadBurst && socket_.is_open();) {
    const int n = batch_.read(socket_.fd());
    if (n < 0) return lost(-n);
    const Time now = base::steady_now();
    const base::WallTime wall = base::wall_now();
    const auto count = static_cast<std::size_t>(n);
    for (std::size_t i = 0; i < count && socket_.is_open(); ++i) take(batch_.at(i), now, wall);
    if (count < CanBatch::kMost) return;
    had += count;
  }
}

void SocketCanLink::take(const CanArrival& arrival, Time now, base::WallTime wall) {
  if (arrival.overrun) overrun_.store(*arrival.overrun, std::memory_order_relaxed);
  const auto frame = frame_of(arrival);
  if (!frame) return;
  if (arrival.own) return confirmations_.confirmed();
  const Time came = arrival.stamp ? monotonic_stamp(*arrival.stamp, wall, now) : now;
  slowest_ = std::max(slowest_, now - came);
  // Interrupted between the two clocks, a frame would seem to come before the one ahead of it.
  last_stamp_ = std::max(last_stamp_, came);
  if (frame->error) count_errors(*frame);
  if (on_frame) on_frame(*frame, last_stamp_);
}

std::optional<CanFrame> SocketCanLink::frame_of(const CanArrival& arrival) {
  if (arrival.packet.size() == CANFD_MTU) {
    ++fd_frames_;
    return {};
  }
  auto frame = from_packet(arrival.packet);
  if (frame) return *frame;
  refused_.fetch_add(1, std::memory_order_relaxed);
  return {};
}

void SocketCanLink::wait_for_others() {
  others_->timer.expires_after(kOthersPause);
  others_->timer.async_wait([this, watched = std::weak_ptr(others_)](error_code ec) {
    const auto still = watched.lock();
    if (!ec && still) read_others(*still);
  });
}

// Not when something waits, for on a full bus something always does, but a bounded number at a
// time. That the interface has gone is told by the first socket.
void SocketCanLink::read_others(Others& others) {
  const auto ours = [&] { return others_.get() == &others; };  // until a callback closes
  for (std::size_t had = 0; had < kReadBurst && ours();) {
    const auto count = static_cast<std::size_t>(std::max(0, batch_.read(others.fd)));
    const Time now = base::steady_now();
    const base::WallTime wall = base::wall_now();
    for (std::size_t i = 0; i < count && ours(); ++i) take_other(batch_.at(i), now, wall);
    if (count < CanBatch::kMost) break;
    had += count;
  }
  if (ours()) wait_for_others();
}

void SocketCanLink::take_other(const CanArrival& arrival, Time now, base::WallTime wall) {
  if (arrival.overrun) others_->dropped = *arrival.overrun;
  const auto frame = frame_of(arrival);
  if (!frame || !on_frame) return;
  const Time came = arrival.stamp ? monotonic_stamp(*arrival.stamp, wall, now) : now;
  on_frame(*frame, std::max(last_stamp_, came));
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
