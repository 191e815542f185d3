// The operator in the field: everything is done with the transmitter in the hand, through real
// frames, while the robot drives.

#include "rig.hpp"
#include "robot/compile.hpp"

namespace roverd::loop {
namespace {

using base::Switch;

class RadioLoop : public testing::Test {
 protected:
  Rig rig{{}};
  sim::Radio radio;
  mission::Plan plan;
  std::int64_t revision = 1;

  /// Throws what `change` sets, and waits until it was acted upon.
  template <class F>
  void hand(F change) {
    change(radio);
    rig.plant.set_radio(radio);
    rig.run(0.3);
    save_edits();
  }

  /// The store's part: keeps what the robot asks for and hands it back, some ticks later.
  void save_edits() {
    std::vector<robot::MissionEdit> edits;
    rig.robot.edits().take(edits);
    for (const robot::MissionEdit& edit : edits) {
      robot::ReviseMission revise;
      revise.kind = edit.kind;
      revise.from_id = edit.mission_id;
      revise.from_revision = edit.revision;
      if (edit.kind == robot::EditKind::AddWaypoint) {
        mission::Waypoint w;
        w.at = edit.at;
        plan.items.emplace_back(w);
        revise.item = static_cast<int>(plan.items.size());
      } else if (edit.kind == robot::EditKind::RemoveItem) {
        revise.item = edit.item.value_or(static_cast<int>(plan.items.size()));
        plan.items.erase(plan.items.begin() + revise.item - 1);
      } else {
        plan.items.clear();
      }
      if (!plan.items.empty()) {
        auto compiled = rig.robot.compile({"m1", ++revision, plan});
        ASSERT_TRUE(compiled) << compiled.error().detail;
        revise.mission = *compiled;
      }
      const auto done = rig.ask(std::move(revise));
      ASSERT_TRUE(done) << done.error().detail;
    }
  }

  void tap_swa() {
    hand([](sim::Radio& r) { r.swa = Switch::Down; });
    hand([](sim::Radio& r) { r.swa = Switch::Up; });
  }
};

TEST_F(RadioLoop, AMissionIsTaughtByHandAndThenDriven) {
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->ready_to_arm; }, 30.0));
  EXPECT_TRUE(rig.events.empty() || !rig.has_event("radio_action"));  // nothing was thrown yet
  // The sticks lead it forward; a waypoint where it started, and one every few metres.
  for (int i = 0; i < 3; ++i) {
    tap_swa();
    hand([](sim::Radio& r) {
      r.swb = Switch::Middle;
      r.right_ud = 0.6;
    });
    rig.run(5.0);
    hand([](sim::Radio& r) { r.right_ud = 0.0; });
    rig.run(2.0);
  }
  EXPECT_EQ(rig.state()->mission.items, 3);
  EXPECT_EQ(rig.execution(), ExecutionState::Loaded);
  const double away_m = rig.distance_to_m({0, 0});
  EXPECT_GT(away_m, 3.0);
  // Given back, armed and started with switches alone, it drives what it was taught.
  hand([](sim::Radio& r) { r.swb = Switch::Up; });
  rig.run(1.0);
  hand([](sim::Radio& r) { r.swd = Switch::Down; });
  ASSERT_TRUE(rig.state()->armed) << rig.failing_checks();
  hand([](sim::Radio& r) { r.swc = Switch::Middle; });
  EXPECT_EQ(rig.state()->mode, Mode::Auto);
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 0}), 0.3);
  hand([](sim::Radio& r) { r.swd = Switch::Up; });
  EXPECT_FALSE(rig.state()->armed);
  for (const char* cue : {"mission_item_added", "armed", "mode", "mission_started", "item_reached",
                          "mission_finished", "disarmed"}) {
    EXPECT_TRUE(rig.has_event(cue)) << cue;
  }
}

