// Goals, moves, targets, parameters and runs over HTTP. The base of this house does as told in the
// air: it never gets anywhere, so what is asked stays under way.

#include <regex>

#include "house.hpp"

namespace roverd::test {
namespace {

using ModesApi = HouseTest;

TEST_F(ModesApi, AGoalIsBegunAndTold) {
  until_ready();
  const Json goal = {
      {"lat", kStart.lat + 0.0001}, {"lon", kStart.lon}, {"heading_deg", 90}, {"valid_for_s", 5}};
  const auto unarmed = call("POST", "/vehicle/goto", goal);
  EXPECT_EQ(unarmed.status, 409u);
  EXPECT_EQ(unarmed.body["detail"], "the robot is not armed");
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto begun = call("POST", "/vehicle/goto", goal);
  ASSERT_EQ(begun.status, 202u);
  EXPECT_EQ(begun.raw.header("location"), "/api/v1/vehicle");
  EXPECT_EQ(begun.body["mode"], "GUIDED");
  const Json& activity = begun.body["activity"];
  EXPECT_EQ(activity["kind"], "goto");
  EXPECT_GE(activity["id"], 1);
  until([this] { return !call("GET", "/vehicle").body["activity"]["goal"].is_null(); }, "told");
  const auto state = call("GET", "/vehicle").body;
  EXPECT_NEAR(state["activity"]["goal"]["lat"], kStart.lat + 0.0001, 1e-7);
  EXPECT_EQ(state["activity"]["goal_heading_deg"], 90.0);
  EXPECT_NEAR(state["origin"]["lat"], kStart.lat, 1e-5);
  EXPECT_TRUE(state["fence"].is_null());
  const auto held = call("PUT", "/vehicle/mode", Json{{"mode", "HOLD"}});
  EXPECT_EQ(held.body["activity"]["state"], "failed");
  EXPECT_EQ(call("POST", "/vehicle/move", Json{{"turn_deg", -90}, {"valid_for_s", 5}}).status,
            202u);
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "RTL"}, {"valid_for_s", 5}}).status, 200u);
  const auto smart = call("PUT", "/vehicle/mode", Json{{"mode", "SMART_RTL"}, {"valid_for_s", 5}});
  EXPECT_EQ(smart.status, 200u) << smart.body.dump();
}

TEST_F(ModesApi, BadGoalsNameTheirFields) {
  until_ready();
  const auto refused = [this](const char* path, const char* method, const Json& body) {
    const auto reply = call(method, path, body);
    EXPECT_EQ(reply.status, 422u) << body.dump() << reply.body.dump();
    return reply.body["errors"].empty() ? std::string()
                                        : reply.body["errors"][0].value("pointer", "");
  };
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"lat", 95}, {"lon", 20}}), "/lat");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"lat", 58}}), "/lon");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"east_m", 1}, {"north_m", nullptr}}), "/north_m");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"speed_mps", 1}}), "/heading_deg");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"lat", 58}, {"lon", 26}, {"east_m", 2}}), "/lat");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"lat", "58"}, {"lon", 26}}), "/lat");
  EXPECT_EQ(refused("/vehicle/goto", "POST", {{"lat", 58}, {"lon", 26}, {"up", 1}}), "/up");
  refused("/vehicle/move", "POST", Json::object());
  refused("/vehicle/move", "POST", {{"forward_m", 1}, {"turn_deg", 10}});
  EXPECT_EQ(refused("/vehicle/move", "POST", {{"heading_deg", 400}}), "/heading_deg");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "DOCK"}}), "/heading_deg");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "DOCK"}, {"tag", 587}}), "/tag");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "DOCK"}, {"tag", nullptr}}), "/tag");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "DOCK"}, {"tag", 5}, {"lat", 58}}), "/lat");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "DOCK"}, {"tag", 5}, {"stand_off_m", 9}}),
            "/stand_off_m");
  EXPECT_EQ(refused("/vehicle/mode", "PUT", {{"mode", "RTL"}, {"lat", 1}}), "/lat");
  EXPECT_EQ(refused("/vehicle/target", "PUT", {{"lat", 58}, {"lon", 26}, {"speed_mps", 1}}),
            "/heading_deg");
  EXPECT_EQ(refused("/vehicle/target", "PUT",
                    {{"lat", 58}, {"lon", 26}, {"time", "2150-01-01T00:00:00Z"}}),
            "/time");
  EXPECT_EQ(refused("/vehicle/target", "PUT",
                    {{"lat", 58}, {"lon", 26}, {"offset", {{"east_m", 1}, {"left_m", 1}}}}),
            "/offset");
  EXPECT_EQ(call("POST", "/vehicle/goto", "{\"lat\": NaN, \"lon\": 1}").status, 400u);
}

