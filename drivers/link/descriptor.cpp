#include "link/descriptor.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace roverd::link {

base::Result<void> Descriptor::open(int fd, std::function<void()> on_readable) {
  close();
  boost::system::error_code ec;
  stream_.assign(fd, ec);
  if (ec) {
    ::close(fd);
    return base::fail(base::Code::Unavailable, ec.message());
  }
  stream_.native_non_blocking(true, ec);
  if (ec) {
    close();
    return base::fail(base::Code::Unavailable, ec.message());
  }
  on_readable_ = std::make_shared<const std::function<void()>>(std::move(on_readable));
  handle_.attach(fd);
  wait();
  return {};
}

void Descriptor::close() noexcept {
  handle_.detach();
  on_readable_.reset();
  boost::system::error_code ignored;  // the descriptor is released in any case
  stream_.close(ignored);
}

void Descriptor::wait() {
  const std::weak_ptr<const std::function<void()>> watched = on_readable_;
  stream_.async_wait(asio::posix::stream_descriptor::wait_read,
                     [this, watched](const boost::system::error_code& ec) {
                       const auto call = watched.lock();
                       if (!call || ec == asio::error::operation_aborted) return;
                       (*call)();
                       // Closed, and perhaps opened anew, by the call: not ours any more.
                       if (call.use_count() == 1) return;
                       wait();
                     });
}

std::string errno_text(int error) {
  return std::generic_category().message(error);
}

SendResult write_result(ssize_t written, std::size_t wanted) noexcept {
  if (written >= 0) {
    return static_cast<std::size_t>(written) == wanted ? SendResult::Sent : SendResult::Busy;
  }
  switch (errno) {
    case EAGAIN:
    case ENOBUFS:
    case ENOMEM:
    case EINTR:
      return SendResult::Busy;
    default:
      return SendResult::Closed;
  }
}

}  // namespace roverd::link
