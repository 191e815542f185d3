#include "link/descriptor.hpp"

#include <array>
#include <atomic>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using Pair = std::array<int, 2>;

Pair socket_pair() {
  Pair fds{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, fds.data()), 0);
  return fds;
}

TEST(Descriptor, TellsThatThereIsSomethingToReadUntilItIsRead) {
  asio::io_context io;
  Descriptor descriptor(io);
  const Pair fds = socket_pair();
  int calls = 0;
  ASSERT_TRUE(descriptor.open(fds[0], [&] { ++calls; }));
  ::send(fds[1], "x", 1, 0);
  EXPECT_TRUE(run_until(io, [&] { return calls >= 3; }));  // nothing was read yet
  ::close(fds[1]);
}

TEST(Descriptor, AHandlerThatIsAlreadyQueuedIsSilentAfterClose) {
  asio::io_context io;
  const Pair fds = socket_pair();
  int calls = 0;
  {
    Descriptor descriptor(io);
    ASSERT_TRUE(descriptor.open(fds[0], [&] { ++calls; }));
    ::send(fds[1], "x", 1, 0);
  }
  run_ready(io);
  EXPECT_EQ(calls, 0);
  ::close(fds[1]);
}

TEST(Descriptor, CloseWaitsForAWriteInProgressAndTheNumberStaysOursUntilThen) {
  asio::io_context io;
  Descriptor descriptor(io);
  const Pair fds = socket_pair();
  ASSERT_TRUE(descriptor.open(fds[0], [] {}));
  std::atomic<bool> inside{false};
  std::atomic<bool> closing{false};
  std::atomic<bool> left{false};
  std::atomic<int> lost{0};
  std::thread writer([&] {
    descriptor.use([&](int fd) {
      inside = true;
      while (!closing) std::this_thread::yield();
      for (int i = 0; i < 200; ++i) {  // time for close to do harm
        if (::fcntl(fd, F_GETFD) < 0) ++lost;
        std::this_thread::yield();
      }
      left = true;
      return SendResult::Sent;
    });
  });
  while (!inside) std::this_thread::yield();
  closing = true;
  descriptor.close();
  EXPECT_TRUE(left);
  EXPECT_EQ(lost, 0);
  EXPECT_LT(::fcntl(fds[0], F_GETFD), 0);
  EXPECT_EQ(descriptor.use([](int) { return SendResult::Sent; }), SendResult::Closed);
  writer.join();
  ::close(fds[1]);
}

// The kernel reuses descriptor numbers at once: after close, the next socket gets the same one.
TEST(Descriptor, AWriterNeverReachesTheNextOwnerOfTheNumber) {
  asio::io_context io;
  Descriptor descriptor(io);
  std::atomic<bool> done{false};
  std::atomic<int> sent{0};
  std::thread writer([&] {
    while (!done) {
      const auto result =
          descriptor.use([](int fd) { return write_result(::send(fd, "x", 1, MSG_NOSIGNAL), 1); });
      if (result == SendResult::Sent) ++sent;
      std::this_thread::yield();
    }
  });
  int foreign = 0;
  for (int i = 0; i < 200; ++i) {
    const Pair ours = socket_pair();
    ASSERT_TRUE(descriptor.open(ours[0], [] {}));
    descriptor.close();
    const Pair others = socket_pair();  // reuses the number just closed
    std::this_thread::yield();
    char byte = 0;
    if (::recv(others[0], &byte, 1, MSG_DONTWAIT) >= 0) ++foreign;
    if (::recv(others[1], &byte, 1, MSG_DONTWAIT) >= 0) ++foreign;
    for (const int fd : {ours[1], others[0], others[1]}) ::close(fd);
  }
  const bool some = run_until(io, [&] {
    if (sent > 0) return true;
    const Pair ours = socket_pair();
    EXPECT_TRUE(descriptor.open(ours[0], [] {}));
    std::this_thread::yield();
    ::close(ours[1]);
    return false;
  });
  done = true;
  writer.join();
  EXPECT_TRUE(some);
  EXPECT_EQ(foreign, 0);
}

}  // namespace
}  // namespace roverd::link
