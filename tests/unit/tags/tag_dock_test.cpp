// Docking at a tag in a closed loop: images ten times a second with the errors that pictures
// showed, an odometry that is a little wrong, a robot that obeys late; judged by the truth.

#include "nav/behave/tag_dock.hpp"

#include <cmath>
#include <deque>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav::tags {
namespace {

using sense::Pose2;

constexpr int kTag = 5;

struct Docking {
  explicit Docking(std::uint64_t seed) : random(seed) {}

  std::mt19937_64 random;
  Pose2 tag{4.0, 1.0, 0.3};  ///< in the world
  Pose2 truth;
  Pose2 odometry{7.0, -3.0, 2.0};
  double slip = 1.02;
  double turn_scale = 1.02;
  double half_view_rad = base::rad_from_deg(35.0);
  bool covered = false;
  bool in_doubt = false;    ///< which way it faces
  bool another = false;     ///< of the same number beside it
  int late_ticks = 0;       ///< images are so much older than they are told to be
  double blind_m = 0.0;     ///< nearer than this to the pose it sees no tag
  bool from_above = false;  ///< it shows well which way the tag faces
  TagDockParams params;
  base::Setting<TagDockParams> set;
  TagBook book;
  TagDock dock{PathParams{}, BehaveParams{}, set};
  base::Time now{std::chrono::hours(1)};
  std::deque<Pose2> was;
  std::deque<base::BodyTwist> pipe = std::deque<base::BodyTwist>(7);
  double speed_mps = 0.0;
  double rate_radps = 0.0;
  double most_aside_m = 0.0;  ///< off the tag's line in the last 0.3 m

  double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }

  /// As a camera of 600 px focal length sees a tag of 0.16 m: corners good to a quarter of a pixel.
  void look() {
    const Pose2 seen = sense::inverse(was.front()) * tag;
    const double range_m = std::hypot(seen.x_m, seen.y_m);
    const bool blind = seen.x_m < params.stand_off_m + blind_m;
    if (covered || (blind_m > 0.0 && blind) || seen.x_m <= 0.1 ||
        std::abs(std::atan2(seen.y_m, seen.x_m)) > half_view_rad) {
      return;
    }
    if (std::abs(seen.yaw_rad) > 1.2 || range_m > 5.0) return;
    TagPlace place;
    place.sigma_range_m = 0.25 * range_m * range_m / (600.0 * 0.16);
    place.sigma_across_m = 0.25 * range_m / 600.0;
    const double slant = std::max(0.15, std::abs(std::sin(seen.yaw_rad)));
    place.sigma_yaw_rad = place.sigma_range_m / (0.16 * slant) * 0.5;
    if (from_above) place.sigma_yaw_rad = 0.01;
    place.yaw_known = place.sigma_yaw_rad < 0.3;
    const double ray = std::atan2(seen.y_m, seen.x_m);
    const double along = normal(place.sigma_range_m);
    const double across = normal(place.sigma_across_m);
    place.pose = {seen.x_m + along * std::cos(ray) - across * std::sin(ray),
                  seen.y_m + along * std::sin(ray) + across * std::cos(ray),
                  base::wrap_rad(seen.yaw_rad + normal(place.sigma_yaw_rad))};
    // One in twenty is the other pose, and it was not noticed.
    if (!from_above && std::uniform_real_distribution<double>(0, 1)(random) < 0.05) {
      place.pose.yaw_rad = base::wrap_rad(2.0 * ray - place.pose.yaw_rad);
    }
    place.id = kTag;
    place.yaw_known = place.yaw_known && !in_doubt;
    TagsSeen image{"front", now, {place}};
    if (another) image.tags.push_back(place);
    (void)book.take(image);
  }

  bool run(double seconds) {
    set.adopt(std::make_shared<const TagDockParams>(params));
    dock.begin({kTag}, now);
    return go_on(seconds);
  }

