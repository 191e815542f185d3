// Who holds control: by facts and time.

#include "people/lease.hpp"

#include <map>

#include <gtest/gtest.h>

namespace roverd::people {
namespace {

using namespace std::chrono_literals;
using How = Lease::How;
using Outcome = Lease::Outcome;
using Kind = Lease::Notice::Kind;

Driver browser(const std::string& session, const std::string& user) {
  return {Who::By::Session, session, {}, user, user + "'s browser"};
}
Driver script(const std::string& token, const std::string& address) {
  return {Who::By::Token, token, address, "anna", "logger"};
}

const Driver kAnna = browser("s1", "anna");
const Driver kBen = browser("s2", "ben");
const Driver kCleo = browser("s3", "cleo");

class LeaseTest : public testing::Test {
 protected:
  void pass(base::Duration time) {
    now += time;
    lease.step([this](const Driver& d) { return facts.contains(d.id) ? facts[d.id] : silent; },
               now);
  }
  base::Result<Outcome> take(const Driver& who, How how = How::IfFree,
                             const std::string& reason = {}) {
    return lease.take(who, how, reason, now);
  }
  /// "taken -> ben", "forced anna -> ben: fire"; all since the last time.
  std::vector<std::string> told() {
    static const std::map<Kind, std::string> kWords = {{Kind::Taken, "taken"},
                                                       {Kind::Released, "released"},
                                                       {Kind::Lost, "lost"},
                                                       {Kind::Ended, "ended"},
                                                       {Kind::Forced, "forced"},
                                                       {Kind::Asked, "asked"},
                                                       {Kind::HandedOver, "handed over"},
                                                       {Kind::Refused, "refused"},
                                                       {Kind::Expired, "expired"},
                                                       {Kind::Withdrawn, "withdrawn"}};
    std::vector<std::string> out;
    for (const auto& n : lease.take_notices()) {
      std::string line = kWords.at(n.kind);
      if (n.from) line += " " + n.from->user;
      if (n.to) line += " -> " + n.to->user;
      if (!n.reason.empty()) line += ": " + n.reason;
      out.push_back(line);
    }
    return out;
  }
  using Lines = std::vector<std::string>;

