// A scanner's own time, and where its stream may be cut.

#include "sick/stream_clock.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

TEST(SickStreamClock, EachScanTellsWhenItWasSent) {
  std::vector<std::uint8_t> all = bytes_of("noise");
  std::vector<std::uint64_t> ends;
  for (const Dialect d : {Dialect::A, Dialect::B}) {
    const auto answer = Writer(d, "sRA", "STlms").u16(7).framed();
    const auto scan = encode(lms111(1, 0xFFFF'FFFFU - 3099U), d);  // sent at 0
    const auto next = encode(lms111(2, 2'000'000), d);
    for (const auto* part : {&answer, &scan, &next})
      all.insert(all.end(), part->begin(), part->end());
    ends.push_back(all.size() - next.size());
    ends.push_back(all.size());
  }
  for (const std::size_t piece : {std::size_t{1}, std::size_t{13}, all.size()}) {
    const auto clock = stream_clock();
    std::vector<base::StreamMark> timed;
    std::uint64_t last = 0;
    for (std::size_t at = 0; at < all.size(); at += piece) {
      clock(Bytes(all).subspan(at, std::min(piece, all.size() - at)),
            [&](const base::StreamMark& m) {
              EXPECT_GE(m.end, last);
              last = m.end;
              if (m.time) timed.push_back(m);
            });
    }
    ASSERT_EQ(timed.size(), 4u) << piece;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(timed[i].end, ends[i]);
      EXPECT_EQ(timed[i].time->clock, base::StreamTime::Clock::Samples);
      EXPECT_DOUBLE_EQ(timed[i].time->s, i % 2 == 0 ? 0.0 : 2.0031);
      EXPECT_DOUBLE_EQ(timed[i].time->period_s, 4294.967296);
    }
    EXPECT_EQ(last, all.size());
  }
}

}  // namespace
}  // namespace roverd::sick
