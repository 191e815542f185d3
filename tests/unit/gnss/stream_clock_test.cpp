// A receiver's own time, and where its stream may be cut.

#include "gnss/stream_clock.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../ubx/frames.hpp"
#include "gnss/nmea_encode.hpp"
#include "ubx/framer.hpp"

namespace roverd::gnss {
namespace {

using Clock = base::StreamTime::Clock;

std::string text_of_frame(ubx::Key key, const std::vector<std::uint8_t>& payload) {
  const auto frame = ubx::encode(key, payload);
  return {frame.begin(), frame.end()};
}

/// iTOW 0x0A0A0A0A ms: four line feeds.
std::vector<std::uint8_t> payload_with_itow(std::size_t at, std::size_t size) {
  std::vector<std::uint8_t> p(size, 0);
  for (std::size_t i = 0; i < 4; ++i) p[at + i] = 0x0A;
  return p;
}

std::vector<base::StreamMark> marks_of(const std::string& text, std::size_t piece) {
  std::vector<base::StreamMark> out;
  const auto clock = stream_clock();
  for (std::size_t at = 0; at < text.size(); at += piece) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(text.data()) + at;
    clock({data, std::min(piece, text.size() - at)}, [&](const base::StreamMark& m) {
      if (m.time || out.empty() || m.end > out.back().end) out.push_back(m);
    });
  }
  return out;
}

TEST(GnssStreamClock, SentencesTellTheTimeOfDayAndFramesTheTimeOfWeek) {
  const std::string gga = line("GNGGA,235959.75,,,,,0,00,99.99,,,,,,");
  const std::string gsv = line("GPGSV,1,1,01,05,45,123,38,1");
  const std::string sat = text_of_frame({0x01, 0x35}, payload_with_itow(0, 8));
  const std::string rel = text_of_frame({0x01, 0x3C}, payload_with_itow(4, 64));
  const std::string hw = text_of_frame({0x0A, 0x09}, payload_with_itow(0, 60));
  const std::string all = gga + sat + gsv + rel + hw;
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, all.size()}) {
    std::vector<base::StreamMark> timed;
    for (const auto& m : marks_of(all, piece)) {
      if (m.time) timed.push_back(m);
    }
    ASSERT_EQ(timed.size(), 3u) << piece;
    EXPECT_EQ(timed[0].end, gga.size() - 2) << "without its line end";
    EXPECT_EQ(timed[0].time->clock, Clock::TimeOfDay);
    EXPECT_DOUBLE_EQ(timed[0].time->s, 86'399.75);
    EXPECT_DOUBLE_EQ(timed[0].time->period_s, 86'400.0);
    EXPECT_EQ(timed[1].end, gga.size() + sat.size());
    EXPECT_EQ(timed[1].time->clock, Clock::TimeOfWeek);
    EXPECT_DOUBLE_EQ(timed[1].time->s, 0x0A0A0A0A / 1e3);
    EXPECT_DOUBLE_EQ(timed[1].time->period_s, 604'800.0);
    EXPECT_EQ(timed[2].end, gga.size() + sat.size() + gsv.size() + rel.size());
    EXPECT_DOUBLE_EQ(timed[2].time->s, 0x0A0A0A0A / 1e3) << "behind the version";
  }
}

TEST(GnssStreamClock, NoMarkLiesWithinAMessage) {
  const std::string frame = text_of_frame({0x01, 0x35}, std::vector<std::uint8_t>(200, '\n'));
  for (const auto& m : marks_of(frame, 1))
    EXPECT_TRUE(m.end == 0 || m.end == frame.size()) << m.end;
  EXPECT_EQ(marks_of(frame, 1).back().end, frame.size());
}

TEST(GnssStreamClock, WhatIsDamagedOrTooShortTellsNoTime) {
  std::string wrong = text_of_frame({0x01, 0x35}, payload_with_itow(0, 8));
  wrong[8] = 'x';
  const std::string empty = text_of_frame({0x01, 0x07}, {});
  const std::string three = text_of_frame({0x01, 0x61}, {1, 2, 3});
  const std::string late = text_of_frame({0x01, 0x3C}, std::vector<std::uint8_t>(7, 0));
  const std::string beyond =
      text_of_frame({0x01, 0x61}, {0xFF, 0xFF, 0xFF, 0xFF});  // no week is so long
  const std::string other = text_of_frame({0x01, 0x23}, payload_with_itow(0, 20));  // GLONASS time
  const std::string sentence = "$GNGGA,235959.75,,,,,0,00,99.99,,,,,,*00\r\n";
  for (const std::string& text : {wrong, empty, three, late, beyond, other, sentence}) {
    for (const auto& m : marks_of(text, 5)) EXPECT_FALSE(m.time);
  }
}

}  // namespace
}  // namespace roverd::gnss