  const Lease::Fact silent{true, false};
  const Lease::Fact linked{true, true};
  const Lease::Fact over{false, false};
  std::map<std::string, Lease::Fact> facts;
  base::Time now{1000s};
  Lease lease{Lease::Params{}};
};

TEST_F(LeaseTest, IsFreeAtFirstAndGoesToWhoeverTakesIt) {
  EXPECT_FALSE(lease.holder());
  EXPECT_FALSE(lease.holds(kAnna));
  EXPECT_EQ(take(kAnna), Outcome::Holds);
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_EQ(lease.since(), now);
  EXPECT_EQ(told(), Lines{"taken -> anna"});
}

TEST_F(LeaseTest, IsRefusedToASecondOneAndFreeAgainAfterRelease) {
  (void)take(kAnna);
  const auto refused = take(kBen);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_FALSE(lease.release(kBen, now));  // not ben's
  EXPECT_TRUE(lease.release(kAnna, now));
  EXPECT_EQ(take(kBen), Outcome::Holds);
  EXPECT_EQ(told(), (Lines{"taken -> anna", "released anna", "taken -> ben"}));
}

TEST_F(LeaseTest, TakingItAgainRenewsIt) {
  (void)take(kAnna);
  pass(9s);
  EXPECT_EQ(take(kAnna), Outcome::Holds);
  pass(9s);
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_EQ(lease.since(), now - 18s);
  EXPECT_EQ(told(), Lines{"taken -> anna"});
}

TEST_F(LeaseTest, IsKeptWhileTheStreamIsOpenAndForTheGraceAfterIt) {
  facts["s1"] = linked;
  (void)take(kAnna);
  for (int i = 0; i < 60; ++i) pass(1min);
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_FALSE(lease.grace_left(now));
  facts["s1"] = silent;  // the stream broke
  pass(4s);
  EXPECT_EQ(lease.grace_left(now), 6s);
  pass(5900ms);
  EXPECT_TRUE(lease.holds(kAnna));
  pass(100ms);
  EXPECT_FALSE(lease.holder());
  EXPECT_EQ(told(), (Lines{"taken -> anna", "lost anna"}));
}

TEST_F(LeaseTest, AStreamThatComesBackInTimeKeepsIt) {
  facts["s1"] = linked;
  (void)take(kAnna);
  pass(1s);
  facts["s1"] = silent;
  pass(9s);
  facts["s1"] = linked;
  pass(5s);
  facts["s1"] = silent;
  pass(9s);
  EXPECT_TRUE(lease.holds(kAnna));
}

TEST_F(LeaseTest, AScriptWithoutStreamKeepsItByCalling) {
  const Driver one = script("t1", "10.0.0.5");
  (void)take(one);
  for (int i = 0; i < 10; ++i) {
    pass(9s);
    lease.heard(one, now);
  }
  lease.heard(script("t1", "10.0.0.6"), now + 5s);  // another one's calls do not
  pass(9s);
  EXPECT_TRUE(lease.holds(one));
  pass(1s);
  EXPECT_FALSE(lease.holder());
}

TEST_F(LeaseTest, WhoIsOverdueDoesNotHoldItEvenIfNobodyLooked) {
  (void)take(kAnna);
  now += 11s;
  EXPECT_EQ(take(kBen), Outcome::Holds);
  EXPECT_EQ(told(), (Lines{"taken -> anna", "lost anna", "taken -> ben"}));
}

TEST_F(LeaseTest, TwoTabsOfOneBrowserAreOneDriverTwoBrowsersOfOneUserAreTwo) {
  (void)take(kAnna);
  Driver other_tab = kAnna;
  other_tab.name = "another tab";
  EXPECT_TRUE(lease.holds(other_tab));
  EXPECT_EQ(take(other_tab), Outcome::Holds);
  EXPECT_FALSE(take(browser("s9", "anna")));
}

TEST_F(LeaseTest, OneTokenFromTwoAddressesIsTwoDriversASessionMayMove) {
  (void)take(script("t1", "10.0.0.5"));
  EXPECT_TRUE(lease.holds(script("t1", "10.0.0.5")));
  EXPECT_FALSE(lease.holds(script("t1", "10.0.0.6")));
  EXPECT_FALSE(take(script("t1", "10.0.0.6")));
  // A session and a token of equal names are not the same either.
  EXPECT_FALSE(lease.holds(browser("t1", "anna")));
}

TEST_F(LeaseTest, TheHolderHandsItOverToWhoAsks) {
  facts["s1"] = facts["s2"] = linked;
  (void)take(kAnna);
  EXPECT_EQ(take(kBen, How::Ask), Outcome::Asked);
  EXPECT_EQ(take(kBen, How::Ask), Outcome::Asked);  // is one request
  ASSERT_EQ(lease.requests().size(), 1u);
  EXPECT_EQ(lease.requests()[0].until, now + 30s);
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_TRUE(lease.answer(lease.requests()[0].id, true, now));
  EXPECT_TRUE(lease.holds(kBen));
  EXPECT_TRUE(lease.requests().empty());
  EXPECT_EQ(told(), (Lines{"taken -> anna", "asked anna -> ben", "handed over anna -> ben"}));
}

TEST_F(LeaseTest, TheHolderRefuses) {
  facts["s1"] = linked;
  (void)take(kAnna);
  (void)take(kBen, How::Ask);
  const auto id = lease.requests()[0].id;
  EXPECT_TRUE(lease.answer(id, false, now));
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_TRUE(lease.requests().empty());
  const auto again = lease.answer(id, true, now);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, base::Code::NotFound);
  EXPECT_EQ(told(), (Lines{"taken -> anna", "asked anna -> ben", "refused anna -> ben"}));
}

TEST_F(LeaseTest, ARequestExpiresAndCannotBeAcceptedThen) {
  facts["s1"] = linked;
  (void)take(kAnna);
  (void)take(kBen, How::Ask);
  const auto id = lease.requests()[0].id;
  pass(29s);
  EXPECT_EQ(lease.requests().size(), 1u);
  now += 1s;
  EXPECT_FALSE(lease.answer(id, true, now));
  EXPECT_TRUE(lease.holds(kAnna));
  EXPECT_EQ(told(), (Lines{"taken -> anna", "asked anna -> ben", "expired anna -> ben"}));
}

TEST_F(LeaseTest, ARequestIsTakenBackAndAskingForWhatIsFreeTakesIt) {
  facts["s1"] = linked;
  EXPECT_EQ(take(kAnna, How::Ask), Outcome::Holds);
  (void)take(kBen, How::Ask);
  EXPECT_TRUE(lease.release(kBen, now));
  EXPECT_TRUE(lease.requests().empty());
  EXPECT_EQ(told(), (Lines{"taken -> anna", "asked anna -> ben", "withdrawn anna -> ben"}));
}

TEST_F(LeaseTest, WhoAskedFirstGetsItWhenItBecomesFree) {
  facts["s1"] = linked;
  (void)take(kAnna);
  (void)take(kBen, How::Ask);
  (void)take(kCleo, How::Ask);
  (void)lease.release(kAnna, now);
  EXPECT_TRUE(lease.holds(kBen));
  ASSERT_EQ(lease.requests().size(), 1u);  // now a question to ben
  pass(10s);                               // who is not heard
  EXPECT_TRUE(lease.holds(kCleo));
  EXPECT_TRUE(lease.requests().empty());
}

TEST_F(LeaseTest, SoManyMayAskAndNotMore) {
  (void)take(kAnna);
  for (std::size_t i = 0; i < Lease::kRequests; ++i) {
    EXPECT_TRUE(take(browser("b" + std::to_string(i), "b"), How::Ask));
  }
  EXPECT_FALSE(take(kBen, How::Ask));
  EXPECT_EQ(lease.requests().size(), Lease::kRequests);
}

TEST_F(LeaseTest, ForceTakesItAtOnceAndTellsTheReason) {
  facts["s1"] = linked;
  (void)take(kAnna);
  (void)take(kBen, How::Ask);
  (void)told();
  EXPECT_EQ(take(kBen, How::Force, "anna has left the field"), Outcome::Holds);
  EXPECT_TRUE(lease.holds(kBen));
  EXPECT_FALSE(lease.holds(kAnna));
  EXPECT_TRUE(lease.requests().empty());
  EXPECT_EQ(told(), Lines{"forced anna -> ben: anna has left the field"});
  // Where there is nobody to take it from it is no force.
  (void)lease.release(kBen, now);
  (void)told();
  (void)take(kCleo, How::Force, "hurry");
  EXPECT_EQ(told(), Lines{"taken -> cleo"});
}

TEST_F(LeaseTest, EndsAtOnceWithTheLogIn) {
  facts["s1"] = linked;
  (void)take(kAnna);
  facts["s1"] = over;
  pass(0s);
  EXPECT_FALSE(lease.holder());
  EXPECT_EQ(told(), (Lines{"taken -> anna", "ended anna"}));
}

TEST_F(LeaseTest, WhoseLogInIsOverDoesNotAskAnyMore) {
  facts["s1"] = linked;
  (void)take(kAnna);
  (void)take(kBen, How::Ask);
  facts["s2"] = over;
  facts["s1"] = over;
  pass(0s);
  EXPECT_FALSE(lease.holder());
  EXPECT_EQ(told(),
            (Lines{"taken -> anna", "asked anna -> ben", "withdrawn anna -> ben", "ended anna"}));
}

}  // namespace
}  // namespace roverd::people
