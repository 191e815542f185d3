#include "supervise/claim.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <functional>
#include <system_error>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace roverd {
namespace {

/// A name in the kernel, not in a folder. Long links are told apart by their sum.
sockaddr_un address_of(const std::string& link, socklen_t& length) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string name = "roverd drives " + link;
  const std::size_t room = sizeof address.sun_path - 1;
  if (name.size() > room) {
    const std::string sum = std::to_string(std::hash<std::string>{}(link));
    name = name.substr(0, room - sum.size()) + sum;
  }
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

/// " (process 4711)", where it can be found out.
std::string holder(const sockaddr_un& address, socklen_t length) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return {};
  std::string text;
  ucred who{};
  socklen_t size = sizeof who;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), length) == 0 &&
      ::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0) {
    text = " (process " + std::to_string(who.pid) + ")";
  }
  ::close(fd);
  return text;
}

}  // namespace

base::Result<Claim> Claim::take(const std::string& link) {
  socklen_t length = 0;
  const sockaddr_un address = address_of(link, length);
  Claim claim(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  // Listening lets the kernel tell a second one who the first is.
  if (claim.fd_ >= 0 &&
      ::bind(claim.fd_, reinterpret_cast<const sockaddr*>(&address), length) == 0 &&
      ::listen(claim.fd_, 64) == 0) {
    return claim;
  }
  const int number = errno;
  if (number == EADDRINUSE) {
    return base::fail(base::Code::Unavailable, "another roverd" + holder(address, length) +
                                                   " drives this robot over " + link);
  }
  return base::fail(base::Code::Unavailable,
                    "cannot claim " + link + ": " + std::generic_category().message(number));
}

Claim::~Claim() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace roverd