  bool go_on(double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      sense::Odometry state;
      state.stamp = now;
      state.pose = odometry;
      book.moved(state);
      was.push_back(truth);
      while (was.size() > static_cast<std::size_t>(late_ticks) + 1) was.pop_front();
      if (i % 5 == 0) look();
      Vehicle v;
      v.at = {-400.0, 7.0};  // the position is of no use to it
      v.speed_mps = speed_mps * slip;
      v.yaw_rate_radps = rate_radps * turn_scale;
      pipe.push_back(dock.step({&book, now, odometry}, v, 1.0, 0.02).command);
      speed_mps = pipe.front().linear_mps;
      rate_radps = pipe.front().angular_radps;
      pipe.pop_front();
      now += std::chrono::milliseconds(20);
      truth = truth * sense::along(speed_mps, rate_radps, 0.02);
      odometry = odometry * sense::along(speed_mps * slip, rate_radps * turn_scale, 0.02);
      const Pose2 from = off();
      if (std::abs(from.x_m) < 0.3) most_aside_m = std::max(most_aside_m, std::abs(from.y_m));
      if (dock.state() == TagDock::State::Docked && speed_mps == 0.0) return true;
      if (dock.state() == TagDock::State::Failed) return false;
    }
    return false;
  }
  /// Where it stands, seen from where it should stand.
  Pose2 off() const { return sense::inverse(tag * Pose2{-params.stand_off_m, 0.0, 0.0}) * truth; }
};

//   100 starts 1.5 to 4 m before the tag, up to 40 deg aside, pointing up to 30 deg past it
TEST(TagDock, AHundredStartsEndWithinTwoCentimetresAndADegree) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Docking d(seed);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const double range_m = 2.75 + 1.25 * part(d.random);
    const double aside_rad = base::rad_from_deg(40.0) * part(d.random);
    d.truth = d.tag * Pose2{-range_m * std::cos(aside_rad), range_m * std::sin(aside_rad), 0.0};
    const double to_tag = std::atan2(d.tag.y_m - d.truth.y_m, d.tag.x_m - d.truth.x_m);
    d.truth.yaw_rad = base::wrap_rad(to_tag + base::rad_from_deg(30.0) * part(d.random));
    ASSERT_TRUE(d.run(180.0)) << seed << " " << to_string(d.dock.state()) << " " << d.dock.reason();
    const Pose2 off = d.off();
    const double off_m = std::hypot(off.x_m, off.y_m);
    const double off_deg = std::abs(base::deg_from_rad(off.yaw_rad));
    EXPECT_LT(off_m, 0.02) << seed;
    EXPECT_LT(off_deg, 1.0) << seed;
    EXPECT_LT(d.most_aside_m, 0.05) << seed;
  }
}

TEST(TagDock, WithoutTheTagItDoesNotMoveAndSaysSo) {
  Docking d(1);
  d.truth = d.tag * Pose2{-2.0, 0.0, 0.0};
  d.covered = true;
  const Pose2 before = d.truth;
  EXPECT_FALSE(d.run(10.0));
  EXPECT_EQ(d.dock.state(), TagDock::State::Failed);
  EXPECT_EQ(d.dock.reason(), "the tag is not seen");
  EXPECT_EQ(d.truth.x_m, before.x_m);
}

TEST(TagDock, ATagThatIsCoveredOnTheLineFailsBeforeTheLastStretch) {
  Docking d(2);
  d.truth = d.tag * Pose2{-3.5, 0.0, 0.0};
  d.params.gate_m = 2.5;
  d.params.lost_s = 1.0;
  EXPECT_FALSE(d.run(6.0));
  for (int i = 0; i < 300 && d.dock.state() != TagDock::State::Line; ++i) (void)d.go_on(0.1);
  ASSERT_EQ(d.dock.state(), TagDock::State::Line);
  d.covered = true;
  EXPECT_FALSE(d.go_on(20.0));
  EXPECT_EQ(d.dock.state(), TagDock::State::Failed);
  EXPECT_EQ(d.dock.reason(), "the tag is not seen any more");
  EXPECT_LT(d.off().x_m, -1.0) << "it stands well before the tag";
}

TEST(TagDock, OfTwoTagsOfOneNumberNeitherIsDockedAt) {
  Docking d(3);
  d.truth = d.tag * Pose2{-2.0, 0.0, 0.0};
  d.another = true;
  const Pose2 before = d.truth;
  EXPECT_FALSE(d.run(10.0));
  EXPECT_EQ(d.dock.reason(),
            "two tags of number 5 are seen at once: nobody knows which one is meant");
  EXPECT_EQ(d.truth.x_m, before.x_m);
  EXPECT_GT(d.book.twice(), 10U);
}

//   ├── line ──▶ 4 cm before the pose the tag leaves the picture
TEST(TagDock, WhatWasSeenOnlyWhileItDroveIsNeverCalledDocked) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Docking d(seed);
    d.truth = d.tag * Pose2{-2.5, 0.2, 0.0};
    d.late_ticks = 12;
    d.blind_m = 0.04;
    d.from_above = true;
    EXPECT_FALSE(d.run(180.0)) << seed << " off by " << d.off().x_m;
    EXPECT_EQ(d.dock.reason(), "the tag is not seen any more") << seed;
  }
}

