#include "link/can_wire.hpp"

#include <cstring>

#include <gtest/gtest.h>
#include <linux/can.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

TEST(CanWire, APacketIsTheKernelsStruct) {
  // given the kernel's own struct, filled by its own names
  can_frame kernel{};
  kernel.can_id = 0x18FF1234U | CAN_EFF_FLAG;
  kernel.can_dlc = 3;
  kernel.data[0] = 0xA6;
  kernel.data[2] = 0x7E;
  // when we write the same frame
  base::CanFrame frame = make_frame(0x18FF1234, {0xA6, 0x00, 0x7E});
  frame.extended = true;
  const CanPacket packet = to_packet(frame);
  // then the bytes are the same
  ASSERT_EQ(sizeof kernel, packet.size());
  EXPECT_EQ(std::memcmp(&kernel, packet.data(), packet.size()), 0);
}

TEST(CanWire, EveryKindOfFrameComesBackAsItWas) {
  base::CanFrame standard = make_frame(0x7FF, {1, 2, 3, 4, 5, 6, 7, 8});
  base::CanFrame extended = make_frame(0x1FFFFFFF, {9});
  extended.extended = true;
  base::CanFrame remote = make_frame(0x241, {});
  remote.remote = true;
  remote.len = 8;
  base::CanFrame error = make_frame(0x40, {0, 0, 0, 0, 0, 0, 0, 0});
  error.error = true;
  for (const auto& frame : {standard, extended, remote, error}) {
    ASSERT_TRUE(is_valid(frame));
    const auto back = from_packet(to_packet(frame));
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, frame);
  }
}

TEST(CanWire, OtherSizesAndLengthsAreRefusedByByte) {
  CanPacket packet{};
  EXPECT_EQ(from_packet(base::Bytes(packet).first(15)).error().fields.at(0).pointer, "byte 15");
  EXPECT_EQ(from_packet({}).error().detail, "a CAN packet has 16 bytes, this one has 0");
  packet[4] = 9;
  EXPECT_EQ(from_packet(packet).error().fields.at(0).pointer, "byte 4");
  EXPECT_EQ(from_packet(packet).error().detail, "a CAN frame carries at most 8 bytes, not 9");
}

TEST(CanWire, BytesBeyondTheLengthAreNotTakenOver) {
  CanPacket packet = to_packet(make_frame(0x111, {1, 2}));
  packet[12] = 0xFF;
  EXPECT_EQ(*from_packet(packet), make_frame(0x111, {1, 2}));
}

TEST(CanWire, AFrameThatCanDoesNotHaveIsNotValid) {
  EXPECT_FALSE(is_valid(make_frame(0x800, {})));
  base::CanFrame wide = make_frame(0x20000000, {});
  wide.extended = true;
  EXPECT_FALSE(is_valid(wide));
  base::CanFrame long_one;
  long_one.len = 9;
  EXPECT_FALSE(is_valid(long_one));
}

}  // namespace
}  // namespace roverd::link
