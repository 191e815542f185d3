// Somebody else's plant: its lines, and programs that answer, die, are silent or tell nonsense.

#include <csignal>

#include <gtest/gtest.h>

#include "study/plant_program.hpp"

namespace roverd::study {
namespace {

using namespace std::chrono_literals;

constexpr const char* kPose =
    R"({"east_m": 1, "north_m": 2, "heading_deg": 90, "speed_mps": 0.5, "yaw_rate_radps": 0.2)";

std::string pose(const std::string& more = "") {
  return kPose + more + "}";
}

std::string problem(const std::string& line, bool first = false) {
  const auto said = read_plant_line(line, {}, first);
  return said ? "" : said.error().detail;
}

TEST(PlantLine, APoseIsEnoughAndWheelsThatNeverSlipAreMadeOfIt) {
  const auto said = read_plant_line(pose(), {}, false);
  ASSERT_TRUE(said) << said.error().detail;
  const sim::ForeignState& s = said->state;
  EXPECT_EQ(s.at, (base::EnuPoint{1.0, 2.0}));
  EXPECT_NEAR(s.yaw_rad, 0.0, 1e-12);
  EXPECT_NEAR(s.left_mps, 0.5 - 0.2 * 0.3, 1e-12);
  EXPECT_NEAR(s.right_mps, 0.5 + 0.2 * 0.3, 1e-12);
  EXPECT_FALSE(s.gyro_radps || s.compass_deg || s.fix);
}

TEST(PlantLine, WhatItMeasuresIsTakenAsItIs) {
  const auto said = read_plant_line(
      pose(R"(, "left_mps": 0.7, "gyro_radps": 0.3, "compass_deg": 12, "own_gnss": true,
              "gnss": {"fix": "rtk_float", "east_m": 1.5, "north_m": 2, "sigma_m": 0.3})"),
      {}, true);
  ASSERT_TRUE(said) << said.error().detail;
  EXPECT_TRUE(said->own_gnss);
  EXPECT_EQ(said->state.left_mps, 0.7);
  EXPECT_EQ(said->state.gyro_radps, 0.3);
  EXPECT_EQ(said->state.compass_deg, 12.0);
  ASSERT_TRUE(said->state.fix);
  EXPECT_EQ(said->state.fix->fix, base::FixType::RtkFloat);
  EXPECT_EQ(said->state.fix->at.east_m, 1.5);
}

TEST(PlantLine, NonsenseIsNamed) {
  EXPECT_NE(problem("hello"), "");
  EXPECT_EQ(problem("[1]"), "the line must be one JSON object");
  EXPECT_NE(problem(R"({"east_m": 1})").find("/north_m is required"), std::string::npos);
  EXPECT_NE(problem(pose(R"(, "speed": 1)")).find("/speed"), std::string::npos);
  EXPECT_NE(problem(pose(R"(, "own_gnss": true)")).find("/own_gnss"), std::string::npos);
  EXPECT_NE(problem(pose(R"(, "gnss": {"fix": "best"})")).find("/gnss/fix must be"),
            std::string::npos);
  EXPECT_NE(problem(pose(R"(, "gnss": {"fix": "gps", "east_m": 1})")).find("/gnss/"),
            std::string::npos);
}

TEST(PlantLine, OrdersAreForTracksOrForACar) {
  EXPECT_EQ(order_line({0.01, false, 1.0, 0.5, std::nullopt}, false),
            R"({"t_s":0.01,"brake":false,"speed_mps":1.0,"yaw_rate_radps":0.5})");
  EXPECT_EQ(order_line({0.02, true, 1.0, 0.0, 0.1}, true),
            R"({"t_s":0.02,"brake":true,"speed_mps":1.0,"wheel_rad":0.1})");
}

base::Result<std::unique_ptr<PlantProgram>> begin(const std::string& command,
                                                  base::Duration patience = 5s) {
  (void)std::signal(SIGPIPE, SIG_IGN);
  return PlantProgram::start(command, {}, patience);
}

/// What it tells of the steps after a good hello.
std::string after(const std::string& script, base::Duration patience = 5s) {
  const auto program = begin("read x; echo '" + pose() + "'; " + script, patience);
  EXPECT_TRUE(program) << program.error().detail;
  if (!program) return "";
  for (int i = 0; i < 3; ++i) (*program)->step({});
  EXPECT_EQ((*program)->state().at.east_m, 1.0);
  return (*program)->problem();
}

TEST(PlantProgram, AnswersInTurn) {
  EXPECT_EQ(after("while read x; do echo '" + pose() + "'; done"), "");
}

TEST(PlantProgram, SaysHowItEnded) {
  EXPECT_EQ(after("exit 3"), "the plant program ended with exit code 3");
  EXPECT_EQ(after("kill -9 $$"), "the plant program was killed by signal 9");
  const auto missing = begin("/nowhere/plant 2>/dev/null");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().detail, "the plant program ended with exit code 127");
}

TEST(PlantProgram, IsNotWaitedForForEver) {
  EXPECT_EQ(after("sleep 60", 1s), "the plant program was silent for 1 s");
}

TEST(PlantProgram, NonsenseEndsIt) {
  EXPECT_EQ(after("read x; echo 7; cat >/dev/null"),
            "the plant program answered 7: the line must be one JSON object");
}

}  // namespace
}  // namespace roverd::study
