// A start without a pose: a place has to win against the others, and against "nowhere in this map".

#include "nav/place/start.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "nav/place/tracker.hpp"
#include "unit/place/shed.hpp"

namespace {

using namespace roverd;
using nav::place::GlobalStart;
using nav::place::Phase;
using nav::place::StartParams;
using nav::place::Told;
using nav::place::Tracker;
using nav::sense::Pose2;

const Pose2 kFrom{2.5, 3.0, 0.0};
const Pose2 kStep{0.1, 0.0, 0.03};

/// @return scans until a place of the shed was decided on; 99: none
int scans_to_decide(double doubt) {
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  tests::Scanner scanner(21);
  GlobalStart start{StartParams{}};
  start.doubt(doubt);
  Pose2 at = kFrom;
  for (int i = 0; i < 30; ++i) {
    const Pose2 step = i > 0 ? kStep : Pose2{};
    at = at * step;
    if (start.feed(*field, scanner.look(tests::shed(), at, 1.0 + 0.1 * i), step)) return i + 1;
  }
  return 99;
}

TEST(GlobalStart, GainsNothingByStandingStill) {
  // Given: a robot that does not move, and a scanner that sees its true place well.
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  tests::Scanner scanner(20);
  GlobalStart start{StartParams{}};
  // When: it looks thirty times.
  double after_one = 0.0;
  for (int i = 0; i < 30; ++i) {
    const auto decided = start.feed(*field, scanner.look(tests::shed(), kFrom, 1.0 + 0.1 * i), {});
    EXPECT_FALSE(decided) << i;
    ASSERT_FALSE(start.places().empty());
    if (i == 0) after_one = start.places().front().stands;
  }
  // Then: the place stands no firmer than after the first scan; a few steps decide.
  EXPECT_GT(after_one, 0.0);
  EXPECT_LE(start.places().front().stands, after_one + 0.5);
  std::optional<Pose2> decided;
  Pose2 at = kFrom;
  for (int i = 0; i < 5 && !decided; ++i) {
    at = at * kStep;
    decided = start.feed(*field, scanner.look(tests::shed(), at, 5.0 + 0.1 * i), kStep);
  }
  EXPECT_TRUE(decided);
}

TEST(GlobalStart, StepsThatTheOdometryDidNotMakeCountAgainstAPlace) {
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  const auto stands = [&](const Pose2& told_step) {
    tests::Scanner scanner(22);
    GlobalStart start{StartParams{}};
    start.feed(*field, scanner.look(tests::shed(), kFrom, 1.0), {});
    start.feed(*field, scanner.look(tests::shed(), kFrom * Pose2{0.2, 0.0, 0.0}, 1.1), told_step);
    return start.places().front().stands;
  };
  EXPECT_GT(stands({0.2, 0.0, 0.0}), stands({0.2, 0.3, 0.0}) + 4.0);
}

TEST(GlobalStart, AsksForMoreWhereAPlaceOfTheMapWasLost) {
  const int at_first = scans_to_decide(1.0);
  const int after_lost = scans_to_decide(4.0);
  EXPECT_LE(at_first, 6);
  EXPECT_GT(after_lost, at_first);
  EXPECT_LE(after_lost, 15) << "and finds it all the same";
}

TEST(GlobalStart, TellsThatNothingInTheMapFits) {
  // Given: the map of the shed, and a drive up and down in another building.
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tests::Scanner scanner(23);
  const auto walls = tests::other_building();
  Told told;
  for (int i = 0; i < 80; ++i) {
    const int turn = i % 60;
    const double x_m = 1.5 + 0.2 * (turn < 30 ? turn : 60 - turn);
    told = tracker.feed(scanner.look(walls, {x_m, 1.7, 0.02 * i}, 1.0 + 0.1 * i),
                        {x_m, 1.7, 0.02 * i});
    // Then: no place is told,
    EXPECT_FALSE(told.fix) << i;
  }
  // and people are asked whether it is the right map.
  EXPECT_EQ(told.phase, Phase::Searching);
  EXPECT_NE(told.reason.find("nothing in the map fits"), std::string_view::npos) << told.reason;
}

}  // namespace
