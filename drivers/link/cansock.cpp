#include "link/cansock.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "link/burst.hpp"
#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

base::Result<sockaddr_un> socket_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return base::fail(base::Code::Invalid, "CAN socket path '" + path + "' must have 1 to " +
                                               std::to_string(sizeof address.sun_path - 1) +
                                               " bytes");
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

base::Error unavailable(const std::string& what, int error) {
  return {base::Code::Unavailable, what + ": " + errno_text(error), {}};
}

int connect_to(int fd, const sockaddr_un& address) noexcept {
  return ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

enum class Read { Frame, Refused, Empty, End };

/// One packet. `frame` is set for Read::Frame.
Read read_packet(int fd, CanFrame& frame) {
  std::array<std::uint8_t, kCanPacketSize + 1> buffer{};  // one more, to notice longer packets
  const ssize_t n = ::recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n < 0) return (errno == EAGAIN || errno == EINTR) ? Read::Empty : Read::End;
  if (n == 0) {
    // Either an empty packet or the end; only the end is also a hang-up.
    pollfd ask{fd, POLLRDHUP, 0};
    const bool hung_up = ::poll(&ask, 1, 0) > 0 && (ask.revents & (POLLRDHUP | POLLHUP)) != 0;
    return hung_up ? Read::End : Read::Refused;
  }
  const auto parsed = from_packet(Bytes(buffer.data(), static_cast<std::size_t>(n)));
  if (!parsed) return Read::Refused;
  frame = *parsed;
  return Read::Frame;
}

SendResult send_packet(int fd, const CanPacket& packet) noexcept {
  return write_result(::send(fd, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL),
                      packet.size());
}

/// A socket file whose program is gone: connecting to it is refused.
bool is_stale(const sockaddr_un& address) noexcept {
  struct stat file {};
  if (::lstat(address.sun_path, &file) != 0 || !S_ISSOCK(file.st_mode)) return false;
  const int probe = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (probe < 0) return false;
  const bool refused = connect_to(probe, address) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  return refused;
}

}  // namespace

CanSocketLink::CanSocketLink(asio::io_context& io, std::string path)
    : path_(std::move(path)), socket_(io) {}

CanSocketLink::~CanSocketLink() {
  close();
}

base::Result<void> CanSocketLink::open() {
  const auto address = socket_address(path_);
  if (!address) return tl::unexpected(address.error());
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return tl::unexpected(unavailable("cannot make a CAN socket", errno));
  if (connect_to(fd, *address) != 0) {
    const int error = errno;
    ::close(fd);
    return tl::unexpected(unavailable("cannot connect to the CAN socket " + path_, error));
  }
  return socket_.open(fd, [this] { read(); });
}

void CanSocketLink::close() noexcept {
  socket_.close();
}

SendResult CanSocketLink::send(const CanFrame& frame) noexcept {
  if (!is_valid(frame)) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return SendResult::Busy;
  }
  const CanPacket packet = to_packet(frame);
  return socket_.use([&](int fd) { return send_packet(fd, packet); });
}

void CanSocketLink::read() {
  for (int i = 0; i < kReadBurst && socket_.is_open(); ++i) {
    CanFrame frame;
    switch (read_packet(socket_.fd(), frame)) {
      case Read::Frame:
        if (on_frame) on_frame(frame, base::steady_now());
        break;
      case Read::Refused:
        refused_.fetch_add(1, std::memory_order_relaxed);
        break;
      case Read::Empty:
        return;
      case Read::End:
        lost("the CAN socket " + path_ + " was closed by the other end");
        return;
    }
  }
}

void CanSocketLink::lost(const std::string& reason) {
  close();
  if (on_closed) on_closed(reason);
}

CanSocketServer::CanSocketServer(asio::io_context& io, std::string path)
    : io_(io), path_(std::move(path)), listener_(io) {}

CanSocketServer::~CanSocketServer() {
  close();
}

