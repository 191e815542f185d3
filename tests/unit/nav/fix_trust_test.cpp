// When a fixed solution counts as one.

#include "nav/estimate/fix_trust.hpp"

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

using base::FixType;
using std::chrono::milliseconds;

class Receiver {
 public:
  /// Tells this class for so long, five times a second.
  Receiver& tells(FixType fix, double for_s) {
    for (int i = 0; i < static_cast<int>(5 * for_s); ++i) {
      trust.take(fix, now_);
      now_ += milliseconds(200);
    }
    return *this;
  }
  FixTrust trust;

 private:
  base::Time now_{};
};

TEST(FixTrust, AFixedSolutionThatStaysIsSettledAfterThreeSeconds) {
  Receiver r;
  EXPECT_FALSE(r.tells(FixType::RtkFixed, 2.8).trust.settled());
  EXPECT_FALSE(r.trust.shaken());
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 0.6).trust.settled());
  // One loss after a long time shakes nothing: a link that was down, a bridge.
  r.tells(FixType::RtkFixed, 60.0).tells(FixType::RtkFloat, 5.0);
  EXPECT_FALSE(r.tells(FixType::RtkFixed, 2.0).trust.shaken());
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 2.0).trust.settled());
}

TEST(FixTrust, OneThatComesAndGoesMustLastTwiceAsLongEachTime) {
  Receiver r;
  r.tells(FixType::RtkFixed, 4.0).tells(FixType::RtkFloat, 2.0);
  r.tells(FixType::RtkFixed, 5.0);  // 6 s now
  EXPECT_TRUE(r.trust.shaken());
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 2.0).trust.settled());
  EXPECT_FALSE(r.trust.shaken());
  r.tells(FixType::None, 1.0).tells(FixType::RtkFixed, 11.0);  // 12 s
  EXPECT_TRUE(r.trust.shaken());
  for (int i = 0; i < 10; ++i) r.tells(FixType::RtkFloat, 2.0).tells(FixType::RtkFixed, 2.0);
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 21.0).trust.shaken());  // 24 s at most
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 2.0).trust.settled());
}

TEST(FixTrust, AMinuteOfOneThatStaysForgivesAllBefore) {
  Receiver r;
  for (int i = 0; i < 10; ++i) r.tells(FixType::RtkFloat, 2.0).tells(FixType::RtkFixed, 2.0);
  r.tells(FixType::RtkFixed, 61.0).tells(FixType::RtkFloat, 2.0).tells(FixType::RtkFixed, 2.0);
  EXPECT_FALSE(r.trust.shaken());
  EXPECT_TRUE(r.tells(FixType::RtkFixed, 2.0).trust.settled());
}

TEST(FixTrust, OnlyAFixedSolutionIsShaken) {
  Receiver r;
  for (int i = 0; i < 3; ++i) r.tells(FixType::RtkFixed, 2.0).tells(FixType::RtkFloat, 2.0);
  EXPECT_FALSE(r.trust.shaken());
  EXPECT_FALSE(r.tells(FixType::Single, 10.0).trust.shaken());
}

}  // namespace
}  // namespace roverd::nav
