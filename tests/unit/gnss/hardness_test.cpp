// What the GNSS driver does with a receiver that is broken, frozen, or not a receiver at all.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gnss/driver.hpp"
#include "gnss/nmea_encode.hpp"
#include "link/memory.hpp"
#include "link/udp.hpp"
#include "unit/link/pump.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

std::string gga_at(double time_s) {
  Gga g;
  g.time_s = time_s;
  g.lat = 58.37802;
  g.lon = 26.7289;
  g.quality = 4;
  return encode(g);
}

struct BadReceiver : ::testing::Test {
  BadReceiver() {
    EXPECT_TRUE(wire.b->open());
    driver.start(now);
  }
  void hear(const std::string& text) {
    wire.b->write(link::bytes_of(text));
    ours->deliver(now);
  }
  void after(base::Duration wait) {
    now += wait;
    driver.tick(now);
  }
  base::DriverStatus status() const { return driver.status(now); }

  Time now = Time{} + 1000s;
  link::MemoryBytePair wire = link::memory_byte_pair();
  link::MemoryByteLink* ours = wire.a.get();
  int fixes = 0;
  int headings = 0;
  Driver driver{"gnss",
                {},
                [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
                [this](const base::Measurement& m) {
                  fixes += std::holds_alternative<base::GnssFix>(m) ? 1 : 0;
                  headings += std::holds_alternative<base::Heading>(m) ? 1 : 0;
                }};
};

TEST_F(BadReceiver, AReceiverMayChangeItsTalkerInTheMiddle) {
  Gga g;
  g.lat = 58.37802;
  g.lon = 26.7289;
  g.quality = 4;
  for (int i = 0; i < 10; ++i) {
    g.talker = i < 5 ? Talker{{'G', 'P'}} : Talker{{'G', 'N'}};
    g.time_s = 43'200.0 + 0.2 * i;
    hear(encode(g));
    after(200ms);
  }
  EXPECT_EQ(fixes, 10);
  EXPECT_EQ(status().refused, 0u);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(BadReceiver, EveryRefusalIsCountedByItsCause) {
  hear("$GPHDT,359.97,T*05\r\n");  // wrong checksum
  hear("$GPHDT,10.0,T\r\n");       // none
  hear("$GNGGA,000000.00,9000.00001,N,02456.11000,E,1,08,1.0,25.4,M,17.9,M,,*4A\r\n");
  hear("$GPHD$GPHDT,359.97,T*04\r\n");  // cut short, then a whole one
  hear("$GPHDT,\x80\r\n");              // not text
  hear("abc\r\n");                      // nothing at all
  hear(std::string("\xB5\x62\x05\x01\x02\x00\x06\x8A\x98\xC1", 10));
  const std::map<std::string, std::uint64_t> wanted{
      {"sentence: wrong checksum", 1}, {"sentence: no checksum", 1},
      {"sentence: bad field", 1},      {"sentence: cut short", 1},
      {"sentence: not text", 1},       {"bytes outside any sentence", 4}};
  EXPECT_EQ(status().detail->counts, wanted);
  EXPECT_EQ(status().refused, 5U);
  EXPECT_EQ(status().received, 2U) << "the sentence and the acknowledgement";
  EXPECT_EQ(fixes, 0);
}

TEST_F(BadReceiver, AFrozenReceiverIsAFaultAndNothingItSaysIsUsed) {
  for (int i = 0; i < 10; ++i) {
    hear(gga_at(36000.0 + 0.2 * i));
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Up);
  for (int i = 0; i < 10; ++i) {  // the same second again and again
    hear(gga_at(36002.0) + "$GPHDT,359.97,T*04\r\n");
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the receiver repeats itself: its time stands still");
  const int fixes_before = fixes;
  const int headings_before = headings;
  for (int i = 0; i < 20; ++i) {
    hear(gga_at(36002.0) + "$GPHDT,359.97,T*04\r\n");
    after(200ms);
  }
  EXPECT_EQ(fixes, fixes_before);
  EXPECT_EQ(headings, headings_before);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_GE(status().detail->counts.at("sentence of a standing clock"), 40U);
  // Its clock goes on: it is believed again
  for (int i = 0; i < 3; ++i) {
    hear(gga_at(36010.0 + 0.2 * i));
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_GT(fixes, fixes_before);
}

TEST_F(BadReceiver, WholeSecondsAtFiveHertzAreNotFrozen) {
  for (int i = 0; i < 50; ++i) {
    hear(gga_at(36000.0 + i / 5));
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(status().detail->counts.count("sentence of a standing clock"), 0U);
}

TEST_F(BadReceiver, AReceiverWithoutAFixMayHaveAStandingClock) {
  for (int i = 0; i < 20; ++i) {
    hear("$GNGGA,081500.00,,,,,0,00,99.99,,,,,,*74\r\n");
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST(GnssOverUdp, ADatagramFromAForeignAddressIsCountedAndNotUsed) {
  boost::asio::io_context io;
  link::UdpLink receiver(io, 0);
  ASSERT_TRUE(receiver.open());
  link::UdpLink* ours = nullptr;
  Driver driver(
      "gnss", {},
      [&]() -> base::Result<std::unique_ptr<link::ByteLink>> {
        auto made = std::make_unique<link::UdpLink>(
            io, 0, link::UdpLink::Peer{"127.0.0.1", receiver.port()});
        ours = made.get();
        return made;
      },
      [](const base::Measurement&) {});
  driver.start(base::steady_now());
  link::Pump<Driver> pump(io, driver);
  link::UdpLink stranger(io, 0, link::UdpLink::Peer{"127.0.0.1", ours->port()});
  ASSERT_TRUE(stranger.open());
  stranger.write(link::bytes_of("$GPHDT,359.97,T*04\r\n"));
  ASSERT_TRUE(pump.until([&] { return pump.counted("from a foreign address") == 1; }));
  EXPECT_EQ(pump.status().received, 0U);
  EXPECT_EQ(pump.status().phase, DriverPhase::Opening);
}

}  // namespace
}  // namespace roverd::gnss
