#include "gnss/driver.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../ubx/frames.hpp"
#include "gnss/nmea_encode.hpp"
#include "link/memory.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

class GnssDriverTest : public ::testing::Test {
 protected:
  GnssDriverTest() { make(Params{}); }

  void make(const Params& params) {
    driver.reset();
    seen.clear();
    wire = link::memory_byte_pair();
    ours = wire.a.get();
    EXPECT_TRUE(wire.b->open());
    driver = std::make_unique<Driver>(
        "gnss", params,
        [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
          if (!make_error.empty()) return base::fail(base::Code::NotFound, make_error);
          return std::move(wire.a);
        },
        [this](const base::Measurement& m) { seen.push_back(m); });
  }
  void hear(const std::string& text) {
    wire.b->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    ours->deliver(now);
  }
  void after(base::Duration wait) {
    now += wait;
    driver->tick(now);
  }
  base::DriverStatus status() const { return driver->status(now); }
  template <class M>
  std::vector<M> measured() const {
    std::vector<M> out;
    for (const auto& m : seen) {
      if (const M* value = std::get_if<M>(&m)) out.push_back(*value);
    }
    return out;
  }

  Time now = Time{} + 1000s;
  link::MemoryBytePair wire;
  link::MemoryByteLink* ours = nullptr;
  std::string make_error;
  std::unique_ptr<Driver> driver;
  std::vector<base::Measurement> seen;
};

const std::string kTrueHeading = "$GPHDT,359.97,T*04\r\n";

