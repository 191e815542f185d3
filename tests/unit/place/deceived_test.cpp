// What a scanner sees that no map shows: mirrors, glass, people who walk through. The place is told
// where it is still sure, and never a wrong one.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "nav/place/tracker.hpp"
#include "unit/place/shed.hpp"

namespace {

using namespace roverd;
using nav::place::Told;
using nav::place::Tracker;
using nav::sense::Pose2;

enum class Eastern { Wall, Mirror, Glass };

/// The shed, whose eastern wall (x = 12 m) is of something else, and people in it.
struct House {
  Eastern eastern = Eastern::Wall;
  std::vector<Pose2> people;

  double range(const Pose2& from, double angle_rad) const {
    const auto walls = tests::shed();
    double range_m = tests::range_m(walls, from.x_m, from.y_m, angle_rad);
    const double to_east_m = (12.0 - from.x_m) / std::cos(angle_rad);
    const bool meets_east = std::abs(range_m - to_east_m) < 1e-6;
    if (meets_east && eastern == Eastern::Glass) {
      return 0.0;  // out into the open
    }
    if (meets_east && eastern == Eastern::Mirror) {
      const Pose2 at{12.0, from.y_m + to_east_m * std::sin(angle_rad), 0.0};
      range_m = to_east_m + tests::range_m(walls, at.x_m, at.y_m, base::kPi - angle_rad);
    }
    for (const Pose2& p : people) {
      const double x = p.x_m - from.x_m;
      const double y = p.y_m - from.y_m;
      const double along_m = x * std::cos(angle_rad) + y * std::sin(angle_rad);
      const double across_m = std::abs(-x * std::sin(angle_rad) + y * std::cos(angle_rad));
      if (across_m < 0.25 && along_m > 0.0) range_m = std::min(range_m, along_m - 0.2);
    }
    return range_m;
  }

  nav::chart::Scan look(const Pose2& at, double time_s) const {
    nav::chart::Scan scan;
    scan.stamp = base::Time{} + base::from_seconds(time_s);
    for (int i = -135; i <= 135; ++i) {
      const double angle = base::rad_from_deg(i);
      const double range_m = range(at, at.yaw_rad + angle);
      if (range_m <= 0.0 || range_m > 20.0) continue;
      scan.beams.push_back({static_cast<float>(range_m * std::cos(angle)),
                            static_cast<float>(range_m * std::sin(angle)), true});
    }
    return scan;
  }
};

struct Counted {
  int fixes = 0;
  double worst_m = 0.0;
};

/// A circle of 1.5 m in the eastern half, 40 steps of 0.3 m.
/// @param people walk up and down through it
Counted drive(Tracker& tracker, House house, bool with_people) {
  Counted out;
  Pose2 at{9.0, 1.2, 0.0};
  for (int i = 0; i < 40; ++i) {
    if (with_people) {
      house.people.clear();
      for (int k = 0; k < 5; ++k) {
        const double phase = 0.4 * i + 1.3 * k;
        house.people.push_back({at.x_m + (1.0 + 0.3 * k) * std::cos(phase),
                                at.y_m + (1.0 + 0.3 * k) * std::sin(phase), 0.0});
      }
    }
    const Told told = tracker.feed(house.look(at, 1.0 + 0.1 * i), at);
    if (told.fix) {
      ++out.fixes;
      out.worst_m = std::max(out.worst_m,
                             std::hypot(told.fix->pose.x_m - at.x_m, told.fix->pose.y_m - at.y_m));
    }
    at = at * Pose2{0.15, 0.0, 0.1};
  }
  return out;
}

Counted told_place(const House& house, bool with_people = false) {
  Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
  tracker.set_pose({9.1, 1.1, 0.05}, 0.3, 0.1);
  return drive(tracker, house, with_people);
}

TEST(DeceivedTracker, AMirrorMovesNothing) {
  const Counted c = told_place({Eastern::Mirror, {}});
  EXPECT_GE(c.fixes, 20);
  EXPECT_LT(c.worst_m, 0.10);
}

TEST(DeceivedTracker, AWallOfGlassMovesNothing) {
  const Counted c = told_place({Eastern::Glass, {}});
  EXPECT_GE(c.fixes, 35);
  EXPECT_LT(c.worst_m, 0.10);
}

TEST(DeceivedTracker, PeopleWhoWalkAroundItMoveNothing) {
  const Counted c = told_place({}, true);
  EXPECT_GE(c.fixes, 20);
  EXPECT_LT(c.worst_m, 0.10);
}

TEST(DeceivedTracker, AStartWithoutAPoseIsRightOrNotToldAtAll) {
  for (const Eastern eastern : {Eastern::Mirror, Eastern::Glass}) {
    for (const bool with_people : {false, true}) {
      Tracker tracker(tests::field_of(tests::shed(), 12.0, 8.0));
      const Counted c = drive(tracker, {eastern, {}}, with_people);
      EXPECT_LT(c.worst_m, 0.3) << static_cast<int>(eastern) << with_people;
    }
  }
}

}  // namespace