TEST(TagDock, PicturesThatAreLaterThanToldDoNotMakeItStandElsewhere) {
  for (const int ticks : {3, 7, 12}) {
    int docked = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Docking d(seed);
      d.truth = d.tag * Pose2{-2.5, 0.6, -0.2};
      d.late_ticks = ticks;
      if (!d.run(240.0)) continue;
      ++docked;
      EXPECT_LT(std::hypot(d.off().x_m, d.off().y_m), 0.02) << ticks << " " << seed;
      EXPECT_LT(std::abs(base::deg_from_rad(d.off().yaw_rad)), 1.0) << ticks << " " << seed;
    }
    EXPECT_GE(docked, 18) << ticks;
  }
}

TEST(TagDock, ATagWhoseDirectionStaysInDoubtIsNeverCalledDocked) {
  Docking d(4);
  d.truth = d.tag * Pose2{-2.0, 0.1, 0.0};
  d.in_doubt = true;
  EXPECT_FALSE(d.run(180.0));
  EXPECT_EQ(d.dock.state(), TagDock::State::Failed);
  EXPECT_EQ(d.dock.reason(), "which way the tag faces stays in doubt");
}

TEST(TagDock, WhoIsPushedAsideMeanwhileComesOntoTheLineAgain) {
  Docking d(5);
  d.truth = d.tag * Pose2{-2.5, 0.3, 0.0};
  EXPECT_FALSE(d.run(2.0));
  for (int i = 0; i < 300 && d.dock.state() != TagDock::State::Line; ++i) (void)d.go_on(0.1);
  ASSERT_EQ(d.dock.state(), TagDock::State::Line);
  // A hand drives 0.3 m aside, seen by the odometry, and lets go.
  d.dock.interrupt();
  const Pose2 aside{0.0, 0.3, 0.1};
  d.truth = d.truth * aside;
  d.odometry = d.odometry * aside;
  d.speed_mps = d.rate_radps = 0.0;
  EXPECT_TRUE(d.go_on(120.0)) << d.dock.reason();
  EXPECT_LT(std::hypot(d.off().x_m, d.off().y_m), 0.02);
}

TEST(TagBook, AnImageFromBeforeWhatIsRememberedIsCountedAndLeftOut) {
  TagBook book;
  const base::Time now{std::chrono::hours(1)};
  sense::Odometry state;
  state.stamp = now;
  ASSERT_TRUE(book.moved(state));
  TagPlace place;
  place.id = 7;
  place.pose = {1.0, 0.0, 0.0};
  place.sigma_range_m = place.sigma_across_m = place.sigma_yaw_rad = 0.01;
  EXPECT_EQ(book.take({"front", now - std::chrono::seconds(9), {place}}), 0U);
  EXPECT_EQ(book.refused(), 1U);
  EXPECT_EQ(book.find(7), nullptr);
  EXPECT_EQ(book.take({"front", now, {place}}), 1U);
  ASSERT_NE(book.find(7), nullptr);
  EXPECT_EQ(book.find(7)->camera, "front");
}

//   ramp of 5 degrees: the tag hangs upright 0.8 m before the body's origin, 0.6 m over it
TEST(TagBook, OnASlopeATagIsAsFarAsItIsInTheLevelPlan) {
  const double lean = base::rad_from_deg(5.0);
  struct Case {
    sense::Lie3 lie;
    TagPlace seen;
  };
  TagPlace nose_up;
  nose_up.pose = {0.8 * std::cos(lean) + 0.6 * std::sin(lean), 0.0, 0.0};
  nose_up.up_m = 0.6 * std::cos(lean) - 0.8 * std::sin(lean);
  nose_up.into_up = -std::sin(lean);
  TagPlace
      right_down;  // the origin's left is raised: what is above it lies to the left of its axis
  right_down.pose = {0.8, 0.6 * std::sin(lean), 0.0};
  right_down.up_m = 0.6 * std::cos(lean);
  for (const auto& [lie, seen] :
       {Case{{0.0, 0.0, lean, true}, nose_up}, Case{{0.0, lean, 0.0, true}, right_down}}) {
    TagBook book;
    sense::Odometry state;
    state.stamp = base::Time{std::chrono::hours(1)};
    state.lie = lie;
    ASSERT_TRUE(book.moved(state));
    TagPlace place = seen;
    place.id = 7;
    place.yaw_known = true;
    place.sigma_range_m = place.sigma_across_m = place.sigma_yaw_rad = 0.01;
    ASSERT_EQ(book.take({"front", state.stamp, {place}}), 1U);
    const Pose2 told = book.find(7)->track.pose().value();
    EXPECT_NEAR(told.x_m, 0.8, 1e-9);
    EXPECT_NEAR(told.y_m, 0.0, 1e-9);
    EXPECT_NEAR(told.yaw_rad, 0.0, 1e-9);
  }
}

