#include "ntrip/driver.hpp"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

#include "bytes.hpp"
#include "link/memory.hpp"
#include "unit/rtcm/rtcm2.hpp"

namespace roverd::ntrip {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

class NtripDriverTest : public ::testing::Test {
 protected:
  void make(const std::string& casters, const Params& params = {}) {
    Driver::Doors doors;
    doors.make_link =
        [this](const std::string& address) -> base::Result<std::unique_ptr<link::ByteLink>> {
      addresses.push_back(address);
      wires.push_back(link::memory_byte_pair());
      ours = wires.back().a.get();
      caster().on_bytes = [this](base::Bytes b, base::Time) { asked.append(b.begin(), b.end()); };
      EXPECT_TRUE(caster().open());
      return std::move(wires.back().a);
    };
    doors.on_measurement = [this](const base::Measurement& m) {
      told.push_back(std::get<base::DriverStatus>(m));
    };
    doors.on_frame = [this](base::Bytes b) {
      frames.emplace_back(b.begin(), b.end());
      return room;
    };
    doors.where = [this] { return fix; };
    driver = std::make_unique<Driver>("ntrip", params, parse_casters(casters).value(), doors);
    driver->start(now);
  }
  link::MemoryByteLink& caster() { return *wires.back().b; }
  void after(base::Duration wait) {
    now += wait;
    driver->tick(now);
    caster().deliver(now);
  }
  void answer(const std::string& text) {
    caster().write(bytes_from(text));
    ours->deliver(now);
  }
  base::DriverStatus status() const { return driver->status(now); }
  std::uint64_t count(const std::string& what) const {
    const auto detail = status().detail;
    const auto at = detail->counts.find(what);
    return at == detail->counts.end() ? 0 : at->second;
  }

