#pragma once
// One open file descriptor of a link: watched for input on the io_context's thread, written to by
// one other thread.
//
//   device thread                      control thread
//   open ──▶ on_readable … ──▶ close   write(): non-blocking system call on the raw descriptor
//
// The kernel gives a closed descriptor's number to the next file that is opened. A writer that read
// the number just before close() would then write a drive command into somebody else's file. So the
// number is used under a leaf mutex: close() takes it away there first, waiting at most for one
// non-blocking system call, and gives it back to the kernel afterwards. The writer only tries the
// lock; it is taken only while the link is being opened or closed, and the answer is then Busy.

#include <functional>
#include <memory>
#include <mutex>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "link/link.hpp"

namespace roverd::link {

namespace asio = boost::asio;

/// The descriptor's number as the writing thread sees it; does not own it.
class WriteHandle {
 public:
  /// Device thread.
  void attach(int fd) noexcept {
    std::lock_guard lock(mutex_);
    fd_ = fd;
  }
  /// Device thread, before the descriptor is closed. No write is in progress afterwards.
  void detach() noexcept { attach(-1); }

  /// Any one thread. @param write called as SendResult(int fd), must not block.
  template <class Write>
  SendResult use(Write&& write) noexcept {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return SendResult::Busy;
    if (fd_ < 0) return SendResult::Closed;
    return write(fd_);
  }

 private:
  std::mutex mutex_;  // leaf
  int fd_ = -1;
};

class Descriptor {
 public:
  explicit Descriptor(asio::io_context& io) : stream_(io) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Device thread. Takes `fd` over (closes it on error too) and makes it non-blocking.
  /// @param on_readable called on the io_context's thread whenever a read would not block: input,
  /// end or error. It may call close(), and it need not read everything.
  base::Result<void> open(int fd, std::function<void()> on_readable);
  /// Device thread. Idempotent; on_readable is not called afterwards.
  void close() noexcept;

  bool is_open() const noexcept { return stream_.is_open(); }
  /// Device thread; only while open.
  int fd() noexcept { return stream_.native_handle(); }

  /// Any one thread.
  template <class Write>
  SendResult use(Write&& write) noexcept {
    return handle_.use(std::forward<Write>(write));
  }

 private:
  void wait();

  asio::posix::stream_descriptor stream_;
  /// The pending wait holds a weak pointer: empty means closed meanwhile.
  std::shared_ptr<const std::function<void()>> on_readable_;
  WriteHandle handle_;
};

/// The text of an errno value: "Connection refused".
std::string errno_text(int error);

/// What the result of a non-blocking write means. @param written as ::write returned it, with errno
/// still set. @param wanted bytes handed over.
SendResult write_result(ssize_t written, std::size_t wanted) noexcept;

}  // namespace roverd::link
