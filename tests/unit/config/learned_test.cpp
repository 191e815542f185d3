// What the estimator learned, kept over a restart.

#include "config/learned.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd {
namespace {

constexpr base::WallTime kNow{std::chrono::seconds(1'780'000'000)};
constexpr auto kDay = std::chrono::hours(24);

nav::Learned sample() {
  return {nav::LearnedValue{0.92, 0.005}, nav::LearnedValue{base::rad_from_deg(0.3), 0.0003}};
}

TEST(Learned, ComesBackAsItWasAndLessCertainWithAge) {
  const std::string text = learned_text(sample(), "bunker can", kNow);
  const auto soon = learned_from(text, "bunker can", kNow);
  ASSERT_TRUE(soon.odometry_scale && soon.gyro_bias_radps);
  EXPECT_NEAR(soon.odometry_scale->value, 0.92, 1e-9);
  EXPECT_NEAR(soon.odometry_scale->sigma, 0.005, 1e-9);
  EXPECT_NEAR(soon.gyro_bias_radps->value, base::rad_from_deg(0.3), 1e-9);
  const auto later = learned_from(text, "bunker can", kNow + 25 * kDay);
  EXPECT_NEAR(later.odometry_scale->sigma, std::hypot(0.005, 0.025), 1e-6);
  EXPECT_NEAR(later.gyro_bias_radps->sigma, base::rad_from_deg(0.25), 1e-4);
}

TEST(Learned, HowTheVehicleAnswersIsKeptForNinetyDays) {
  nav::Learned known = sample();
  known.delay_s = nav::LearnedValue{0.31, 0.01};
  known.braking_mps2 = nav::LearnedValue{0.4, 0.02};
  const std::string text = learned_text(known, "bunker can", kNow);
  const auto later = learned_from(text, "bunker can", kNow + 89 * kDay);
  ASSERT_TRUE(later.delay_s && later.braking_mps2);
  EXPECT_NEAR(later.delay_s->value, 0.31, 1e-9);
  EXPECT_GT(later.delay_s->sigma, 0.02);
  EXPECT_NEAR(later.braking_mps2->value, 0.4, 1e-9);
  const auto old = learned_from(text, "bunker can", kNow + 91 * kDay);
  EXPECT_FALSE(old.delay_s || old.braking_mps2);
  EXPECT_TRUE(old.odometry_scale);
}

TEST(Learned, WhatACalibrationMeasuredIsKeptForNinetyDaysFromThenOn) {
  nav::Learned known;
  known.acceleration_mps2 = nav::LearnedValue{0.46, 0.02};
  known.yaw_scale = nav::LearnedValue{0.71, 0.004};
  known.pull_1pm = nav::LearnedValue{-0.02, 0.002, 30.0 * 86'400.0};
  known.pivot_m = nav::LearnedValue{-0.06, 0.004};
  const std::string text = learned_text(known, "bunker can", kNow);
  const auto later = learned_from(text, "bunker can", kNow + 59 * kDay);
  ASSERT_TRUE(later.acceleration_mps2 && later.yaw_scale && later.pull_1pm && later.pivot_m);
  EXPECT_NEAR(later.pivot_m->value, -0.06, 1e-9);
  EXPECT_NEAR(later.pivot_m->sigma, std::hypot(0.004, 0.003 * std::sqrt(59.0)), 1e-6);
  EXPECT_NEAR(later.acceleration_mps2->value, 0.46, 1e-9);
  EXPECT_NEAR(later.yaw_scale->value, 0.71, 1e-9);
  EXPECT_GT(later.yaw_scale->sigma, 0.03);
  EXPECT_NEAR(later.pull_1pm->value, -0.02, 1e-9);
  const auto old = learned_from(text, "bunker can", kNow + 61 * kDay);
  EXPECT_FALSE(old.pull_1pm) << "it was thirty days old already";
  EXPECT_TRUE(old.yaw_scale);
}

TEST(Learned, WhatAPersonForgotIsNotInTheFileAnyMore) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("learned_forgotten_" + std::to_string(::getpid()) + ".json");
  nav::Learned known = sample();
  known.yaw_scale = nav::LearnedValue{0.71, 0.004};
  ASSERT_TRUE(write_learned(file, known, "bunker can", kNow));
  nav::Learned forgotten;
  forgotten.delay_s = nav::LearnedValue{0.2, 0.01};  // learned since
  forgotten.forgotten = true;
  ASSERT_TRUE(write_learned(file, forgotten, "bunker can", kNow));
  const auto left = read_learned(file, "bunker can", kNow);
  EXPECT_FALSE(left.yaw_scale || left.odometry_scale);
  EXPECT_TRUE(left.delay_s);
  EXPECT_TRUE(left.gyro_bias_radps) << "the sensor's, not the vehicle's";
  std::filesystem::remove(file);
}

TEST(Learned, IsForgottenWhenItIsTooOld) {
  const std::string text = learned_text(sample(), "bunker can", kNow);
  const auto old = learned_from(text, "bunker can", kNow + 100 * kDay);
  EXPECT_TRUE(old.odometry_scale);
  EXPECT_FALSE(old.gyro_bias_radps);
  EXPECT_FALSE(learned_from(text, "bunker can", kNow + 400 * kDay).odometry_scale);
}

TEST(Learned, OfAnUnknownAgeIsUncertainButNotLost) {
  const std::string text = learned_text(sample(), "bunker can", kNow);
  const auto early = learned_from(text, "bunker can", kNow - 100 * kDay);  // no clock yet
  ASSERT_TRUE(early.odometry_scale);
  EXPECT_GT(early.odometry_scale->sigma, 0.05);
}

TEST(Learned, OfAnotherVehicleOrOfNoneIsNone) {
  const std::string text = learned_text(sample(), "bunker can", kNow);
  EXPECT_FALSE(learned_from(text, "bunker cansock", kNow).odometry_scale);
  for (const char* bad :
       {"", "{", "[]", "null", "{\"vehicle\": 3}", "{\"vehicle\": \"bunker can\"}"}) {
    const auto none = learned_from(bad, "bunker can", kNow);
    EXPECT_FALSE(none.odometry_scale || none.gyro_bias_radps) << bad;
  }
}

TEST(Learned, WhatNoRobotHasIsNotBelieved) {
  const auto with = [](double scale, double sigma) {
    nav::Learned l = sample();
    l.odometry_scale = nav::LearnedValue{scale, sigma};
    return learned_from(learned_text(l, "x", kNow), "x", kNow).odometry_scale.has_value();
  };
  EXPECT_TRUE(with(0.7, 0.01));
  EXPECT_FALSE(with(0.3, 0.01));
  EXPECT_FALSE(with(1.5, 0.01));
  EXPECT_FALSE(with(0.9, 0.0));
  EXPECT_FALSE(with(0.9, -1.0));
}

TEST(Learned, AFileKeepsWhatWasNotLearnedAgain) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("roverd-learned." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "learned.json";
  EXPECT_FALSE(read_learned(file, "x", kNow).odometry_scale);
  ASSERT_TRUE(write_learned(file, sample(), "x", kNow));
  nav::Learned bias_only;
  bias_only.gyro_bias_radps = nav::LearnedValue{0.001, 0.0001};
  ASSERT_TRUE(write_learned(file, bias_only, "x", kNow + kDay));
  const auto both = read_learned(file, "x", kNow + kDay);
  ASSERT_TRUE(both.odometry_scale && both.gyro_bias_radps);
  EXPECT_NEAR(both.odometry_scale->value, 0.92, 1e-9);
  EXPECT_GT(both.odometry_scale->sigma, 0.005);  // a day older
  EXPECT_NEAR(both.gyro_bias_radps->value, 0.001, 1e-9);
  EXPECT_FALSE(write_learned(folder / "none" / "learned.json", sample(), "x", kNow));
  std::filesystem::remove_all(folder);
}

TEST(Learned, TheEstimatorBeginsWithItAndTellsItAgainOnceItIsLearnedAgain) {
  nav::Estimator fresh{nav::EstimateParams{}};
  fresh.recall(sample());
  EXPECT_NEAR(fresh.health().odometry_scale, 0.92, 1e-9);
  EXPECT_FALSE(fresh.learned().odometry_scale);
  EXPECT_FALSE(fresh.learned().gyro_bias_radps);
  nav::Learned silly;
  silly.odometry_scale = nav::LearnedValue{7.0, 0.001};
  fresh.recall(silly);
  EXPECT_NEAR(fresh.health().odometry_scale, 0.92, 1e-9);
}

}  // namespace
}  // namespace roverd
