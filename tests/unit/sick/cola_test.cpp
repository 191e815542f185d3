// From bytes to telegrams: split, joined, cut, damaged, in both dialects.

#include "sick/cola.hpp"

#include <gtest/gtest.h>

#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

using Strings = std::vector<std::string>;

std::vector<std::uint8_t> joined(std::initializer_list<std::vector<std::uint8_t>> parts) {
  std::vector<std::uint8_t> out;
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}
std::vector<std::uint8_t> in_b(std::string_view body) {
  return frame(Dialect::B, bytes_of(body));
}

TEST(SickFramer, ReadsATextInPiecesOfSevenBytes) {
  Framer framer;
  EXPECT_EQ(bodies(framer, in_a(kShortScan), 7), Strings{std::string(kShortScan)});
  EXPECT_EQ(framer.counts().skipped_bytes, 0u);
  EXPECT_FALSE(framer.waiting());
}

TEST(SickFramer, ReadsTwoTelegramsInOneRead) {
  Framer framer;
  const auto both = joined({in_a(kShortScan), in_a(kPolledScan)});
  EXPECT_EQ(bodies(framer, both, both.size()),
            (Strings{std::string(kShortScan), std::string(kPolledScan)}));
}

TEST(SickFramer, ANewBeginningEndsACutText) {
  Framer framer;
  auto cut = in_a(kShortScan.substr(0, kShortScan.find("FFF92230")));
  cut.pop_back();
  EXPECT_EQ(bodies(framer, joined({cut, in_a(kShortScan)}), 7), Strings{std::string(kShortScan)});
  EXPECT_EQ(framer.counts().cut, 1u);
  EXPECT_EQ(framer.counts().skipped_bytes, cut.size());
}

TEST(SickFramer, SkipsWhatStandsOutsideTelegrams) {
  Framer framer;
  const auto noise = bytes_of("noise\r\n\x03");
  EXPECT_EQ(bodies(framer, joined({noise, in_a("sFA 3"), noise, in_a("sFA 4")}), 3),
            (Strings{"sFA 3", "sFA 4"}));
  EXPECT_EQ(framer.counts().skipped_bytes, 2 * noise.size());
}

// The log-in of the recorded session: 02020202, length 23, body, XOR b3.
TEST(SickFramer, ReadsABinaryFrameAndBuildsTheSame) {
  const std::vector<std::uint8_t> login{0x02, 0x02, 0x02, 0x02, 0x00, 0x00, 0x00, 0x17,
                                        0x73, 0x4d, 0x4e, 0x20, 0x53, 0x65, 0x74, 0x41,
                                        0x63, 0x63, 0x65, 0x73, 0x73, 0x4d, 0x6f, 0x64,
                                        0x65, 0x20, 0x03, 0xf4, 0x72, 0x47, 0x44, 0xb3};
  for (std::size_t piece = 1; piece <= login.size(); ++piece) {
    Framer framer;
    const auto found = bodies(framer, login, piece);
    ASSERT_EQ(found.size(), 1u) << piece;
    EXPECT_EQ(frame(Dialect::B, bytes_of(found[0])), login);
  }
}

TEST(SickFramer, TellsTheDialectTelegramByTelegram) {
  Framer framer;
  std::vector<Dialect> heard;
  framer.feed(joined({in_b("sFA"), in_a("sFA 3"), in_b("sFA")}),
              [&](const Telegram& t) { heard.push_back(t.dialect); });
  EXPECT_EQ(heard, (std::vector{Dialect::B, Dialect::A, Dialect::B}));
}

TEST(SickFramer, AFrameMayHoldTheMagicWord) {
  Framer framer;
  const std::string body = std::string("sRA LIDinputstate ") + "\x02\x02\x02\x02 and more";
  EXPECT_EQ(bodies(framer, in_b(body), 1), Strings{body});
}

TEST(SickFramer, AWrongChecksumIsCountedAndTheNextFrameIsFound) {
  Framer framer;
  auto wrong = in_b("sSN LMDscandata something");
  wrong.back() ^= 0x10;
  EXPECT_EQ(bodies(framer, joined({wrong, in_b("sRA STlms 7")}), 5), Strings{"sRA STlms 7"});
  EXPECT_EQ(framer.counts().bad_checksum, 1u);
  EXPECT_EQ(framer.counts().skipped_bytes, wrong.size());
}

TEST(SickFramer, ALengthOver64kBIsCountedAndTheNextFrameIsFound) {
  Framer framer;
  const std::vector<std::uint8_t> long_one{2, 2, 2, 2, 0x00, 0x01, 0x00, 0x01, 's', 'S', 'N'};
  EXPECT_EQ(bodies(framer, joined({long_one, in_b("sRA STlms 7")}), 4), Strings{"sRA STlms 7"});
  EXPECT_EQ(framer.counts().bad_length, 1u);
}

TEST(SickFramer, ATextOver64kBIsGivenUp) {
  Framer framer;
  const std::string endless = "s" + std::string(70'000, 'x');
  EXPECT_EQ(bodies(framer, joined({in_a(endless), in_a("sFA 3")}), 1000), Strings{"sFA 3"});
  EXPECT_EQ(framer.counts().bad_length, 1u);
}

TEST(SickFramer, WhatWaitsForItsEndCanBeGivenUp) {
  Framer framer;
  // A length that damage made longer than what follows: the frame behind it would wait for long.
  auto damaged = in_b("sSN LMDscandata 1");
  damaged[6] = 0x40;
  EXPECT_TRUE(bodies(framer, joined({damaged, in_b("sRA STlms 7")}), 9).empty());
  EXPECT_TRUE(framer.waiting());
  Strings found;
  framer.give_up([&](const Telegram& t) { found.push_back(text_of(t.body)); });
  EXPECT_EQ(found, Strings{"sRA STlms 7"});
  EXPECT_FALSE(framer.waiting());
}

// Whatever byte is damaged, the telegram behind it is found, and a binary one is never believed.
TEST(SickFramer, EveryDamagedByteCostsOneTelegramAtMost) {
  const Scan scan = *decode_a(kFullScan);
  for (const Dialect d : {Dialect::A, Dialect::B}) {
    const auto good = encode(scan, d);
    for (std::size_t at = 0; at < good.size(); ++at) {
      for (const unsigned flip : {0x01U, 0x20U, 0x80U, 0xFFU}) {
        auto bad = good;
        bad[at] = static_cast<std::uint8_t>(bad[at] ^ flip);
        Framer framer;
        std::vector<Scan> heard;
        const auto sink = [&](const Telegram& t) {
          if (auto s = decode_scan(t)) heard.push_back(*s);
        };
        framer.feed(joined({bad, good, good, good}), sink);
        framer.give_up(sink);
        ASSERT_GE(heard.size(), 3u) << to_string(d) << " byte " << at;
        EXPECT_EQ(heard.back(), scan);
        EXPECT_LE(heard.size(), d == Dialect::A ? 4u : 3u) << "byte " << at;
      }
    }
  }
}

}  // namespace
}  // namespace roverd::sick
