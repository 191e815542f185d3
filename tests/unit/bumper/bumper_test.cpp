#include <vector>

#include <gtest/gtest.h>

#include "bumper/driver.hpp"
#include "link/memory.hpp"

namespace roverd::bumper {
namespace {

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(BumperCodec, EveryMaskIsWrittenAndReadBack) {
  EXPECT_EQ(encode(0), "B,0*5E\r\n");
  EXPECT_EQ(encode(1), "B,1*5F\r\n");
  Decoder decoder;
  for (int mask = 0; mask < 256; ++mask) {
    int heard = -1;
    decoder.feed(bytes_of(encode(static_cast<std::uint8_t>(mask))), [&](int m) { heard = m; });
    EXPECT_EQ(heard, mask);
  }
  EXPECT_EQ(decoder.refused(), 0U);
}

TEST(BumperCodec, DamagedLinesSayNothing) {
  for (const char* line : {"B,0*5F", "B,256*68", "B,-1*72", "B,*6E", "C,0*5F", "B,0", "", "B,0*5",
                           "B,0x1*16", "*00"}) {
    EXPECT_FALSE(parse(line)) << line;
  }
  Decoder decoder;
  int lines = 0;
  decoder.feed(bytes_of(std::string(1000, 'B') + "\r\n" + "B,4*"), [&](int) { ++lines; });
  EXPECT_EQ(lines, 0);
  EXPECT_EQ(decoder.refused(), 1U);
  decoder.feed(bytes_of("5A\r\n"), [&](int mask) { lines += mask; });
  EXPECT_EQ(lines, 4) << "half a line waits for its rest";
}

TEST(BumperCodec, PlacesAreNamed) {
  EXPECT_EQ(where(0), "");
  EXPECT_EQ(where(1), "front left");
  EXPECT_EQ(where(0x81), "front left, rear right");
}

TEST(BumperDriver, TellsEveryHitAndIsAHazardWhileItIsSilent) {
  auto wire = link::memory_byte_pair();
  auto* ours = wire.a.get();
  ASSERT_TRUE(wire.b->open());
  std::vector<base::Bumper> hits;
  base::DriverStatus status;
  Driver driver(
      "bumper", {},
      [&] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
      [&](const base::Measurement& m) {
        if (const auto* b = std::get_if<base::Bumper>(&m)) hits.push_back(*b);
        if (const auto* s = std::get_if<base::DriverStatus>(&m)) status = *s;
      });
  Time now{};
  driver.start(now);
  EXPECT_EQ(status.detail->hazards.size(), 1U);
  wire.b->write(bytes_of(encode(0)));
  wire.b->write(bytes_of(encode(3)));
  wire.b->write(bytes_of(encode(0)));
  ours->deliver(now);
  ASSERT_EQ(hits.size(), 3U);
  EXPECT_TRUE(hits[1].pressed);
  EXPECT_EQ(hits[1].where, "front left, front");
  EXPECT_FALSE(hits[2].pressed);
  EXPECT_EQ(status.phase, base::DriverPhase::Up);
  EXPECT_TRUE(status.detail->hazards.empty());
  driver.tick(now + std::chrono::milliseconds(600));
  EXPECT_EQ(status.phase, base::DriverPhase::Faulty);
  EXPECT_EQ(status.detail->hazards.size(), 1U);
}

}  // namespace
}  // namespace roverd::bumper
