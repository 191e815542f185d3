// What every drive link is promised, whatever its messages look like. The messages are made by
// hand here, from the protocols' descriptions.

#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "gate_fixture.hpp"

namespace roverd::gate {
namespace {

using Message = std::vector<std::uint8_t>;

Message bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

int whole(double value) {
  return static_cast<int>(std::lround(value));
}

/// One drive link with limits of 1 m/s (growing by 0.2) and 2 (growing by 0.5) for turning.
struct Link {
  const char* name = "";
  std::function<std::vector<Table>()> table;
  std::uint32_t id = 0;  ///< of a CAN frame
  std::function<Message(double speed, double turn, bool drives)> says;
  std::function<void(Gate&, Time)> hear;  ///< all that must arrive; empty: nothing must
  double forgets_s = 0.6;
  bool turn_holds = false;

  friend std::ostream& operator<<(std::ostream& out, const Link& link) { return out << link.name; }
};

constexpr Limits kLimits{.max_speed = 1.0,
                         .max_turn = 2.0,
                         .max_speed_step = 0.2,
                         .max_turn_step = 0.5,
                         .feedback_max_age_s = 0.3};

void vouch(Gate& gate, Time now) {
  gate.saw(now);
}

Message sum_sealed(std::uint32_t id, Message seven) {
  unsigned sum = (id & 0xFFU) + (id >> 8U) + 8U;
  for (const std::uint8_t b : seven) sum += b;
  seven.push_back(static_cast<std::uint8_t>(sum));
  return seven;
}

CanFrame frame_of(std::uint32_t id, const Message& message) {
  CanFrame f;
  f.id = id;
  for (const std::uint8_t b : message) f.data[f.len++] = b;
  return f;
}

Link bunker_v2() {
  return {.name = "bunker_v2",
          .table =
              [] {
                return bunker({1000, 2000, 200, 500});
              },
          .id = 0x111,
          .says =
              [](double speed, double turn, bool) {
                const auto v = static_cast<std::uint16_t>(whole(speed * 1000.0));
                const auto w = static_cast<std::uint16_t>(whole(turn * 1000.0));
                const auto low = [](unsigned x) { return static_cast<std::uint8_t>(x & 0xFFU); };
                return Message{low(v >> 8U), low(v), low(w >> 8U), low(w), 0, 0, 0, 0};
              },
          .hear =
              [](Gate& gate, Time now) {
                gate.saw(frame(0x221, {0, 0, 0, 0, 0, 0, 0, 0}), now);
                gate.saw(frame(0x211, {0, 1, 1, 0xE0, 0, 0, 0, 0}), now);
              },
          .forgets_s = 0.5};
}

Link bunker_v1() {
  return {.name = "bunker_v1",
          .table =
              [] {
                return bunker({.max_linear_pct = 100,
                               .max_angular_pct = 100,
                               .max_linear_step_pct = 20,
                               .max_angular_step_pct = 25});
              },
          .id = 0x130,
          .says =
              [](double speed, double turn, bool drives) {
                const auto pct = [](double x) { return static_cast<std::uint8_t>(whole(x)); };
                return sum_sealed(0x130, {static_cast<std::uint8_t>(drives), 0, pct(speed * 100.0),
                                          pct(turn * 50.0), 0, 0, 9});
              },
          .hear =
              [](Gate& gate, Time now) {
                gate.saw(frame_of(0x131, sum_sealed(0x131, {0, 0, 0, 0, 0, 0, 7})), now);
                gate.saw(frame_of(0x151, sum_sealed(0x151, {0, 1, 0, 0xF5, 0, 0, 3})), now);
              },
          .forgets_s = 0.5};
}

void put_float(Message& into, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  for (unsigned shift : {24U, 16U, 8U, 0U}) {
    into.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
}

Link car(bool feedback_required) {
  return {.name = feedback_required ? "ackermann_that_must_answer" : "ackermann",
          .table = [=] { return ackermann(kLimits, feedback_required); },
          .says =
              [](double speed, double turn, bool drives) {
                Message m{0x10};
                put_float(m, speed);
                m.push_back(0x20);
                put_float(m, turn);
                m.push_back(0x30);
                m.push_back(drives ? 2 : 1);
                return m;
              },
          .hear = vouch,
          .turn_holds = true};
}

Link text() {
  return {.name = "twist_text",
          .table = [] { return twist_text(kLimits); },
          .says =
              [](double speed, double turn, bool drives) {
                char line[64];
                std::snprintf(line, sizeof line, "$RVC,7,%.3f,%.3f,%d", speed, turn, drives);
                unsigned sum = 0;
                for (const char* c = line + 1; *c != 0; ++c) sum ^= static_cast<unsigned>(*c);
                char sealed[80];
                std::snprintf(sealed, sizeof sealed, "%s*%02X\r\n", line, sum);
                return bytes_of(sealed);
              },
          .hear = vouch};
}

Link binary() {
  return {.name = "twist_binary",
          .table = [] { return twist_binary(kLimits); },
          .says =
              [](double speed, double turn, bool drives) {
                Message m{0xA5, 0x5A, 1, 6, 66};
                for (const double x : {speed, turn}) {
                  const auto mm = static_cast<std::uint16_t>(whole(x * 1000.0));
                  m.push_back(static_cast<std::uint8_t>(mm & 0xFFU));
                  m.push_back(static_cast<std::uint8_t>(mm >> 8U));
                }
                m.push_back(drives ? 1 : 0);
                // CRC-16/CCITT-FALSE by shifting whole bytes.
                std::uint16_t crc = 0xFFFF;
                for (std::size_t i = 2; i < m.size(); ++i) {
                  crc = static_cast<std::uint16_t>(crc ^ (m[i] << 8));
                  for (int bit = 0; bit < 8; ++bit) {
                    crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? (crc << 1) ^ 0x1021
                                                                         : crc << 1);
                  }
                }
                m.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
                m.push_back(static_cast<std::uint8_t>(crc >> 8U));
                return m;
              },
          .hear = vouch};
}

Link line() {
  return {.name = "ratio",
          .table = [] { return ratio(kLimits); },
          .says =
              [](double speed, double turn, bool) {
                char text[32];
                std::snprintf(text, sizeof text, "%.3f %.3f\n", speed, turn);
                return bytes_of(text);
              },
          .hear = {}};
}

class EveryLink : public ::testing::TestWithParam<Link> {
 protected:
  const Link& link = GetParam();
  Gate gate{link.table()};
  Time now = Time{} + 100s;

