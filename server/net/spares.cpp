#include "net/spares.hpp"

#include <algorithm>
#include <array>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

namespace roverd::net {

namespace {

/// Beyond this nothing here needs more; some old calls (select) take none above 1023.
constexpr std::size_t kEnough = 1024;
/// For devices, the database and files that are opened later.
constexpr int kForOthers = 96;
constexpr int kLeast = 4;

int open_now(std::size_t most) noexcept {
  std::array<pollfd, kEnough> all{};
  for (std::size_t i = 0; i < most; ++i) all[i].fd = static_cast<int>(i);
  if (::poll(all.data(), most, 0) < 0) return 64;
  return static_cast<int>(std::count_if(all.data(), all.data() + most, [](const pollfd& one) {
    return (one.revents & POLLNVAL) == 0;
  }));
}

}  // namespace

Spares::~Spares() {
  for (const int fd : held_) ::close(fd);
}

bool Spares::give() noexcept {
  if (held_.empty()) return false;
  ::close(held_.back());
  held_.pop_back();
  return true;
}

void Spares::refill() noexcept {
  while (held_.size() < kSpares) {
    const int fd = ::eventfd(0, EFD_CLOEXEC);
    if (fd < 0) return;
    held_.push_back(fd);
  }
}

int Spares::descriptors_left(int reserve) noexcept {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return kLeast;
  if (limit.rlim_cur < kEnough) {
    rlimit more = limit;
    more.rlim_cur = std::min<rlim_t>(limit.rlim_max, kEnough);
    if (::setrlimit(RLIMIT_NOFILE, &more) == 0) limit = more;
  }
  const auto most = static_cast<std::size_t>(std::min<rlim_t>(limit.rlim_cur, kEnough));
  const int free = static_cast<int>(most) - open_now(most);
  const int others = std::min(kForOthers, free / 2);
  return std::max(kLeast, free - others - std::min(reserve, free / 8) - kSpares);
}

}  // namespace roverd::net