TEST_F(GnssDriverTest, OpensAndIsUpWithTheFirstIntactSentence) {
  EXPECT_EQ(status().phase, DriverPhase::Down);
  driver->start(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  EXPECT_EQ(status().reason, "waiting for a sentence");
  hear("$GPHDT,359.97,T*05\r\n");
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  hear(kTrueHeading);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(status().reason, "");
  EXPECT_EQ(status().received, 1u);
  EXPECT_EQ(status().refused, 1u);
  EXPECT_EQ(status().last_received, now);
  EXPECT_EQ(measured<base::DriverStatus>().back().phase, DriverPhase::Up) << "told at once";
}

TEST_F(GnssDriverTest, TwoSecondsWithoutBytesAreAFault) {
  driver->start(now);
  hear(kTrueHeading);
  after(2s);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  after(1ms);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "no bytes: the receiver is silent");
  EXPECT_TRUE(ours->is_open()) << "the port is not to blame";
  hear(kTrueHeading);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(GnssDriverTest, BytesThatMakeNoSentenceAreAnotherFault) {
  driver->start(now);
  for (int i = 0; i < 5; ++i) {
    hear("\x80\x81rubbish");
    after(500ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "bytes but no sentence: wrong baud rate, or another device");
  after(2001ms);
  EXPECT_EQ(status().reason, "no bytes: the receiver is silent");
}

TEST_F(GnssDriverTest, ASilentPortIsOpenedAgain) {
  driver->start(now);
  after(15s);
  EXPECT_TRUE(ours->is_open());
  after(1ms);
  EXPECT_FALSE(ours->is_open());
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  after(5s);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  EXPECT_TRUE(ours->is_open());
}

TEST_F(GnssDriverTest, ARecordingIsNotBegunAgainInItsGaps) {
  Params p;
  p.silent_reopen_s = 0.0;
  make(p);
  driver->start(now);
  after(3600s);
  EXPECT_TRUE(ours->is_open());
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
}

TEST_F(GnssDriverTest, ALinkThatBreaksIsFaultyAndTriedAgain) {
  driver->start(now);
  hear(kTrueHeading);
  ours->fail("the adapter was unplugged");
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the adapter was unplugged");
  after(499ms);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  after(1ms);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(GnssDriverTest, ALinkThatCannotBeMadeOrOpenedIsTriedAgain) {
  make_error = "no such port";
  driver->start(now);
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "no such port");
  make_error.clear();
  ours->refuse_open("busy");
  after(500ms);
  EXPECT_EQ(status().reason, "busy");
  ours->refuse_open("");
  after(999ms);
  EXPECT_EQ(status().phase, DriverPhase::Faulty) << "the second wait is twice as long";
  after(1ms);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

TEST_F(GnssDriverTest, CanBeStoppedAndRestarted) {
  driver->start(now);
  hear(kTrueHeading);
  driver->stop(now);
  EXPECT_EQ(status().phase, DriverPhase::Down);
  EXPECT_FALSE(ours->is_open());
  after(60s);
  EXPECT_EQ(status().phase, DriverPhase::Down);
  driver->restart(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  hear(kTrueHeading);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(GnssDriverTest, RepeatsItsStatusTwiceASecond) {
  driver->start(now);
  hear(kTrueHeading);
  driver->tick(now);
  const auto before = measured<base::DriverStatus>().size();
  for (int i = 0; i < 75; ++i) after(20ms);
  EXPECT_EQ(measured<base::DriverStatus>().size(), before + 3) << "in a second and a half";
}

TEST_F(GnssDriverTest, AWholeEpochBecomesMeasurements) {
  Gga g;
  g.time_s = 36000.0;
  g.lat = 58.37802;
  g.lon = 26.7289;
  g.quality = 4;
  Rmc r;
  r.time_s = 36000.0;
  r.active = true;
  r.speed_kn = 1.0;
  r.course_deg = 0.0;
  r.date = Date{std::chrono::year{2026}, std::chrono::month{3}, std::chrono::day{1}};
  r.mode = 'R';
  Hdt h;
  h.heading_deg = 40.0;
  driver->start(now);
  const Time first = now;
  hear(encode(g).substr(0, 20));
  now += 10ms;
  hear(encode(g).substr(20) + encode(r) + encode(h));
  after(50ms);
  EXPECT_TRUE(measured<base::GnssFix>().empty());
  after(250ms);
  ASSERT_EQ(measured<base::GnssFix>().size(), 1u);
  EXPECT_EQ(measured<base::GnssFix>()[0].stamp, first);
  EXPECT_NEAR(measured<base::GnssFix>()[0].position->lat, 58.37802, 1e-9);
  EXPECT_NEAR(measured<base::GnssVelocity>().at(0).north_mps, 1852.0 / 3600.0, 1e-12);
  EXPECT_EQ(measured<base::Heading>().at(0).stamp, first);
}

TEST_F(GnssDriverTest, AFalseBinaryFrameHoldsSentencesBackForASecondAtMost) {
  driver->start(now);
  hear("\xD3\x03\xFF" + kTrueHeading);
  EXPECT_EQ(status().received, 0u);
  after(1s);
  EXPECT_EQ(status().received, 1u);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

std::string text_of_hex(std::string_view hex) {
  const auto bytes = ubx::from_hex(hex);
  return {bytes.begin(), bytes.end()};
}

TEST_F(GnssDriverTest, BothLanguagesOnOnePortAreOneReceiver) {
  Params p;
  p.baseline_m = 1.0;
  make(p);
  driver->start(now);
  hear(text_of_hex(ubx::kPvtFixed) + text_of_hex(ubx::kHpPosLlh) + text_of_hex(ubx::kRelPosNed));
  EXPECT_EQ(status().phase, DriverPhase::Up) << "UBX alone will do";
  after(300ms);
  Gga g;
  g.time_s = 43182.0;
  g.lat = 10.0;
  g.lon = 20.0;
  g.quality = 4;
  hear(encode(g));
  hear("$GPHDT,359.97,T*04\r\n");
  after(300ms);
  ASSERT_EQ(measured<base::GnssFix>().size(), 1u);
  EXPECT_NEAR(measured<base::GnssFix>()[0].position->lat, -33.868724293, 1e-10);
  EXPECT_EQ(measured<base::Heading>().size(), 1u);
  EXPECT_EQ(measured<base::Heading>()[0].source, base::HeadingSource::DualAntenna);
  EXPECT_EQ(status().received, 3u + 2u);
  EXPECT_EQ(status().refused, 0u);
}

TEST_F(GnssDriverTest, AReceiverThatRepeatsOneUbxEpochIsNotBelieved) {
  driver->start(now);
  for (int i = 0; i < 10; ++i) {
    hear(text_of_hex(ubx::kPvtFixed));
    after(200ms);
  }
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "the receiver repeats itself: its time stands still");
  EXPECT_GT(status().detail->counts.at("sentence of a standing clock"), 0u);
}

TEST_F(GnssDriverTest, TheReceiverSaysWhoItIs) {
  std::string asked;
  wire.b->on_bytes = [&](Bytes b, Time) { asked.assign(b.begin(), b.end()); };
  driver->start(now);
  after(20ms);
  wire.b->deliver(now);
  EXPECT_EQ(asked, "") << "nothing is said to a receiver that may not know UBX";
  hear(text_of_hex(ubx::kPvtNoFix));
  after(20ms);
  wire.b->deliver(now);
  EXPECT_EQ(asked, text_of_hex(ubx::kMonVerPoll));
  hear(text_of_hex(ubx::kMonVerAnswer));
  EXPECT_EQ(status().detail->facts.at("receiver"), "ZED-F9P");
  EXPECT_EQ(status().sent, 1u);
}

TEST(GnssParams, WordsOutsideTheListAreRefusedByName) {
  Params p;
  EXPECT_TRUE(validate(p));
  p.heading_source = "magic";
  EXPECT_EQ(validate(p).error().fields.at(0).pointer, "heading_source");
  EXPECT_THROW(Driver("gnss", p, {}, {}), std::invalid_argument);
  p.heading_source = "compass";
  p.ubx_port = "spi";
  EXPECT_EQ(validate(p).error().fields.at(0).pointer, "ubx_port");
}

TEST(GnssParams, AreListedWithTheirRanges) {
  Params p;
  EXPECT_TRUE(base::set_param(p, "silent_after_s", 3.0));
  EXPECT_FALSE(base::set_param(p, "silent_after_s", 0.1));
  EXPECT_EQ(base::describe(p).size(), 13u);
}

std::string no_position_fact(const base::DriverStatus& s) {
  const auto fact = s.detail->facts.find("no_position");
  return fact == s.detail->facts.end() ? "" : fact->second;
}

TEST_F(GnssDriverTest, AReceiverThatSendsNoPositionMessageIsNamed) {
  driver->start(now);
  const auto satellites_only = [&] { hear(line("GPGSV,1,1,01,05,45,123,38,1")); };
  for (int i = 0; i < 10; ++i) {
    satellites_only();
    after(500ms);
    EXPECT_EQ(no_position_fact(status()), "") << i;
  }
  satellites_only();
  after(500ms);
  satellites_only();
  EXPECT_EQ(status().phase, DriverPhase::Up) << "it speaks";
  EXPECT_NE(no_position_fact(status()).find("sends no position message"), std::string::npos);
  EXPECT_TRUE(measured<base::GnssFix>().empty());
  // Switched on, though without a fix: that is another matter.
  for (int i = 0; i < 4; ++i) {
    hear(line("GNGGA,08150" + std::to_string(i) + ".00,,,,,0,00,99.99,,,,,,"));
    after(1s);
  }
  EXPECT_FALSE(measured<base::GnssFix>().empty());
  satellites_only();
  EXPECT_EQ(no_position_fact(status()), "");
  // Opened again, it has its five seconds again.
  after(10s);
  driver->restart(now);
  satellites_only();
  EXPECT_EQ(no_position_fact(status()), "");
}

}  // namespace
}  // namespace roverd::gnss