base::Result<int> CanSocketServer::bind_listener() {
  const auto address = socket_address(path_);
  if (!address) return tl::unexpected(address.error());
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return tl::unexpected(unavailable("cannot make a CAN socket", errno));
  const auto bind_it = [&] {
    return ::bind(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address);
  };
  int failed = bind_it();
  if (failed != 0 && errno == EADDRINUSE && is_stale(*address)) {
    ::unlink(path_.c_str());
    failed = bind_it();
  }
  if (failed == 0) failed = ::listen(fd, static_cast<int>(kMaxClients));
  if (failed != 0) {
    const int error = errno;
    ::close(fd);
    return tl::unexpected(unavailable("cannot listen on the CAN socket " + path_, error));
  }
  return fd;
}

base::Result<void> CanSocketServer::open() {
  const auto fd = bind_listener();
  if (!fd) return tl::unexpected(fd.error());
  struct stat file {};
  if (::lstat(path_.c_str(), &file) == 0) {
    inode_ = file.st_ino;
    device_ = file.st_dev;
  }
  return listener_.open(*fd, [this] { accept(); });
}

void CanSocketServer::close() noexcept {
  if (!listener_.is_open()) return;
  listener_.close();
  std::vector<std::shared_ptr<Client>> gone;
  {
    std::lock_guard lock(mutex_);
    gone.swap(clients_);
  }
  for (const auto& client : gone) client->socket.close();  // one may be in the middle of read()
  struct stat file {};
  if (::lstat(path_.c_str(), &file) == 0 && file.st_ino == inode_ && file.st_dev == device_) {
    ::unlink(path_.c_str());
  }
}

void CanSocketServer::accept() {
  const int fd = ::accept4(listener_.fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return;  // gone again, or out of descriptors: the next wake-up tries anew
  if (clients() >= kMaxClients) {
    ::close(fd);
    return;
  }
  auto client = std::make_shared<Client>(io_);
  const auto on_readable = [this, weak = std::weak_ptr(client)] {
    if (const auto alive = weak.lock()) read(*alive);
  };
  if (!client->socket.open(fd, on_readable)) return;
  std::lock_guard lock(mutex_);
  clients_.push_back(std::move(client));
}

void CanSocketServer::read(Client& client) {
  for (int i = 0; i < kReadBurst && client.socket.is_open(); ++i) {
    CanFrame frame;
    switch (read_packet(client.socket.fd(), frame)) {
      case Read::Frame:
        spread(frame, &client);
        if (on_frame) on_frame(frame, base::steady_now());
        break;
      case Read::Refused:
        refused_.fetch_add(1, std::memory_order_relaxed);
        break;
      case Read::Empty:
        return;
      case Read::End:
        drop(client);
        return;
    }
  }
}

void CanSocketServer::drop(const Client& client) {
  std::shared_ptr<Client> gone;  // freed outside the lock
  std::lock_guard lock(mutex_);
  const auto it =
      std::find_if(clients_.begin(), clients_.end(), [&](auto& c) { return c.get() == &client; });
  if (it == clients_.end()) return;
  gone = std::move(*it);
  clients_.erase(it);
}

SendResult CanSocketServer::send(const CanFrame& frame) noexcept {
  if (!is_valid(frame)) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return SendResult::Busy;
  }
  return spread(frame, nullptr);
}

SendResult CanSocketServer::spread(const CanFrame& frame, const Client* from) noexcept {
  const CanPacket packet = to_packet(frame);
  SendResult result = SendResult::Sent;
  std::lock_guard lock(mutex_);
  for (const auto& client : clients_) {
    if (client.get() == from) continue;
    const auto sent = client->socket.use([&](int fd) { return send_packet(fd, packet); });
    if (sent == SendResult::Busy) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      result = SendResult::Busy;
    }
  }
  return result;
}

std::size_t CanSocketServer::clients() const {
  std::lock_guard lock(mutex_);
  return clients_.size();
}

}  // namespace roverd::link
