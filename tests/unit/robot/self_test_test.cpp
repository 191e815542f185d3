// A table of failsafes that is broken is noticed at the start, and nobody arms.

#include "robot/safety/self_test.hpp"

#include <algorithm>
#include <array>

#include "field.hpp"
#include "robot/safety/made_up.hpp"
#include "robot/safety/safety.hpp"

namespace roverd::robot {
namespace {

using Told = std::optional<std::string>;

constexpr Failsafe kGood{
    .id = "made_up",
    .seen = "it is asked to",
    .after = "at once",
    .response = Response::Hold,
    .ends = "never",
    .over = "nobody",
    .test = [](const Facts& f, const SafetyParams&, Time) -> Told {
      return f.estop ? Told("yes") : Told();
    },
    .provoke = [](MadeUp& m) { m.facts.estop = true; },
};

std::string found_in(Failsafe row) {
  const std::array rows{kGood, row};
  return test_failsafes(rows);
}

TEST(SelfTest, TheTableAsItIsHasNoFault) {
  EXPECT_EQ(test_failsafes(), "");
}

TEST(SelfTest, NamesARowThatDoesNotSpeakWhenItMust) {
  Failsafe deaf = kGood;
  deaf.id = "deaf";
  deaf.test = [](const Facts&, const SafetyParams&, Time) -> Told { return {}; };
  EXPECT_EQ(found_in(deaf), "the failsafe deaf (it is asked to) does not see what it is there for");
  Failsafe mute = deaf;
  mute.test = [](const Facts& f, const SafetyParams&, Time) -> Told {
    return f.estop ? Told("") : Told();
  };
  EXPECT_NE(found_in(mute), "");
}

TEST(SelfTest, NamesARowThatAlwaysSpeaksOrHasNoTest) {
  Failsafe loud = kGood;
  loud.id = "loud";
  loud.test = [](const Facts&, const SafetyParams&, Time) -> Told { return "always"; };
  EXPECT_EQ(found_in(loud), "the failsafe loud (it is asked to) speaks where nothing is wrong");
  Failsafe empty = kGood;
  empty.id = "empty";
  empty.test = nullptr;
  EXPECT_EQ(found_in(empty), "the failsafe empty (it is asked to) has no test");
}

TEST(SelfTest, NamesARowThatAWeakerOneOfItsIdSilences) {
  Failsafe weaker = kGood;
  weaker.response = Response::Warn;
  const std::array rows{weaker, kGood};
  EXPECT_EQ(test_failsafes(rows),
            "the failsafe made_up (it is asked to) is not followed by what it says");
}

TEST(SelfTest, WithAFaultNobodyArmsAndWithoutOneTheCheckSaysSo) {
  Field f;
  f.run(8.0);
  EXPECT_TRUE(f.check("self_test").ok) << f.check("self_test").detail;
  MadeUp m;
  m.facts.self_test = "the failsafe deaf does not see what it is there for";
  const auto checks = arming_checks(m.facts, m.params, ArmingParams{}, true, m.now);
  const auto own = std::find_if(checks.begin(), checks.end(),
                                [](const base::Check& c) { return c.id == "self_test"; });
  ASSERT_NE(own, checks.end());
  EXPECT_FALSE(own->ok);
  EXPECT_EQ(own->severity, base::Severity::Error);
  EXPECT_EQ(own->detail, m.facts.self_test);
}

}  // namespace
}  // namespace roverd::robot
