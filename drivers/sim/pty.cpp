#include "sim/pty.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace roverd::sim {
namespace {

namespace fs = std::filesystem;

tl::unexpected<base::Error> failed(const std::string& what, int error) {
  return base::fail(base::Code::Unavailable, what + ": " + link::errno_text(error));
}

/// No echo, no line discipline: bytes pass as they are.
bool make_raw(int fd) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B115200);
  return ::tcsetattr(fd, TCSANOW, &settings) == 0;
}

}  // namespace

Pty::Pty(boost::asio::io_context& io, std::string path) : path_(std::move(path)), master_(io) {}

Pty::~Pty() {
  close();
}

base::Result<void> Pty::open() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  if (master < 0) return failed("pseudo-terminal", errno);
  std::array<char, 64> name{};
  if (::grantpt(master) != 0 || ::unlockpt(master) != 0 ||
      ::ptsname_r(master, name.data(), name.size()) != 0) {
    const int error = errno;
    ::close(master);
    return failed("pseudo-terminal", error);
  }
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (slave_ < 0 || !make_raw(slave_)) {
    const int error = errno;
    ::close(master);
    close();
    return failed(name.data(), error);
  }
  auto done = master_.open(master, [this] { read(); });
  if (done) done = make_symlink(name.data());
  if (!done) close();
  return done;
}

base::Result<void> Pty::make_symlink(const std::string& device) {
  if (path_.empty()) {
    device_ = device;
    return {};
  }
  std::error_code ec;
  const fs::file_status there = fs::symlink_status(path_, ec);
  if (fs::is_symlink(there)) {
    fs::remove(path_, ec);
  } else if (fs::exists(there)) {
    return failed(path_, EEXIST);
  }
  fs::create_symlink(device, path_, ec);
  if (ec) return failed(path_, ec.value());
  device_ = device;
  return {};
}

void Pty::close() noexcept {
  std::error_code ec;
  if (!path_.empty() && !device_.empty() && fs::read_symlink(path_, ec) == device_)
    fs::remove(path_, ec);
  device_.clear();
  master_.close();
  if (slave_ >= 0) ::close(slave_);
  slave_ = -1;
}

link::SendResult Pty::write(base::Bytes bytes) noexcept {
  int unread = 0;
  if (slave_ >= 0 && ::ioctl(slave_, FIONREAD, &unread) == 0 && unread > kMaxUnread) drop_unread();
  const auto once = [&](int fd) {
    return link::write_result(::write(fd, bytes.data(), bytes.size()), bytes.size());
  };
  if (master_.use(once) == link::SendResult::Sent) return link::SendResult::Sent;
  drop_unread();  // the kernel's own queue was full: nobody has listened for long
  return master_.use(once);
}

/// Both what waits at the reader's end and what is still on its way there.
void Pty::drop_unread() noexcept {
  if (slave_ < 0 || !master_.is_open()) return;
  ::tcflush(master_.fd(), TCOFLUSH);
  ::tcflush(slave_, TCIFLUSH);
}

/// What the robot writes to the receiver (settings, corrections) is taken and forgotten.
void Pty::read() {
  std::array<std::uint8_t, 1024> buffer{};
  const ssize_t n = ::read(master_.fd(), buffer.data(), buffer.size());
  if (n > 0 && on_bytes) {
    on_bytes({buffer.data(), static_cast<std::size_t>(n)}, base::steady_now());
  }
}

}  // namespace roverd::sim
