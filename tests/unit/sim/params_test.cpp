// The simulator's parameters by name, as its configuration file and command line set them.

#include "sim/params.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace roverd::sim {
namespace {

TEST(SimParams, AreSetBySectionAndName) {
  Params p;
  ASSERT_TRUE(set_param(p, "drive.slip", 0.3));
  ASSERT_TRUE(set_param(p, "gnss.profile", std::string("consumer")));
  ASSERT_TRUE(set_param(p, "compass.fitted", false));
  EXPECT_EQ(p.drive.slip, 0.3);
  EXPECT_EQ(p.gnss.profile, "consumer");
  EXPECT_FALSE(p.compass.fitted);
}

TEST(SimParams, BadOnesNameTheWholeKeyAndChangeNothing) {
  Params p;
  EXPECT_EQ(set_param(p, "drive.slipp", 0.3).error().detail, "unknown key drive.slipp");
  EXPECT_EQ(set_param(p, "drives.slip", 0.3).error().detail, "unknown key drives.slip");
  EXPECT_EQ(set_param(p, "slip", 0.3).error().detail, "unknown key slip");
  EXPECT_EQ(set_param(p, "drive.slip", 1.5).error().detail, "drive.slip must lie in 0.0 .. 0.9");
  EXPECT_EQ(set_param(p, "drive.slip", true).error().detail, "drive.slip must be a number");
  EXPECT_EQ(set_param(p, "gnss.profile", std::string("best")).error().detail,
            "gnss.profile must be one of rtk float consumer plain");
  EXPECT_EQ(p.drive.slip, Params{}.drive.slip);
  EXPECT_EQ(p.gnss.profile, "rtk");
}

TEST(SimParams, EveryDefaultLiesInItsOwnRange) {
  Params p;
  for (const auto& info : describe(p)) {
    EXPECT_TRUE(set_param(p, info.name, info.value)) << info.name;
    EXPECT_FALSE(info.description.empty()) << info.name;
  }
  EXPECT_GT(describe(p).size(), 40u);
}

}  // namespace
}  // namespace roverd::sim
