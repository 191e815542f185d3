// What the checks of a mission know of the guard: by the parameters of now.
#include "api/profile.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "api/json/words.hpp"
#include "nav/sense/params.hpp"
#include "robot/config.hpp"

namespace roverd::api {
namespace {

//   A cell may hold its thing anywhere: of the middle of one the guard keeps half a diagonal more.
TEST(ProfileTest, TheRoomBesideAWallIsWhatTheGuardKeepsOfTheCellsItSees) {
  robot::Config config;
  config.vehicle.width_m = 0.8;
  config.protect.side_m = 0.08;
  Profile profile;
  profile.guard = {.back_m = 0.5, .cell_m = 0.05};
  take_parameters(profile, config);
  EXPECT_NEAR(profile.limits.room_m, 0.4 + 0.08 + 0.0354, 1e-4);
  EXPECT_EQ(profile.guard->back_m, 0.5);
  EXPECT_EQ(profile.guard->cell_m, 0.05);
  EXPECT_EQ(profile.guard->side_m, 0.08);
}

TEST(ProfileTest, WhereRaysStandInForTheGuardNoRoomIsKnownAndWithoutAGuardNone) {
  robot::Config config;
  Profile profile;
  profile.guard = {.back_m = 0.5, .cell_m = 0.05};
  config.rays.enabled = config.rays.instead = true;
  take_parameters(profile, config);
  EXPECT_EQ(profile.limits.room_m, 0.0);
  Profile blind;
  take_parameters(blind, config);
  EXPECT_EQ(blind.limits.room_m, 0.0);
}

TEST(ProfileTest, WhetherItCreepsIntoWhatNobodyHasSeenFollowsTheParameters) {
  robot::Config config;
  Profile profile;
  profile.guard = {.back_m = 0.5, .cell_m = 0.05};
  config.protect.creep_back_mps = 0.0;
  config.protect.creep_turn_radps = 0.1;
  take_parameters(profile, config);
  EXPECT_FALSE(profile.limits.creeps_back);
  EXPECT_TRUE(profile.limits.creeps_turning);
  config.protect.creep_back_mps = 0.1;
  take_parameters(profile, config);
  EXPECT_TRUE(profile.limits.creeps_back);
}

}  // namespace
}  // namespace roverd::api