  base::Time now = base::Time{} + 1000s;
  std::deque<link::MemoryBytePair> wires;
  link::MemoryByteLink* ours = nullptr;
  std::vector<std::string> addresses;
  std::string asked;
  std::vector<std::string> frames;
  std::vector<base::DriverStatus> told;
  base::GnssFix fix;
  bool room = true;
  std::unique_ptr<Driver> driver;
};

const std::string kOne = "ntrip://rover:secret@10.0.0.1/TEST0";

TEST_F(NtripDriverTest, CorrectionsGoToTheReceiverUnchangedAndAreCounted) {
  make(kOne);
  EXPECT_EQ(status().reason, "connecting to ntrip://10.0.0.1:2101/TEST0");
  after(20ms);
  EXPECT_TRUE(asked.starts_with("GET /TEST0 HTTP/1.1\r\n")) << asked;
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  answer("ICY 200 OK\r\n" + k1005 + k1006 + k1005);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(frames, (std::vector<std::string>{k1005, k1006, k1005}));
  EXPECT_EQ(count("RTCM3 1005"), 2u);
  EXPECT_EQ(count("RTCM3 1006"), 1u);
  now += 3s;
  EXPECT_EQ(status().detail->facts.at("age of RTCM3 1005"), "3 s");
  EXPECT_EQ(status().detail->facts.at("protocol"), "NTRIP 1");
  EXPECT_EQ(status().received, 3u);
  EXPECT_EQ(status().link, "ntrip://10.0.0.1:2101/TEST0");
}

TEST_F(NtripDriverTest, ADamagedFrameIsCountedAndNotForwarded) {
  make(kOne);
  after(20ms);
  std::string damaged = k1005;
  damaged.back() = '\x50';
  answer("ICY 200 OK\r\n" + damaged + k1006);
  after(999ms);
  EXPECT_TRUE(frames.empty()) << "a D3 inside it looks like the beginning of a long frame";
  after(1ms);
  EXPECT_EQ(frames, (std::vector<std::string>{k1006}));
  EXPECT_EQ(status().refused, 1u);
}

TEST_F(NtripDriverTest, AFrameForWhichThereIsNoRoomIsCounted) {
  make(kOne);
  room = false;
  after(20ms);
  answer("ICY 200 OK\r\n" + k1006);
  EXPECT_EQ(count("frame for which the receiver had no room"), 1u);
}

TEST_F(NtripDriverTest, ThePositionIsToldAfterTheAnswerAndThenPeriodically) {
  fix.stamp = now;
  fix.fix = base::FixType::Single;
  fix.position = base::LatLon{60.167, 24.9};
  make(kOne);
  after(20ms);
  EXPECT_EQ(asked.find("$GPGGA"), std::string::npos) << "not glued to the request";
  answer("ICY 200 OK\r\n" + k1005);
  asked.clear();
  after(20ms);
  EXPECT_TRUE(asked.starts_with("$GPGGA,")) << asked;
  EXPECT_EQ(count("position told to the caster"), 1u);
  after(9s);
  EXPECT_EQ(count("position told to the caster"), 1u);
  fix.stamp = now;
  after(1s);
  EXPECT_EQ(count("position told to the caster"), 2u);
  answer(k1005);
  after(11s);
  EXPECT_EQ(count("position told to the caster"), 2u) << "where it was 12 s ago is not where it is";
}

TEST_F(NtripDriverTest, TheNextCasterIsTriedAndTheFirstAgainLater) {
  make(kOne + " ntrip://b:c@10.0.0.2/OTHER");
  after(20ms);
  ours->fail("Connection refused");
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_EQ(status().reason, "ntrip://10.0.0.1:2101/TEST0: the caster closed without an answer");
  after(20ms);
  ours->fail("Connection refused");
  after(20ms);
  EXPECT_EQ(addresses, (std::vector<std::string>{"tcp:10.0.0.1:2101", "tcp:10.0.0.2:2101"}));
  after(1s);
  EXPECT_EQ(addresses.size(), 3u);
  EXPECT_EQ(addresses.back(), "tcp:10.0.0.1:2101");
}

TEST_F(NtripDriverTest, TheFirstCasterIsReturnedToAfterAWhile) {
  make(kOne + " ntrip://b:c@10.0.0.2/OTHER", {.return_after_s = 100.0});
  after(20ms);
  ours->fail("Connection refused");
  after(20ms);
  after(20ms);
  answer("ICY 200 OK\r\n" + k1005);
  ASSERT_EQ(status().phase, DriverPhase::Up);
  ASSERT_EQ(status().link, "ntrip://10.0.0.2:2101/OTHER");
  for (int i = 0; i < 9; ++i) {
    after(10s);
    answer(k1005);
  }
  EXPECT_EQ(addresses.size(), 2u);
  after(11s);
  EXPECT_EQ(addresses.back(), "tcp:10.0.0.1:2101");
  EXPECT_EQ(count("return to a caster further up"), 1u);
  // It is still away: the second one serves again at once.
  ours->fail("Connection refused");
  after(20ms);
  EXPECT_EQ(addresses.back(), "tcp:10.0.0.2:2101");
}

TEST_F(NtripDriverTest, AWaitDoublesUntilCorrectionsCome) {
  make(kOne);
  for (const auto wait : {1s, 2s, 4s}) {
    after(20ms);
    ours->fail("gone");
    const auto tries = addresses.size();
    after(wait - 1ms);
    EXPECT_EQ(addresses.size(), tries);
    after(1ms);
    EXPECT_EQ(addresses.size(), tries + 1);
  }
  after(20ms);
  answer("ICY 200 OK\r\n" + k1005);
  ours->fail("gone");
  after(1s);
  EXPECT_EQ(status().phase, DriverPhase::Opening) << "the first wait again";
}

TEST_F(NtripDriverTest, ARefusedLoginIsNotTriedAgainSoonAndNeverTold) {
  make(kOne);
  after(20ms);
  answer("HTTP/1.0 401 Unauthorized\r\n\r\n");
  EXPECT_EQ(status().reason, "ntrip://10.0.0.1:2101/TEST0: the caster does not accept the login");
  after(59s);
  EXPECT_EQ(addresses.size(), 1u);
  after(1s);
  EXPECT_EQ(addresses.size(), 2u);
  for (const auto& s : told) {
    EXPECT_EQ((s.reason + s.link).find("secret"), std::string::npos);
    EXPECT_EQ((s.reason + s.link).find("cm92ZXI6"), std::string::npos);
  }
}

TEST_F(NtripDriverTest, ATableInsteadOfAStreamNamesWhatThereIs) {
  make(kOne);
  after(20ms);
  answer("SOURCETABLE 200 OK\r\n\r\nSTR;A;a;RTCM 3.2\r\nSTR;B\r\nENDSOURCETABLE\r\n");
  EXPECT_EQ(status().reason,
            "ntrip://10.0.0.1:2101/TEST0: the caster has no mountpoint TEST0; it has: "
            "A (RTCM 3.2), B");
  EXPECT_EQ(status().detail->facts.at("mountpoints"), "A (RTCM 3.2), B");
}

TEST_F(NtripDriverTest, ASilentCasterIsLeft) {
  make(kOne);
  after(20ms);
  after(10s);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
  after(1ms);
  EXPECT_EQ(status().reason, "ntrip://10.0.0.1:2101/TEST0: the caster does not answer");
  after(1s);
  after(20ms);
  answer("ICY 200 OK\r\n" + k1005);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  after(30s);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  after(1ms);
  EXPECT_EQ(status().reason, "ntrip://10.0.0.1:2101/TEST0: no corrections: the caster is silent");
}

TEST_F(NtripDriverTest, CanBeStoppedAndRestarted) {
  make(kOne);
  after(20ms);
  answer("ICY 200 OK\r\n" + k1005);
  driver->stop(now);
  EXPECT_EQ(status().phase, DriverPhase::Down);
  EXPECT_FALSE(ours->is_open());
  after(60s);
  EXPECT_EQ(status().phase, DriverPhase::Down);
  driver->restart(now);
  EXPECT_EQ(status().phase, DriverPhase::Opening);
}

/// Of RFC 2617, section 3.5, with the robot's login and mountpoint.
const std::string kDigest =
    "HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Digest realm=\"caster\", qop=\"auth\", "
    "nonce=\"abc\", opaque=\"x1\"\r\n\r\n";

TEST_F(NtripDriverTest, ACasterThatWantsADigestGetsOneAtOnce) {
  make(kOne);
  after(20ms);
  EXPECT_NE(asked.find("Authorization: Basic "), std::string::npos);
  asked.clear();
  answer(kDigest);
  after(20ms);
  after(20ms);
  EXPECT_NE(asked.find("Authorization: Digest username=\"rover\", realm=\"caster\""),
            std::string::npos)
      << asked;
  EXPECT_NE(asked.find("uri=\"/TEST0\""), std::string::npos);
  EXPECT_EQ(asked.find("secret"), std::string::npos);
  answer("ICY 200 OK\r\n" + k1005);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(NtripDriverTest, AWrongLoginByDigestIsGivenUp) {
  make(kOne);
  for (int i = 0; i < 2; ++i) {
    after(20ms);
    after(20ms);
    answer(kDigest);
  }
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_NE(status().reason.find("does not accept the login"), std::string::npos);
  const std::size_t before = wires.size();
  after(20ms);
  EXPECT_EQ(wires.size(), before) << "it waits";
}

TEST_F(NtripDriverTest, ADigestOfAnUnknownKindIsNamed) {
  make(kOne);
  after(20ms);
  answer("HTTP/1.1 401 No\r\nWWW-Authenticate: Digest nonce=\"a\", algorithm=SHA-512-256\r\n\r\n");
  EXPECT_NE(status().reason.find("SHA-512-256"), std::string::npos) << status().reason;
}

TEST_F(NtripDriverTest, AMountpointThatSendsRtcm2IsNamedAndTheNextCasterTried) {
  make(kOne + " ntrip://10.0.0.2/RTCM3");
  after(20ms);
  rtcm::Rtcm2Writer station;
  for (int i = 0; i < 4; ++i) station.message(1, 723, {0x123456, 0xFFFFFF, 0, 0xABCDEF, 1});
  answer("ICY 200 OK\r\n" + station.bytes());
  EXPECT_EQ(status().phase, DriverPhase::Faulty);
  EXPECT_NE(status().reason.find("the mountpoint sends RTCM 2; RTCM 3 is needed"),
            std::string::npos)
      << status().reason;
  EXPECT_TRUE(frames.empty());
  after(20ms);
  EXPECT_EQ(addresses.size(), 2u);
  after(20ms);
  answer("ICY 200 OK\r\n" + k1005);
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(NtripDriverTest, BytesThatLookLikeRtcm2BesideRtcm3ChangeNothing) {
  make(kOne);
  after(20ms);
  rtcm::Rtcm2Writer station;
  for (int i = 0; i < 4; ++i) station.message(1, 723, {0x123456, 0xFFFFFF, 0, 0xABCDEF, 1});
  answer("ICY 200 OK\r\n" + k1005 + station.bytes() + k1006);
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(frames, (std::vector<std::string>{k1005, k1006}));
}

}  // namespace
}  // namespace roverd::ntrip
