// The table of the failsafes: each row alone, and many at once.

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "robot/safety/made_up.hpp"
#include "robot/safety/safety.hpp"

namespace roverd::robot {
namespace {

std::vector<std::string> ids(const Assessment& a) {
  std::vector<std::string> out;
  for (const auto& c : a.conditions) out.push_back(c.id);
  return out;
}

Assessment assess(const MadeUp& m) {
  return assess(m.facts, m.params, m.now);
}

TEST(Failsafes, NothingIsSeenOnARobotToWhichNothingIsWrong) {
  const MadeUp well;
  const Assessment a = assess(well);
  EXPECT_EQ(ids(a), std::vector<std::string>{});
  EXPECT_EQ(a.response, Response::None);
  EXPECT_EQ(a.disarms, "");
}

TEST(Failsafes, EveryRowSeesWhatItIsThereForAndIsShown) {
  for (const Failsafe& row : failsafes()) {
    ASSERT_NE(row.test, nullptr) << row.id;
    ASSERT_NE(row.provoke, nullptr) << row.id;
    MadeUp m;
    ASSERT_FALSE(row.test(m.facts, m.params, m.now)) << row.id;
    row.provoke(m);
    const auto told = row.test(m.facts, m.params, m.now);
    ASSERT_TRUE(told) << row.id << ": " << row.seen;
    EXPECT_NE(*told, "") << row.id;
    const Assessment a = assess(m);
    const auto shown = ids(a);
    EXPECT_TRUE(std::find(shown.begin(), shown.end(), row.id) != shown.end()) << row.id;
    EXPECT_GE(a.response, row.response) << row.id << ": " << row.seen;
  }
}

TEST(Failsafes, WhatActsByItselfOnlyIsShownByHandAndNothingFollows) {
  int rows = 0;
  for (const Failsafe& row : failsafes()) {
    if (row.acts != Acts::ByItself) continue;
    ++rows;
    MadeUp m;
    row.provoke(m);
    m.facts.autonomous = false;
    const Assessment a = assess(m);
    EXPECT_EQ(ids(a), std::vector<std::string>{std::string(row.id)});
    EXPECT_EQ(a.response, Response::None) << row.id;
    EXPECT_EQ(a.cause, "") << row.id;
  }
  EXPECT_GE(rows, 9);
}

TEST(Failsafes, RowsOfOneIdStandTogetherTheStrongerFirst) {
  std::set<std::string_view> done;
  const Failsafe* before = nullptr;
  for (const Failsafe& row : failsafes()) {
    if (before != nullptr && before->id == row.id) {
      EXPECT_LE(row.response, before->response) << row.id;
      EXPECT_EQ(row.acts, before->acts) << row.id;
    } else {
      EXPECT_TRUE(done.insert(row.id).second) << row.id << " stands in two places";
    }
    before = &row;
  }
}

TEST(Failsafes, EveryRowSaysAllOfItselfForPeople) {
  for (const auto rows : {failsafes(), failsafes_elsewhere()}) {
    for (const Failsafe& row : rows) {
      for (const auto text : {row.id, row.seen, row.after, row.ends, row.over}) {
        EXPECT_FALSE(text.empty()) << row.id;
        EXPECT_EQ(text.find('|'), std::string_view::npos) << row.id;
      }
    }
  }
}

/// Collects what a section lists.
struct Names {
  std::set<std::string> all;
  template <class T, class... More>
  void operator()(const char* name, T&, const More&...) {
    all.insert(name);
  }
};

TEST(Failsafes, TheyNameEveryParameterOfSafetyAndNoOther) {
  SafetyParams p;
  Names known;
  fields(known, p);
  std::set<std::string> named;
  for (const auto rows : {failsafes(), failsafes_elsewhere()}) {
    for (const Failsafe& row : rows) {
      const std::string text = std::string(row.seen) + " " + std::string(row.after);
      for (auto at = text.find('{'); at != std::string::npos; at = text.find('{', at + 1)) {
        named.insert(text.substr(at + 1, text.find('}', at) - at - 1));
      }
    }
  }
  EXPECT_EQ(named, known.all);
}

// ---- several at once ----

/// What the table says of these facts, reckoned from it row by row.
struct Expected {
  Response response = Response::None;
  std::vector<std::string> shown;
};
Expected expected(const MadeUp& m) {
  Expected e;
  for (const Failsafe& row : failsafes()) {
    if (!row.test(m.facts, m.params, m.now)) continue;
    if (acts_now(row, m.facts, m.params, m.now)) e.response = std::max(e.response, row.response);
    if (e.shown.empty() || e.shown.back() != row.id) e.shown.emplace_back(row.id);
  }
  return e;
}

TEST(Failsafes, OfManyAtOnceTheStrongestWinsAndAllAreShownInTheTablesOrder) {
  std::mt19937 random(7);
  const auto rows = failsafes();
  int most = 0;
  std::set<Response> seen;
  for (int round = 0; round < 4000; ++round) {
    MadeUp m;
    m.facts.autonomous = random() % 3 != 0;
    m.facts.armed = random() % 4 != 0;
    m.params.radio_required = random() % 4 != 0;
    const auto count = random() % 8;
    for (unsigned i = 0; i < count; ++i) {
      const auto which = random() % rows.size();
      if (m.world.base && m.world.battery && m.pose) rows[which].provoke(m);
    }
    const Assessment a = assess(m);
    const Expected e = expected(m);
    ASSERT_EQ(a.response, e.response) << "round " << round;
    ASSERT_EQ(ids(a), e.shown) << "round " << round;
    ASSERT_EQ(a.cause.empty(), a.response == Response::None) << "round " << round;
    ASSERT_EQ(assess(m).conditions, a.conditions) << "the same facts, the same words";
    most = std::max(most, static_cast<int>(a.conditions.size()));
    seen.insert(a.response);
  }
  EXPECT_GE(most, 5);
  EXPECT_GE(seen.size(), 6u) << "every response has won once";
}

TEST(Failsafes, TheCauseIsTheFirstOfTheStrongest) {
  MadeUp m;
  m.world.battery->charge_pct = 15.0;
  m.pose->horizontal_sigma_m = 2.5;
  EXPECT_EQ(assess(m).cause, "the position is uncertain by 2.5 m");
  m.facts.base_left = true;
  m.facts.spins = true;
  EXPECT_EQ(assess(m).cause.substr(0, 29), "the base left our control by ");
  m.facts.estop = true;
  EXPECT_EQ(assess(m).cause, "emergency stop is latched");
  EXPECT_EQ(ids(assess(m)), (std::vector<std::string>{"estop", "base_left_control", "wheels_spin",
                                                      "pose_uncertain", "battery_low"}));
}

}  // namespace
}  // namespace roverd::robot
