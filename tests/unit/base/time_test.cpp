#include "base/time.hpp"

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

using namespace std::chrono_literals;

TEST(Time, IsWrittenAsRfc3339WithMilliseconds) {
  EXPECT_EQ(to_rfc3339(WallTime{}), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(to_rfc3339(WallTime(1'709'210'130'209'999'999ns)), "2024-02-29T12:35:30.209Z");
}

TEST(Time, BeforeTheEpochRoundsDown) {
  EXPECT_EQ(to_rfc3339(WallTime(-1ns)), "1969-12-31T23:59:59.999Z");
}

TEST(Time, SecondsRoundTrip) {
  EXPECT_DOUBLE_EQ(seconds(from_seconds(0.02)), 0.02);
  EXPECT_EQ(from_seconds(1.5), 1500ms);
}

}  // namespace
}  // namespace roverd::base
