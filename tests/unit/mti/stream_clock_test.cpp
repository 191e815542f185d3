// An MTi's own time, and where its stream may be cut.

#include "mti/stream_clock.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mti/data2_build.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {
namespace {

using Clock = base::StreamTime::Clock;

std::vector<base::StreamMark> timed_of(const std::vector<std::uint8_t>& bytes, std::size_t piece) {
  std::vector<base::StreamMark> out;
  const auto clock = stream_clock();
  std::uint64_t last = 0;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    clock(Bytes(bytes).subspan(at, std::min(piece, bytes.size() - at)),
          [&](const base::StreamMark& m) {
            EXPECT_GE(m.end, last);
            last = m.end;
            if (m.time) out.push_back(m);
          });
  }
  return out;
}

TEST(MtiStreamClock, TheSampleTimeCountsBeforeTheUtcTime) {
  const std::vector<std::uint8_t> utc{0x1D, 0xCD, 0x65, 0x00, 0x07, 0xEA, 5, 20, 11, 59, 42, 7};
  Data2Builder both;
  both.bytes(xdi_of(Kind::UtcTime), utc).integer(xdi_of(Kind::SampleTimeFine), 0xFFFF'FFFF, 4);
  Data2Builder only;
  only.bytes(xdi_of(Kind::UtcTime), utc);
  Data2Builder none;
  none.integer(xdi_of(Kind::PacketCounter), 7, 2);
  std::vector<std::uint8_t> unset = utc;
  unset.back() = 1;  // the date is valid, the time is not
  Data2Builder waiting;
  waiting.bytes(xdi_of(Kind::UtcTime), unset);

  std::vector<std::uint8_t> all{0xFA, 0x00};  // no message
  std::vector<std::size_t> ends;
  for (const auto* b : {&both, &only, &none, &waiting}) {
    const auto message = encode(mid::kMtData2, b->payload());
    all.insert(all.end(), message.begin(), message.end());
    ends.push_back(all.size());
  }
  for (const std::size_t piece : {std::size_t{1}, std::size_t{13}, all.size()}) {
    const auto timed = timed_of(all, piece);
    ASSERT_EQ(timed.size(), 2u) << piece;
    EXPECT_EQ(timed[0].end, ends[0]);
    EXPECT_EQ(timed[0].time->clock, Clock::Samples);
    EXPECT_DOUBLE_EQ(timed[0].time->s, 429496.7295);
    EXPECT_DOUBLE_EQ(timed[0].time->period_s, 429496.7296);
    EXPECT_EQ(timed[1].end, ends[1]);
    EXPECT_EQ(timed[1].time->clock, Clock::TimeOfDay);
    EXPECT_DOUBLE_EQ(timed[1].time->s, 43'182.5);
  }
}

}  // namespace
}  // namespace roverd::mti
