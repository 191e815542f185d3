// Teach-in over HTTP and by the radio, through the real store.

#include <algorithm>

#include "base/geo.hpp"
#include "house.hpp"

namespace roverd::test {
namespace {

class TeachApi : public HouseTest {
 protected:
  explicit TeachApi(const Before& before = {}) : HouseTest(House::Vehicle::Whole, before) {}
  bool has_event(const std::string& kind) {
    const Json items = call("GET", "/events?limit=1000").body["items"];
    return std::any_of(items.begin(), items.end(),
                       [&](const Json& e) { return e["kind"] == kind; });
  }
  Json teach() { return call("GET", "/teach").body; }
  unsigned post(const std::string& what, const Json& body = Json::object()) {
    return call("POST", "/teach/" + what, body).status;
  }
  /// The receiver goes north by steps that the estimator believes.
  void walk(double to_m) {
    while (house.moved_m < to_m) {
      house.moved_m = house.moved_m + 0.05;
      const auto tick = house.snapshot()->tick;
      until([&] { return house.snapshot()->tick > tick + 10; }, "a fix");
    }
  }
};

TEST_F(TeachApi, ADrivenWayBecomesAMission) {
  until_ready();
  until([this] { return teach()["state"] == "idle"; }, "it is known that nothing was left behind");
  EXPECT_EQ(post("pause"), 409u);
  EXPECT_EQ(post("stop"), 409u);
  ASSERT_EQ(post("start", {{"name", "to the gate"}, {"step_m", 0.2}}), 200u);
  EXPECT_EQ(post("start"), 409u);
  until([this] { return teach()["points"] == 1; }, "where it stands");
  EXPECT_EQ(call("GET", "/vehicle").body["teach"]["state"], "recording");
  // Nothing was driven yet: it goes on.
  EXPECT_EQ(post("stop"), 409u);
  EXPECT_EQ(teach()["state"], "recording");
  walk(1.0);
  until([this] { return teach()["points"].get<int>() >= 3; }, "some points");
  ASSERT_EQ(post("pause"), 200u);
  const int points = teach()["points"];
  EXPECT_EQ(teach()["state"], "paused");
  until([this] { return teach()["unsaved_points"] == 0; }, "they are on the disk");
  ASSERT_EQ(post("resume"), 200u);
  walk(1.5);
  const auto made = call("POST", "/teach/stop", Json{{"tolerance_m", 0.0}});
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_GE(made.body["items"].size(), static_cast<std::size_t>(points));
  EXPECT_EQ(made.body["name"], "to the gate");
  // The estimator follows the receiver with a lag.
  EXPECT_GT(made.body["length_m"], 0.7);
  EXPECT_LT(made.body["length_m"], 1.7);
  EXPECT_EQ(teach()["state"], "idle");
  EXPECT_EQ(call("GET", "/missions/" + made.body["id"].get<std::string>()).body, made.body);
}

TEST_F(TeachApi, WhatIsNotTrustedIsNotRecordedAndSaysWhy) {
  until_ready();
  ASSERT_EQ(post("start", {{"sigma_max_m", 0.01}}), 200u);
  until([this] { return !teach()["waiting"].is_null(); }, "a reason");
  EXPECT_NE(teach()["waiting"].get<std::string>().find("uncertain"), std::string::npos);
  EXPECT_EQ(teach()["points"], 0);
  ASSERT_EQ(post("discard"), 200u);
  EXPECT_EQ(teach()["state"], "idle");
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 0u);
}

/// A recording of three points was being made when the power went.
void with_recording(const std::filesystem::path& file) {
  const auto at_once = [](const std::function<void()>& work) { work(); };
  const auto store = store::Store::open(file, at_once).value();
  std::vector<mission::TaughtPoint> points;
  for (int i = 0; i < 3; ++i) {
    mission::TaughtPoint point;
    point.at = base::destination(kStart, 0.0, i - 4.0);
    point.speed_mps = 0.5;
    point.gap = i == 1;
    points.push_back(point);
  }
  const auto done = [](const base::Result<void>& result) { ASSERT_TRUE(result); };
  store->begin_teach({base::wall_now(), "cut off", {0.2, 10.0, 0.0, 0.5}, {}}, done);
  store->add_teach_points(points, done);
}

class TeachApiAfterACut : public TeachApi {
 protected:
  TeachApiAfterACut() : TeachApi({with_recording}) {}
};

TEST_F(TeachApiAfterACut, TheRecordingIsThereAndGoesOn) {
  until([this] { return call("GET", "/teach").status == 200; }, "the store's answer");
  const Json found = teach();
  EXPECT_EQ(found["state"], "interrupted");
  EXPECT_EQ(found["name"], "cut off");
  EXPECT_EQ(found["points"], 3);
  EXPECT_EQ(found["unsaved_points"], 0);
  EXPECT_EQ(found["gaps"], 1);
  EXPECT_EQ(found["settings"]["step_m"], 0.2);
  EXPECT_NEAR(found["length_m"].get<double>(), 1.0, 0.01);
  EXPECT_TRUE(has_event("teach_interrupted"));
  // Nothing takes its place unasked.
  EXPECT_EQ(post("start"), 409u);
  EXPECT_EQ(post("pause"), 409u);
  until_ready();
  ASSERT_EQ(post("resume"), 200u);
  // Where it stands now no way leads to from the last point. (The walk below is by steps, without
  // wheels: what the estimator makes of those may be a gap of its own.)
  until([this] { return teach()["points"].get<int>() >= 4; }, "the first point");
  EXPECT_EQ(teach()["gaps"], 2);
  walk(1.0);
  until([this] { return teach()["points"].get<int>() >= 5; }, "more points");
  const auto made = call("POST", "/teach/stop");
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.body["name"], "cut off");
  EXPECT_GE(made.body["items"].size(), 5u);
  EXPECT_NEAR(made.body["items"][0]["lat"], base::destination(kStart, 0.0, -4.0).lat, 1e-9);
  EXPECT_EQ(teach()["state"], "idle");
}

