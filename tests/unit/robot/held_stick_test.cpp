// Whatever begins: a stick that is held already moves nothing until it was let go.

#include <functional>
#include <string>

#include "field.hpp"
#include "robot/modes/manual.hpp"

namespace roverd::robot {
namespace {

using base::Mode;
using base::TeleopPhase;
using std::chrono::milliseconds;

class HeldStick : public Field {
 public:
  HeldStick() {
    run(8.0);
    EXPECT_TRUE(ask(Arm{}));
    EXPECT_TRUE(ask(SetMode{Mode::Manual}));
    let_go();
    EXPECT_TRUE(push());
  }

  /// The same stick, never let go. @return whether it moved the robot at any time
  bool push(double seconds = 1.0) {
    bool moved = false;
    for (double t = 0.0; t < seconds; t += 0.02) {
      robot.request(Drive{{0.5, 0.0}, true}, now + milliseconds(250), {});
      tick();
      moved = moved || moves();
    }
    return moved;
  }
  TeleopPhase phase() const { return state()->teleop.phase; }
};

TEST(HeldStickTest, MovesNothingAfterAnythingThatBegins) {
  struct Case {
    const char* name;
    std::function<void(HeldStick&)> begins;
  };
  const Case cases[] = {
      {"arming",
       [](HeldStick& f) {
         EXPECT_TRUE(f.ask(Disarm{}));
         f.push(0.2);
         EXPECT_TRUE(f.ask(Arm{}));
       }},
      {"another mode and back",
       [](HeldStick& f) {
         EXPECT_TRUE(f.ask(SetMode{Mode::Hold}));
         f.push(0.2);
         EXPECT_TRUE(f.ask(SetMode{Mode::Manual}));
       }},
      {"from one mode of sticks to another",
       [](HeldStick& f) { EXPECT_TRUE(f.ask(SetMode{Mode::Steering})) << "not entered"; }},
      {"the end of an emergency stop",
       [](HeldStick& f) {
         EXPECT_TRUE(f.ask(Estop{"a test"}));
         f.push(0.2);
         EXPECT_TRUE(f.ask(ResetEstop{}));
         EXPECT_TRUE(f.ask(SetMode{Mode::Manual}));
         EXPECT_TRUE(f.ask(Arm{}));
       }},
      {"the radio that gives back",
       [](HeldStick& f) {
         f.swb = base::Switch::Down;
         f.push(0.5);
         f.swb = base::Switch::Up;
       }},
      {"the base that listens again",
       [](HeldStick& f) {
         f.swb = base::Switch::Middle;
         f.push(0.1);
         f.control_mode = base::ControlMode::Radio;
         f.push(0.3);
         f.swb = base::Switch::Up;
         f.control_mode = base::ControlMode::Standby;
         f.push(0.3);
         f.control_mode = base::ControlMode::Can;
       }},
      {"a hold by safety that is over",
       [](HeldStick& f) {
         f.vehicle_state = base::VehicleState::Exception;
         f.push(0.5);
         f.vehicle_state = base::VehicleState::Normal;
         f.push(0.5);
         EXPECT_TRUE(f.ask(SetMode{Mode::Manual}));
       }},
      {"silence of the stream", [](HeldStick& f) { f.run(0.6); }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    HeldStick f;
    c.begins(f);
    f.run(0.02);
    EXPECT_FALSE(f.push(3.0));
    EXPECT_EQ(f.phase(), TeleopPhase::Release);
    EXPECT_NE(f.state()->teleop.reason.find("release the stick first"), std::string::npos);
    EXPECT_TRUE(f.has_condition("release_stick") || f.has_condition("teleop_stale"));
    f.let_go();
    EXPECT_EQ(f.phase(), TeleopPhase::Ready);
    EXPECT_TRUE(f.push());
    EXPECT_EQ(f.phase(), TeleopPhase::Held);
  }
}

TEST(HeldStickTest, AWordFromBeforeWhatBeganDoesNotCount) {
  HeldStick f;
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  const base::Time before = f.now;
  f.run(0.1);
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.robot.request(Drive{{}, false, 1, before}, f.now, {});
  EXPECT_FALSE(f.push());
  f.let_go();
  EXPECT_TRUE(f.push());
}

TEST(Manual, EachSourceMustHaveLetGoItself) {
  Manual m{ManualParams{}};
  base::Time t{};
  const auto hold = [&](std::uint64_t who) { return m.drive({{0.4, 0.0}, true, who, t}, t); };
  const auto free = [&](std::uint64_t who) { m.drive({{}, false, who, t}, t); };
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
  EXPECT_FALSE(hold(1));
  free(1);
  EXPECT_EQ(m.phase(), Manual::Phase::Ready);
  EXPECT_FALSE(hold(2));
  EXPECT_TRUE(hold(1));
  EXPECT_FALSE(hold(2));
  // The second lets go and pushes again while the first drives: not obeyed when that one is done.
  free(2);
  EXPECT_FALSE(hold(2));
  free(1);
  EXPECT_FALSE(hold(2));
  EXPECT_TRUE(hold(1));  // who drove may go on
  free(1);
  free(2);
  EXPECT_TRUE(hold(2));
  // One that leaves has let nothing go.
  m.drive({{}, false, 2, t, true}, t);
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
  EXPECT_EQ(m.step(t, 0.02), base::BodyTwist{});
  EXPECT_FALSE(hold(2));
}

TEST(Manual, LettingGoMeansTheMiddleAndTheDeadMansSwitch) {
  Manual m{ManualParams{}};
  const base::Time t{};
  m.drive({{0.0, 0.0}, true, 1, t}, t);
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
  m.drive({{0.1, 0.0}, false, 1, t}, t);
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
  m.drive({{0.0, -0.1}, false, 1, t}, t);
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
  m.drive({{0.01, -0.01}, false, 1, t}, t);
  EXPECT_EQ(m.phase(), Manual::Phase::Ready);
  m.drive({{0.1, 0.0}, false, 1, t}, t);  // pushed again
  EXPECT_EQ(m.phase(), Manual::Phase::Locked);
}

TEST(Manual, OneMoreThanItRemembersMakesTheOldestLetGoAgain) {
  Manual m{ManualParams{}};
  const base::Time t{};
  for (std::uint64_t who = 1; who <= Manual::kSources + 1; ++who) {
    m.drive({{}, false, who, t}, t);
  }
  EXPECT_EQ(m.released().size(), Manual::kSources);
  EXPECT_FALSE(m.drive({{0.4, 0.0}, true, 1, t}, t));
  EXPECT_TRUE(m.drive({{0.4, 0.0}, true, 2, t}, t));
}

}  // namespace
}  // namespace roverd::robot