TEST_F(ModesApi, ATargetIsTakenAndFollowed) {
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto none = call("PUT", "/vehicle/mode", Json{{"mode", "FOLLOW"}, {"valid_for_s", 5}});
  EXPECT_EQ(none.status, 409u);
  const Json target = {
      {"lat", kStart.lat + 0.0001}, {"lon", kStart.lon},
      {"speed_mps", 0.5},           {"heading_deg", 0},
      {"valid_for_s", 5},           {"offset", {{"forward_m", -3}, {"left_m", 1}}}};
  ASSERT_EQ(call("PUT", "/vehicle/target", target).status, 200u);
  const auto follow = call("PUT", "/vehicle/mode", Json{{"mode", "FOLLOW"}, {"valid_for_s", 5}});
  EXPECT_EQ(follow.status, 200u) << follow.body.dump();
  // The target falls silent: it holds by itself.
  until([this] { return call("GET", "/vehicle").body["mode"] == "HOLD"; }, "held");
  const auto far = call("PUT", "/vehicle/target",
                        Json{{"lat", kStart.lat + 1.0}, {"lon", kStart.lon}, {"valid_for_s", 5}});
  EXPECT_EQ(far.status, 422u);
}

TEST_F(ModesApi, ParametersAreListedAndChanged) {
  until_ready();
  const auto all = call("GET", "/parameters");
  ASSERT_EQ(all.status, 200u);
  EXPECT_GT(all.body["items"].size(), 80u);
  for (const Json& one : all.body["items"]) {  // nothing that could hold a login
    EXPECT_FALSE(one["name"].get<std::string>().ends_with(".link")) << one;
    EXPECT_FALSE(one["name"].get<std::string>().starts_with("drivers.")) << one;
    EXPECT_EQ(one["value"].dump().find("://"), std::string::npos) << one;
  }
  const auto one = call("GET", "/parameters/nav.speed.max_mps");
  EXPECT_EQ(one.body["unit"], "m/s");
  EXPECT_EQ(one.body["type"], "number");
  EXPECT_EQ(one.body["acts"], "at_once");
  EXPECT_EQ(one.body["value"], one.body["default"]);
  const auto changed = call("PUT", "/parameters/nav.speed.max_mps", Json{{"value", 0.7}});
  ASSERT_EQ(changed.status, 200u) << changed.body.dump();
  EXPECT_EQ(changed.body["value"], 0.7);
  EXPECT_EQ(changed.body["acted"], true);
  EXPECT_EQ(changed.body["kept"], true);
  until([this] { return call("GET", "/parameters/nav.speed.max_mps").body["value"] == 0.7; },
        "published");
  const auto later = call("PUT", "/parameters/vehicle.wheelbase_m", Json{{"value", 2}});
  EXPECT_EQ(later.status, 200u);
  EXPECT_EQ(later.body["acted"], false);
  EXPECT_EQ(later.body["next_start"], 2.0);
  const auto status = [this](const char* name, const Json& body) {
    return call("PUT", std::string("/parameters/") + name, body).status;
  };
  EXPECT_EQ(status("nav.speed.max_mps", {{"value", 99}}), 422u);
  EXPECT_EQ(status("nav.speed.max_mps", {{"value", "fast"}}), 422u);
  EXPECT_EQ(status("nav.speed.max_mps", {{"value", nullptr}}), 422u);
  EXPECT_EQ(status("nav.speed.max_mps", Json::object()), 422u);
  EXPECT_EQ(status("nav.speed.nothing", {{"value", 1}}), 404u);
  EXPECT_EQ(call("GET", "/parameters/nothing").status, 404u);
}