  void hear() {
    if (link.hear) link.hear(gate, now);
  }
  void ready() {
    gate.permit(true);
    hear();
  }
  /// @return why the message stays inside.
  Refusal send(const Message& message) {
    const auto before = gate.counts();
    const bool left = link.id == 0 ? gate.allows(base::Bytes(message), now)
                                   : gate.allows(frame_of(link.id, message), now);
    const auto after = gate.counts();
    EXPECT_EQ(after.allowed - before.allowed, left ? 1u : 0u);
    EXPECT_EQ(after.refused_total() - before.refused_total(), left ? 0u : 1u);
    for (std::size_t i = 0; i < kRefusals; ++i) {
      if (after.refused[i] != before.refused[i]) return static_cast<Refusal>(i);
    }
    return Refusal::None;
  }
  Refusal drive(double speed, double turn) { return send(link.says(speed, turn, true)); }
  Refusal stop() { return send(link.says(0.0, 0.0, false)); }
};

/// Zero speeds may come with the wish to drive.
class LinkWithMode : public EveryLink {};
class LinkThatHolds : public EveryLink {};
class LinkThatAnswers : public EveryLink {};

TEST_P(EveryLink, IsSilentUntilPermittedButAlwaysLetsAStopOut) {
  hear();
  EXPECT_EQ(drive(0.1, 0.0), Refusal::NotPermitted);
  EXPECT_EQ(drive(0.0, 0.1), Refusal::NotPermitted);
  EXPECT_EQ(stop(), Refusal::None);
  ready();
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None);
  gate.permit(false);
  EXPECT_EQ(drive(0.1, 0.0), Refusal::NotPermitted);
  EXPECT_EQ(stop(), Refusal::None);
}

TEST_P(LinkWithMode, ZeroSpeedWithTheWishToDriveIsMotion) {
  hear();
  EXPECT_EQ(drive(0.0, 0.0), Refusal::NotPermitted);
  ready();
  EXPECT_EQ(drive(0.0, 0.0), Refusal::None);
}

TEST_P(LinkWithMode, HalfAStopStaysInside) {
  ready();
  EXPECT_EQ(send(link.says(0.1, 0.0, false)), Refusal::WrongContent);
  EXPECT_EQ(send(link.says(0.0, 0.1, false)),
            link.turn_holds ? Refusal::None : Refusal::WrongContent);
}

TEST_P(EveryLink, SpeedStaysInItsLimitAndGrowsByItsStep) {
  ready();
  EXPECT_EQ(drive(1.01, 0.0), Refusal::TooLarge);
  EXPECT_EQ(drive(-1.01, 0.0), Refusal::TooLarge);
  EXPECT_EQ(drive(0.21, 0.0), Refusal::TooSudden);
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(drive(0.19 * i, 0.0), Refusal::None) << i;
  EXPECT_EQ(drive(1.0, 0.0), Refusal::None) << "the limit itself";
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None) << "to slow down is always allowed";
  EXPECT_EQ(drive(0.32, 0.0), Refusal::TooSudden);
  EXPECT_EQ(drive(0.04, 0.0), Refusal::None);
  EXPECT_EQ(drive(0.23, 0.0), Refusal::None) << "from however little";
  EXPECT_EQ(drive(-0.21, 0.0), Refusal::TooSudden) << "a reversal counts from zero";
  EXPECT_EQ(drive(-0.19, 0.0), Refusal::None);
  EXPECT_EQ(drive(-0.38, 0.0), Refusal::None);
  EXPECT_EQ(stop(), Refusal::None);
  EXPECT_EQ(drive(-0.38, 0.0), Refusal::TooSudden) << "a stop counts as the last one";
}

