// The scanner's driver: the conversation with the scanner and the states.

#include <algorithm>

#include "unit/sick/bench.hpp"

namespace roverd::sick {
namespace {

TEST(SickDriver, OnlySubscribesUnlessItIsToConfigure) {
  Bench b;
  b.obey(Dialect::A);
  b.wait(40ms);
  EXPECT_EQ(b.texts, std::vector<std::string>{"sEN LMDscandata 1"});
  EXPECT_EQ(b.status().phase, Phase::Opening);
  b.scan(10);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_EQ(b.status().received, 10u);
  EXPECT_EQ(b.status().refused, 0u);
  ASSERT_EQ(b.seen.size(), 10u);
  EXPECT_EQ(b.seen[0]->sensor, "front");
  EXPECT_EQ(b.seen[9]->count, 9u);
  EXPECT_EQ(b.fact("configuration"), "as stored in the scanner");
  EXPECT_EQ(b.fact("dialect"), "CoLa A");
  EXPECT_EQ(b.fact("scan"), "541 beams of 0.5 deg from -45 deg, 50 Hz");
  EXPECT_EQ(b.fact("status"), "ok");
  EXPECT_EQ(b.fact("window"), "clean");
}

TEST(SickDriver, ConfiguresStepByStepAndWaitsUntilItMeasures) {
  Bench b({.configure = true,
           .frequency_hz = 25.0,
           .resolution_deg = 0.25,
           .right_deg = -90.0,
           .left_deg = 90.0,
           .echoes = 2,
           .remission = false});
  b.obey(Dialect::A);
  b.state = 4;
  b.wait(2s);
  const std::vector<std::string> texts{"sEN LMDscandata 0",
                                       "sRN DeviceIdent",
                                       "sRN SerialNumber",
                                       "sRN FirmwareVersion",
                                       "sMN SetAccessMode 03 F4724744",
                                       "sMN mLMPsetscancfg +2500 +1 +2500 -450000 +2250000",
                                       "sWN LMPoutputRange 1 9C4 0 1B7740",
                                       "sWN LMDscandatacfg 03 00 0 1 0 00 00 0 0 0 0 +1",
                                       "sMN LMCstartmeas",
                                       "sRN STlms"};
  ASSERT_GT(b.texts.size(), texts.size());
  EXPECT_TRUE(std::equal(texts.begin(), texts.end(), b.texts.begin()));
  EXPECT_EQ(b.texts.back(), "sRN STlms");
  EXPECT_EQ(b.fact("state"), "rotating");
  EXPECT_EQ(b.status().phase, Phase::Opening);  // for as long as it needs
  b.state = 7;
  b.wait(400ms);
  ASSERT_EQ(b.texts.back(), "sEN LMDscandata 1");
  EXPECT_EQ(b.texts[b.texts.size() - 2], "sMN Run");
  EXPECT_EQ(b.fact("configuration"), "as wanted");
  EXPECT_EQ(b.fact("device"), "LMS111");
  b.scan(2);
  EXPECT_EQ(b.status().phase, Phase::Up);
}

TEST(SickDriver, ARefusalIsNamedAndTheScannerScansWithWhatItHas) {
  Bench b({.configure = true});
  b.obey(Dialect::A);
  const auto obedient = b.answer;
  b.answer = [&](const Telegram& t, const Words& words) {
    if (words.name == "mLMPsetscancfg") return b.say(in_a("sFA 4"));
    if (words.name == "SetAccessMode") return b.say(in_a("sAN SetAccessMode 0"));
    if (words.name == "STlms") return b.say(in_a("sFA 3"));
    obedient(t, words);
  };
  b.wait(1s);
  EXPECT_EQ(b.fact("configuration"),
            "login: refused, scan configuration: local condition failed, measuring state: unknown "
            "variable index");
  EXPECT_EQ(b.count("error from the scanner: local condition failed"), 1u);
  EXPECT_EQ(b.fact("last_error"), "unknown variable index");
  EXPECT_EQ(b.asked.back(), "sEN LMDscandata");
  b.scan(2);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_TRUE(b.status().detail->hazards.empty());
}

TEST(SickDriver, AnAcceptedCallIsWaitedFor) {
  Bench b({.configure = true});
  b.obey(Dialect::A);
  const auto obedient = b.answer;
  b.answer = [&](const Telegram& t, const Words& words) {
    if (words.name == "LMCstartmeas") return b.say(in_a("sMA LMCstartmeas"));
    obedient(t, words);
  };
  b.wait(4s);
  EXPECT_EQ(b.asked.back(), "sMN LMCstartmeas");
  EXPECT_EQ(std::count(b.asked.begin(), b.asked.end(), "sMN LMCstartmeas"), 1);
  b.say(in_a("sAN LMCstartmeas 0"));
  b.wait(200ms);
  EXPECT_EQ(b.asked.back(), "sEN LMDscandata");
}

TEST(SickDriver, AnswersMayComeBetweenScansAndLate) {
  Bench b({.configure = true});
  b.obey(Dialect::A);
  const auto obedient = b.answer;
  b.answer = [&](const Telegram& t, const Words& words) {
    b.scan(1);
    b.say(in_a("sRA LIDinputstate 0"));
    obedient(t, words);
  };
  b.wait(600ms);
  EXPECT_EQ(b.fact("configuration"), "as wanted");
  EXPECT_EQ(b.status().refused, 0u);
}

TEST(SickDriver, TriesTheOtherDialectWhereNobodyAnswers) {
  for (const Dialect speaks : {Dialect::A, Dialect::B}) {
    Bench b({.dialect = speaks == Dialect::A ? "b" : "a"});
    b.obey(speaks);
    b.wait(1500ms);
    EXPECT_EQ(b.asked_in.front(), other(speaks));
    EXPECT_EQ(b.asked_in.back(), speaks);
    b.scan(3, speaks);
    EXPECT_EQ(b.status().phase, Phase::Up) << b.status().reason;
    EXPECT_EQ(b.fact("dialect"), to_string(speaks));
  }
}

TEST(SickDriver, AnAnswerInTheOtherDialectIsEnough) {
  Bench b;
  b.answer = [&](const Telegram& t, const Words&) {
    if (t.dialect == Dialect::A) b.say(Writer(Dialect::B, "sFA", "").u16(1).framed());
    if (t.dialect == Dialect::B) b.say(Writer(Dialect::B, "sEA", "LMDscandata").u8(1).framed());
  };
  b.wait(100ms);
  EXPECT_EQ(b.asked_in, (std::vector{Dialect::A, Dialect::B}));
  EXPECT_EQ(b.fact("configuration"), "as stored in the scanner");
}

TEST(SickDriver, WhoHangsUpWithoutAWordIsAskedInTheOtherDialectNext) {
  Bench b;
  b.wait(40ms);
  ASSERT_EQ(b.asked_in, std::vector{Dialect::A});
  b.driver_end->fail("closed by the scanner");
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  b.wait(700ms);
  EXPECT_EQ(b.asked_in, (std::vector{Dialect::A, Dialect::B}));
}

TEST(SickDriver, NoAnswerAtAllIsSaidAndTriedAgain) {
  Bench b;
  b.wait(2200ms);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "no answer, neither in CoLa A nor in CoLa B");
  EXPECT_FALSE(b.status().link_open);
  b.obey(Dialect::A);
  b.wait(3s);
  b.scan(2);
  EXPECT_EQ(b.status().phase, Phase::Up);
}

TEST(SickDriver, AfterASecondWithoutAScanItConnectsAnew) {
  Bench b;
  b.obey(Dialect::A);
  b.scan(20);
  b.wait(980ms);
  EXPECT_EQ(b.status().phase, Phase::Up);
  b.wait(60ms);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "no scan: the port is silent");
  EXPECT_FALSE(b.status().link_open);
  b.wait(600ms);  // back-off 0.5 s
  EXPECT_EQ(b.status().phase, Phase::Opening);
  EXPECT_EQ(std::count(b.asked.begin(), b.asked.end(), "sEN LMDscandata"), 2);
  b.scan(5);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_EQ(b.seen.back()->count, 24u);  // what came between is not known
}

