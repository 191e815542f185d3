// The same guarantees for a base of protocol V1.

#include "gate_fixture.hpp"

namespace roverd::gate {
namespace {

/// Sealed: the checksum is put into byte 7.
CanFrame v1(std::uint32_t id, std::initializer_list<int> seven) {
  CanFrame f = frame(id, seven);
  f.len = 8;
  unsigned sum = (id & 0xFFU) + (id >> 8U) + 8U;
  for (std::size_t i = 0; i < 7; ++i) sum += f.data[i];
  f.data[7] = static_cast<std::uint8_t>(sum);
  return f;
}

CanFrame command(int mode, int linear_pct, int angular_pct, int count = 0) {
  return v1(0x130, {mode, 0, linear_pct & 0xFF, angular_pct & 0xFF, 0, 0, count});
}
CanFrame v1_or_v2_state(int vehicle, int mode) {
  return v1(0x151, {vehicle, mode, 0, 0xF5, 0, 0, 3});
}
const CanFrame kMotionFeedback = v1(0x131, {0, 0, 0, 0, 0, 0, 7});

class GateV1Test : public GateTest {
 protected:
  void hear(int mode = 1) {
    gate.saw(kMotionFeedback, now);
    gate.saw(v1_or_v2_state(0, mode), now);
  }
  void ready() {
    gate.permit(true);
    hear();
  }
};

TEST_F(GateV1Test, TheFramesOfTheFactSheetPass) {
  EXPECT_EQ(command(1, 10, 0), frame(0x130, {0x01, 0, 0x0A, 0, 0, 0, 0, 0x44}));
  Gate wide{bunker({.max_linear_step_pct = 100, .max_angular_step_pct = 100})};
  wide.permit(true);
  wide.saw(frame(0x131, {0x01, 0x2C, 0xFF, 0x9C, 0, 0, 0x07, 0x09}), now);
  wide.saw(frame(0x151, {0x00, 0x01, 0x00, 0xF5, 0, 0, 0x03, 0x53}), now);
  EXPECT_TRUE(wide.allows(frame(0x130, {0x01, 0, 0xE7, 0x19, 0, 0, 0x42, 0x7C}), now));
}

TEST_F(GateV1Test, IsSilentByDefault) {
  hear();
  expect_refused(command(1, 1, 0), Refusal::NotPermitted);
  gate.permit(false);
  expect_refused(command(1, 0, 0), Refusal::NotPermitted);
  expect_refused(v1(0x130, {0, 3, 0, 0, 0, 0, 0}), Refusal::NotPermitted);
  expect_refused(v1(0x140, {1, 1, 0, 1, 0, 0, 0}), Refusal::NotPermitted);
}

TEST_F(GateV1Test, AlwaysLetsAStopOut) {
  // Given neither permission nor feedback
  EXPECT_TRUE(gate.allows(command(0, 0, 0), now));
  EXPECT_TRUE(gate.allows(command(0, 0, 0, 1), now)) << "as often as one likes";
  // and given a base in CAN mode that fell silent
  ready();
  now += 10s;
  EXPECT_TRUE(gate.allows(command(1, 0, 0), now));
  EXPECT_TRUE(gate.allows(command(1, 0, 0), now));
}

TEST_F(GateV1Test, MovesOnlyANormalBaseInCanMode) {
  ready();
  for (const auto& [vehicle, mode] : {std::pair{1, 1}, {2, 1}, {7, 1}, {0, 0}, {0, 2}}) {
    gate.saw(v1_or_v2_state(vehicle, mode), now);
    expect_refused(command(1, 5, 0), Refusal::NotReady);
  }
  gate.saw(v1_or_v2_state(0, 1), now);
  EXPECT_TRUE(gate.allows(command(1, 5, -5), now));
}

TEST_F(GateV1Test, LostFeedbackWithdrawsPermission) {
  ready();
  now += 300ms;
  EXPECT_TRUE(gate.allows(command(1, 5, 0), now));
  now += 1ms;
  expect_refused(command(1, 5, 0), Refusal::Stale);
  gate.saw(kMotionFeedback, now);
  EXPECT_TRUE(gate.allows(command(1, 5, 0), now));
  now += 400ms;
  gate.saw(kMotionFeedback, now);
  expect_refused(command(1, 5, 0), Refusal::Stale);
}

TEST_F(GateV1Test, FeedbackWithAWrongChecksumProvesNothing) {
  gate.permit(true);
  CanFrame broken = v1_or_v2_state(0, 1);
  ++broken.data[7];
  gate.saw(broken, now);
  gate.saw(kMotionFeedback, now);
  expect_refused(command(1, 5, 0), Refusal::Stale);
}

TEST_F(GateV1Test, KeepsPercentagesInTheirLimitsAndSteps) {
  ready();
  expect_refused(command(1, 10, 0), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(command(1, 9, 10), now));
  expect_refused(command(1, 9, 21), Refusal::TooSudden);
  EXPECT_TRUE(gate.allows(command(1, 18, 20), now));
  expect_refused(command(1, -10, 0), Refusal::TooSudden);
  for (int pct = 27; pct <= 45; pct += 9) EXPECT_TRUE(gate.allows(command(1, pct, 20), now));
  EXPECT_TRUE(gate.allows(command(1, 50, 30), now));
  expect_refused(command(1, 51, 30), Refusal::TooLarge);
  expect_refused(command(1, 50, 32), Refusal::TooLarge);
  expect_refused(command(1, -128, 0), Refusal::TooLarge);
}

TEST_F(GateV1Test, LetsOnlySealedAndListedContentOut) {
  ready();
  CanFrame unsealed = command(1, 5, 0);
  ++unsealed.data[7];
  expect_refused(unsealed, Refusal::WrongContent);
  expect_refused(v1(0x130, {2, 0, 0, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {1, 0, 5, 0, 1, 0, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {1, 0, 5, 0, 0, 1, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {1, 9, 0, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {1, 3, 5, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {0, 0, 5, 0, 0, 0, 0}), Refusal::WrongContent);
  expect_refused(v1(0x130, {0, 0, 0, 5, 0, 0, 0}), Refusal::WrongContent);
}

TEST_F(GateV1Test, AsksForCanModeAtMostTwiceASecondAndNotWhileAnotherHostDrives) {
  gate.permit(true);
  expect_refused(command(1, 0, 0), Refusal::NotReady);
  hear(2);
  expect_refused(command(1, 0, 0), Refusal::NotReady);
  hear(0);
  EXPECT_TRUE(gate.allows(command(1, 0, 0), now));
  now += 449ms;
  expect_refused(command(1, 0, 0), Refusal::TooOften);
  now += 1ms;
  EXPECT_TRUE(gate.allows(command(1, 0, 0), now));
}

TEST_F(GateV1Test, ClearsOneErrorAtATime) {
  ready();
  EXPECT_TRUE(gate.allows(v1(0x130, {1, 8, 0, 0, 0, 0, 0}), now));
  expect_refused(v1(0x130, {1, 3, 0, 0, 0, 0, 0}), Refusal::TooOften);
  now += 450ms;
  EXPECT_TRUE(gate.allows(v1(0x130, {0, 3, 0, 0, 0, 0, 0}), now));
}

TEST_F(GateV1Test, MovesNobodyWhileBothProtocolsAreHeard) {
  ready();
  EXPECT_TRUE(gate.allows(command(1, 5, 0), now));
  gate.saw(frame(0x221, {0, 0, 0, 0, 0, 0, 0, 0}), now);
  expect_refused(command(1, 5, 0), Refusal::TwoProtocols);
  gate.saw(frame(0x211, {0, 1, 1, 0xE0, 0, 0, 0, 0}), now);
  expect_refused(frame(0x111, {0, 10, 0, 0, 0, 0, 0, 0}), Refusal::TwoProtocols);
  EXPECT_TRUE(gate.allows(command(0, 0, 0), now)) << "but stops";
  EXPECT_TRUE(gate.allows(frame(0x111, {0, 0, 0, 0, 0, 0, 0, 0}), now));
  // The state alone is enough to doubt
  now += 600ms;
  hear();
  expect_refused(command(1, 5, 0), Refusal::TwoProtocols);
  now += 101ms;
  EXPECT_TRUE(gate.allows(command(1, 5, 0), now));
}

TEST_F(GateV1Test, SpeedsOfTheOtherProtocolDoNotCountAsARunningStart) {
  ready();
  EXPECT_TRUE(gate.allows(command(1, 9, 0), now));
  now += 400ms;
  gate.permit(false);
  gate.permit(true);
  gate.saw(frame(0x221, {0, 0, 0, 0, 0, 0, 0, 0}), now);
  gate.saw(frame(0x211, {0, 1, 1, 0xE0, 0, 0, 0, 0}), now);
  expect_refused(frame(0x111, {1, 3, 0, 0, 0, 0, 0, 0}), Refusal::TooSudden);
}

TEST_F(GateV1Test, LetsSealedLightsOutWithinTheirBounds) {
  gate.permit(true);
  for (std::size_t at = 0; at < 6; ++at) {
    std::array<int, 7> b{1, 3, 100, 3, 100, 0, 5};
    ++b[at];
    expect_refused(v1(0x140, {b[0], b[1], b[2], b[3], b[4], b[5], b[6]}), Refusal::WrongContent);
  }
  CanFrame unsealed = v1(0x140, {1, 3, 100, 3, 100, 0, 5});
  ++unsealed.data[7];
  expect_refused(unsealed, Refusal::WrongContent);
  EXPECT_TRUE(gate.allows(v1(0x140, {1, 3, 100, 3, 100, 0, 5}), now));
  now += 14ms;
  expect_refused(v1(0x140, {1, 3, 100, 3, 100, 0, 6}), Refusal::TooOften);
  now += 1ms;
  EXPECT_TRUE(gate.allows(v1(0x140, {1, 3, 100, 3, 100, 0, 6}), now));
}

}  // namespace
}  // namespace roverd::gate
