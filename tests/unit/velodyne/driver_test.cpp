// The driver on memory links and on real datagrams.

#include "velodyne/driver.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "link/udp.hpp"
#include "packets.hpp"
#include "unit/link/pump.hpp"

namespace roverd::velodyne {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

struct OnWire : ::testing::Test {
  OnWire() {
    EXPECT_TRUE(data.b->open());
    EXPECT_TRUE(position.b->open());
    driver.start(now);
  }
  /// One packet of a head every 1.327 ms.
  void turn(double turns) {
    for (int i = 0; i < static_cast<int>(turns * 75); ++i) {
      now += 1327104ns;
      data.b->write(encode(head.next()));
      ours->deliver(now);
      if (i % 8 == 0) driver.tick(now);
    }
  }
  std::uint64_t counted(const std::string& what) const {
    const auto counts = driver.status(now).detail->counts;
    return counts.contains(what) ? counts.at(what) : 0;
  }
  std::string fact(const std::string& key) const {
    const auto facts = driver.status(now).detail->facts;
    return facts.contains(key) ? facts.at(key) : "";
  }

  Time now{std::chrono::hours(1)};
  Head head;
  link::MemoryBytePair data = link::memory_byte_pair();
  link::MemoryBytePair position = link::memory_byte_pair();
  link::MemoryByteLink* ours = data.a.get();
  link::MemoryByteLink* our_position = position.a.get();
  std::vector<std::shared_ptr<const base::Sight>> sights;
  Driver driver{
      "front",
      {},
      [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(data.a)); },
      [](const base::Measurement&) {},
      [this](std::shared_ptr<const base::Sight> s) { sights.push_back(std::move(s)); },
      [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(position.a)); }};
};

TEST_F(OnWire, AWholeTurnMakesItUpAndTheFactsTellItsHealth) {
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  turn(0.9);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  turn(3);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
  EXPECT_EQ(sights.size(), 3U);
  EXPECT_EQ(sights.back()->points.size(), 28'800U);
  EXPECT_EQ(fact("rpm"), "603");
  EXPECT_EQ(fact("missing_pct"), "0.0");
  EXPECT_EQ(fact("product"), "VLP-16");
  EXPECT_EQ(fact("return_mode"), "strongest");
  EXPECT_EQ(driver.status(now).received, 67U + 225U);
}

TEST_F(OnWire, SilenceIsAFaultAndItsOwnVoiceEndsIt) {
  turn(3);
  now += 310ms;
  driver.tick(now);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  EXPECT_EQ(driver.status(now).reason, "no packet of the sensor");
  head.stamp_us += 310'000;
  turn(3);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
}

TEST_F(OnWire, AHeadThatStopsTurningIsAFaultThoughPacketsCome) {
  turn(3);
  for (int i = 0; i < 300; ++i) {
    now += 1327104ns;
    head.azimuth_cdeg = 100;
    data.b->write(encode(head.next()));
    ours->deliver(now);
    driver.tick(now);
  }
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  EXPECT_EQ(driver.status(now).reason.rfind("no whole turn, though packets come", 0), 0U);
}

TEST_F(OnWire, ForeignDatagramsAreRefusedByReason) {
  auto other = encode(head.next());
  other[1205] = 0x28;
  data.b->write(other);
  data.b->write(Bytes(other).first(1205));
  ours->deliver(now);
  EXPECT_EQ(counted("product 28 is a VLP-32C: only VLP-16 (22) and VLP-16 Hi-Res (24) are "
                    "understood"),
            1U);
  EXPECT_EQ(counted("a datagram that has not 1206 bytes"), 1U);
  EXPECT_EQ(driver.status(now).refused, 2U);
  EXPECT_EQ(driver.status(now).received, 0U);
}

TEST_F(OnWire, LossesStandInTheCounts) {
  turn(2);
  for (int i = 0; i < 5; ++i) head.next();
  now += 5 * 1327104ns;
  turn(1);
  EXPECT_EQ(counted("packets lost"), 5U);
  EXPECT_EQ(driver.status(now).detail->lost, 5U);
}

TEST_F(OnWire, PositionPacketsAreFacts) {
  EXPECT_EQ(fact("position"), "not heard yet");
  Position p;
  p.pps = 2;
  p.nmea = "$GPRMC,,V,,,,,,,,,,N*53";
  position.b->write(encode(p));
  our_position->deliver(now);
  EXPECT_EQ(fact("pps"), "locked");
  EXPECT_EQ(fact("nmea"), p.nmea);
  position.b->write(std::vector<std::uint8_t>(100));
  our_position->deliver(now);
  EXPECT_EQ(counted("a position packet that is none"), 1U);
}

TEST(VelodyneDriver, HearsDatagramsOnARealPort) {
  boost::asio::io_context io;
  link::UdpLink* port = nullptr;
  std::size_t points = 0;
  Driver driver(
      "front", {},
      [&]() -> base::Result<std::unique_ptr<link::ByteLink>> {
        auto made = std::make_unique<link::UdpLink>(io, 0);
        port = made.get();
        return made;
      },
      [](const base::Measurement&) {},
      [&](std::shared_ptr<const base::Sight> s) { points += s->points.size(); });
  driver.start(base::steady_now());
  ASSERT_NE(port, nullptr);
  link::UdpLink sensor(io, 0, link::UdpLink::Peer{"127.0.0.1", port->port()});
  ASSERT_TRUE(sensor.open());
  Head head;
  link::Pump<Driver> pump(io, driver);
  ASSERT_TRUE(pump.until([&] {
    sensor.write(encode(head.next()));
    return pump.status().phase == DriverPhase::Up;
  }));
  EXPECT_GE(points, 28'800U);
}

TEST(VelodyneParams, RangesThatExcludeEachOtherAreRefused) {
  Params params;
  EXPECT_TRUE(validate(params));
  params.min_range_m = 10.0;
  params.max_range_m = 5.0;
  EXPECT_FALSE(validate(params));
}

}  // namespace
}  // namespace roverd::velodyne
