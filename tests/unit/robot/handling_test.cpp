// What was learned takes the place of what was set, for as long as it is known.

#include "robot/handling.hpp"

#include <gtest/gtest.h>

#include "field.hpp"

namespace roverd::robot {
namespace {

TEST(Handling, WhatWasLearnedBeforeARestartIsUsedAndTold) {
  Field field;
  nav::Learned known;
  known.delay_s = nav::LearnedValue{0.3, 0.01};
  known.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  field.robot.recall(known);
  field.tick();
  const base::VehicleLearned told = field.robot.snapshot()->learned;
  EXPECT_NEAR(told.delay_used_s, 0.3, 1e-9);
  EXPECT_NEAR(told.delay_set_s, nav::TrackParams{}.delay_s, 1e-9);
  EXPECT_NEAR(told.braking_used_mps2, 0.368, 1e-9);
  EXPECT_NEAR(told.braking_set_mps2, nav::SpeedParams{}.decel_mps2, 1e-9);
}

TEST(Handling, WhatIsMerelyRememberedIsNotKeptAnew) {
  Field field;
  nav::Learned known;
  known.delay_s = nav::LearnedValue{0.3, 0.01};
  known.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  field.robot.recall(known);
  for (int i = 0; i < 60; ++i) field.tick();
  const auto kept = field.robot.learned();
  ASSERT_TRUE(kept);
  EXPECT_FALSE(kept->delay_s);
  EXPECT_FALSE(kept->braking_mps2);
}

TEST(Handling, AParameterThatIsChangedKeepsWhatWasLearned) {
  const ParameterSet set{Config{}};
  Handling handling{set};
  nav::Learned known;
  known.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  handling.recall(known);
  handling.see({}, set);
  EXPECT_NEAR(set.path->speed.decel_mps2, 0.368, 1e-9);
  Config next;
  next.speed.decel_mps2 = 0.3;
  ParameterSet other = set;
  other.adopt(std::make_shared<const Config>(next));
  handling.see({}, other);
  EXPECT_NEAR(other.path->speed.decel_mps2, 0.3, 1e-9);
  EXPECT_NEAR(handling.learned().braking_set_mps2, 0.3, 1e-9);
  next.speed.decel_mps2 = 0.8;
  other.adopt(std::make_shared<const Config>(next));
  handling.see({}, other);
  EXPECT_NEAR(other.path->speed.decel_mps2, 0.368, 1e-9);
}

TEST(Handling, WallsAndLandmarksAreDrivenByWhatWasLearnedToo) {
  // Given brakes that are worn, a slow base, and gains of a wall's own
  Config config;
  config.wall.gains.offset = 4.0;
  const ParameterSet set{config};
  Handling handling{set};
  nav::Learned known;
  known.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  known.delay_s = nav::LearnedValue{0.3, 0.01};
  handling.recall(known);
  // When
  handling.see({}, set);
  // Then
  for (const auto& path : {set.marks.wall_path, set.marks.landmark_path}) {
    EXPECT_NEAR((*path)->speed.decel_mps2, 0.368, 1e-9);
    EXPECT_NEAR((*path)->track.delay_s, 0.3, 1e-9);
  }
  EXPECT_NEAR((*set.marks.wall_path)->track.settle_min_m,
              0.5 * (*set.marks.landmark_path)->track.settle_min_m, 1e-9);
  // And again once the parameters are set anew
  ParameterSet other = set;
  other.adopt(std::make_shared<const Config>(config));
  EXPECT_NEAR((*other.marks.wall_path)->speed.decel_mps2, nav::SpeedParams{}.decel_mps2, 1e-9);
  handling.see({}, other);
  EXPECT_NEAR((*other.marks.wall_path)->speed.decel_mps2, 0.368, 1e-9);
}

TEST(Handling, SpeedingUpThatWasLearnedBoundsThePlan) {
  const ParameterSet set{Config{}};
  Handling handling{set};
  nav::Learned known;
  known.acceleration_mps2 = nav::LearnedValue{0.5, 0.02};
  handling.recall(known);
  handling.see({}, set);
  EXPECT_NEAR(set.path->speed.accel_mps2, 0.46, 1e-9);
  EXPECT_NEAR(handling.learned().acceleration_used_mps2, 0.46, 1e-9);
  handling.forget();
  handling.see({}, set);
  EXPECT_NEAR(set.path->speed.accel_mps2, nav::SpeedParams{}.accel_mps2, 1e-9);
}

TEST(Handling, WhatAPersonKeptTakesThePlaceOfWhatWasLearned) {
  const ParameterSet set{Config{}};
  Handling handling{set};
  nav::Learned before;
  before.delay_s = nav::LearnedValue{0.3, 0.01};
  before.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  handling.recall(before);
  nav::Learned measured;
  measured.delay_s = nav::LearnedValue{0.2, 0.01};
  handling.adopt(measured);
  handling.see({}, set);
  EXPECT_NEAR(handling.learned().delay_used_s, 0.2, 1e-9);
  EXPECT_NEAR(handling.learned().braking_used_mps2, 0.368, 1e-9) << "not measured: as before";
}

TEST(Handling, BrakesThatAreWorseThanTheFenceReliesOnCountForTheFence) {
  const ParameterSet set{Config{}};
  Handling handling{set};
  EXPECT_EQ(handling.braking_mps2(0.5), 0.5);
  nav::Learned known;
  known.braking_mps2 = nav::LearnedValue{0.3, 0.02};
  handling.recall(known);
  EXPECT_NEAR(handling.braking_mps2(0.5), 0.27, 1e-9);
  EXPECT_EQ(handling.braking_mps2(0.2), 0.2);
}

}  // namespace
}  // namespace roverd::robot
