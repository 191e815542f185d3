// The two switches that say whether anything may move, arrow by arrow.

#include "robot/safety/arm_switch.hpp"

#include <gtest/gtest.h>

namespace roverd::robot {
namespace {

ArmSwitch armed() {
  ArmSwitch s;
  EXPECT_TRUE(s.arm());
  return s;
}

TEST(ArmSwitch, IsDisarmedAndReleasedAtFirst) {
  const ArmSwitch s;
  EXPECT_FALSE(s.armed());
  EXPECT_FALSE(s.latched());
}

TEST(ArmSwitch, ArmsOnceAndDisarmsOnce) {
  ArmSwitch s = armed();
  EXPECT_TRUE(s.armed());
  EXPECT_FALSE(s.arm()) << "it is armed already";
  EXPECT_TRUE(s.disarm());
  EXPECT_FALSE(s.armed());
  EXPECT_FALSE(s.disarm()) << "it was not armed";
}

TEST(ArmSwitch, LatchingDisarmsAndForbidsArmingUntilItIsReleased) {
  ArmSwitch s = armed();
  const ArmSwitch::Latch first = s.latch();
  EXPECT_TRUE(first.newly);
  EXPECT_TRUE(first.disarmed);
  EXPECT_TRUE(s.latched());
  EXPECT_FALSE(s.armed());
  EXPECT_FALSE(s.arm());
  EXPECT_FALSE(s.armed());
  const ArmSwitch::Latch again = s.latch();
  EXPECT_FALSE(again.newly);
  EXPECT_FALSE(again.disarmed);
  EXPECT_TRUE(s.release());
  EXPECT_FALSE(s.latched());
  EXPECT_FALSE(s.armed()) << "released is not armed";
  EXPECT_FALSE(s.release());
  EXPECT_TRUE(s.arm());
}

TEST(ArmSwitch, LatchingADisarmedOneDisarmsNothing) {
  ArmSwitch s;
  const ArmSwitch::Latch latch = s.latch();
  EXPECT_TRUE(latch.newly);
  EXPECT_FALSE(latch.disarmed);
}

TEST(ArmingRefusal, NamesEveryFailingCheckAndNoWarning) {
  using base::Severity;
  const auto none = arming_refusal({});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->detail, "not armed: the checks have not run yet");
  EXPECT_FALSE(arming_refusal({{"heading", false, Severity::Warning, "unknown"},
                               {"radio", true, Severity::Error, "heard"}}));
  const auto two = arming_refusal({{"gnss_fix", false, Severity::Error, "no fix"},
                                   {"radio", false, Severity::Error, "silent"},
                                   {"heading", false, Severity::Warning, "unknown"}});
  ASSERT_TRUE(two);
  EXPECT_EQ(two->code, base::Code::Conflict);
  EXPECT_EQ(two->detail, "not armed: no fix (and 1 more)");
  ASSERT_EQ(two->fields.size(), 2u);
  EXPECT_EQ(two->fields[1].pointer, "/checks/radio");
  const auto by_hand = arming_refusal({{"gnss_fix", false, Severity::Error, "no fix"},
                                       {"position_accuracy", false, Severity::Error, "5 m"},
                                       {"radio", false, Severity::Error, "silent"}},
                                      true);
  ASSERT_TRUE(by_hand);
  EXPECT_EQ(by_hand->fields.size(), 1u) << "a radio must be heard, whoever drives";
}

TEST(ReleaseRefusal, NamesWhoStillPresses) {
  World w;
  EXPECT_EQ(release_refusal(w), "");
  base::Bumper bumper;
  bumper.pressed = true;
  w.take(base::Measurement(bumper));
  EXPECT_EQ(release_refusal(w), "the bumper is still pressed: free it first");
  base::BaseStatus status;
  status.vehicle_state = base::VehicleState::Estop;
  w.take(base::Measurement(status));
  EXPECT_EQ(release_refusal(w),
            "the emergency stop at the base is still pressed: release it first");
}

}  // namespace
}  // namespace roverd::robot