TEST(TagBook, MoreTagsThanItKeepsTakeThePlaceOfTheOldest) {
  TagBook book;
  base::Time now{std::chrono::hours(1)};
  for (int id = 0; id < 40; ++id) {
    sense::Odometry state;
    state.stamp = now;
    ASSERT_TRUE(book.moved(state));
    TagPlace place;
    place.id = id;
    place.pose = {1.0, 0.0, 0.0};
    place.sigma_range_m = place.sigma_across_m = place.sigma_yaw_rad = 0.01;
    ASSERT_EQ(book.take({"front", now, {place}}), 1U);
    now += std::chrono::milliseconds(20);
  }
  EXPECT_EQ(book.all().size(), TagBook::kMost);
  EXPECT_EQ(book.find(7), nullptr);
  EXPECT_NE(book.find(8), nullptr);
}

TEST(TagTrack, OneImageOfTheOtherPoseAtTheBeginIsMendedByTheNextAndMeanwhileItIsNotSteady) {
  TagTrack track;
  base::Time now{std::chrono::hours(1)};
  TagPlace place;
  place.sigma_range_m = 0.02;
  place.sigma_across_m = 0.005;
  place.sigma_yaw_rad = 0.05;
  place.yaw_known = true;
  place.pose = {2.0, 0.0, 0.5};
  TagPlace other = place;
  other.pose.yaw_rad = -0.5;
  EXPECT_TRUE(track.take(other, {}, now));
  // Right, right, right, the other again: those that fit each other count, not any five.
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(track.take(place, {}, now));
  EXPECT_TRUE(track.take(other, {}, now));
  EXPECT_FALSE(track.steady());
  for (int i = 0; i < 5; ++i) track.take(place, {}, now);
  EXPECT_NEAR(track.pose()->yaw_rad, 0.5, 1e-6);
  EXPECT_FALSE(track.steady()) << "it has just begun anew";
  for (int i = 0; i < 4; ++i) track.take(place, {}, now);
  EXPECT_TRUE(track.steady());
}

//   T ◀──── 0.8 m ──── B     5 degrees of the tag's direction are 70 mm sidewards at B
TEST(TagTrack, TheTagsDirectionIsAPartOfHowWellThePlaceBeforeItIsKnown) {
  TagTrack track;
  TagPlace place;
  place.sigma_range_m = place.sigma_across_m = 0.002;
  place.sigma_yaw_rad = base::rad_from_deg(5.0);
  place.yaw_known = true;
  place.pose = {0.8, 0.0, 0.0};
  ASSERT_TRUE(track.take(place, {}, base::Time{std::chrono::hours(1)}));
  const auto [near_m, near_rad] = track.sigma_before({});
  EXPECT_GT(near_m, 0.8 * base::rad_from_deg(5.0));
  EXPECT_NEAR(near_m / 0.8, near_rad, 0.02 * near_rad);
  EXPECT_LT(track.sigma_from({}).first, 0.005) << "how far it is, is known well";
}

TEST(TagTrack, ManyImagesMakeItSurerAndOneWrongOneIsLeftOut) {
  TagTrack track;
  base::Time now{std::chrono::hours(1)};
  TagPlace place;
  place.sigma_range_m = 0.02;
  place.sigma_across_m = 0.005;
  place.sigma_yaw_rad = 0.05;
  place.yaw_known = false;
  place.pose = {2.0, 0.5, 0.1};
  EXPECT_TRUE(track.take(place, {}, now));
  EXPECT_FALSE(track.direction_known());
  EXPECT_NEAR(track.pose()->yaw_rad, std::atan2(0.5, 2.0), 1e-9) << "it faces who saw it";
  place.yaw_known = true;
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(track.take(place, {}, now));
  ASSERT_TRUE(track.direction_known());
  EXPECT_LT(track.sigma_yaw_rad(), 0.02);
  TagPlace wrong = place;
  wrong.pose.yaw_rad = -0.6;
  EXPECT_FALSE(track.take(wrong, {}, now));
  EXPECT_NEAR(track.pose()->yaw_rad, 0.1, 1e-3);
  // The tag was moved: after five it is believed.
  for (int i = 0; i < 5; ++i) track.take(wrong, {}, now);
  EXPECT_NEAR(track.pose()->yaw_rad, -0.6, 1e-6);
}

}  // namespace
}  // namespace roverd::nav::tags