TEST(SickDriver, WaitsLongerFromTryToTry) {
  Bench b({.silent_after_s = 0.2, .retry_first_s = 0.5, .retry_max_s = 2.0});
  b.obey(Dialect::A);
  b.wait(20s);
  // 0.2 s of silence each, then 0.5, 1, 2, 2, 2 … s
  const auto tries = std::count(b.asked.begin(), b.asked.end(), "sEN LMDscandata");
  EXPECT_GE(tries, 9);
  EXPECT_LE(tries, 12);
}

TEST(SickDriver, StopsAndStartsAgain) {
  Bench b;
  b.obey(Dialect::A);
  b.scan(5);
  b.driver.stop(b.now);
  EXPECT_EQ(b.status().phase, Phase::Down);
  b.driver.restart(b.now);
  b.scan(5);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_EQ(b.asked.back(), "sEN LMDscandata");
}

TEST(SickParams, RefuseWhatTheModelCannotDo) {
  const auto problem = [](const Params& p) {
    const auto valid = validate(p);
    return valid ? "" : valid.error().fields[0].pointer;
  };
  EXPECT_EQ(problem({}), "");
  EXPECT_EQ(problem({.model = "lms"}), "model");
  EXPECT_EQ(problem({.dialect = "c"}), "dialect");
  EXPECT_EQ(problem({.right_deg = 10.0, .left_deg = -10.0}), "right_deg");
  EXPECT_EQ(problem({.configure = true, .frequency_hz = 35.0}), "frequency_hz");
  EXPECT_EQ(problem({.configure = true, .resolution_deg = 0.25}), "resolution_deg");
  EXPECT_EQ(problem({.configure = true, .frequency_hz = 25.0, .resolution_deg = 0.25}), "");
  EXPECT_EQ(
      problem({.model = "lms5xx", .configure = true, .frequency_hz = 100.0, .resolution_deg = 1.0}),
      "");
}

}  // namespace
}  // namespace roverd::sick
