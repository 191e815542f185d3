#include "supervise/service_manager.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

namespace roverd {
namespace {

const char* from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Has the process the right to lock whatever it wants?
bool may_lock() noexcept {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct rights[_LINUX_CAPABILITY_U32S_3]{};
  return ::syscall(SYS_capget, &header, rights) == 0 &&
         (rights[0].effective & (1u << CAP_IPC_LOCK)) != 0;
}

}  // namespace

ServiceManager::ServiceManager(std::string socket, std::string_view watchdog_us)
    : socket_(std::move(socket)) {
  if (socket_.empty() || socket_.size() >= sizeof(sockaddr_un::sun_path)) return;
  fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  std::int64_t us = 0;
  const char* end = watchdog_us.data() + watchdog_us.size();
  const auto read = std::from_chars(watchdog_us.data(), end, us);
  if (fd_ < 0 || watchdog_us.empty() || read.ec != std::errc{} || read.ptr != end || us <= 0)
    return;
  period_ = std::chrono::microseconds(std::max<std::int64_t>(us / 3, 1000));
}

ServiceManager ServiceManager::of_this_process() {
  return {from_environment("NOTIFY_SOCKET"), from_environment("WATCHDOG_USEC")};
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      socket_(std::move(other.socket_)),
      period_(other.period_),
      told_(other.told_) {}

ServiceManager::~ServiceManager() {
  if (fd_ >= 0) ::close(fd_);
}

void ServiceManager::ready(const std::string& address) {
  tell("READY=1\nSTATUS=serving " + address);
}

void ServiceManager::stopping() {
  tell("STOPPING=1");
}

void ServiceManager::alive(std::uint64_t ticks) {
  if (told_ && *told_ == ticks) return;
  told_ = ticks;
  tell("WATCHDOG=1");
}

/// One that nobody takes is lost: the manager's own socket is not worth waiting for.
void ServiceManager::tell(const std::string& words) {
  if (fd_ < 0) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  ::sendto(fd_, words.data(), words.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&address), length);
}

bool lock_memory() noexcept {
  // With a limit, the next allocation beyond it would fail instead of being unlocked.
  rlimit limit{};
  const bool unlimited =
      ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (!unlimited && !may_lock()) return false;
  return ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

}  // namespace roverd