TEST_F(TeachApiAfterACut, TheRecordingBecomesAMissionOrGoesWithoutAPosition) {
  until([this] { return call("GET", "/teach").status == 200; }, "the store's answer");
  const auto made = call("POST", "/teach/stop", Json{{"name", "as far as it went"}});
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.body["items"].size(), 3u);
  EXPECT_EQ(post("resume"), 409u);
  EXPECT_EQ(post("discard"), 409u);
}

class TeachByRadio : public TeachApi {
 protected:
  TeachByRadio() : TeachApi({{}, switches}) {}
  static void switches(robot::Config& config) {
    config.radio.swa_up = config.radio.swc_up = config.radio.swd_up = "none";
    config.radio.swa_down = "teach.start";
    config.radio.swd_down = "teach.pause";
    config.radio.swc_middle = "teach.stop";
    config.radio.swc_down = "teach.discard";
  }
  void ticks(std::uint64_t count) {
    const std::uint64_t tick = house.snapshot()->tick;
    until([&] { return house.snapshot()->tick > tick + count; }, "some ticks");
  }
  /// Up and there, again and again: a throw does nothing after a silence, which a machine with much
  /// else to do may make.
  void throw_until(std::atomic<base::Switch>& key, base::Switch to,
                   const std::function<bool()>& claim, const char* what) {
    const auto once = [&] {
      key = base::Switch::Up;
      ticks(10);
      key = to;
      ticks(15);
      return claim();
    };
    until(once, what);
  }
  bool is(const char* state) { return teach()["state"] == state; }
  bool refused(const std::string& what) {
    const Json items = call("GET", "/events?limit=1000").body["items"];
    return std::any_of(items.begin(), items.end(), [&](const Json& e) {
      return e["kind"] == "teach_refused" && e["detail"].get<std::string>().starts_with(what);
    });
  }
};

TEST_F(TeachByRadio, ARecordingIsStartedPausedResumedStoppedAndDiscarded) {
  using base::Switch;
  until_ready();
  throw_until(
      house.swd, Switch::Down, [this] { return refused("pause: "); }, "nothing to pause");
  EXPECT_TRUE(is("idle"));
  throw_until(
      house.swa, Switch::Down, [this] { return is("recording"); }, "it records");
  EXPECT_TRUE(teach()["name"].get<std::string>().starts_with("Taught 20"));
  until([this] { return teach()["points"] == 1; }, "where it stands");
  // Of one place there is no mission; the recording stays.
  throw_until(
      house.swc, Switch::Middle, [this] { return refused("stop: "); }, "the refusal");
  EXPECT_TRUE(is("recording"));
  throw_until(
      house.swd, Switch::Down, [this] { return is("paused"); }, "a pause");
  walk(0.5);
  throw_until(
      house.swa, Switch::Down, [this] { return is("recording"); }, "it goes on");
  walk(2.5);
  until([this] { return teach()["points"].get<int>() >= 3; }, "some points");
  throw_until(
      house.swc, Switch::Middle, [this] { return is("idle"); }, "a mission");
  const Json missions = call("GET", "/missions").body["items"];
  ASSERT_EQ(missions.size(), 1u);
  const std::string id = missions[0]["id"];
  EXPECT_EQ(call("GET", "/missions/" + id + "/revisions").body["items"][0]["author"], "teach-in");
  // Another one, which nobody wants.
  throw_until(
      house.swa, Switch::Down, [this] { return is("recording"); }, "another one");
  throw_until(
      house.swc, Switch::Down, [this] { return is("idle"); }, "it is gone");
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 1u);
  EXPECT_TRUE(has_event("teach_discarded"));
}

TEST_F(TeachApi, EveryWrongMemberIsNamed) {
  const auto pointer = [this](const std::string& what, const Json& body) {
    const auto reply = call("POST", "/teach/" + what, body);
    EXPECT_EQ(reply.status, 422u) << body;
    return reply.body["errors"][0]["pointer"];
  };
  EXPECT_EQ(pointer("start", {{"step_m", 0}}), "/step_m");
  EXPECT_EQ(pointer("start", {{"heading_deg", 1e308}}), "/heading_deg");
  EXPECT_EQ(pointer("start", {{"tolerance_m", "much"}}), "/tolerance_m");
  EXPECT_EQ(pointer("start", {{"sigma_max_m", -1}}), "/sigma_max_m");
  EXPECT_EQ(pointer("start", {{"name", ""}}), "/name");
  EXPECT_EQ(pointer("start", {{"speed", 1}}), "/speed");
  EXPECT_EQ(pointer("stop", {{"tolerance_m", 11}}), "/tolerance_m");
  EXPECT_EQ(pointer("pause", {{"now", true}}), "/now");
}

}  // namespace
}  // namespace roverd::test
