// The radio's edits of the mission, through the real store and back to the robot.

#include <algorithm>

#include "house.hpp"

namespace roverd::test {
namespace {

using base::Switch;

class RadioApi : public HouseTest {
 protected:
  bool has_event(const std::string& kind) {
    const auto items = call("GET", "/events?limit=1000").body["items"];
    return std::any_of(items.begin(), items.end(),
                       [&](const Json& e) { return e["kind"] == kind; });
  }
  Json execution() { return call("GET", "/execution").body; }

  /// SWA down and up again, each for more frames than a bounce has.
  void tap_swa() {
    for (const Switch position : {Switch::Up, Switch::Down, Switch::Up}) {
      house.swa = position;
      const std::uint64_t tick = house.snapshot()->tick;
      until([&] { return house.snapshot()->tick > tick + 10; }, "ten more frames");
    }
  }

  void drive(const std::string& id) {
    ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
    ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
    const Json start = {{"mission_id", id}, {"revision", 1}, {"valid_for_s", 5}};
    ASSERT_EQ(call("POST", "/execution/start", start).status, 200u);
  }
};

TEST_F(RadioApi, AWaypointAddedWhileDrivingIsANewRevisionThatIsDriven) {
  until_ready();
  const std::string id = make_mission();
  drive(id);
  tap_swa();
  until([this] { return has_event("mission_item_added"); }, "the cue");
  const Json now = execution();
  EXPECT_EQ(now["mission_id"], id);
  EXPECT_EQ(now["revision"], 2);
  EXPECT_EQ(now["items"], 3);
  EXPECT_EQ(now["state"], "running");
  const Json stored = call("GET", "/missions/" + id).body;
  EXPECT_EQ(stored["revision"], 2);
  EXPECT_NEAR(stored["items"][2]["lat"], kStart.lat, 1e-5);
  const Json newest = call("GET", "/missions/" + id + "/revisions").body["items"][0];
  EXPECT_EQ(newest["author"], "radio");
  EXPECT_EQ(newest["what"], "waypoint added by radio");
  // The knob chooses: remove the current one,
  house.vra = 0.9;
  tap_swa();
  until([this] { return has_event("mission_item_removed"); }, "the cue");
  EXPECT_EQ(execution()["items"], 2);
  EXPECT_EQ(execution()["state"], "running");
  EXPECT_NEAR(call("GET", "/missions/" + id).body["items"][0]["lon"], kStart.lon + 0.0002, 1e-9);
  // or clear it all; home is where the robot stands.
  house.vra = -0.9;
  tap_swa();
  until([this] { return has_event("mission_cleared"); }, "the cue");
  EXPECT_EQ(execution()["state"], "idle");
  EXPECT_TRUE(call("GET", "/missions/" + id).body["items"].empty());
  EXPECT_NEAR(call("GET", "/missions/" + id).body["home"]["lat"], kStart.lat, 1e-5);
  EXPECT_EQ(call("GET", "/vehicle").body["mode"], "HOLD");
  // What is added next goes into the same one.
  house.vra = 0.0;
  tap_swa();
  until([this] { return execution()["items"] == 1; }, "an item");
  EXPECT_EQ(execution()["mission_id"], id);
  EXPECT_EQ(execution()["state"], "loaded");
}

TEST_F(RadioApi, WithoutAMissionTheFirstWaypointMakesOne) {
  until_ready();
  tap_swa();
  until([this] { return execution()["state"] == "loaded"; }, "a mission is loaded");
  const Json now = execution();
  EXPECT_EQ(now["items"], 1);
  EXPECT_TRUE(now["name"].get<std::string>().starts_with("Radio 20"));
  tap_swa();
  until([this] { return execution()["items"] == 2; }, "a second item");
  EXPECT_EQ(execution()["revision"], 2);
  // Nothing is in hand: the last one goes, as an undo.
  house.vra = 0.9;
  tap_swa();
  until([this] { return execution()["items"] == 1; }, "one item");
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 1u);
}

TEST_F(RadioApi, WhatSomebodyElseSavedMeanwhileIsNotOverwritten) {
  until_ready();
  const std::string id = make_mission();
  drive(id);
  Json changed = two_waypoints("by the page");
  ASSERT_EQ(call("PUT", "/missions/" + id, changed.dump(), "If-Match: \"rev-1\"\r\n").status, 200u);
  tap_swa();
  until([this] { return has_event("mission_edit_refused"); }, "the refusal");
  EXPECT_EQ(call("GET", "/missions/" + id).body["name"], "by the page");
  EXPECT_EQ(execution()["revision"], 1);
  EXPECT_EQ(execution()["state"], "running");
}

/// After a take-over only a mission goes on by itself: a goal waits for the word.
TEST_F(RadioApi, WhatTheRadioInterruptedGoesOnWhenItIsTold) {
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const Json goal = {{"lat", kStart.lat + 0.0002}, {"lon", kStart.lon}, {"valid_for_s", 5}};
  ASSERT_EQ(call("POST", "/vehicle/goto", goal).status, 202u);
  until([this] { return house.sent().twist.linear_mps > 0.1; }, "it drives");
  EXPECT_EQ(call("POST", "/vehicle/resume", Json{{"valid_for_s", 5}}).status, 409u);
  house.swb = Switch::Middle;
  until([this] { return call("GET", "/vehicle").body["control"] == "rc"; }, "the radio drives");
  const auto early = call("POST", "/vehicle/resume", Json{{"valid_for_s", 5}});
  EXPECT_EQ(early.status, 409u);
  EXPECT_EQ(early.body["detail"], "the radio drives: put its switch SWB up first");
  house.swb = Switch::Up;
  until([this] { return call("GET", "/vehicle").body["control"] != "rc"; }, "given back");
  const Json held = call("GET", "/vehicle").body["activity"];
  EXPECT_EQ(held["state"], "held");
  EXPECT_EQ(held["reason"], "the radio took over: the goto waits until it is resumed");
  EXPECT_EQ(house.sent().twist, base::BodyTwist{});
  const auto resumed = call("POST", "/vehicle/resume", Json{{"valid_for_s", 5}});
  ASSERT_EQ(resumed.status, 200u) << resumed.raw.body;
  EXPECT_TRUE(has_event("activity_resumed"));
  until([this] { return house.sent().twist.linear_mps > 0.1; }, "it goes on");
  EXPECT_EQ(call("GET", "/vehicle").body["activity"]["state"], "driving");
  EXPECT_EQ(call("GET", "/vehicle").body["activity"]["id"], held["id"]);
}

TEST_F(RadioApi, SwitchesArmAndChooseModesAndTheirMeaningIsTold) {
  until_ready();
  EXPECT_EQ(call("GET", "/vehicle").body["armed"], false);
  const Json meaning = call("GET", "/vehicle").body["rc"]["meaning"];
  EXPECT_EQ(meaning["swa"], "nothing");
  EXPECT_EQ(meaning["swb"], "the computer drives");
  EXPECT_EQ(meaning["swc"], "mode MANUAL");
  EXPECT_EQ(meaning["swd"], "disarm");
  EXPECT_EQ(meaning["vra"], "add a waypoint here");
  EXPECT_FALSE(has_event("radio_action"));
  house.swd = Switch::Down;
  until([this] { return call("GET", "/vehicle").body["armed"] == true; }, "armed");
  house.swc = Switch::Middle;
  until([this] { return has_event("mode_refused"); }, "no mission is loaded");
  house.swc = Switch::Up;
  until([this] { return call("GET", "/vehicle").body["mode"] == "MANUAL"; }, "MANUAL");
  house.swd = Switch::Up;
  until([this] { return call("GET", "/vehicle").body["armed"] == false; }, "disarmed");
}

}  // namespace
}  // namespace roverd::test
