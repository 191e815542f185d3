#include "gnss/framer.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gnss/decoder.hpp"
#include "gnss/nmea_encode.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

struct Seen {
  Piece piece;
  Flaw flaw;
  std::string text;
  Time stamp;
};

class FramerTest : public ::testing::Test {
 protected:
  void feed(const std::string& text) {
    framer.feed(bytes_of(text), now, [this](const Cut& c) { note(c); });
  }
  void give_up(Time then) {
    framer.give_up(then, [this](const Cut& c) { note(c); });
  }
  void note(const Cut& c) {
    seen.push_back(
        {c.piece, c.flaw,
         c.bytes.empty() ? std::string(c.text) : std::string(c.bytes.begin(), c.bytes.end()),
         c.stamp});
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> out;
    for (const Seen& s : seen) out.push_back(s.text);
    return out;
  }

  Framer framer;
  std::vector<Seen> seen;
  Time now = Time{} + 10s;
};

/// A UBX frame with its checksum.
std::string ubx(const std::string& payload) {
  std::string body = "\x05\x01"s;
  body += static_cast<char>(payload.size() & 0xFFU);
  body += static_cast<char>(payload.size() >> 8U);
  body += payload;
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  for (const char c : body) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return "\xB5\x62"s + body + static_cast<char>(a) + static_cast<char>(b);
}

/// RTCM3: message 1005 of the RTCM standard's own example.
const std::string kRtcm1005 =
    "\xD3\x00\x13\x3E\xD7\xD3\x02\x02\x98\x0E\xDE\xEF\x34\xB4\xBD\x62\xAC\x09\x41\x98\x6F\x33\x36"
    "\x0B\x98"s;
const std::string kHdt = "$GPHDT,359.97,T*04";
const std::string kHdtText = "GPHDT,359.97,T*04";

TEST_F(FramerTest, CrLfAndBothEndALine) {
  feed(kHdt + "\r" + kHdt + "\n" + kHdt + "\r\n");
  EXPECT_EQ(texts(), (std::vector<std::string>{kHdtText, kHdtText, kHdtText}));
  EXPECT_EQ(framer.counts().skipped_bytes, 0u);
}

TEST_F(FramerTest, RubbishBeforeALineIsSkippedAndCounted) {
  feed("# comment\r\n\xFFrubbish" + kHdt + "\r\n");
  EXPECT_EQ(texts(), std::vector<std::string>{kHdtText});
  EXPECT_EQ(framer.counts().skipped_bytes, 17u);
}

TEST_F(FramerTest, ADollarInsideALineBeginsANewOne) {
  feed("$GPGGA,1200" + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].piece, Piece::Broken);
  EXPECT_EQ(seen[0].flaw, Flaw::CutShort);
  EXPECT_EQ(seen[0].text, "GPGGA,1200");
  EXPECT_EQ(seen[1].piece, Piece::Line);
  EXPECT_EQ(seen[1].text, kHdtText);
}

TEST_F(FramerTest, NulBytesAreSkipped) {
  feed("\0\0$GP\0HDT,35\0\0"s);
  feed("9.97,T*04\0\r\n"s);
  EXPECT_EQ(texts(), std::vector<std::string>{kHdtText});
}

TEST_F(FramerTest, ABrokenByteSpoilsItsLineOnly) {
  feed("$GPHDT,35\x80.97,T*04\r\n" + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].flaw, Flaw::NotText);
  EXPECT_EQ(seen[1].text, kHdtText);
}

TEST_F(FramerTest, ALineMayHave256BytesAndNotMore) {
  const std::string longest = "$" + std::string(255, 'A');
  feed(longest + "\r\n");
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].piece, Piece::Line);
  feed(longest + "A\r\n");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[1].flaw, Flaw::TooLong);
  feed(kHdt + "\r\n");
  EXPECT_EQ(seen.back().text, kHdtText) << "the next one is fine";
}

TEST_F(FramerTest, ALineMayComeByteByByteWithTheStampOfItsFirst) {
  const Time first = now;
  for (const char c : kHdt + "\r") {
    feed(std::string(1, c));
    now += 1ms;
  }
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].text, kHdtText);
  EXPECT_EQ(seen[0].stamp, first);
}

TEST_F(FramerTest, EachLineHasTheStampOfTheChunkItBeganIn) {
  feed(kHdt + "\r\n$GPHDT,1");
  now += 50ms;
  feed("0.0,T*00\r\n" + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen[0].stamp, now - 50ms);
  EXPECT_EQ(seen[1].stamp, now - 50ms);
  EXPECT_EQ(seen[2].stamp, now);
}

TEST_F(FramerTest, ARightBinaryFrameOwnsAllItsBytes) {
  const std::string inside = ubx("abc\r\n" + kHdt + "\r\n");
  feed(inside + kHdt + "\r\n" + kRtcm1005 + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[0].piece, Piece::Ubx);
  EXPECT_EQ(seen[0].text, inside);
  EXPECT_EQ(seen[1].text, kHdtText);
  EXPECT_EQ(seen[2].piece, Piece::Rtcm3);
  EXPECT_EQ(seen[2].text, kRtcm1005);
  EXPECT_EQ(seen[3].text, kHdtText);
}

