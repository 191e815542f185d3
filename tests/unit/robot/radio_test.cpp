// The radio as user interface: a thrown switch acts once, a bounce or a return from silence never.

#include "field.hpp"
#include "robot/radio/keys.hpp"

namespace roverd::robot {
namespace {

using base::Switch;
using std::chrono::milliseconds;

/// A transmitter in a hand: frames every 20 ms.
class Hand {
 public:
  explicit Hand(const RadioParams& params = {}) : keys(params, SafetyParams{}) {
    radio.swa = radio.swb = radio.swc = radio.swd = Switch::Up;
  }

  RadioKeys keys;
  base::RadioState radio;
  Time now{};
  std::vector<std::string> done;  ///< words of the actions

  void hold(double seconds) {
    for (int i = 0; i < std::lround(seconds * 50.0); ++i) {
      now += milliseconds(20);
      radio.stamp = now;
      for (const RadioKey& key : keys.take(radio, radio.swb)) {
        if (key.action != nullptr) done.emplace_back(key.action->word);
      }
    }
  }
  std::vector<std::string> take() { return std::exchange(done, {}); }
};

using Words = std::vector<std::string>;

TEST(RadioKeys, EachThrowDoesExactlyItsAction) {
  Hand h;
  h.hold(1.0);
  EXPECT_EQ(h.take(), Words{});  // what stands so at the start was not thrown
  const auto throws = [&h](Switch base::RadioState::*lever, Switch to) {
    h.radio.*lever = to;
    h.hold(0.5);
    return h.take();
  };
  EXPECT_EQ(throws(&base::RadioState::swc, Switch::Middle), Words{"mode.auto"});
  EXPECT_EQ(throws(&base::RadioState::swc, Switch::Down), Words{"mode.hold"});
  EXPECT_EQ(throws(&base::RadioState::swc, Switch::Up), Words{"mode.manual"});
  EXPECT_EQ(throws(&base::RadioState::swd, Switch::Down), Words{"arm"});
  EXPECT_EQ(throws(&base::RadioState::swd, Switch::Up), Words{"disarm"});
  EXPECT_EQ(throws(&base::RadioState::swb, Switch::Middle), Words{});  // decides who drives
  EXPECT_EQ(throws(&base::RadioState::swa, Switch::Down), Words{"mission.add_waypoint"});
  EXPECT_EQ(throws(&base::RadioState::swa, Switch::Up), Words{});
}

TEST(RadioKeys, TheKnobChoosesTheEditAndSwbDownForbidsIt) {
  const std::pair<double, const char*> cases[] = {
      {0.0, "mission.add_waypoint"},   {0.25, "mission.add_waypoint"},
      {-0.25, "mission.add_waypoint"}, {0.26, "mission.remove_current"},
      {1.0, "mission.remove_current"}, {-0.26, "mission.clear"},
      {-1.0, "mission.clear"},
  };
  for (const auto& [vra, word] : cases) {
    for (const Switch swb : {Switch::Up, Switch::Middle, Switch::Down}) {
      Hand h;
      h.radio.swb = swb;
      h.radio.vra = vra;
      h.hold(0.5);
      EXPECT_EQ(h.keys.positions(h.radio).knob->word, word);
      h.radio.swa = Switch::Down;
      h.hold(0.5);
      EXPECT_EQ(h.take(), swb == Switch::Down ? Words{} : Words{word}) << vra;
    }
  }
}

// up ───┐ ┌┐┌────      shorter than 0.1 s, or between two detents: nothing was thrown
//       └─┘└┘
TEST(RadioKeys, ABounceIsNoThrow) {
  Hand h;
  h.hold(1.0);
  for (int i = 0; i < 20; ++i) {
    h.radio.swd = i % 2 == 0 ? Switch::Down : Switch::Up;
    h.hold(0.08);
  }
  EXPECT_EQ(h.take(), Words{});
  // A lever on its long way, which then arrives: once.
  h.radio.swd = Switch::Unknown;
  h.hold(1.0);
  EXPECT_EQ(h.take(), Words{});
  h.radio.swd = Switch::Down;
  h.hold(0.1);
  EXPECT_EQ(h.take(), Words{});
  h.hold(0.02);
  EXPECT_EQ(h.take(), Words{"arm"});
  h.hold(5.0);
  EXPECT_EQ(h.take(), Words{});
}

TEST(RadioKeys, WhatWasThrownWhileTheRadioWasAwayIsOnlyRemembered) {
  Hand h;
  h.hold(1.0);
  h.now += milliseconds(600);  // silence
  h.radio.swd = Switch::Down;
  h.hold(1.0);
  EXPECT_EQ(h.take(), Words{});
  h.keys.lost();  // or a frozen counter, or the base's word
  h.radio.swc = Switch::Middle;
  h.hold(1.0);
  EXPECT_EQ(h.take(), Words{});
  h.radio.swc = Switch::Up;
  h.hold(1.0);
  EXPECT_EQ(h.take(), Words{"mode.manual"});
}

TEST(RadioKeys, TwoAtOnceActBothAndDisarmingComesFirst) {
  Hand h;
  h.radio.swd = Switch::Down;
  h.hold(1.0);
  h.radio.swd = Switch::Up;
  h.radio.swc = Switch::Middle;
  h.hold(1.0);
  EXPECT_EQ(h.take(), (Words{"disarm", "mode.auto"}));
}

TEST(RadioKeys, OtherActionsCanBeAssignedAndWrongWordsAreNamed) {
  RadioParams p;
  p.swa_down = "estop";
  p.swc_down = "mode.rtl";
  p.debounce_s = 0.3;
  ASSERT_TRUE(check(p));
  Hand h(p);
  h.hold(1.0);
  h.radio.swa = h.radio.swc = Switch::Down;
  h.hold(0.2);
  EXPECT_EQ(h.take(), Words{});
  h.hold(0.2);
  EXPECT_EQ(h.take(), (Words{"mode.rtl", "estop"}));
  p.swc_down = "mode.fly";
  const auto bad = check(p);
  ASSERT_FALSE(bad);
  EXPECT_TRUE(bad.error().detail.starts_with("swc_down must be one of none, by_knob, "));
  EXPECT_TRUE(bad.error().detail.ends_with("; is \"mode.fly\""));
  p.swc_down = "none";
  p.knob_high = "by_knob";
  EXPECT_EQ(check(p).error().detail, "knob_high cannot be by_knob: the knob would ask itself");
}

TEST(RadioPanel, ArmsAndChoosesModesByTheSameChecksAsTheNetwork) {
  Field f;
  f.run(1.0);
  f.swd = Switch::Down;
  f.run(0.3);
  EXPECT_FALSE(f.state()->armed);  // too early: the fix is not trusted yet
  EXPECT_TRUE(f.has_event("arm_refused"));
  f.swd = Switch::Up;
  f.run(8.0);
  f.swd = Switch::Down;
  f.run(0.3);
  EXPECT_TRUE(f.state()->armed);
  EXPECT_TRUE(f.has_event("armed"));
  f.swc = Switch::Middle;
  f.run(0.3);
  EXPECT_TRUE(f.has_event("mode_refused"));  // no mission is loaded
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  f.swc = Switch::Up;
  f.run(0.3);
  EXPECT_EQ(f.state()->mode, Mode::Manual);
  ASSERT_TRUE(f.load(plan_of({{0, 20}})));
  f.swc = Switch::Middle;
  f.run(3.0);
  EXPECT_EQ(f.state()->mode, Mode::Auto);
  EXPECT_TRUE(f.moves());
  f.swc = Switch::Down;
  f.run(0.3);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.events.back().detail, "mode HOLD: by the radio");
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  EXPECT_EQ(f.events.back().detail, "mode MANUAL: by the operator");
  f.swc = Switch::Middle;  // on again, where it paused
  f.run(2.0);
  EXPECT_TRUE(f.moves());
  f.swd = Switch::Up;
  f.run(0.3);
  EXPECT_FALSE(f.state()->armed);
  EXPECT_FALSE(f.moves());
}

TEST(RadioPanel, ARadioThatComesBackDoesNotDoWhatWasThrownMeanwhile) {
  Field f;
  f.drive_mission();
  f.swc = Switch::Down;
  f.run(0.3);
  ASSERT_EQ(f.execution(), ExecutionState::Paused);
  f.radio_counts = false;  // frozen: the base repeats the last frame
  f.run(2.0);
  f.swc = Switch::Middle;
  f.radio_counts = true;
  f.run(2.0);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_FALSE(f.moves());
}

TEST(RadioPanel, AsksForEditsOfTheMissionAndStopsAtOnceWhenItIsCleared) {
  Field f;
  std::vector<MissionEdit> edits;
  f.run(1.0);
  f.swa = Switch::Down;
  f.run(0.3);
  f.robot.edits().take(edits);
  ASSERT_EQ(edits.size(), 1u);  // nothing is loaded: a new mission begins here
  EXPECT_EQ(edits[0].kind, EditKind::AddWaypoint);
  EXPECT_EQ(edits[0].mission_id, "");
  EXPECT_NEAR(base::distance_bearing(edits[0].at, kFrame.to_global(f.at)).distance_m, 0.0, 0.1);
  f.swa = Switch::Up;
  f.vra = 0.8;
  f.run(0.3);
  f.swa = Switch::Down;
  f.run(0.3);
  EXPECT_TRUE(f.has_event("mission_edit_refused"));  // nothing to remove
  f.swa = Switch::Up;
  f.drive_mission();
  edits.clear();
  f.swa = Switch::Down;
  f.run(0.3);
  f.swa = Switch::Up;
  f.vra = -0.8;
  f.run(0.3);
  EXPECT_TRUE(f.moves());
  f.swa = Switch::Down;
  f.run(0.3);
  f.robot.edits().take(edits);
  ASSERT_EQ(edits.size(), 2u);
  EXPECT_EQ(edits[0].kind, EditKind::RemoveItem);
  EXPECT_EQ(edits[0].item, 1);
  EXPECT_EQ(edits[0].mission_id, "m");
  EXPECT_EQ(edits[0].revision, 1);
  EXPECT_EQ(edits[1].kind, EditKind::Clear);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST(RadioPanel, ARevisionIsTakenOnlyInThePlaceOfTheOneItWasMadeFrom) {
  Field f;
  f.drive_mission();
  const auto compiled = f.robot.compile({"m", 2, plan_of({{0, 20}, {5, 20}})});
  ASSERT_TRUE(compiled);
  EXPECT_FALSE(f.ask(ReviseMission{EditKind::AddWaypoint, 2, "other", 1, *compiled}));
  EXPECT_FALSE(f.ask(ReviseMission{EditKind::AddWaypoint, 2, "m", 7, *compiled}));
  EXPECT_FALSE(f.ask(ReviseMission{EditKind::AddWaypoint, 2, "", 0, *compiled}));
  EXPECT_EQ(f.state()->mission.revision, 1);
  ASSERT_TRUE(f.ask(ReviseMission{EditKind::AddWaypoint, 2, "m", 1, *compiled}));
  EXPECT_EQ(f.state()->mission.revision, 2);
  EXPECT_EQ(f.state()->mission.items, 2);
  EXPECT_TRUE(f.has_event("mission_item_added"));
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  ASSERT_TRUE(f.ask(ReviseMission{EditKind::Clear, 0, "m", 2, nullptr}));
  EXPECT_EQ(f.execution(), ExecutionState::Idle);
  EXPECT_EQ(f.robot.loaded(), nullptr);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST(RadioPanel, TellsWhatTheSwitchesMeanAsTheyStand) {
  Field f;
  f.swc = Switch::Middle;
  f.swb = Switch::Middle;
  f.vra = -1.0;
  f.run(1.0);
  const base::RadioMeaning& m = f.state()->radio_meaning;
  EXPECT_EQ(m.swa, "nothing");
  EXPECT_EQ(m.swb, "the sticks drive");
  EXPECT_EQ(m.swc, "mode AUTO");
  EXPECT_EQ(m.swd, "disarm");
  EXPECT_EQ(m.vra, "clear the mission");
}

}  // namespace
}  // namespace roverd::robot
