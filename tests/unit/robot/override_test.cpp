// A hand that holds the guard off.

#include <algorithm>
#include <cmath>

#include "seeing.hpp"

namespace roverd::robot {
namespace {

class Overriding : public Seeing {
 protected:
  /// In MANUAL before a wall that stopped it.
  void stand_before_wall() {
    field.run(8.0);
    ASSERT_TRUE(field.ask(Arm{}));
    ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
    wall_at(2.0);
    field.let_go();
    push(0.5, 0.0, 10.0, false);
    ASSERT_FALSE(field.moves());
  }

  void push(double v, double w, double seconds, bool held_off) {
    Drive d{{v, w}, true};
    d.override_guard = held_off;
    if (held_off) d.who = "anna";
    for (int i = 0; i < seconds * 50.0; ++i) {
      field.robot.request(d, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
  }

  int told(const std::string& kind) const {
    return int(std::count_if(field.events.begin(), field.events.end(),
                             [&](const auto& e) { return e.kind == kind; }));
  }
};

TEST_F(Overriding, ItCreepsTowardsWhatStopsItAndSaysWho) {
  stand_before_wall();
  const double stood_m = driven_m();
  // When the guard is held off,
  push(0.8, 0.0, 1.0, true);
  // then it creeps, tells who did it, and what it does.
  EXPECT_NEAR(field.command.twist.linear_mps, nav::sense::ProtectParams{}.override_mps, 1e-9);
  EXPECT_GT(driven_m(), stood_m + 0.08);
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Overridden);
  EXPECT_EQ(told("guard_overridden"), 1);
  const auto event = std::find_if(field.events.begin(), field.events.end(),
                                  [](const auto& e) { return e.kind == "guard_overridden"; });
  EXPECT_NE(event->detail.find("by anna: something stands"), std::string::npos) << event->detail;
  // And without that it stands at once, and that is told.
  push(0.8, 0.0, 0.1, false);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 1);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
}

TEST_F(Overriding, ItTurnsSlowlyBesideAWall) {
  stand_before_wall();
  push(0.6, 0.0, 2.0, true);  // so near that its corners need the room of the wall
  push(0.0, 0.8, 0.5, false);
  ASSERT_FALSE(field.moves());
  push(0.0, 0.8, 0.5, true);
  const double corner_mps = std::abs(field.command.twist.angular_radps) * std::hypot(0.5115, 0.389);
  EXPECT_NEAR(corner_mps, 0.15, 0.005);
}

TEST_F(Overriding, WhereNothingIsInTheWayItChangesNothing) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  push(0.6, 0.0, 3.0, true);
  EXPECT_NEAR(field.command.twist.linear_mps, 0.6, 0.01);
  EXPECT_EQ(told("guard_overridden"), 0);
}

TEST_F(Overriding, ItEndsWithTheHandTheRadioAndTheEmergencyStop) {
  stand_before_wall();
  // A hand that falls silent.
  push(0.8, 0.0, 0.3, true);
  field.run(0.7);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 1);
  // The radio.
  field.let_go();
  push(0.8, 0.0, 0.3, true);
  ASSERT_TRUE(field.moves());
  field.swb = base::Switch::Middle;
  push(0.8, 0.0, 0.3, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 2);
  field.swb = base::Switch::Up;
  field.run(1.0);
  // The emergency stop.
  field.let_go();
  push(0.8, 0.0, 0.3, true);
  ASSERT_TRUE(field.moves());
  ASSERT_TRUE(field.ask(Estop{"a test"}));
  push(0.8, 0.0, 0.3, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 3);
}

TEST_F(Overriding, WhatDrivesByItselfOverridesNothing) {
  field.drive_mission();
  wall_at(driven_m() + 3.0);
  push(0.5, 0.0, 15.0, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_overridden"), 0);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
}

}  // namespace
}  // namespace roverd::robot
