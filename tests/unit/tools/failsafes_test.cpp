// What docs/safety.md says of the failsafes is what the robot judges by.

#include "tools/failsafes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "robot/safety/failsafes.hpp"
#include "source_folder.hpp"

namespace roverd {
namespace {

std::string safety_page() {
  const auto page = tests::in_source("docs/safety.md");
  std::ifstream in(page, std::ios::binary);
  EXPECT_TRUE(in) << page;
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Failsafes, ThePageShowsTheTableByWhichTheRobotJudges) {
  const std::string page = safety_page();
  const auto made = with_failsafes(page);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_TRUE(*made == page)
      << "docs/safety.md is old; build/bin/roverd failsafes --into docs/safety.md";
}

TEST(Failsafes, TheTableHasALineForEachRowAndNamesDefaults) {
  const std::string table = failsafes_table();
  const auto lines = static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n'));
  EXPECT_EQ(lines, 2 + robot::failsafes().size() + robot::failsafes_elsewhere().size());
  EXPECT_NE(table.find("| 0.4 s (`base_timeout_s`) | **hold** |"), std::string::npos) << table;
  EXPECT_NE(table.find("charge is below 8 % (`battery_stop_pct`)"), std::string::npos);
  EXPECT_NE(table.find("(yes (`radio_required`))"), std::string::npos);
  EXPECT_NE(table.find("**slow** by itself"), std::string::npos);
  EXPECT_EQ(table.find('{'), std::string::npos) << "a parameter that is not known";
}

TEST(Failsafes, APageWithoutAPlaceForItIsRefused) {
  EXPECT_FALSE(with_failsafes("# Safety\n"));
  EXPECT_FALSE(with_failsafes(
      "<!-- end of failsafes -->\n<!-- failsafes: written by roverd failsafes -->\n"));
  const auto made = with_failsafes(
      "a\n<!-- failsafes: written by roverd failsafes -->\nof yesterday\n<!-- end of failsafes "
      "-->\nb\n");
  ASSERT_TRUE(made);
  EXPECT_EQ(made->find("of yesterday"), std::string::npos);
  EXPECT_TRUE(made->starts_with("a\n<!-- failsafes"));
  EXPECT_TRUE(made->ends_with("|\n\n<!-- end of failsafes -->\nb\n"));
}

/// "TEST_P(Suite, Name" of all test sources, without what clang-format puts between.
std::string all_tests() {
  std::string all;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(tests::in_source("tests"))) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path(), std::ios::binary);
    for (char c = 0; in.get(c);) {
      if (c != ' ' && c != '\n') all += c;
    }
  }
  return all;
}

TEST(Failsafes, TheTestsThatThePageNamesExist) {
  const std::string page = safety_page();
  const std::string tests = all_tests();
  const std::regex name("`([A-Z][A-Za-z]+)\\.([A-Z][A-Za-z0-9]+)`");
  int named = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), name), end; at != end; ++at) {
    ++named;
    const std::string wanted = "(" + (*at)[1].str() + "," + (*at)[2].str();
    EXPECT_NE(tests.find(wanted + ")"), std::string::npos) << at->str();
  }
  EXPECT_GT(named, 15);
}

TEST(Failsafes, WhatIsWatchedElsewhereIsWatchedInAFileThatExists) {
  for (const robot::Failsafe& row : robot::failsafes_elsewhere()) {
    const auto file = tests::in_source(row.watched_by);
    EXPECT_TRUE(std::filesystem::exists(file)) << row.id << ": " << file;
  }
}

}  // namespace
}  // namespace roverd
