#include "link/can_options.hpp"

#include <gtest/gtest.h>

namespace roverd::link {
namespace {

TEST(CanOptions, EveryOptionIsReadAndWrittenBack) {
  const std::string text = "?bitrate=250000&up=1&restart_ms=0&only=211+7FF+18FF0001";
  const auto options = parse_can_options(text.substr(1));
  ASSERT_TRUE(options) << options.error().detail;
  EXPECT_EQ(options->bitrate, 250'000u);
  EXPECT_TRUE(options->up);
  EXPECT_EQ(options->restart_ms, 0u);
  EXPECT_EQ(options->only, (std::vector<CanId>{{0x211}, {0x7FF}, {0x18FF0001, true}}));
  EXPECT_EQ(to_string(*options), text);
}

TEST(CanOptions, WithoutAnyNothingIsConfiguredAndEverythingHeard) {
  const auto options = parse_can_options("");
  ASSERT_TRUE(options);
  EXPECT_FALSE(options->configures());
  EXPECT_TRUE(options->only.empty());
  EXPECT_EQ(to_string(*options), "");
}

TEST(CanOptions, ABitRateMeansThatTheInterfaceIsOursToSetUp) {
  EXPECT_TRUE(parse_can_options("bitrate=500000")->configures());
  EXPECT_TRUE(parse_can_options("up=1")->configures());
  EXPECT_FALSE(parse_can_options("up=0&restart_ms=5")->configures());
}

TEST(CanOptions, WhatIsWrongIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"bitrate=9999", "bitrate must be"},
      {"bitrate=1000001", "bitrate must be"},
      {"bitrate=fast", "bitrate must be"},
      {"bitrate=-500000", "bitrate must be"},
      {"restart_ms=60001", "restart_ms must be"},
      {"up=2", "up must be"},
      {"only=", "only: must name"},
      {"only=800", "'800' is no CAN id"},
      {"only=20000000", "'20000000' is no CAN id"},
      {"only=21", "'21' is no CAN id"},
      {"only=211++221", "'' is no CAN id"},
      {"=1", "unknown option ''"},
      {"Up=1", "unknown option 'Up'"},
  };
  for (const auto& [text, problem] : cases) {
    const auto options = parse_can_options(text);
    ASSERT_FALSE(options) << text;
    EXPECT_NE(options.error().detail.find(problem), std::string::npos) << options.error().detail;
  }
}

}  // namespace
}  // namespace roverd::link
