// After the radio had the robot only a mission goes on by itself.

#include "field.hpp"
#include "robot/modes/held_by_radio.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::Switch;

TEST(HeldByRadio, WaitsFromTheTakeOverUntilAWordIsSaid) {
  HeldByRadio held;
  EXPECT_FALSE(held.waits());
  held.go_on();
  EXPECT_FALSE(held.waits());
  held.take("goto");
  EXPECT_TRUE(held.waits());
  EXPECT_EQ(held.why(), "the radio took over: the goto waits until it is resumed");
  held.go_on();
  EXPECT_FALSE(held.waits());
}

GoTo north(double metres) {
  GoTo g;
  g.at = kFrame.to_global({0.0, metres});
  return g;
}

SetTarget walker(const Field& f) {
  SetTarget t;
  t.at = kFrame.to_global({0.0, 30.0});
  t.asked = f.now;
  return t;
}

/// Armed, and at a place from which there is a way home.
void begin(Field& f) {
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(north(8.0)));
  f.run(25.0);
  ASSERT_EQ(f.state()->activity.state, ActivityState::Reached) << f.state()->activity.reason;
}

void take_over_and_release(Field& f) {
  f.swb = Switch::Middle;
  f.run(1.0);
  EXPECT_EQ(f.state()->control, base::Driver::Radio);
  EXPECT_FALSE(f.moves());
  f.swb = Switch::Up;
}

struct Case {
  const char* name;
  Mode mode;
  Command (*command)(const Field&);
};
const Case kCases[] = {
    {"goto", Mode::Guided, [](const Field&) -> Command { return north(20.0); }},
    {"move", Mode::Guided,
     [](const Field&) -> Command {
       MoveBy m;
       m.forward_m = 5.0;
       return m;
     }},
    {"return", Mode::Rtl, [](const Field&) -> Command { return SetMode{Mode::Rtl}; }},
    {"retrace", Mode::SmartRtl, [](const Field&) -> Command { return SetMode{Mode::SmartRtl}; }},
    {"dock", Mode::Dock,
     [](const Field&) -> Command {
       SetMode dock{Mode::Dock, north(20.0)};
       dock.goal->yaw_rad = base::kPi / 2.0;
       return dock;
     }},
};

class TakenOver : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Modes, TakenOver, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST_P(TakenOver, WaitsForAWordAndGoesOnFromThere) {
  Field f;
  begin(f);
  const Case& c = GetParam();
  const auto begun = f.ask(c.command(f));
  ASSERT_TRUE(begun) << begun.error().detail;
  f.run(2.0);
  ASSERT_TRUE(f.moves());
  take_over_and_release(f);
  for (int i = 0; i < 250; ++i) {
    f.tick();
    ASSERT_FALSE(f.moves());
  }
  EXPECT_EQ(f.state()->mode, c.mode);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Held);
  EXPECT_EQ(f.state()->activity.kind, c.name);
  EXPECT_EQ(f.state()->activity.reason,
            "the radio took over: the " + std::string(c.name) + " waits until it is resumed");
  EXPECT_EQ(f.state()->speed_reason, "held");
  EXPECT_TRUE(f.has_event("activity_held"));
  const auto id = f.state()->activity.id;
  ASSERT_TRUE(f.ask(ResumeActivity{}));
  f.run(2.0);
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.state()->activity.id, id) << "the same goes on";
  EXPECT_EQ(f.state()->activity.state, ActivityState::Driving);
  EXPECT_EQ(f.state()->activity.reason.find("radio"), std::string::npos);
  EXPECT_FALSE(f.ask(ResumeActivity{})) << "nothing waits any more";
}

TEST_P(TakenOver, EndsWithWhatEndsEverything) {
  for (const Command& end :
       {Command{SetMode{Mode::Hold}}, Command{Disarm{}}, Command{Estop{"x"}}}) {
    Field f;
    begin(f);
    ASSERT_TRUE(f.ask(GetParam().command(f)));
    f.run(1.0);
    take_over_and_release(f);
    f.run(1.0);
    ASSERT_TRUE(f.ask(end));
    EXPECT_EQ(f.state()->activity.state, ActivityState::Failed);
    const auto refused = f.ask(ResumeActivity{});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().detail, "nothing was interrupted by the radio");
    f.run(1.0);
    EXPECT_FALSE(f.moves());
  }
}

TEST(TakenOverOnce, APursuitWaitsThoughItsTargetIsToldOnAndOn) {
  Field f;
  begin(f);
  ASSERT_TRUE(f.ask(walker(f)));
  ASSERT_TRUE(f.ask(SetMode{Mode::Follow}));
  const auto tell = [&f](double seconds) {
    for (double t = 0.0; t < seconds; t += 0.2) {
      ASSERT_TRUE(f.ask(walker(f)));
      f.run(0.18);
    }
  };
  tell(2.0);
  ASSERT_TRUE(f.moves());
  f.swb = Switch::Middle;
  tell(1.0);
  f.swb = Switch::Up;
  tell(3.0);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->activity.state, ActivityState::Held);
  ASSERT_TRUE(f.ask(SetMode{Mode::Follow})) << "choosing the mode again is a word too";
  tell(2.0);
  EXPECT_TRUE(f.moves());
}

TEST(TakenOverOnce, AStreamOfHeadingsIsNoWordOfAPerson) {
  Field f;
  begin(f);
  GoTo ahead;
  ahead.yaw_rad = base::kPi / 2.0;
  ahead.speed_mps = 0.4;
  ASSERT_TRUE(f.ask(ahead));
  f.run(1.0);
  ASSERT_TRUE(f.moves());
  take_over_and_release(f);
  for (int i = 0; i < 10; ++i) {
    const auto refused = f.ask(ahead);
    ASSERT_FALSE(refused);
    f.run(0.1);
    EXPECT_FALSE(f.moves());
  }
  ASSERT_TRUE(f.ask(ResumeMission{})) << "no mission waits: it is meant";
  ASSERT_TRUE(f.ask(ahead));
  f.run(0.5);
  EXPECT_TRUE(f.moves());
}

TEST(TakenOverOnce, AnotherGoalReplacesWhatWaits) {
  Field f;
  begin(f);
  ASSERT_TRUE(f.ask(north(20.0)));
  f.run(1.0);
  take_over_and_release(f);
  f.run(1.0);
  ASSERT_TRUE(f.ask(north(12.0)));
  f.run(2.0);
  EXPECT_TRUE(f.moves());
  EXPECT_FALSE(f.ask(ResumeActivity{}));
}

TEST(TakenOverOnce, AGoalThatIsReachedOrNotThereIsNotHeld) {
  Field f;
  begin(f);
  take_over_and_release(f);
  f.run(1.0);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Reached);
  EXPECT_FALSE(f.has_event("activity_held"));
}

TEST(TakenOverOnce, AMissionGoesOnByItself) {
  Field f;
  f.drive_mission();
  take_over_and_release(f);
  f.run(2.0);
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Auto);
  EXPECT_FALSE(f.has_event("activity_held"));
}

TEST(TakenOverOnce, ResumeOfTheMissionMeansTheMissionWhereOneWaits) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(north(12.0)));
  f.run(1.0);
  take_over_and_release(f);
  f.run(1.0);
  ASSERT_TRUE(f.ask(ResumeMission{}));
  EXPECT_EQ(f.state()->mode, Mode::Auto);
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_FALSE(f.ask(ResumeActivity{}));
}

}  // namespace
}  // namespace roverd::robot