TEST_F(FramerTest, ABrokenBinaryFrameGivesItsLinesBack) {
  std::string broken = ubx("abc\r\n" + kHdt + "\r\n");
  broken.back() = static_cast<char>(broken.back() + 1);
  feed(broken + kHdt + "\r\n");
  EXPECT_EQ(texts(), (std::vector<std::string>{kHdtText, kHdtText}));
  EXPECT_EQ(framer.counts().broken_binary, 1u);

  seen.clear();
  std::string rtcm = kRtcm1005;
  rtcm.back() = static_cast<char>(rtcm.back() + 1);
  feed(rtcm + kHdt + "\r\n");
  EXPECT_TRUE(seen.empty()) << "a byte of its payload looks like another beginning";
  give_up(now);
  EXPECT_EQ(texts(), std::vector<std::string>{kHdtText});
  EXPECT_EQ(framer.counts().broken_binary, 2u);
}

TEST_F(FramerTest, TheSearchGoesOnOneByteAfterAWrongBeginning) {
  // Given B5 62 of no frame directly before a real one
  const std::string real = ubx("hello");
  feed("\xB5\x62\x01"s + real + std::string(30'000, '.') + "\r\n");
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen[0].text, real);
}

TEST_F(FramerTest, ALongestUbxFrameFits) {
  const std::string longest = ubx(std::string(Framer::kMaxUbxPayload, '$'));
  for (std::size_t i = 0; i < longest.size(); i += 61) feed(longest.substr(i, 61));
  feed(kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].text.size(), longest.size());
  seen.clear();
  feed(ubx(std::string(Framer::kMaxUbxPayload + 1, '.')) + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 1u) << "more is no frame";
  EXPECT_EQ(seen[0].text, kHdtText);
}

TEST_F(FramerTest, ABinaryFrameInTheMiddleOfALineIsFound) {
  feed("$GPHDT,35" + kRtcm1005 + kHdt + "\r\n");
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen[0].flaw, Flaw::NotText);
  EXPECT_EQ(seen[1].piece, Piece::Rtcm3);
  EXPECT_EQ(seen[2].text, kHdtText);
}

TEST_F(FramerTest, AFalseBeginningIsGivenUpAfterAWhile) {
  // Given D3 of no frame, which makes the lines behind it wait for its end
  feed("\xD3\x03\xFF"s + kHdt + "\r\n");
  EXPECT_TRUE(seen.empty());
  give_up(now - 1ms);
  EXPECT_TRUE(seen.empty()) << "it may still come";
  give_up(now);
  EXPECT_EQ(texts(), std::vector<std::string>{kHdtText});
  give_up(now);
  EXPECT_EQ(seen.size(), 1u);
}

TEST_F(FramerTest, EveryCutOfAStreamGivesTheSamePieces) {
  const std::string stream = "junk" + kHdt + "\r\n" + ubx("$GPHDT" + kHdt) + "$GPGG\0A\r"s +
                             kRtcm1005 + "$CUT" + kHdt + "\n\xB5" + kHdt + "\r\n";
  feed(stream);
  const auto whole = texts();
  ASSERT_EQ(whole.size(), 7u);
  for (std::size_t at = 1; at < stream.size(); ++at) {
    framer = Framer{};
    seen.clear();
    feed(stream.substr(0, at));
    feed(stream.substr(at));
    EXPECT_EQ(texts(), whole) << "cut at " << at;
  }
}

TEST(NmeaDecoder, AccountsForEverySentence) {
  Decoder decoder;
  std::vector<double> headings;
  const std::string stream = kHdt + "\r\n" + "$GPHDT,359.97,T*05\r\n" + "$GPHDT,359.97,T\r\n" +
                             line("GNGLL,,,,,,V,N") + line("PUBX,00") + line("GPHDT,400.0,T") +
                             line("GPHDT,1") + "$cut" + ubx("x") + kRtcm1005 + kHdt + "\r\n";
  decoder.feed(bytes_of(stream), Time{}, [&](const Sentence& s, Time) {
    headings.push_back(std::get<Hdt>(s).heading_deg.value());
  });
  EXPECT_EQ(headings, (std::vector<double>{359.97, 359.97}));
  const SentenceCounts& c = decoder.counts();
  EXPECT_EQ(c.used, 2u);
  EXPECT_EQ(c.unused, 1u);
  EXPECT_EQ(c.unknown, 1u);
  EXPECT_EQ(c.damaged, 5u);
  EXPECT_EQ(c.by_flaw[static_cast<std::size_t>(Flaw::WrongChecksum)], 1u);
  EXPECT_EQ(c.by_flaw[static_cast<std::size_t>(Flaw::NoChecksum)], 1u);
  EXPECT_EQ(c.by_flaw[static_cast<std::size_t>(Flaw::BadField)], 1u);
  EXPECT_EQ(c.by_flaw[static_cast<std::size_t>(Flaw::TooFewFields)], 1u);
  EXPECT_EQ(c.by_flaw[static_cast<std::size_t>(Flaw::NotText)], 1u);
  EXPECT_EQ(c.ubx, 1u);
  EXPECT_EQ(c.rtcm3, 1u);
}

}  // namespace
}  // namespace roverd::gnss
