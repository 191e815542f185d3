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