/// Not after a restart, when nobody expects it: at once, and what a start would refuse not at all.
TEST_F(ModesApi, AParameterActsWhenItIsSaidToAndWrongOnesAreRefusedInWords) {
  until_ready();
  const auto refused = [this](const char* name, const Json& value) {
    const auto reply = call("PUT", std::string("/parameters/") + name, Json{{"value", value}});
    EXPECT_EQ(reply.status, 422u) << name;
    EXPECT_EQ(reply.body["errors"][0]["pointer"], "/value") << reply.raw.body;
    EXPECT_EQ(call("GET", std::string("/parameters/") + name).body["value"],
              call("GET", std::string("/parameters/") + name).body["default"]);
    return reply.body["detail"].get<std::string>();
  };
  EXPECT_EQ(refused("nav.track.law", "zigzag"),
            "nav.track.law must be path_frame, pure_pursuit or stanley, is \"zigzag\"");
  EXPECT_EQ(refused("battery.curve", "garbage"),
            "battery.curve: \"garbage\" must be a voltage (0 to 1000) and a charge (0 to 100)");
  EXPECT_EQ(refused("nav.speed.min_mps", 0.9),
            "nav.speed.reverse_max_mps must not be below nav.speed.min_mps");
  const auto before = call("GET", "/vehicle").body;
  EXPECT_EQ(before["ready_to_arm"], true);
  const auto fewer = call("PUT", "/parameters/nav.estimate.satellites_min", Json{{"value", 30}});
  ASSERT_EQ(fewer.status, 200u) << fewer.raw.body;
  EXPECT_EQ(fewer.body["acted"], true);
  until(
      [this] {
        return call("GET", "/vehicle").body["estimator"]["refusals"]["satellites"].get<int>() > 0;
      },
      "its positions are not used any more");
}

TEST_F(ModesApi, ADrivenMissionBecomesARun) {
  until_ready();
  EXPECT_EQ(call("GET", "/runs").body["items"].size(), 0u);
  const std::string id = make_mission("short");
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const Json start = {{"mission_id", id}, {"revision", 1}, {"valid_for_s", 5}};
  ASSERT_EQ(call("POST", "/execution/start", start).status, 200u);
  until([this] { return call("GET", "/runs").body["items"].size() == 1; }, "a run is listed");
  until([this] { return call("GET", "/runs/1/track?format=csv").raw.body.size() > 400; },
        "points are stored");
  ASSERT_EQ(call("POST", "/execution/stop").status, 200u);
  until([this] { return call("GET", "/runs/1").body["outcome"] == "aborted"; }, "it ended");
  const auto run = call("GET", "/runs/1");
  EXPECT_EQ(run.body["name"], "short");
  EXPECT_EQ(run.body["mission_id"], id);
  EXPECT_EQ(run.body["parameters"]["robot.arming.healthy_s"], 0.2);
  EXPECT_EQ(run.body["plan"]["items"].size(), 2u);
  const auto report = call("GET", "/runs/1/report");
  ASSERT_EQ(report.status, 200u) << report.body.dump();
  EXPECT_GT(report.body["time_s"], 0.3);
  const auto geojson = call("GET", "/runs/1/track");
  EXPECT_EQ(geojson.body["features"][0]["geometry"]["type"], "LineString");
  EXPECT_NE(call("GET", "/runs/1/track?format=gpx").raw.body.find("<trkpt"), std::string::npos);
  const std::string offered = geojson.raw.header("content-disposition");
  EXPECT_TRUE(std::regex_match(
      offered, std::regex(R"(attachment; filename="run-1-\d{4}-\d\d-\d\d-short\.geojson")")))
      << offered;
  EXPECT_EQ(call("GET", "/runs/1/track?format=pdf").status, 422u);
  EXPECT_EQ(call("GET", "/runs/7").status, 404u);
  EXPECT_EQ(call("DELETE", "/runs/7").status, 404u);
  EXPECT_EQ(call("DELETE", "/runs/1").status, 204u);
  EXPECT_EQ(call("GET", "/runs/1").status, 404u);
  EXPECT_EQ(call("GET", "/runs").body["items"].size(), 0u);
  EXPECT_EQ(call("GET", "/runs/seven/report").status, 404u);
  EXPECT_TRUE(call("GET", "/execution").body["left_behind"].is_null());
  EXPECT_EQ(call("DELETE", "/execution/left_behind").status, 204u);
}

}  // namespace
}  // namespace roverd::test
