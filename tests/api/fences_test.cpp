// Fences over HTTP, and the check of missions against them.

#include "house.hpp"

namespace roverd::test {
namespace {

class FencesApi : public HouseTest {
 protected:
  static Json fence(double radius_m = 100.0) {
    return {{"name", "field"},
            {"areas",
             {{{"kind", "inclusion"},
               {"circle", {{"lat", kStart.lat}, {"lon", kStart.lon}, {"radius_m", radius_m}}}}}},
            {"rally", {{{"lat", kStart.lat}, {"lon", kStart.lon}}}}};
  }
  static std::string tag(int revision) {
    return "If-Match: \"rev-" + std::to_string(revision) + "\"\r\n";
  }
  /// Waypoints so many metres north of the start.
  std::string mission(const std::vector<double>& north_m) {
    Json items = Json::array();
    for (const double m : north_m) {
      items.push_back(
          {{"type", "waypoint"}, {"lat", kStart.lat + m / 111'384}, {"lon", kStart.lon}});
    }
    return call("POST", "/missions", Json{{"name", "course"}, {"items", items}}).body["id"];
  }
};

TEST_F(FencesApi, AFenceIsCreatedReadReplacedAndDeleted) {
  const auto made = call("POST", "/fences", fence());
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  const std::string id = made.body["id"];
  EXPECT_EQ(made.raw.header("location"), "/api/v1/fences/" + id);
  EXPECT_EQ(call("GET", "/fences/" + id).body, made.body);
  EXPECT_EQ(call("GET", "/fences").body["items"][0]["areas"], 1);
  EXPECT_EQ(call("PUT", "/fences/" + id, fence(50)).status, 428u);
  EXPECT_EQ(call("PUT", "/fences/" + id, fence(50), tag(1)).raw.header("etag"), "\"rev-2\"");
  const auto late = call("PUT", "/fences/" + id, fence(60), tag(1));
  EXPECT_EQ(late.status, 412u);
  EXPECT_EQ(late.body["current"]["areas"][0]["circle"]["radius_m"], 50.0);
  const auto back = call("POST", "/fences/" + id + "/revert", Json{{"revision", 1}}, tag(2));
  EXPECT_EQ(back.body["areas"], made.body["areas"]);
  EXPECT_EQ(call("GET", "/fences/" + id + "/revisions").body["items"].size(), 3u);
  EXPECT_EQ(call("DELETE", "/fences/" + id, "", tag(3)).status, 204u);
  EXPECT_EQ(call("GET", "/fences/" + id).status, 404u);
}

TEST_F(FencesApi, WhatIsNoFenceIsRefusedWithItsPlace) {
  Json crossed = fence();
  crossed["areas"][0] = {{"kind", "exclusion"},
                         {"polygon",
                          {{{"lat", 58.0}, {"lon", 26.0}},
                           {{"lat", 58.001}, {"lon", 26.001}},
                           {{"lat", 58.0}, {"lon", 26.001}},
                           {{"lat", 58.001}, {"lon", 26.0}}}}};
  const auto reply = call("POST", "/fences", crossed);
  EXPECT_EQ(reply.status, 422u);
  EXPECT_EQ(reply.body["errors"][0]["pointer"], "/areas/0/polygon");
  EXPECT_TRUE(call("GET", "/fences").body["items"].empty());
}

TEST_F(FencesApi, OneOfThemIsTheActiveOne) {
  EXPECT_TRUE(call("GET", "/fence").body["fence"].is_null());
  const std::string id = call("POST", "/fences", fence()).body["id"];
  const auto active = call("PUT", "/fence", Json{{"fence_id", id}});
  ASSERT_EQ(active.status, 200u) << active.raw.body;
  EXPECT_EQ(call("GET", "/fence").body["fence"]["id"], id);
  EXPECT_EQ(call("GET", "/fences").body["items"][0]["active"], true);
  EXPECT_EQ(call("DELETE", "/fences/" + id, "", tag(1)).status, 409u);
  EXPECT_EQ(call("PUT", "/fence", Json{{"fence_id", "nobody"}}).status, 422u);
  EXPECT_EQ(call("PUT", "/fence", Json::object()).status, 422u);
  // A change of the active one counts at once.
  ASSERT_EQ(call("PUT", "/fences/" + id, fence(7), tag(1)).status, 200u);
  EXPECT_EQ(call("GET", "/fence").body["fence"]["areas"][0]["circle"]["radius_m"], 7.0);
  EXPECT_TRUE(call("PUT", "/fence", Json{{"fence_id", nullptr}}).body["fence"].is_null());
}

/// The answer tells what the robot did: when it comes, the robot holds the fence.
TEST_F(FencesApi, TheAnswerComesWhenTheRobotHoldsTheFence) {
  until_ready();
  const std::string id = call("POST", "/fences", fence(30)).body["id"];
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(call("PUT", "/fence", Json{{"fence_id", id}}).status, 200u);
    ASSERT_TRUE(house.snapshot()->fence);
    EXPECT_EQ(house.snapshot()->fence->name, "field");
    Json renamed = fence(20 + i);
    renamed["name"] = "yard";
    ASSERT_EQ(call("PUT", "/fences/" + id, renamed, tag(2 * i + 1)).status, 200u);
    EXPECT_EQ(house.snapshot()->fence->name, "yard");
    ASSERT_EQ(call("PUT", "/fences/" + id, fence(30), tag(2 * i + 2)).status, 200u);
    EXPECT_EQ(house.snapshot()->fence->name, "field");
    ASSERT_EQ(call("PUT", "/fence", Json{{"fence_id", nullptr}}).status, 200u);
    EXPECT_FALSE(house.snapshot()->fence);
  }
}

TEST_F(FencesApi, AFenceThatTheRobotDoesNotTakeIsNotToldAsHeld) {
  until_ready();
  const std::string id = call("POST", "/fences", fence(30)).body["id"];
  house.ticking = false;
  const auto answer = call("PUT", "/fence", Json{{"fence_id", id}});
  EXPECT_EQ(answer.status, 503u);
  EXPECT_EQ(answer.body["detail"],
            "it is stored and chosen, but the robot does not hold it yet: nobody answers: the "
            "control loop or the driver hangs");
  house.ticking = true;
  until([this] { return house.snapshot()->fence.has_value(); }, "it holds after all");
}

TEST_F(FencesApi, AMissionIsCheckedAndItsErrorsAreNotLoaded) {
  until_ready();
  const std::string good = mission({5, 20, 20});
  const auto report = call("POST", "/missions/" + good + "/check");
  ASSERT_EQ(report.status, 200u) << report.raw.body;
  EXPECT_EQ(report.body["ready"], true);
  ASSERT_EQ(report.body["findings"].size(), 1u);
  EXPECT_EQ(report.body["findings"][0]["code"], "duplicate_point");
  EXPECT_EQ(report.body["findings"][0]["pointer"], "/items/2");
  EXPECT_EQ(report.body["findings"][0]["item"], 3);
  EXPECT_NEAR(report.body["length_m"], 15.0, 0.1);
  EXPECT_GT(report.body["time_s"], 10.0);
  EXPECT_GT(report.body["battery_pct"], 0.0);

  // Its warnings are shown when it is loaded, and before it starts.
  const auto loaded = call("POST", "/execution/load", Json{{"mission_id", good}});
  ASSERT_EQ(loaded.status, 200u) << loaded.raw.body;
  EXPECT_EQ(loaded.body["warnings"].size(), 1u);
  EXPECT_EQ(call("GET", "/execution/preview").body["warnings"], loaded.body["warnings"]);

  // With a fence round the first two only, another one is refused.
  const std::string id = call("POST", "/fences", fence(30)).body["id"];
  ASSERT_EQ(call("PUT", "/fence", Json{{"fence_id", id}}).status, 200u);
  const std::string outside = mission({5, 40});
  EXPECT_EQ(call("POST", "/missions/" + outside + "/check").body["fence_id"], id);
  const auto refused = call("POST", "/execution/load", Json{{"mission_id", outside}});
  EXPECT_EQ(refused.status, 422u);
  EXPECT_EQ(refused.body["errors"][0]["pointer"], "/items/1");
  EXPECT_EQ(refused.body["detail"], "item 2 lies outside the fence");
  EXPECT_EQ(call("GET", "/execution").body["mission_id"], good);
}

/// Check, load, preview and start: the same finding in the same words, before anything is armed.
TEST_F(FencesApi, WhatAStartRefusesIsFoundByEveryQuestionBeforeIt) {
  until_ready();
  // A hole between the robot and a mission that itself stays clear of it.
  Json ring = fence(60);
  Json hole = Json::array();
  for (const auto& [north_m, east_m] :
       {std::pair{8.0, -3.0}, std::pair{8.0, 3.0}, std::pair{12.0, 3.0}, std::pair{12.0, -3.0}}) {
    hole.push_back(
        {{"lat", kStart.lat + north_m / 111'384}, {"lon", kStart.lon + east_m / 58'500}});
  }
  ring["areas"].push_back({{"kind", "exclusion"}, {"polygon", hole}});
  const auto made = call("POST", "/fences", ring);
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  ASSERT_EQ(call("PUT", "/fence", Json{{"fence_id", made.body["id"]}}).status, 200u);
  until([&] { return call("GET", "/vehicle").body["fence"].is_object(); }, "the fence holds");
  const std::string beyond = mission({20, 30});
  const auto report = call("POST", "/missions/" + beyond + "/check");
  ASSERT_EQ(report.status, 200u) << report.raw.body;
  EXPECT_EQ(report.body["ready"], false);
  ASSERT_EQ(report.body["findings"].size(), 1u) << report.raw.body;
  const Json finding = report.body["findings"][0];
  EXPECT_EQ(finding["code"], "approach_outside_fence");
  EXPECT_EQ(finding["severity"], "error");
  EXPECT_EQ(finding["pointer"], "/items/0");
  // It may be driven to the other side by hand: it is loaded, and the finding shown.
  const auto loaded = call("POST", "/execution/load", Json{{"mission_id", beyond}});
  ASSERT_EQ(loaded.status, 200u) << loaded.raw.body;
  EXPECT_EQ(loaded.body["warnings"], Json::array({finding}));
  const auto preview = call("GET", "/execution/preview");
  ASSERT_EQ(preview.status, 200u);
  EXPECT_EQ(preview.body["ready"], false);
  EXPECT_EQ(preview.body["findings"], Json::array({finding}));
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  Reply start;
  until(
      [&] {
        start = call(
            "POST", "/execution/start",
            Json{{"mission_id", beyond}, {"revision", 1}, {"from", "first"}, {"valid_for_s", 5}});
        return start.body["detail"] != "fence and mission are being compared: try again";
      },
      "fence and mission are compared");
  ASSERT_EQ(start.status, 409u) << start.raw.body;
  EXPECT_EQ(start.body["detail"], "item 1 " + finding["detail"].get<std::string>());
  EXPECT_EQ(start.body["errors"][0]["pointer"], "/items/0");
}

TEST_F(FencesApi, AnActionThatNobodyDoesIsFoundAndStopsTheLoad) {
  until_ready();
  const Json items = {
      {{"type", "waypoint"}, {"lat", kStart.lat + 5.0 / 111'384}, {"lon", kStart.lon}},
      {{"type", "action"}, {"name", "set_home"}},
      {{"type", "action"}, {"name", "pump_on"}},
      {{"type", "action"}, {"name", "take_photo"}}};
  const auto made = call("POST", "/missions", Json{{"name", "spray"}, {"items", items}});
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  const std::string id = made.body["id"];
  const auto report = call("POST", "/missions/" + id + "/check");
  EXPECT_EQ(report.body["ready"], false);
  ASSERT_EQ(report.body["findings"].size(), 2u) << report.raw.body;
  EXPECT_EQ(report.body["findings"][0]["code"], "unknown_action");
  EXPECT_EQ(report.body["findings"][0]["pointer"], "/items/2");
  EXPECT_EQ(report.body["findings"][1]["pointer"], "/items/3");
  const auto refused = call("POST", "/execution/load", Json{{"mission_id", id}});
  EXPECT_EQ(refused.status, 422u);
  EXPECT_EQ(refused.body["detail"],
            "item 3 asks for the action \"pump_on\", which nothing here does; built in: set_home; "
            "2 findings in all");
  EXPECT_EQ(call("GET", "/execution").body["state"], "idle");
}

TEST_F(FencesApi, TypesWithoutTheirDriverAreStoredAndRefusedAtLoad) {
  const Json items = {{{"type", "waypoint"}, {"lat", kStart.lat}, {"lon", kStart.lon}},
                      {{"type", "row"}, {"side", "left"}, {"gap_m", 0.8}},
                      {{"type", "wall"}, {"side", "right"}, {"distance_m", 0.9}},
                      {{"type", "landmarks"}, {"name", "cone"}, {"offset_m", 0.7}}};
  const auto made = call("POST", "/missions", Json{{"name", "rows"}, {"items", items}});
  ASSERT_EQ(made.status, 201u);
  EXPECT_EQ(call("GET", "/missions/" + made.body["id"].get<std::string>()).body["items"], items);
  const auto refused = call("POST", "/execution/load", Json{{"mission_id", made.body["id"]}});
  EXPECT_EQ(refused.status, 422u);
  EXPECT_EQ(refused.body["errors"].size(), 3u);
  EXPECT_EQ(refused.body["errors"][0]["pointer"], "/items/1");
}

}  // namespace
}  // namespace roverd::test
