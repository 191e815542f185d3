#include "mti/xbus.hpp"

#include <gtest/gtest.h>

#include "messages.hpp"

namespace roverd::mti {
namespace {

struct Heard {
  std::uint8_t mid = 0;
  std::vector<std::uint8_t> payload;
};

std::vector<Heard> messages_of(Framer& framer, Bytes bytes, std::size_t piece) {
  std::vector<Heard> out;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), [&](const Message& m) {
      out.push_back({m.mid, {m.payload.begin(), m.payload.end()}});
    });
  }
  return out;
}

TEST(Xbus, CutsMessagesOutOfNoiseHoweverTheyArrive) {
  std::vector<std::uint8_t> all{0xFA, 0x00, 0xFA, 0xFF};
  for (const auto hex : {kDeviceId, kWrongChecksum, kEuler, kFourMatrices, kShortExtended}) {
    const auto one = from_hex(hex);
    all.insert(all.end(), one.begin(), one.end());
  }
  for (const std::size_t piece : {1U, 3U, 1000U}) {
    Framer framer;
    const auto heard = messages_of(framer, all, piece);
    ASSERT_EQ(heard.size(), 4U);
    EXPECT_EQ(heard[0].mid, mid::kDeviceId);
    EXPECT_EQ(heard[0].payload, (std::vector<std::uint8_t>{0x07, 0x70, 0x01, 0x23}));
    EXPECT_EQ(heard[2].payload.size(), 300U);
    EXPECT_EQ(heard[3].payload.size(), 7U);
    EXPECT_GE(framer.counts().bad_checksum, 1U);
    EXPECT_EQ(framer.counts().messages, 4U);
  }
}

TEST(Xbus, AnEndlessMessageHidesNothing) {
  Framer framer;
  auto all = from_hex("faff36ff1000");  // 4096 bytes: too long to be true
  const auto good = from_hex(kGoToConfigAck);
  all.insert(all.end(), good.begin(), good.end());
  EXPECT_EQ(messages_of(framer, all, 1000).size(), 1U);
  EXPECT_EQ(framer.counts().too_long, 1U);
  // One that is only announced is given up on request
  auto begun = from_hex("faff3620");
  begun.insert(begun.end(), good.begin(), good.end());
  EXPECT_TRUE(messages_of(framer, begun, 1000).empty());
  int heard = 0;
  framer.give_up([&](const Message&) { ++heard; });
  EXPECT_EQ(heard, 1);
}

TEST(Xbus, CommandsAreWrittenAsTheSheetSays) {
  EXPECT_EQ(encode(mid::kGoToConfig, {}), from_hex(kGoToConfig));
  EXPECT_EQ(encode(mid::kGoToMeasurement, {}), from_hex(kGoToMeasurement));
  EXPECT_EQ(encode(mid::kReqDid, {}), from_hex(kReqDid));
  const std::vector<Output> wanted{{0x1020, 0xFFFF}, {0x1060, 0xFFFF}, {0x1010, 0xFFFF},
                                   {0x2014, 100},    {0x4020, 100},    {0x8020, 100},
                                   {0xC020, 100},    {0x5042, 100},    {0x5022, 100},
                                   {0xD016, 100},    {0x7010, 4},      {0xE020, 0xFFFF}};
  const auto bytes = encode(wanted);
  EXPECT_EQ(bytes, from_hex(kSetOutputs));
  EXPECT_EQ(outputs_of(Bytes(bytes).subspan(4, bytes.size() - 5)), wanted);
}

TEST(Xbus, LongPayloadsTakeTheExtendedForm) {
  const auto message = from_hex(kFourMatrices);
  EXPECT_EQ(encode(mid::kMtData2, Bytes(message).subspan(6, 300)), message);
}

TEST(Xbus, ErrorsAndMessagesHaveWords) {
  EXPECT_EQ(error_words(33), "parameter invalid");
  EXPECT_EQ(error_words(99), "unknown error");
  EXPECT_EQ(name_of(mid::kMtData2), "MTData2");
  EXPECT_EQ(name_of(0x99), "");
}

}  // namespace
}  // namespace roverd::mti
