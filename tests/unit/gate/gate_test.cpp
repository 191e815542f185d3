#include <thread>

#include "gate_fixture.hpp"

namespace roverd::gate {
namespace {

/// 0x111 with these wire steps.
CanFrame motion(int linear, int angular) {
  const auto high = [](int v) { return (v >> 8) & 0xFF; };
  const auto low = [](int v) { return v & 0xFF; };
  return frame(0x111, {high(linear), low(linear), high(angular), low(angular), 0, 0, 0, 0});
}

CanFrame state(int vehicle, int mode) {
  return frame(0x211, {vehicle, mode, 1, 0xE0, 0, 0, 0, 0});
}
const CanFrame kMotionState = frame(0x221, {0, 0, 0, 0, 0, 0, 0, 0});
const CanFrame kCanMode = frame(0x421, {1, 0, 0, 0, 0, 0, 0, 0});
const CanFrame kStandby = frame(0x421, {0, 0, 0, 0, 0, 0, 0, 0});
const CanFrame kClearAll = frame(0x441, {0, 0, 0, 0, 0, 0, 0, 0});

class GateV2Test : public GateTest {
 protected:
  /// A base in CAN mode that answers, and permission.
  void ready() {
    gate.permit(true);
    hear();
  }
  void hear() {
    gate.saw(kMotionState, now);
    gate.saw(state(0, 1), now);
  }
};

TEST_F(GateV2Test, IsSilentByDefault) {
  expect_refused(motion(1, 0), Refusal::NotPermitted);
  expect_refused(kCanMode, Refusal::NotPermitted);
  expect_refused(kClearAll, Refusal::NotPermitted);
  hear();
  expect_refused(motion(1, 0), Refusal::NotPermitted);
  EXPECT_EQ(gate.counts().allowed, 0u);
  EXPECT_EQ(gate.counts().refused_total(), 4u);
}

TEST_F(GateV2Test, LetsMotionOutWhenAllIsWell) {
  ready();
  EXPECT_TRUE(gate.allows(motion(100, -100), now));
  EXPECT_EQ(gate.counts().allowed, 1u);
}

TEST_F(GateV2Test, AlwaysLetsAStopAndStandbyOut) {
  // Given neither permission nor feedback
  EXPECT_TRUE(gate.allows(motion(0, 0), now));
  EXPECT_TRUE(gate.allows(kStandby, now));
  EXPECT_TRUE(gate.allows(kStandby, now)) << "as often as one likes";
  // and given a base in radio mode with a fault
  gate.permit(true);
  gate.saw(state(2, 3), now);
  EXPECT_TRUE(gate.allows(motion(0, 0), now));
  EXPECT_TRUE(gate.allows(kStandby, now));
}

TEST_F(GateV2Test, KnowsOnlyTheListedIds) {
  ready();
  for (const std::uint32_t id :
       {0x000u, 0x110u, 0x112u, 0x131u, 0x141u, 0x151u, 0x211u, 0x41Au, 0x420u, 0x4A0u, 0x7FFu}) {
    expect_refused(frame(id, {0, 0, 0, 0, 0, 0, 0, 0}), Refusal::NotListed);
  }
}

TEST_F(GateV2Test, TheFirmwareMayBeAskedForOncePermittedAndNotTooOften) {
  for (const std::uint32_t id : {0x411u, 0x4A1u}) {
    gate.permit(false);
    expect_refused(frame(id, {1}), Refusal::NotPermitted);
    ready();
    expect_refused(frame(id, {1, 0, 0, 0, 0, 0, 0, 0}), Refusal::WrongLength);
    expect_refused(frame(id, {2}), Refusal::WrongContent);
    EXPECT_TRUE(gate.allows(frame(id, {1}), now));
    now += 449ms;
    expect_refused(frame(id, {1}), Refusal::TooOften);
    now += 1ms;
    EXPECT_TRUE(gate.allows(frame(id, {1}), now));
  }
}

TEST_F(GateV2Test, LetsOnlyPlainFramesOut) {
  ready();
  for (bool CanFrame::*flag : {&CanFrame::extended, &CanFrame::remote, &CanFrame::error}) {
    CanFrame f = motion(0, 0);
    f.*flag = true;
    expect_refused(f, Refusal::NotListed);
  }
}

TEST_F(GateV2Test, LetsOnlyWholeFramesOut) {
  ready();
  CanFrame f = motion(0, 0);
  f.len = 7;
  expect_refused(f, Refusal::WrongLength);
  expect_refused(frame(0x421, {0}), Refusal::WrongLength);
}

TEST_F(GateV2Test, KeepsValuesInTheirLimits) {
  // Given steps as wide as the limits
  Gate wide{bunker({.max_linear_step = 40000, .max_angular_step = 40000})};
  wide.permit(true);
  wide.saw(kMotionState, now);
  wide.saw(state(0, 1), now);
  EXPECT_TRUE(wide.allows(motion(1500, 786), now));
  EXPECT_TRUE(wide.allows(motion(-1500, -786), now));
  EXPECT_FALSE(wide.allows(motion(1501, 0), now));
  EXPECT_FALSE(wide.allows(motion(-1501, 0), now));
  EXPECT_FALSE(wide.allows(motion(0, 787), now));
  EXPECT_FALSE(wide.allows(motion(0, -787), now));
  EXPECT_FALSE(wide.allows(motion(-32768, 0), now));
  EXPECT_EQ(wide.counts().refused[static_cast<std::size_t>(Refusal::TooLarge)], 5u);
}

TEST_F(GateV2Test, LetsNoSidewaysOrSteeringMotionOut) {
  ready();
  expect_refused(frame(0x111, {0, 10, 0, 0, 0, 1, 0, 0}), Refusal::WrongContent);
  expect_refused(frame(0x111, {0, 10, 0, 0, 1, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(frame(0x111, {0, 0, 0, 0, 0, 0, 0, 1}), Refusal::WrongContent);
}

TEST_F(GateV2Test, RefusesASuddenRiseAndAllowsAnySlowingDown) {
  // 0 ─▶ 251 no   0 ─▶ 250 ─▶ 500 yes   500 ─▶ 751 no   500 ─▶ 10 yes
  ready();
  expect_refused(motion(251, 0), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(motion(250, 0), now));
  EXPECT_TRUE(gate.allows(motion(500, 0), now));
  expect_refused(motion(751, 0), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
  expect_refused(motion(0, -251), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(motion(0, -250), now));
  EXPECT_TRUE(gate.allows(motion(0, -500), now));
}

TEST_F(GateV2Test, CountsAReversalFromZero) {
  ready();
  EXPECT_TRUE(gate.allows(motion(200, 0), now));
  EXPECT_TRUE(gate.allows(motion(400, 0), now));
  expect_refused(motion(-251, 0), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(motion(-250, 0), now));
}

TEST_F(GateV2Test, ForgetsTheLastMotionWhenTheBaseDoes) {
  ready();
  EXPECT_TRUE(gate.allows(motion(250, 0), now));
  now += 499ms;
  hear();
  EXPECT_TRUE(gate.allows(motion(500, 0), now));
  // When half a second passes, the base has stopped and a rise begins at zero again
  now += 500ms;
  hear();
  expect_refused(motion(500, 0), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(motion(250, 0), now));
}

TEST_F(GateV2Test, LostMotionFeedbackWithdrawsPermission) {
  ready();
  now += 300ms;
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
  now += 1ms;
  gate.saw(state(0, 1), now);
  expect_refused(motion(10, 0), Refusal::Stale);
  EXPECT_TRUE(gate.allows(motion(0, 0), now));
  gate.saw(kMotionState, now);
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
}

TEST_F(GateV2Test, LostStateFeedbackWithdrawsPermission) {
  ready();
  now += 700ms;
  gate.saw(kMotionState, now);
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
  now += 1ms;
  gate.saw(kMotionState, now);
  expect_refused(motion(10, 0), Refusal::Stale);
}

TEST_F(GateV2Test, FramesThatProveNothingDoNotCountAsFeedback) {
  gate.permit(true);
  CanFrame remote = kMotionState;
  remote.remote = true;
  CanFrame shorter = kMotionState;
  shorter.len = 7;
  gate.saw(state(0, 1), now);
  gate.saw(remote, now);
  gate.saw(shorter, now);
  gate.saw(frame(0x222, {0, 0, 0, 0, 0, 0, 0, 0}), now);
  expect_refused(motion(10, 0), Refusal::Stale);
}

TEST_F(GateV2Test, MovesOnlyANormalBaseInCanMode) {
  ready();
  for (const auto& [vehicle, mode] : {std::pair{1, 1}, {2, 1}, {7, 1}, {0, 0}, {0, 2}, {0, 3}}) {
    gate.saw(state(vehicle, mode), now);
    expect_refused(motion(10, 0), Refusal::NotReady);
  }
  gate.saw(state(0, 1), now);
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
}

TEST_F(GateV2Test, PermissionBeginsWithFreshFrames) {
  ready();
  gate.permit(false);
  expect_refused(motion(10, 0), Refusal::NotPermitted);
  gate.permit(true);
  expect_refused(motion(10, 0), Refusal::Stale);
  gate.saw(kMotionState, now);
  expect_refused(motion(10, 0), Refusal::Stale);
  gate.saw(state(0, 1), now);
  EXPECT_TRUE(gate.allows(motion(10, 0), now));
}

TEST_F(GateV2Test, AsksForCanModeAtMostTwiceASecond) {
  gate.permit(true);
  gate.saw(state(0, 0), now);
  EXPECT_TRUE(gate.allows(kCanMode, now));
  now += 449ms;
  expect_refused(kCanMode, Refusal::TooOften);
  now += 1ms;
  EXPECT_TRUE(gate.allows(kCanMode, now));
}

TEST_F(GateV2Test, AsksOnlyABaseInStandbyForCanMode) {
  gate.permit(true);
  expect_refused(kCanMode, Refusal::NotReady);
  for (const int mode : {1, 2, 3, 4}) {
    gate.saw(state(0, mode), now);
    expect_refused(kCanMode, Refusal::NotReady);
  }
  EXPECT_TRUE(gate.allows(kClearAll, now)) << "errors may be cleared";
  gate.saw(state(0, 0), now);
  EXPECT_TRUE(gate.allows(kCanMode, now));
  // When permission was withdrawn, what the base said before counts no more
  now += 1s;
  gate.permit(false);
  gate.permit(true);
  expect_refused(kCanMode, Refusal::NotReady);
}

TEST_F(GateV2Test, LetsOnlyListedCodesOut) {
  ready();
  expect_refused(frame(0x421, {2, 0, 0, 0, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(frame(0x421, {1, 0, 0, 0, 0, 0, 0, 1}), Refusal::WrongContent);
  expect_refused(frame(0x441, {1, 1, 0, 0, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(frame(0x441, {3, 0, 0, 0, 0, 0, 0, 0}), Refusal::WrongContent);
  EXPECT_TRUE(gate.allows(frame(0x441, {2, 0, 0, 0, 0, 0, 0, 0}), now));
  expect_refused(kClearAll, Refusal::TooOften);
  now += 100ms;
  EXPECT_TRUE(gate.allows(kClearAll, now));
}

TEST_F(GateV2Test, LetsLightsOutWithinTheirBounds) {
  const CanFrame lights = frame(0x121, {1, 3, 100, 3, 100, 0, 0, 77});
  expect_refused(lights, Refusal::NotPermitted);
  gate.permit(true);
  for (std::size_t at = 0; at < 7; ++at) {
    CanFrame f = lights;
    ++f.data[at];
    expect_refused(f, Refusal::WrongContent);
  }
  EXPECT_TRUE(gate.allows(lights, now));
  now += 14ms;
  expect_refused(lights, Refusal::TooOften);
  now += 1ms;
  EXPECT_TRUE(gate.allows(frame(0x121, {0, 0, 0, 0, 0, 0, 0, 78}), now));
  now += 1s;
  CanFrame shorter = lights;
  shorter.len = 7;
  expect_refused(shorter, Refusal::WrongLength);
}

TEST_F(GateV2Test, MayBeUsedByTheLoopAndTheDeviceAtOnce) {
  // For the thread sanitizer; the counts show that no call was lost.
  ready();
  std::thread device([&] {
    for (int i = 0; i < 2000; ++i) gate.saw(kMotionState, now);
  });
  for (int i = 0; i < 2000; ++i) gate.allows(motion(10, 0), now);
  device.join();
  EXPECT_EQ(gate.counts().allowed, 2000u);
}

}  // namespace
}  // namespace roverd::gate
