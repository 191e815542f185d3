// Parameters tell the truth: when a change acts, what the next start begins with, what may be
// changed while the robot is armed, and what is not as the vehicle's profile says.

#include <algorithm>

#include "house.hpp"

namespace roverd::test {
namespace {

class ParametersApi : public HouseTest {
 protected:
  Reply set(const std::string& name, const Json& value) {
    return call("PUT", "/parameters/" + name, Json{{"value", value}});
  }
  Json get(const std::string& name) { return call("GET", "/parameters/" + name).body; }
  Json load(const std::string& id) {
    const auto loaded = call("POST", "/execution/load", Json{{"mission_id", id}});
    EXPECT_EQ(loaded.status, 200u) << loaded.raw.body;
    return loaded.body;
  }
  void arm() { ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u); }
  bool has_event(const std::string& kind, const std::string& detail) {
    const auto items = call("GET", "/events?limit=1000").body["items"];
    return std::any_of(items.begin(), items.end(),
                       [&](const Json& e) { return e["kind"] == kind && e["detail"] == detail; });
  }
};

TEST_F(ParametersApi, WhatWaitsForTheNextStartIsShownBesideWhatHolds) {
  until_ready();
  EXPECT_EQ(get("vehicle.width_m")["next_start_value"], 0.778);
  const auto later = set("vehicle.width_m", 0.9);
  ASSERT_EQ(later.status, 200u) << later.raw.body;
  EXPECT_EQ(later.body["acted"], false);
  EXPECT_EQ(get("vehicle.width_m")["value"], 0.778);
  EXPECT_EQ(get("vehicle.width_m")["next_start_value"], 0.9);
  EXPECT_EQ(get("vehicle.width_m")["acts"], "at_next_start");
  const Json all = call("GET", "/parameters").body["items"];
  EXPECT_GT(all.size(), 100u);
  for (const Json& one : all) {
    const bool changed = one["name"] == "vehicle.width_m";
    EXPECT_EQ(one["next_start_value"] == one["value"], !changed) << one;
  }
  ASSERT_EQ(set("nav.track.damping", 1.2).status, 200u);
  EXPECT_EQ(get("nav.track.damping")["next_start_value"], 1.2);
}

TEST_F(ParametersApi, OfTheWayActInALoadedMissionThatIsNotInHandAndElseSayWhatTheyWaitFor) {
  until_ready();
  const std::string corner = "nav.track.corner_deviation_m";
  EXPECT_EQ(get(corner)["acts"], "at_next_load");
  const auto nothing = set(corner, 0.2);
  EXPECT_EQ(nothing.body["acted"], true);
  EXPECT_TRUE(nothing.body["waits_for"].is_null());

  const std::string id = make_mission();
  load(id);
  const auto loaded = set(corner, 0.3);
  ASSERT_EQ(loaded.status, 200u) << loaded.raw.body;
  EXPECT_EQ(loaded.body["acted"], true);
  EXPECT_TRUE(loaded.body["waits_for"].is_null());
  EXPECT_EQ(call("GET", "/execution").body["state"], "loaded");
  const auto laid = house.snapshot()->mission;
  EXPECT_FALSE(laid.laid_by_old);

  arm();
  const Json start = {{"mission_id", id}, {"revision", 1}, {"valid_for_s", 5}};
  ASSERT_EQ(call("POST", "/execution/start", start).status, 200u);
  const auto driving = set(corner, 0.1);
  ASSERT_EQ(driving.status, 200u) << driving.raw.body;
  EXPECT_EQ(driving.body["acted"], false);
  EXPECT_EQ(driving.body["value"], 0.1);
  EXPECT_EQ(driving.body["waits_for"],
            "the loaded mission drives the way that was laid out before: the mission is running: "
            "its way stays as it is");
  // The speed that is kept to acts at once; what was planned with it waits.
  const auto slower = set("nav.speed.max_mps", 0.6);
  EXPECT_EQ(slower.body["acts"], "at_once");
  EXPECT_EQ(slower.body["acted"], true);
  EXPECT_FALSE(slower.body["waits_for"].is_null());
  EXPECT_TRUE(house.snapshot()->mission.laid_by_old);
  // Nobody has to load it again: it is laid anew when it is not in hand any more.
  ASSERT_EQ(call("POST", "/execution/stop").status, 200u);
  until([this] { return !house.snapshot()->mission.laid_by_old; }, "laid anew");
  EXPECT_EQ(call("GET", "/execution").body["state"], "aborted");
}

TEST_F(ParametersApi, CapabilitiesAndChecksGoByThemAsTheyAreNow) {
  until_ready();
  ASSERT_EQ(set("nav.speed.max_mps", 0.5).status, 200u);
  until([this] { return get("nav.speed.max_mps")["value"] == 0.5; }, "published");
  EXPECT_EQ(call("GET", "/vehicle/capabilities").body["limits"]["max_speed_mps"], 0.5);
  Json fast = two_waypoints("fast");
  fast["items"][0]["speed_mps"] = 0.9;
  const std::string id = call("POST", "/missions", fast).body["id"];
  const auto report = call("POST", "/missions/" + id + "/check");
  const auto& findings = report.body["findings"];
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const Json& f) {
    return f["code"] == "speed_above_limit";
  })) << report.raw.body;
}

