// Scan telegrams: the fact sheet's, both directions, and those that lie about themselves.

#include "sick/scan.hpp"

#include <gtest/gtest.h>

#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

std::string changed(std::string_view text, std::string_view from, std::string_view to) {
  std::string out(text);
  const auto at = out.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return out.replace(at, from.size(), to);
}
std::string refusal(std::string_view text) {
  const auto scan = decode_a(text);
  return scan ? "believed" : scan.error().detail;
}

TEST(SickScan, ReadsAShortScanFieldByField) {
  const auto s = decode_a(kShortScan);
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_FALSE(s->polled);
  EXPECT_EQ(s->version, 1);
  EXPECT_EQ(s->device, 1);
  EXPECT_EQ(s->serial, 0xB3C0DEu);
  EXPECT_TRUE(status_of(*s).good);
  EXPECT_EQ(s->telegram_count, 679);
  EXPECT_EQ(s->scan_count, 683);
  EXPECT_EQ(s->start_us, 0x11A3F00Du);
  EXPECT_EQ(s->sent_us, 0x11A4059Fu);
  EXPECT_EQ(s->outputs[0], 7);
  EXPECT_EQ(s->scan_frequency_chz, 5000u);
  EXPECT_EQ(s->measuring_hhz, 360u);
  EXPECT_TRUE(s->encoders.empty());
  ASSERT_EQ(s->channels.size(), 1u);
  const Channel& c = s->channels[0];
  EXPECT_EQ(c.name, "DIST1");
  EXPECT_EQ(c.bits, 16);
  EXPECT_EQ(c.start_e4deg, -450'000);
  EXPECT_EQ(c.step_e4deg, 5000);
  EXPECT_EQ(c.values, (std::vector<std::uint16_t>{1000, 0, 1500, 18, 20'000}));
  EXPECT_FALSE(s->name || s->comment || s->position || s->time);
}

TEST(SickScan, ReadsEncoderScaleRemissionNameAndTime) {
  const auto s = decode_a(kFullScan);
  ASSERT_TRUE(s) << s.error().detail;
  ASSERT_EQ(s->encoders.size(), 1u);
  EXPECT_EQ(s->encoders[0], (Encoder{-5, 10}));
  ASSERT_EQ(s->channels.size(), 2u);
  EXPECT_EQ(s->channels[0].scale, 2.0F);
  EXPECT_EQ(s->channels[0].start_e4deg, -50'000);
  EXPECT_EQ(s->channels[1].name, "RSSI1");
  EXPECT_EQ(s->channels[1].values, (std::vector<std::uint16_t>{120, 0, 255, 65535}));
  EXPECT_EQ(s->name, "Front left");
  EXPECT_EQ(s->time, (DeviceTime{2026, 5, 20, 11, 59, 42, 250'000}));
}

TEST(SickScan, ReadsAPolledScanWithAChannelOf8Bits) {
  const auto s = decode_a(kPolledScan);
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_TRUE(s->polled);
  ASSERT_EQ(s->channels.size(), 2u);
  EXPECT_EQ(s->channels[0].values, (std::vector<std::uint16_t>{500, 600}));
  EXPECT_EQ(s->channels[1].bits, 8);
  EXPECT_EQ(s->channels[1].values, (std::vector<std::uint16_t>{10, 200}));
}

TEST(SickScan, ANameMayHoldTwoBlanksInARow) {
  const auto s = decode_a(changed(kFullScan, "A Front left", "B Front  left"));
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->name, "Front  left");
}

TEST(SickScan, NumbersMayBeDecimalWithASign) {
  const auto s = decode_a(changed(kShortScan, "FFF92230 1388 5 ", "-450000 +5000 +5 "));
  ASSERT_TRUE(s) << s.error().detail;
  EXPECT_EQ(s->channels[0].start_e4deg, -450'000);
  EXPECT_EQ(s->channels[0].step_e4deg, 5000);
}

TEST(SickScan, OtherFirmwareSaysVersionZeroAndEventsEndTheReading) {
  EXPECT_EQ(decode_a(changed(kShortScan, "data 1", "data 0"))->version, 0);
  EXPECT_EQ(
      decode_a(std::string(kShortScan.substr(0, kShortScan.size() - 1)) + "1 FDIN whatever")->event,
      1);
}

// All that a scan may hold, there and back in both dialects.
TEST(SickScan, BothDialectsSayTheSame) {
  Scan s = *decode_a(kFullScan);
  s.channels.push_back({"DIST2", 16, 0.1F, -3.5F, 0, 1667, {1, 2, 3}});
  std::swap(s.channels[1], s.channels[2]);
  s.channels.push_back({"RSSI2", 8, 1.0F, 0.0F, 0, 1667, {0, 127, 255}});
  s.position = Position{{1.5F, -2.0F, 0.0F, 0.1F, 0.2F, -0.3F}, 2};
  s.comment = "two  blanks ";
  s.status = {1, 5};
  s.encoders.push_back({2'147'483'647, 65535});
  for (const Dialect d : {Dialect::A, Dialect::B}) {
    std::vector<Scan> heard;
    Framer framer;
    framer.feed(encode(s, d), [&](const Telegram& t) {
      const auto read = decode_scan(t);
      ASSERT_TRUE(read) << read.error().detail;
      heard.push_back(*read);
    });
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard[0], s) << to_string(d);
  }
  EXPECT_EQ(text_of(encode(*decode_a(kFullScan), Dialect::A)), text_of(in_a(kFullScan)));
  EXPECT_EQ(text_of(encode(*decode_a(kShortScan), Dialect::A)), text_of(in_a(kShortScan)));
}

TEST(SickScan, ACountThatDoesNotFitIsRefused) {
  EXPECT_EQ(refusal(changed(kShortScan, "1388 5 3E8", "1388 FFFF 3E8")),
            "number of values: more than the telegram holds");
  EXPECT_EQ(refusal(changed(kShortScan, "168 0 1 DIST1", "168 FFFF 1 DIST1")),
            "number of encoders: more than the telegram holds");
  EXPECT_EQ(refusal(changed(kShortScan, "168 0 1 DIST1", "168 0 FF DIST1")),
            "number of 16-bit channels: more than the telegram holds");
  // One more than there is: the fields behind shift.
  EXPECT_NE(refusal(changed(kShortScan, "1388 5 3E8", "1388 6 3E8")), "believed");
  EXPECT_NE(refusal(changed(kShortScan, "1388 5 3E8", "1388 4 3E8")), "believed");
}

TEST(SickScan, SaysWhichFieldIsWrongAndWhere) {
  const auto s = decode_a(changed(kShortScan, "B3C0DE", "B3C0DG"));
  ASSERT_FALSE(s);
  EXPECT_EQ(s.error().detail, "serial number: no such number");
  ASSERT_EQ(s.error().fields.size(), 1u);
  EXPECT_EQ(s.error().fields[0].pointer, "byte 20");
}

TEST(SickScan, NumbersThatAreNoneAreRefused) {
  EXPECT_EQ(refusal(changed(kShortScan, "3E8", "1003E8")), "value: no such number");
  EXPECT_EQ(refusal(changed(kShortScan, "3E8 0", "3E8  0")), "value: no such number");
  EXPECT_EQ(refusal(changed(kShortScan, "2A7", "-1")), "telegram counter: no such number");
  EXPECT_EQ(refusal(changed(kShortScan, "2A7", "+")), "telegram counter: no such number");
  EXPECT_EQ(refusal(changed(kShortScan, "2A7", "0x2A7")), "telegram counter: no such number");
  EXPECT_EQ(refusal(changed(kShortScan, "3F800000", "7FC00000")), "scale: no useful number");
  EXPECT_EQ(refusal(changed(kShortScan, "3F800000", "7F800000")), "scale: no useful number");
  EXPECT_EQ(refusal(changed(kShortScan, "3F800000", "00000000")), "scale: no useful number");
  EXPECT_EQ(refusal(changed(kShortScan, "3F800000 00000000", "3F800000 FFC00000")),
            "offset: no useful number");
  EXPECT_EQ(refusal(std::string(kShortScan) + " 0"), "end: something follows the last field");
  EXPECT_EQ(refusal(changed(kFullScan, "A Front left", "9 Front left")),
            "name: longer than its length");
  EXPECT_EQ(refusal("sRA STlms 7"), "no scan telegram");
}

TEST(SickScan, EveryEndIsRefused) {
  for (const Dialect d : {Dialect::A, Dialect::B}) {
    const auto framed = encode(*decode_a(kFullScan), d);
    const std::size_t before = d == Dialect::A ? 1 : 8;
    const Bytes body = Bytes(framed).subspan(before, framed.size() - before - 1);
    for (std::size_t n = 0; n < body.size(); ++n) {
      EXPECT_FALSE(decode_scan({d, body.first(n)})) << to_string(d) << ' ' << n;
    }
    EXPECT_TRUE(decode_scan({d, body}));
  }
}

TEST(SickScan, TheStatusIsASetOfBits) {
  const auto of = [](std::uint8_t first, std::uint8_t second) {
    Scan s;
    s.status = {first, second};
    return status_of(s);
  };
  EXPECT_EQ(of(0, 0).words, "ok");
  EXPECT_TRUE(of(0, 0).good);
  EXPECT_EQ(of(1, 0).words, "starting");
  EXPECT_FALSE(of(1, 0).good);
  EXPECT_EQ(of(0, 1).words, "faulty");
  EXPECT_FALSE(of(0, 1).good);
  EXPECT_EQ(of(0, 2).words, "pollution warning");
  EXPECT_TRUE(of(0, 2).good && of(0, 2).dirty && !of(0, 2).blocked);
  EXPECT_EQ(of(0, 4).words, "pollution error");
  EXPECT_TRUE(of(0, 4).good && of(0, 4).blocked);
  EXPECT_TRUE(of(0, 5).blocked && !of(0, 5).good);
}

}  // namespace
}  // namespace roverd::sick
