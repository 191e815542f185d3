// The two vectors of the fact sheet, and what is refused.

#include "velodyne/codec.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "packets.hpp"

namespace roverd::velodyne {
namespace {

std::uint32_t crc_of(Bytes bytes) {
  return static_cast<std::uint32_t>(::crc32(0, bytes.data(), static_cast<unsigned>(bytes.size())));
}

TEST(VelodyneCodec, TheVectorsAreWrittenByteForByteAndReadBack) {
  const auto a = encode(vector_a());
  EXPECT_EQ(crc_of(a), 0x891becc4U);
  const auto b = encode(vector_b());
  EXPECT_EQ(crc_of(b), 0xa77bf11bU);
  for (const Packet& packet : {vector_a(), vector_b()}) {
    const Decoded decoded = decode(encode(packet));
    EXPECT_EQ(decoded.fault, Fault::None);
    EXPECT_EQ(decoded.packet, packet);
  }
  EXPECT_EQ(decode(a).packet.stamp_us, 1'234'567U);
  EXPECT_EQ(to_string(decode(a).packet.mode), "strongest");
  EXPECT_EQ(to_string(decode(a).packet.product), "VLP-16");
}

TEST(VelodyneCodec, WhatIsNoPacketIsRefusedWithTheReason) {
  const auto good = encode(vector_a());
  EXPECT_EQ(describe(decode(Bytes(good).first(1205))), "a datagram that has not 1206 bytes");
  EXPECT_EQ(decode({}).fault, Fault::WrongSize);
  auto bytes = good;
  bytes[301] = 0xDD;
  EXPECT_EQ(describe(decode(bytes)), "block 3 does not begin with FF EE");
  bytes = good;
  bytes[702] = 0xA0;  // 36000
  bytes[703] = 0x8C;
  EXPECT_EQ(describe(decode(bytes)), "block 7 has an azimuth of 360 deg or more");
  bytes = good;
  bytes[1203] = 0xFF;
  EXPECT_EQ(describe(decode(bytes)), "a time stamp of more than an hour");
  bytes = good;
  bytes[1204] = 0x3A;
  EXPECT_EQ(describe(decode(bytes)), "unknown return mode 3A");
}

TEST(VelodyneCodec, OtherSensorsOfTheMakerAreRefusedByName) {
  auto bytes = encode(vector_a());
  bytes[1205] = 0x28;
  EXPECT_EQ(describe(decode(bytes)),
            "product 28 is a VLP-32C: only VLP-16 (22) and VLP-16 Hi-Res (24) are understood");
  bytes[1205] = 0x21;
  EXPECT_NE(describe(decode(bytes)).find("an HDL-32E"), std::string::npos);
  bytes[1205] = 0x24;
  EXPECT_EQ(decode(bytes).packet.product, Product::Vlp16HiRes);
}

TEST(VelodyneCodec, LasersLookUpAndDownAsInTheTable) {
  constexpr std::array kAngles{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  constexpr std::array kHeights_mm{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                   5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  for (std::size_t i = 0; i < kLasers; ++i) {
    EXPECT_DOUBLE_EQ(elevation_deg(Product::Vlp16, i), kAngles[i]);
    EXPECT_NEAR(height_m(Product::Vlp16, i), kHeights_mm[i] * 1e-3, 1e-9);
    EXPECT_EQ(ring_of(i), i % 2 == 0 ? i / 2 : (i - 1) / 2 + 8);
  }
  // Hi-Res: 20 deg in steps of 1.333, the same order.
  EXPECT_DOUBLE_EQ(elevation_deg(Product::Vlp16HiRes, 0), -10.0);
  EXPECT_NEAR(elevation_deg(Product::Vlp16HiRes, 1), 0.667, 1e-3);
  EXPECT_NEAR(elevation_deg(Product::Vlp16HiRes, 2), -8.667, 1e-3);
  EXPECT_DOUBLE_EQ(elevation_deg(Product::Vlp16HiRes, 15), 10.0);
}

TEST(VelodyneCodec, AStepThatIsNoneGivesWayToTheNominalOne) {
  Packet p = vector_b();  // through 360 deg
  Steps steps = steps_of(p, 40);
  EXPECT_FALSE(steps.gap);
  for (const std::uint16_t step : steps.cdeg) EXPECT_EQ(step, 20);
  p.blocks[6].azimuth_cdeg = p.blocks[5].azimuth_cdeg;  // stands still, then leaps
  p.blocks[7].azimuth_cdeg = 20'000;
  steps = steps_of(p, 40);
  EXPECT_TRUE(steps.gap);
  EXPECT_EQ(steps.cdeg[4], 20);
  EXPECT_EQ(steps.cdeg[5], 40);
  EXPECT_EQ(steps.cdeg[6], 40);
}

TEST(VelodyneCodec, PositionPacketsAreWrittenAndReadBack) {
  Position p;
  p.stamp_us = 42'000'000;
  p.pps = 2;
  p.nmea = "$GPRMC,214829,A,3708.0184,N,12136.1234,W,000.0,000.0,110818,013.8,E,A*1F";
  const auto bytes = encode(p);
  EXPECT_EQ(bytes[198], 0x80U);  // 42000000 = 02 80 DE 80
  EXPECT_EQ(bytes[201], 0x02U);
  EXPECT_EQ(bytes[206], '$');
  EXPECT_EQ(decode_position(bytes).position, p);
  EXPECT_EQ(decode_position(Bytes(bytes).first(511)).fault, Fault::WrongSize);
  // A sensor without a receiver sends zeros there; one with line noise must not reach the page.
  EXPECT_EQ(decode_position(std::vector<std::uint8_t>(512, 0)).position.nmea, "");
  auto noise = bytes;
  noise[206] = 0x80;
  EXPECT_EQ(decode_position(noise).position.nmea, "");
}

}  // namespace
}  // namespace roverd::velodyne