TEST_F(ParametersApi, OfSafetyAreNotRelaxedWhileTheRobotIsArmed) {
  until_ready();
  EXPECT_EQ(get("robot.fence.margin_m")["stricter"], "higher");
  EXPECT_EQ(get("robot.safety.base_timeout_s")["stricter"], "lower");
  EXPECT_EQ(get("vehicle.width_m")["stricter"], "none");
  EXPECT_TRUE(get("nav.track.damping")["stricter"].is_null());
  arm();
  const auto relaxed = set("robot.fence.margin_m", 0.02);
  EXPECT_EQ(relaxed.status, 409u);
  EXPECT_EQ(
      relaxed.body["detail"],
      "robot.fence.margin_m keeps people safe: while the robot is armed it is only raised (it "
      "is 0.1); disarm first");
  EXPECT_EQ(set("vehicle.width_m", 0.5).status, 409u);
  EXPECT_EQ(get("vehicle.width_m")["next_start_value"], 0.778);
  EXPECT_EQ(set("robot.fence.margin_m", 0.2).status, 200u);
  EXPECT_TRUE(
      has_event("safety_parameter",
                "robot.fence.margin_m was changed from 0.1 to 0.2 by the page or a script"));
  EXPECT_EQ(set("robot.fence.margin_m", 0.1).status, 409u);
  ASSERT_EQ(call("POST", "/vehicle/disarm").status, 200u);
  EXPECT_EQ(set("robot.fence.margin_m", 0.1).status, 200u);
}

TEST_F(ParametersApi, OfSafetyThatAreNotAsTheProfileSaysAreShownBeforeAStart) {
  until_ready();
  const std::string id = make_mission();
  load(id);
  const auto rows = [](const Json& findings) {
    Json out = Json::array();
    for (const Json& f : findings) {
      if (f["code"] == "safety_parameter") out.push_back(f);
    }
    return out;
  };
  EXPECT_TRUE(rows(call("GET", "/execution/preview").body["findings"]).empty());
  ASSERT_EQ(set("robot.fence.margin_m", 0.02).status, 200u);
  until([this] { return get("robot.fence.margin_m")["value"] == 0.02; }, "published");
  const Json row = {
      {"severity", "warning"},
      {"code", "safety_parameter"},
      {"pointer", "/parameters/robot.fence.margin_m"},
      {"item", nullptr},
      {"detail",
       "the safety parameter robot.fence.margin_m is 0.02, the vehicle's profile says 0.1"}};
  const auto preview = call("GET", "/execution/preview");
  EXPECT_EQ(rows(preview.body["findings"]), Json::array({row}));
  EXPECT_EQ(preview.body["ready"], true);
  const auto report = call("POST", "/missions/" + id + "/check");
  EXPECT_EQ(rows(report.body["findings"]), Json::array({row}));
  EXPECT_EQ(report.body["ready"], true);
  EXPECT_EQ(rows(load(id)["warnings"]), Json::array({row}));
  // Told once, and no longer than it is so.
  EXPECT_EQ(rows(call("GET", "/execution/preview").body["findings"]).size(), 1u);
  ASSERT_EQ(set("robot.fence.margin_m", 0.1).status, 200u);
  until([this] { return get("robot.fence.margin_m")["value"] == 0.1; }, "published");
  EXPECT_TRUE(rows(call("GET", "/execution/preview").body["findings"]).empty());
}

}  // namespace
}  // namespace roverd::test