TEST_F(RadioLoop, AWaypointAddedWhileItDrivesIsDrivenLastAndNothingStops) {
  plan = rig.plan_of({{0, 10}});
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 4.0; }, 60.0));
  const double north_m = rig.truth().local.north_m;
  double slowest_mps = 1.0;
  radio.swa = Switch::Down;
  rig.plant.set_radio(radio);
  for (int i = 0; i < 50; ++i) {
    rig.tick();
    save_edits();
    slowest_mps = std::min(slowest_mps, rig.truth().twist.linear_mps);
  }
  EXPECT_EQ(rig.state()->mission.items, 2);
  EXPECT_GT(slowest_mps, 0.5);
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 10}), 0.2);
  EXPECT_LT(rig.distance_to_m({0, north_m}), 0.4);
}

TEST_F(RadioLoop, TakenOverByTheSticksItMayBeToldMoreAndGoesOnAfterwards) {
  plan = rig.plan_of({{0, 12}});
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 4.0; }, 60.0));
  hand([](sim::Radio& r) {
    r.swb = Switch::Middle;
    r.right_ud = 0.5;
    r.left_lr = 0.5;
  });
  rig.run(3.0);
  hand([](sim::Radio& r) { r.right_ud = r.left_lr = 0.0; });
  rig.run(1.5);
  const auto here = rig.truth().local;
  tap_swa();
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  EXPECT_EQ(rig.state()->mode, Mode::Auto);
  EXPECT_EQ(rig.state()->control, base::Driver::Radio);
  EXPECT_EQ(rig.state()->mission.items, 2);
  hand([](sim::Radio& r) { r.swb = Switch::Up; });
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 12}), 0.2);
  EXPECT_LT(rig.distance_to_m({here.east_m, here.north_m}), 0.3);
}

TEST_F(RadioLoop, TheKnobRemovesTheCurrentWaypointOrClearsTheMission) {
  plan = rig.plan_of({{0, 8}, {6, 8}, {6, 2}});
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 3.0; }, 60.0));
  ASSERT_EQ(rig.state()->mission.current_item, 1);
  hand([](sim::Radio& r) { r.vra = 0.5; });
  tap_swa();
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  EXPECT_EQ(rig.state()->mission.items, 2);
  EXPECT_TRUE(rig.has_event("mission_item_removed"));
  ASSERT_TRUE(rig.run_until([&] { return rig.distance_to_m({6, 8}) < 0.3; }, 60.0));
  EXPECT_GT(rig.nearest_m({0, 8}), 1.0);
  hand([](sim::Radio& r) { r.vra = -0.5; });
  tap_swa();
  rig.run(2.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.execution(), ExecutionState::Idle);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  EXPECT_TRUE(rig.has_event("mission_cleared"));
}

TEST_F(RadioLoop, ABounceDoesNothingAndALossForgetsWhatWasThrown) {
  plan = rig.plan_of({{0, 20}});
  rig.arm_and_start(plan);
  rig.run(3.0);
  for (int i = 0; i < 10; ++i) {  // a worn lever
    radio.swc = i % 2 == 0 ? Switch::Middle : Switch::Up;
    radio.swd = i % 2 == 0 ? Switch::Down : Switch::Up;
    rig.plant.set_radio(radio);
    rig.run(0.06);
  }
  EXPECT_FALSE(rig.has_event("radio_action"));
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  rig.fault([](sim::Faults& f) { f.radio_freeze = true; });
  rig.run(2.0);
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  radio.swc = Switch::Middle;  // thrown while nobody listens
  radio.swd = Switch::Down;
  rig.plant.set_radio(radio);
  rig.fault([](sim::Faults&) {});
  rig.run(3.0);
  EXPECT_FALSE(rig.has_event("radio_action"));
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  // Thrown anew it acts.
  hand([](sim::Radio& r) { r.swc = Switch::Up; });
  hand([](sim::Radio& r) { r.swc = Switch::Middle; });
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
}

}  // namespace
}  // namespace roverd::loop
