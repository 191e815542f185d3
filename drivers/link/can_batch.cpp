#include "link/can_batch.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>

namespace roverd::link {

CanBatch::CanBatch() noexcept {
  for (std::size_t i = 0; i < kMost; ++i) {
    parts_[i] = {packets_[i].data(), packets_[i].size()};
    messages_[i].msg_hdr.msg_iov = &parts_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
    messages_[i].msg_hdr.msg_control = extras_[i].bytes.data();
  }
}

int CanBatch::read(int fd) noexcept {
  // The kernel shortens it to what it has written.
  for (mmsghdr& m : messages_) m.msg_hdr.msg_controllen = sizeof(Extras::bytes);
  const int n = ::recvmmsg(fd, messages_.data(), kMost, MSG_DONTWAIT, nullptr);
  if (n >= 0) return n;
  return errno == EAGAIN || errno == EINTR ? 0 : -errno;
}

CanArrival CanBatch::at(std::size_t i) noexcept {
  msghdr& message = messages_[i].msg_hdr;
  CanArrival out;
  out.packet = base::Bytes(packets_[i].data(), messages_[i].msg_len);
  out.own = (message.msg_flags & MSG_CONFIRM) != 0;
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

}  // namespace roverd::link
