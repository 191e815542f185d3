#include "bunker/tally.hpp"

#include <gtest/gtest.h>

#include "bunker/plausible.hpp"
#include "bunker/watch.hpp"

namespace roverd::bunker {
namespace {

using namespace std::chrono_literals;
using base::Time;

TEST(BunkerTally, CountsByCauseInWords) {
  Tally tally;
  tally.add(Cause::TooShort, 0x221);
  tally.add(Cause::TooShort, 0x221);
  tally.add(Cause::UnknownId, 0x123);
  tally.add(Cause::Remote);
  tally.add(Cause::ErrorFrame);
  tally.add(Cause::Extended);
  tally.add(Cause::Impossible, 0x211, {"battery", 6553.5, " V"});
  tally.add(Cause::Impossible, 0x211, {"battery", 6000.0, " V"});
  tally.add(Cause::Frozen, 0x211);
  const std::map<std::string, std::uint64_t> wanted{
      {"0x221 too short", 2},   {"unknown id 0x123", 1},
      {"remote frame", 1},      {"error frame", 1},
      {"extended id", 1},       {"impossible value in 0x211: battery 6553.5 V", 2},
      {"0x211 count frozen", 1}};
  EXPECT_EQ(tally.words(), wanted);
}

TEST(BunkerTally, AFloodOfIdsDoesNotMakeItGrowNorHideTheRest) {
  Tally tally;
  for (std::uint32_t id = 0; id < 2048; ++id) tally.add(Cause::UnknownId, id);
  tally.add(Cause::TooShort, 0x221);
  const auto words = tally.words();
  EXPECT_EQ(words.size(), Tally::kUnknownIds + 2);
  EXPECT_EQ(words.at("other unknown ids"), 2048 - Tally::kUnknownIds);
  EXPECT_EQ(words.at("0x221 too short"), 1u);
}

TEST(BunkerTally, HasALastLineForEverythingElse) {
  Tally tally;
  for (std::uint32_t id = 0; id < 2048; ++id) tally.add(Cause::TooShort, id);
  EXPECT_EQ(tally.words().size(), Tally::kMost + 1);
  EXPECT_EQ(tally.words().at("other causes"), 2048 - Tally::kMost);
}

TEST(BunkerRates, AreFramesASecondSinceTheLastQuestion) {
  Rates rates;
  Time now = Time{} + 10s;
  rates.words(now);
  for (int i = 0; i < 25; ++i) rates.add(0x221);
  now += 500ms;
  EXPECT_DOUBLE_EQ(rates.words(now).at("0x221"), 50.0);
  rates.add(0x221);
  EXPECT_DOUBLE_EQ(rates.words(now + 100ms).at("0x221"), 50.0) << "too soon to say";
  EXPECT_DOUBLE_EQ(rates.words(now + 500ms).at("0x221"), 2.0);
  EXPECT_DOUBLE_EQ(rates.words(now + 1s).at("0x221"), 0.0) << "silence is told";
  for (std::uint32_t id = 0; id < 100; ++id) rates.add(id);
  EXPECT_EQ(rates.words(now + 2s).size(), Rates::kIds);
}

TEST(BunkerPlausible, ImpossibleValuesAreNamed) {
  const auto what = [](const Message& m) {
    const auto bad = impossible(m, 4.0);
    return bad ? std::string(bad->what) : std::string();
  };
  SystemState s;
  s.battery_v = 100.0;
  EXPECT_EQ(what(s), "");
  s.battery_v = 6553.5;
  EXPECT_EQ(what(s), "battery");
  EXPECT_EQ(what(MotionState{{.linear_mps = -4.0}}), "");
  EXPECT_EQ(what(MotionState{{.linear_mps = 32.0}}), "speed");
  EXPECT_EQ(what(MotionState{{.linear_mps = -32.0}}), "speed");
  EXPECT_EQ(what(MotionState{{.angular_radps = 15.1}}), "turn rate");
  EXPECT_EQ(what(ActuatorFast{1, 32767, 0.0, 0}), "motor speed");
  EXPECT_EQ(what(ActuatorFast{1, 0, -501.0, 0}), "motor current");
  EXPECT_EQ(what(ActuatorSlow{1, 101.0, 20, 20, 0}), "driver supply");
  EXPECT_EQ(what(ActuatorSlow{1, 48.0, 201, 20, 0}), "driver temperature");
  EXPECT_EQ(what(Battery{101, 99, 54.0, 0.0, 20.0}), "charge");
  EXPECT_EQ(what(Battery{100, 255, 54.0, 0.0, 20.0}), "health");
  EXPECT_EQ(what(Battery{100, 99, -0.1, 0.0, 20.0}), "battery");
  EXPECT_EQ(what(Battery{100, 99, 54.0, 501.0, 20.0}), "battery current");
  EXPECT_EQ(what(Battery{100, 99, 54.0, 0.0, -61.0}), "battery temperature");
  EXPECT_EQ(what(Battery{100, 99, 54.0, 0.0, 20.0}), "");
  EXPECT_TRUE(impossible(v1::Message{v1::SystemState{.battery_v = 101.0}}, 4.0));
  EXPECT_TRUE(impossible(v1::Message{v1::MotionState{.linear_mps = 4.1}}, 4.0));
  EXPECT_TRUE(impossible(v1::Message{v1::Motor{.current_a = 501.0}}, 4.0));
  EXPECT_FALSE(impossible(v1::Message{v1::Motor{}}, 4.0));
}

TEST(CountWatch, ACounterThatNeverCountedProvesNothing) {
  CountWatch watch;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(watch.add(0, Time{} + i * 100ms));
}

TEST(CountWatch, ACounterThatStopsCountingIsFrozenAfterASecond) {
  CountWatch watch;
  Time now{};
  for (std::uint8_t c = 253; c != 1; ++c) EXPECT_FALSE(watch.add(c, now));
  now += 1s;
  EXPECT_FALSE(watch.add(0, now));
  now += 1ms;
  EXPECT_TRUE(watch.add(0, now));
  EXPECT_TRUE(watch.frozen());
  EXPECT_FALSE(watch.add(1, now)) << "it counts again";
}

class TurnWatchTest : public ::testing::Test {
 protected:
  /// So many 20 ms readings with this reported turn and this difference of the tracks.
  void turn(int n, double angular_radps, double difference_mps) {
    for (int i = 0; i < n; ++i) {
      now += 20ms;
      watch.motion(angular_radps, now);
      watch.travel(-difference_mps * 0.01, difference_mps * 0.01, now);
    }
  }
  TurnWatch watch;
  Time now = Time{} + 5s;
};

TEST_F(TurnWatchTest, ContradictionOverTwoSecondsOfTurningIsTold) {
  turn(100, 0.5, -0.3);
  EXPECT_FALSE(watch.swapped());
  turn(2, 0.5, -0.3);
  EXPECT_TRUE(watch.swapped());
  // Standing still proves nothing, two seconds of agreement do
  turn(500, 0.0, 0.0);
  EXPECT_TRUE(watch.swapped());
  turn(99, -0.5, -0.3);
  EXPECT_TRUE(watch.swapped());
  turn(3, -0.5, -0.3);
  EXPECT_FALSE(watch.swapped());
}

TEST_F(TurnWatchTest, SlowTurnsAndOldReportsProveNothing) {
  turn(500, 0.09, -0.3);
  turn(500, 0.5, -0.02);
  EXPECT_FALSE(watch.swapped());
  watch.motion(0.5, now);
  now += 201ms;
  for (int i = 0; i < 500; ++i) watch.travel(0.003, -0.003, now += 20ms);
  EXPECT_FALSE(watch.swapped());
}

TEST_F(TurnWatchTest, AMomentOfAgreementBeginsTheCountAnew) {
  turn(90, 0.5, -0.3);
  turn(1, 0.5, 0.3);
  turn(90, 0.5, -0.3);
  EXPECT_FALSE(watch.swapped());
}

}  // namespace
}  // namespace roverd::bunker
