// The computer's clock is set while the robot drives: by a phone, by the receiver, by years. Times
// on paper change, and nothing else does.

#include "rig.hpp"

namespace roverd::loop {
namespace {

constexpr base::Duration kYear = std::chrono::hours(24 * 365);

/// What happened when, by the monotonic clock, and the way that was driven.
struct Course {
  std::vector<sim::Truth> track;
  std::vector<std::string> events;
  std::vector<std::string> conditions;
  bool finished = false;
};

/// A mission with a corner and a wait, in the middle of which the clock jumps and the receiver is
/// away for a while: time-outs are running when it happens.
Course drive(const std::vector<base::Duration>& jumps) {
  RigOptions o;
  o.seed = 4;
  Rig rig(o);
  auto plan = rig.plan_of({{0, 6}, {6, 6}, {6, 0}});
  std::get<mission::Waypoint>(plan.items[0]).hold_s = 3.0;
  rig.arm_and_start(plan);
  Course course;
  for (const base::Duration& jump : jumps) {
    rig.run(1.5);
    rig.clock_jump += jump;
    rig.run(1.5);
  }
  rig.fault([](sim::Faults& f) { f.gnss_silent = true; });
  rig.run(1.0);
  for (const auto& condition : rig.state()->safety) course.conditions.push_back(condition.id);
  rig.fault([](sim::Faults&) {});
  course.finished = rig.finish(120.0);
  course.track = rig.track;
  for (const auto& event : rig.events) course.events.push_back(event.kind);
  return course;
}

TEST(Clock, JumpsOfYearsBothWaysInTheMiddleOfAMissionChangeNothing) {
  // Given a mission driven by a clock that nobody touches,
  const Course still = drive({{}, {}, {}, {}});
  ASSERT_TRUE(still.finished);
  // when the clock is set forward and back by years, hours and less than a period,
  for (const auto& jumps : std::vector<std::vector<base::Duration>>{
           {30 * kYear, -30 * kYear, {}, {}},
           {-50 * kYear, {}, 20 * kYear, {}},
           {std::chrono::hours(2), -std::chrono::hours(1), std::chrono::seconds(-3),
            std::chrono::milliseconds(-15)}}) {
    const Course jumped = drive(jumps);
    // then the robot drove the very same way, tick by tick, and told the same.
    EXPECT_TRUE(jumped.finished);
    ASSERT_EQ(jumped.track.size(), still.track.size());
    for (std::size_t i = 0; i < still.track.size(); ++i) {
      ASSERT_EQ(jumped.track[i].local.east_m, still.track[i].local.east_m) << "at tick " << i;
      ASSERT_EQ(jumped.track[i].local.north_m, still.track[i].local.north_m) << "at tick " << i;
    }
    EXPECT_EQ(jumped.events, still.events);
    EXPECT_EQ(jumped.conditions, still.conditions);
  }
}

}  // namespace
}  // namespace roverd::loop
