// What can be said without a CAN kernel: errors and stamps. Frames on a real vcan are the matter of
// tests/can.

#include "link/socketcan.hpp"

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

TEST(SocketCan, AMissingInterfaceIsNamed) {
  asio::io_context io;
  SocketCanLink link(io, "can77");
  const auto opened = link.open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().detail, "CAN interface can77 does not exist");
  EXPECT_EQ(opened.error().code, base::Code::NotFound);
  EXPECT_EQ(link.describe(), "can:can77");
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Closed);
}

TEST(SocketCan, AnInterfaceThatIsNotCanIsRefused) {
  asio::io_context io;
  SocketCanLink link(io, "lo");
  const auto opened = link.open();
  ASSERT_FALSE(opened);  // the reason depends on whether this kernel has CAN at all
  EXPECT_EQ(opened.error().detail.rfind("CAN interface lo", 0), 0u) << opened.error().detail;
}

TEST(SocketCan, AnImpossibleNameIsRefused) {
  asio::io_context io;
  EXPECT_FALSE(SocketCanLink(io, "").open());
  EXPECT_FALSE(SocketCanLink(io, "a-name-of-16-let").open());
}

TEST(MonotonicStamp, IsAsLongAgoAsTheKernelSays) {
  const base::WallTime wall(1'700'000'000s);
  EXPECT_EQ(monotonic_stamp(wall - 3ms, wall, Time(50s)), Time(50s - 3ms));
  EXPECT_EQ(monotonic_stamp(wall, wall, Time(50s)), Time(50s));
}

TEST(MonotonicStamp, IsNowWhenTheWallClockWasSetMeanwhile) {
  const base::WallTime wall(1'700'000'000s);
  EXPECT_EQ(monotonic_stamp(wall + 1ms, wall, Time(50s)), Time(50s));
  EXPECT_EQ(monotonic_stamp(wall - 2s, wall, Time(50s)), Time(50s));
}

}  // namespace
}  // namespace roverd::link