TEST_P(EveryLink, TurningStaysInItsLimitAndGrowsByItsStep) {
  ready();
  EXPECT_EQ(drive(0.1, 2.02), Refusal::TooLarge);
  EXPECT_EQ(drive(0.1, -2.02), Refusal::TooLarge);
  EXPECT_EQ(drive(0.1, -0.52), Refusal::TooSudden);
  for (int i = 1; i <= 4; ++i) EXPECT_EQ(drive(0.1, -0.5 * i), Refusal::None) << i;
  // A turn rate may fall at once; a wheel that stands somewhere takes a step back like any other.
  EXPECT_EQ(drive(0.1, 0.0), link.turn_holds ? Refusal::TooSudden : Refusal::None);
  EXPECT_EQ(drive(0.1, -1.5), link.turn_holds ? Refusal::None : Refusal::TooSudden);
}

TEST_P(LinkThatHolds, WhatHoldsMayStandInAStopAndStepsFromThereAfterAnySilence) {
  ready();
  EXPECT_EQ(drive(0.1, 0.5), Refusal::None);
  EXPECT_EQ(send(link.says(0.0, 0.9, false)), Refusal::None);
  EXPECT_EQ(send(link.says(0.0, 2.02, false)), Refusal::TooLarge);
  EXPECT_EQ(send(link.says(0.0, 2.0, false)), Refusal::None) << "the limit itself";
  EXPECT_EQ(send(link.says(0.0, 0.9, false)), Refusal::None);
  now += 10s;
  ready();
  EXPECT_EQ(drive(0.1, 0.39), Refusal::TooSudden);
  EXPECT_EQ(drive(0.1, 1.41), Refusal::TooSudden);
  EXPECT_EQ(drive(0.1, 1.39), Refusal::None);
}

TEST_P(EveryLink, AfterASilenceStepsCountFromZero) {
  ready();
  EXPECT_EQ(drive(0.15, 0.0), Refusal::None);
  EXPECT_EQ(drive(0.3, 0.0), Refusal::None);
  now += std::chrono::milliseconds(whole(link.forgets_s * 1000.0) - 1);
  ready();
  EXPECT_EQ(drive(0.45, 0.0), Refusal::None);
  now += std::chrono::milliseconds(whole(link.forgets_s * 1000.0));
  ready();
  EXPECT_EQ(drive(0.3, 0.0), Refusal::TooSudden);
  EXPECT_EQ(drive(0.15, 0.0), Refusal::None);
}

TEST_P(LinkThatAnswers, FeedbackThatWasHeardMustStayFresh) {
  ready();
  now += 300ms;
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None);
  now += 1ms;
  EXPECT_EQ(drive(0.1, 0.0), Refusal::Stale);
  EXPECT_EQ(stop(), Refusal::None);
  hear();
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None);
}

TEST_P(LinkThatAnswers, APermissionBeginsWithFreshFeedback) {
  ready();
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None);
  gate.permit(false);
  gate.permit(true);
  EXPECT_EQ(drive(0.1, 0.0), Refusal::Stale);
  hear();
  EXPECT_EQ(drive(0.1, 0.0), Refusal::None);
}

TEST_P(EveryLink, ANegativeLimitLetsNothingMove) {
  auto tables = link.table();
  for (Table& t : tables) t.motion.values[0].max = -1.0;
  Gate shut{tables};
  shut.permit(true);
  if (link.hear) link.hear(shut, now);
  const Message message = link.says(0.05, 0.0, true);
  EXPECT_FALSE(link.id == 0 ? shut.allows(base::Bytes(message), now)
                            : shut.allows(frame_of(link.id, message), now));
  const Message zero = link.says(0.0, 0.0, false);
  EXPECT_TRUE(link.id == 0 ? shut.allows(base::Bytes(zero), now)
                           : shut.allows(frame_of(link.id, zero), now));
}

TEST_P(EveryLink, LetsOnlyWholeMessagesOut) {
  ready();
  const Message whole_one = link.says(0.1, 0.0, true);
  for (std::size_t size = 0; size < whole_one.size(); ++size) {
    const Refusal why = send({whole_one.begin(), whole_one.begin() + static_cast<long>(size)});
    EXPECT_TRUE(why == Refusal::WrongLength || why == Refusal::WrongContent) << size;
  }
  EXPECT_EQ(send(whole_one), Refusal::None);
}

std::string name_of(const ::testing::TestParamInfo<Link>& told) {
  return told.param.name;
}

INSTANTIATE_TEST_SUITE_P(Drive, EveryLink,
                         ::testing::Values(bunker_v2(), bunker_v1(), car(false), car(true), text(),
                                           binary(), line()),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Drive, LinkWithMode,
                         ::testing::Values(car(false), car(true), text(), binary()), name_of);
INSTANTIATE_TEST_SUITE_P(Drive, LinkThatHolds, ::testing::Values(car(false), car(true)), name_of);
INSTANTIATE_TEST_SUITE_P(Drive, LinkThatAnswers,
                         ::testing::Values(bunker_v2(), bunker_v1(), car(false), car(true), text(),
                                           binary()),
                         name_of);

}  // namespace
}  // namespace roverd::gate
