// Vehicle and execution over HTTP: answers tell what the robot did.

#include <algorithm>

#include "house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
using VehicleApi = HouseTest;

TEST_F(VehicleApi, TheStateIsWholeAndJudgedByTheDocument) {
  until_ready();
  const auto reply = call("GET", "/vehicle");
  EXPECT_EQ(reply.status, 200u);
  EXPECT_EQ(reply.body["name"], "bunker");
  EXPECT_EQ(reply.body["mode"], "HOLD");
  EXPECT_EQ(reply.body["armed"], false);
  EXPECT_NEAR(reply.body["position"]["lat"], kStart.lat, 1e-5);
  EXPECT_EQ(reply.body["gnss"]["fix"], "rtk_fixed");
  EXPECT_EQ(reply.body["battery"]["charge_pct"], 80.0);
  EXPECT_EQ(call("GET", "/vehicle/checks").body["ready"], true);
  EXPECT_EQ(call("GET", "/vehicle/capabilities").body["kinematics"], "skid_steer");
  until([this] { return !call("GET", "/drivers").body["items"].empty(); }, "a driver is listed");
}

TEST_F(VehicleApi, TheSkyIsToldReceiverByReceiver) {
  // Given no receiver that tells of satellites,
  until_ready();
  EXPECT_EQ(call("GET", "/gnss/satellites").body["receivers"], Json::array());
  // when one does,
  auto all = std::make_shared<std::vector<base::Satellite>>();
  all->push_back(
      {"galileo", 11, 50.0, 200.0, 41.0, true, {{"E1 C", 41.0, true}, {"E5b Q", {}, false}}});
  all->push_back({"glonass", 3, {}, {}, {}, {}});
  house.hear(base::SatellitesInView{base::steady_now(), "gnss", all});
  until([this] { return !call("GET", "/gnss/satellites").body["receivers"].empty(); }, "a sky");
  // then it is listed; what is not known is null.
  const auto reply = call("GET", "/gnss/satellites");
  EXPECT_EQ(reply.status, 200u);
  const Json& sky = reply.body["receivers"][0];
  EXPECT_EQ(sky["driver"], "gnss");
  EXPECT_EQ(sky["stale"], false);
  EXPECT_EQ(sky["satellites"][0],
            (Json{{"system", "galileo"},
                  {"number", 11},
                  {"elevation_deg", 50.0},
                  {"azimuth_deg", 200.0},
                  {"cn0_dbhz", 41.0},
                  {"used", true},
                  {"signals",
                   Json::array({{{"name", "E1 C"}, {"cn0_dbhz", 41.0}, {"used", true}},
                                {{"name", "E5b Q"}, {"cn0_dbhz", nullptr}, {"used", false}}})}}));
  EXPECT_EQ(sky["satellites"][1]["signals"], Json::array());
  EXPECT_EQ(sky["satellites"][1]["elevation_deg"], nullptr);
  EXPECT_EQ(sky["satellites"][1]["used"], nullptr);
}

TEST_F(VehicleApi, TheWaySoFarIsKeptInPiecesForWhoComesLate) {
  until_ready();
  const auto here = call("GET", "/vehicle/trail");
  ASSERT_EQ(here.status, 200u);
  ASSERT_EQ(here.body["estimated"].size(), 1u);
  ASSERT_EQ(here.body["received"].size(), 1u);
  for (const char* track : {"estimated", "received"}) {
    const Json& first = here.body[track][0][0];
    EXPECT_NEAR(first[0], kStart.lat, 1e-6) << track;
    EXPECT_NEAR(first[1], kStart.lon, 1e-6) << track;
    EXPECT_LT(first[2], 20.0) << track;
  }
  // When the receiver insists on being 60 m away, the robot believes it after a while,
  house.moved_m = 60.0;
  until([this] { return call("GET", "/vehicle/trail").body["estimated"].size() == 2; }, "set anew");
  // and no line leads there; the time of the answer is that of the robot's state.
  const auto there = call("GET", "/vehicle/trail");
  EXPECT_NEAR(there.body["estimated"][1][0][0], kStart.lat + 60.0 / 111'400, 1e-5);
  EXPECT_EQ(there.body["received"].size(), 2u);
  EXPECT_GT(there.body["time"], here.body["time"]);
  EXPECT_LE(there.body["time"], call("GET", "/vehicle").body["time"]);
  EXPECT_EQ(call("DELETE", "/vehicle/trail").status, 405u);
}

TEST_F(VehicleApi, TheWayHomeIsShownBeforeAnythingMoves) {
  until_ready();
  const auto unarmed = call("GET", "/vehicle/way_home");
  ASSERT_EQ(unarmed.status, 200u) << unarmed.body.dump();
  EXPECT_EQ(unarmed.body["mode"], "RTL");
  EXPECT_EQ(unarmed.body["possible"], false);
  EXPECT_EQ(unarmed.body["reason"], "the robot is not armed");
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const Json there = {{"lat", kStart.lat + 0.0001}, {"lon", kStart.lon}};
  ASSERT_EQ(call("PUT", "/vehicle/home", there).status, 200u);
  until([this] { return call("GET", "/vehicle/way_home").body["possible"] == true; }, "armed");
  const auto shown = call("GET", "/vehicle/way_home?mode=RTL");
  EXPECT_NEAR(shown.body["target"]["lat"], there["lat"].get<double>(), 1e-9);
  EXPECT_EQ(shown.body["target_is"], "home");
  EXPECT_NEAR(shown.body["distance_m"], 11.1, 0.3);
  ASSERT_EQ(shown.body["line"].size(), 2u);
  EXPECT_NEAR(shown.body["line"][0]["lat"], kStart.lat, 1e-5);
  EXPECT_EQ(shown.body["line"][1], shown.body["target"]);
  EXPECT_EQ(call("GET", "/vehicle/way_home?mode=SMART_RTL").status, 200u);
  for (const char* bad : {"AUTO", "rtl", "x"}) {
    const auto refused = call("GET", std::string("/vehicle/way_home?mode=") + bad);
    EXPECT_EQ(refused.status, 422u) << bad;
    EXPECT_EQ(refused.body["errors"][0]["pointer"], "mode");
  }
  // The answer to the command tells the same before it moves.
  const auto going = call("PUT", "/vehicle/mode", Json{{"mode", "RTL"}, {"valid_for_s", 5}});
  ASSERT_EQ(going.status, 200u) << going.body.dump();
  EXPECT_NEAR(going.body["activity"]["distance_m"], 11.1, 0.3);
  EXPECT_NEAR(going.body["activity"]["goal"]["lat"], there["lat"].get<double>(), 1e-9);
  // Nothing was interrupted by the radio.
  EXPECT_EQ(call("POST", "/vehicle/resume", Json{{"valid_for_s", 5}}).status, 409u);
  EXPECT_EQ(call("GET", "/vehicle").body["loop"]["faults"], 0);
}

TEST_F(VehicleApi, SilentDevicesGoStale) {
  until_ready();
  house.healthy = false;
  until([this] { return call("GET", "/vehicle").body["base"]["stale"] == true; }, "base stale");
  const auto reply = call("GET", "/vehicle");
  EXPECT_GT(reply.body["base"]["age_s"].get<double>(), 0.5);
  EXPECT_EQ(reply.body["base"]["state"], "normal");  // what was last heard stays
}

TEST_F(VehicleApi, ArmingSaysWhichChecksFail) {
  // Given a robot whose devices are silent,
  house.healthy = false;
  until([this] { return call("GET", "/vehicle").body["base"]["stale"] == true; }, "base stale");
  const auto refused = call("POST", "/vehicle/arm");
  EXPECT_EQ(refused.status, 409u);
  ASSERT_FALSE(refused.body["errors"].empty());
  EXPECT_EQ(call("GET", "/vehicle").body["armed"], false);
  // when they speak,
  house.healthy = true;
  until_ready();
  // then it arms.
  const auto armed = call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}});
  EXPECT_EQ(armed.status, 200u);
  EXPECT_EQ(armed.body["armed"], true);
  EXPECT_EQ(call("POST", "/vehicle/disarm").body["armed"], false);
}

TEST_F(VehicleApi, ModesAreSetOrRefusedWithTheReason) {
  until_ready();
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).body["mode"], "MANUAL");
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "HOLD"}}).body["mode"], "HOLD");
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "RTL"}}).status, 409u);
  const auto wrong = call("PUT", "/vehicle/mode", Json{{"mode", "fly"}});
  EXPECT_EQ(wrong.status, 422u);
  EXPECT_EQ(wrong.body["errors"][0]["pointer"], "/mode");
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", 3}, {"speed", 1}}).body["errors"].size(),
            2u);
  EXPECT_EQ(call("PUT", "/vehicle/mode").status, 415u);
  EXPECT_EQ(call("PUT", "/vehicle/mode", std::string("{")).status, 400u);
  EXPECT_EQ(call("PUT", "/vehicle/mode", std::string("null")).status, 422u);
}

TEST_F(VehicleApi, TheStopIsLatchedUntilItIsReset) {
  until_ready();
  const auto stopped = call("POST", "/vehicle/estop");
  EXPECT_EQ(stopped.status, 200u);
  EXPECT_EQ(stopped.body["estop"], true);
  EXPECT_EQ(call("POST", "/vehicle/arm").status, 409u);
  EXPECT_EQ(call("POST", "/vehicle/estop/reset").body["estop"], false);
}

TEST_F(VehicleApi, HomeIsHereOrThere) {
  until_ready();
  const auto here = call("PUT", "/vehicle/home");
  EXPECT_EQ(here.status, 200u);
  EXPECT_NEAR(here.body["home"]["lat"], kStart.lat, 1e-5);
  const auto there = call("PUT", "/vehicle/home", Json{{"lat", 58.4}, {"lon", 26.8}});
  EXPECT_EQ(there.body["home"]["lat"], 58.4);
  // Out of the map's reach: a return home would drive there.
  EXPECT_EQ(call("PUT", "/vehicle/home", Json{{"lat", 0}, {"lon", 0}}).status, 422u);
  EXPECT_EQ(call("PUT", "/vehicle/home", Json{{"lat", 58.5}}).body["errors"][0]["pointer"], "/lon");
  EXPECT_EQ(call("PUT", "/vehicle/home", Json{{"lat", 91}, {"lon", 26.5}}).status, 422u);
}

TEST_F(VehicleApi, AnOperatorSaysWhereTheRobotStandsAndAtWhichPoint) {
  until_ready();
  const auto known = call("GET", "/vehicle").body;
  EXPECT_TRUE(known["estimator"]["anchor"].is_null());
  EXPECT_TRUE(known["position"]["ellipse"]["major_m"].is_number());
  // Given a point a metre north of where the receiver says that the robot stands,
  const double lat = known["position"]["lat"].get<double>() + 1.0 / 111'360.0;
  const Json point = {{"lat", lat}, {"lon", known["position"]["lon"]}};
  const auto anchored = call("POST", "/vehicle/anchor", point);
  ASSERT_EQ(anchored.status, 200u);
  EXPECT_NEAR(anchored.body["estimator"]["anchor"]["north_m"].get<double>(), 1.0, 0.05);
  EXPECT_NEAR(anchored.body["position"]["lat"].get<double>(), lat, 1e-6);
  EXPECT_EQ(anchored.body["estimator"]["last_reset"]["what"], "anchor");
  EXPECT_TRUE(call("DELETE", "/vehicle/anchor").body["estimator"]["anchor"].is_null());
  EXPECT_EQ(call("DELETE", "/vehicle/anchor").status, 409u);
  // A point that is far away, an item of no mission, halves and doubles are refused.
  EXPECT_EQ(call("POST", "/vehicle/anchor", Json{{"lat", lat + 0.01}, {"lon", 26.7289}}).status,
            409u);
  EXPECT_EQ(call("POST", "/vehicle/anchor", Json{{"item", 1}}).status, 409u);
  EXPECT_EQ(call("POST", "/vehicle/anchor", Json::object()).body["errors"][0]["pointer"], "/item");
  EXPECT_EQ(call("POST", "/vehicle/anchor", Json{{"lat", lat}}).body["errors"][0]["pointer"],
            "/lon");
  // A pose: which way it points, where it stands on the map, but not both ways of saying where.
  const auto turned = call("PUT", "/vehicle/pose", Json{{"heading_deg", 123}});
  ASSERT_EQ(turned.status, 200u);
  EXPECT_NEAR(turned.body["position"]["heading_deg"].get<double>(), 123.0, 1.0);
  EXPECT_EQ(turned.body["estimator"]["last_reset"]["what"], "pose");
  EXPECT_EQ(call("PUT", "/vehicle/pose", Json{{"east_m", 1}, {"north_m", 2}}).status, 200u);
  const Json both = {{"lat", lat}, {"lon", 26.7289}, {"east_m", 1}, {"north_m", 2}};
  EXPECT_EQ(call("PUT", "/vehicle/pose", both).status, 422u);
  EXPECT_EQ(call("PUT", "/vehicle/pose", Json::object()).body["errors"][0]["pointer"],
            "/heading_deg");
  EXPECT_EQ(call("PUT", "/vehicle/pose", Json{{"east_m", 1}}).body["errors"][0]["pointer"],
            "/north_m");
  EXPECT_EQ(call("PUT", "/vehicle/pose", Json{{"heading_deg", "north"}}).status, 422u);
}

TEST_F(VehicleApi, AHangingLoopIsReportedAndLateCommandsAreNotCarriedOut) {
  // Given a control loop that hangs,
  until_ready();
  house.ticking = false;
  until([this] { return call("GET", "/health").body["status"] == "degraded"; }, "degraded");
  // when somebody arms, then he hears that nothing answers,
  const auto reply = call("POST", "/vehicle/arm", Json{{"valid_for_s", 0.2}});
  EXPECT_EQ(reply.status, 503u);
  // and when the loop runs again, the old command is not carried out.
  house.ticking = true;
  until([this] { return call("GET", "/health").body["status"] == "ok"; }, "well again");
  EXPECT_EQ(call("GET", "/vehicle").body["armed"], false);
}

TEST_F(VehicleApi, ACommandWhoseBodyTrickledInIsTooLate) {
  until_ready();
  // Given an arm command of which the end comes after its validity,
  Client client(house.port());
  client.send(
      "POST /api/v1/vehicle/arm HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
      "Content-Length: 20\r\n\r\n{\"valid_for_s\":");
  std::this_thread::sleep_for(300ms);
  client.send(" 0.1}");
  const auto answer = client.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 409u);
  EXPECT_NE(answer->body.find("too late"), std::string::npos);
  EXPECT_EQ(call("GET", "/vehicle").body["armed"], false);
}

/// Every 30 cm one, 2 cm to either side of a line to the north.
Json dense_points(int count) {
  Json items = Json::array();
  for (int i = 0; i < count; ++i) {
    items.push_back({{"type", "waypoint"},
                     {"lat", kStart.lat + 2.7e-6 * (i + 30)},
                     {"lon", kStart.lon + (i % 2 == 0 ? 3.4e-7 : -3.4e-7)}});
  }
  return items;
}

TEST_F(VehicleApi, TheWayIsToldAsItWillBeDrivenNotAsItsPointsLie) {
  until_ready();
  EXPECT_EQ(call("GET", "/execution/way").status, 409u);
  // Given a driven track, as a receiver tells it,
  const auto made =
      call("POST", "/missions", Json{{"name", "track"}, {"items", dense_points(200)}});
  ASSERT_EQ(made.status, 201u);
  const std::string id = made.body["id"];
  const auto checked = call("POST", "/missions/" + id + "/check");
  ASSERT_EQ(checked.body["smoothed"].size(), 1u);
  const Json& stretch = checked.body["smoothed"][0];
  EXPECT_EQ(stretch["first_item"], 1);
  EXPECT_EQ(stretch["last_item"], 200);
  EXPECT_GT(stretch["deviation_m"], 0.01);
  EXPECT_LT(stretch["deviation_m"], 0.05);
  // when it is loaded,
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  EXPECT_EQ(call("GET", "/execution/preview").body["smoothed"], checked.body["smoothed"]);
  // then the way that is drawn goes through the middle of its points.
  const auto way = call("GET", "/execution/way");
  ASSERT_EQ(way.status, 200u);
  EXPECT_EQ(way.body["mission_id"], id);
  EXPECT_EQ(way.body["revision"], 1);
  EXPECT_EQ(way.body["within_m"], 0.01);
  EXPECT_NEAR(way.body["length_m"], 199 * 0.3, 0.3);
  const Json& line = way.body["line"];
  ASSERT_GE(line.size(), 2u);
  EXPECT_LT(line.size(), 40u);
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    EXPECT_NEAR(line[i]["lon"], kStart.lon, 2.6e-7) << i;  // 1.5 cm
  }
}

/// What is told of the way from `item` - 1 to it.
double told_set_mps(const Json& pace, int item) {
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < pace.size(); ++i) {
    if (pace[i]["item"] == item) most = std::max(most, pace[i]["set_mps"].get<double>());
  }
  return most;
}

//   2 ──▶ 3        from 1 to the north, at 2 on the spot to the east, from 3 back to 4, and south
//   ▲     │
//   1     5
TEST_F(VehicleApi, TheWayTellsHowFastItIsDrivenAndWhereItStopsAndTurns) {
  until_ready();
  const double north = 9e-5;  // 10 m
  const double east = 1.7e-4;
  const auto to = [&](double n, double e, double speed_mps) {
    return Json{{"type", "waypoint"},
                {"lat", kStart.lat + n * north},
                {"lon", kStart.lon + e * east},
                {"speed_mps", speed_mps}};
  };
  Json corner = to(2, 0, 0.8);
  corner["turn"] = "pivot";
  Json back = to(2, 0.2, 0.3);
  back["reverse"] = true;
  const auto made =
      call("POST", "/missions",
           Json{{"name", "told"},
                {"items", {to(1, 0, 0.8), corner, to(2, 1, 0.4), back, to(0, 0.2, 0.8)}}});
  ASSERT_EQ(made.status, 201u) << made.body.dump();
  const std::string id = made.body["id"];
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  const auto way = call("GET", "/execution/way");
  ASSERT_EQ(way.status, 200u);
  const Json& pace = way.body["pace"];
  ASSERT_GT(pace.size(), 8u);
  EXPECT_NEAR(told_set_mps(pace, 2), 0.8, 1e-9);
  EXPECT_NEAR(told_set_mps(pace, 3), 0.4, 1e-9);
  EXPECT_NEAR(told_set_mps(pace, 4), 0.3, 1e-9);
  double before_m = -1.0;
  for (std::size_t i = 0; i < pace.size(); ++i) {
    const Json& p = pace[i];
    EXPECT_GT(p["distance_m"], before_m) << i;
    before_m = p["distance_m"];
    EXPECT_LE(p["speed_mps"].get<double>(), 0.8 + 1e-9) << i;
    const bool last_of_back = p["item"] == 4;
    if (i + 1 == pace.size()) continue;
    EXPECT_EQ(p["reverse"], last_of_back) << i;
  }
  EXPECT_EQ(pace.front()["speed_mps"], 0.0);
  EXPECT_EQ(pace.back()["speed_mps"], 0.0);
  EXPECT_NEAR(pace.back()["distance_m"], way.body["length_m"], 0.002);

  const Json& stops = way.body["stops"];
  EXPECT_EQ(way.body["stops_left_out"], 0);
  ASSERT_EQ(stops.size(), 5u);
  EXPECT_EQ(stops[0]["item"], 1);
  EXPECT_EQ(stops[0]["distance_m"], 0.0);
  EXPECT_TRUE(stops[0]["turns"][0]["from_heading_deg"].is_null());
  EXPECT_NEAR(stops[0]["turns"][0]["to_heading_deg"], 0.0, 0.5);
  EXPECT_EQ(stops[1]["item"], 2);
  EXPECT_NEAR(stops[1]["lat"], kStart.lat + 2 * north, 2e-8);
  ASSERT_EQ(stops[1]["turns"].size(), 1u);
  EXPECT_NEAR(stops[1]["turns"][0]["turn_deg"], 90.0, 0.5);
  EXPECT_NEAR(stops[1]["turns"][0]["to_heading_deg"], 90.0, 0.5);
  EXPECT_EQ(stops[2]["item"], 3);
  EXPECT_TRUE(stops[2]["turns"].empty());  // it backs up as it stands
  // Facing east still, it turns to the south.
  EXPECT_EQ(stops[3]["item"], 4);
  ASSERT_EQ(stops[3]["turns"].size(), 1u);
  EXPECT_NEAR(stops[3]["turns"][0]["turn_deg"], 90.0, 0.5);
  EXPECT_EQ(stops[4]["item"], 5);
  EXPECT_TRUE(stops[4]["turns"].empty());
}

TEST_F(VehicleApi, AMissionIsLoadedPreviewedStartedPausedAndStopped) {
  until_ready();
  const std::string id = make_mission();
  // Nothing is loaded yet: there is nothing to start.
  EXPECT_EQ(call("GET", "/execution").body["state"], "idle");
  EXPECT_EQ(call("GET", "/execution/preview").status, 409u);
  const Json start = {{"mission_id", id}, {"revision", 1}, {"valid_for_s", 5}};
  EXPECT_EQ(call("POST", "/execution/start", start).status, 409u);
  // Load: a copy of one revision.
  const auto loaded = call("POST", "/execution/load", Json{{"mission_id", id}});
  ASSERT_EQ(loaded.status, 200u) << loaded.body.dump();
  EXPECT_EQ(loaded.body["state"], "loaded");
  EXPECT_EQ(loaded.body["mission_id"], id);
  // Preview tells what start would do.
  const auto preview = call("GET", "/execution/preview?from=2");
  ASSERT_EQ(preview.status, 200u) << preview.body.dump();
  EXPECT_EQ(preview.body["first_item"], 2);
  const auto first = call("GET", "/execution/preview");
  EXPECT_EQ(first.body["first_item"], 1);
  EXPECT_NEAR(first.body["distance_m"], 11.1, 0.2);
  EXPECT_NEAR(first.body["bearing_deg"], 0.0, 0.5);
  EXPECT_EQ(first.body["at_end"], "hold");
  EXPECT_EQ(first.body["smoothed"], Json::array());
  // Start is refused while not armed, and for what is not loaded.
  EXPECT_EQ(call("POST", "/execution/start", start).status, 409u);
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  Json other = start;
  other["revision"] = 2;
  EXPECT_EQ(call("POST", "/execution/start", other).status, 409u);
  const auto started = call("POST", "/execution/start", start);
  ASSERT_EQ(started.status, 200u) << started.body.dump();
  EXPECT_EQ(started.body["state"], "running");
  EXPECT_EQ(started.body["name"], "field");
  EXPECT_EQ(call("GET", "/vehicle").body["mode"], "AUTO");
  until([this] { return house.sent().twist.linear_mps > 0.0; }, "the base is told to move");
  // Pause, resume, stop.
  EXPECT_EQ(call("POST", "/execution/pause").body["state"], "paused");
  // Said twice, as the page does over the stream and by a call: it is as was asked for.
  const auto again = call("POST", "/execution/pause");
  EXPECT_EQ(again.status, 200u);
  EXPECT_EQ(again.body["state"], "paused");
  const auto resumed = call("POST", "/execution/resume");
  EXPECT_EQ(resumed.body["state"], "running") << resumed.body.dump();
  EXPECT_EQ(call("POST", "/execution/skip", Json{{"item", 2}}).body["current_item"], 2);
  EXPECT_EQ(call("POST", "/execution/stop").status, 200u);
  EXPECT_NE(call("GET", "/execution").body["state"], "running");
}

TEST_F(VehicleApi, AutoGoesOnButStartsOnlyTheNewestRevision) {
  until_ready();
  const Json autonomous = {{"mode", "AUTO"}, {"valid_for_s", 5}};
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  // Given nothing that could be driven, then a mission that somebody changes after it was loaded,
  EXPECT_EQ(call("PUT", "/vehicle/mode", autonomous).status, 409u);
  const std::string id = make_mission();
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  ASSERT_EQ(
      call("PUT", "/missions/" + id, two_waypoints("changed"), "If-Match: \"rev-1\"\r\n").status,
      200u);
  // when AUTO is chosen,
  const auto refused = call("PUT", "/vehicle/mode", autonomous);
  // then it is not started: nobody has said which revision is meant.
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body["detail"].get<std::string>().find("revision 2"), std::string::npos);
  EXPECT_EQ(call("GET", "/vehicle").body["mode"], "HOLD");
  // The newest is,
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  const auto begun = call("PUT", "/vehicle/mode", autonomous);
  EXPECT_EQ(begun.body["mission"]["state"], "running") << begun.body.dump();
  EXPECT_EQ(call("PUT", "/vehicle/mode", autonomous).status, 200u);  // and again: nothing happens
  // and what waits goes on, whatever became of the stored one.
  EXPECT_EQ(call("POST", "/execution/pause").body["state"], "paused");
  ASSERT_EQ(call("DELETE", "/missions/" + id, "", "If-Match: \"rev-2\"\r\n").status, 204u);
  EXPECT_EQ(call("PUT", "/vehicle/mode", autonomous).body["mission"]["state"], "running");
  EXPECT_EQ(call("POST", "/execution/stop").status, 200u);
  const auto gone = call("PUT", "/vehicle/mode", autonomous);
  EXPECT_EQ(gone.status, 409u);
  EXPECT_NE(gone.body["detail"].get<std::string>().find("deleted"), std::string::npos);
}

TEST_F(VehicleApi, HalfAPositionIsNotHere) {
  until_ready();
  const auto pointer = [this](const std::string& body) {
    const auto reply = call("PUT", "/vehicle/home", body);
    EXPECT_EQ(reply.status, 422u) << body;
    return reply.body["errors"][0]["pointer"].get<std::string>();
  };
  EXPECT_EQ(pointer(R"({"lat": null})"), "/lat");
  EXPECT_EQ(pointer(R"({"lat": null, "lon": null})"), "/lat");
  EXPECT_EQ(pointer(R"({"lat": 58.378, "lon": null})"), "/lon");
  EXPECT_EQ(pointer(R"({"lat": 58.378})"), "/lon");
  EXPECT_EQ(pointer(R"({"lat": 91, "lon": 26})"), "/lat");
  EXPECT_EQ(pointer(R"({"lat": "58", "lon": 26})"), "/lat");
}

TEST_F(VehicleApi, ExecutionRefusesWhatCannotBe) {
  until_ready();
  EXPECT_EQ(call("POST", "/execution/load", Json{{"mission_id", "nobody"}}).status, 404u);
  EXPECT_EQ(call("POST", "/execution/load", Json{{"mission_id", 7}}).status, 422u);
  EXPECT_EQ(call("POST", "/execution/load").status, 415u);
  EXPECT_EQ(call("POST", "/execution/pause").status, 409u);
  EXPECT_EQ(call("POST", "/execution/skip", Json{{"item", 0}}).status, 422u);
  for (const Json& from : {Json("last"), Json(0), Json(1.5), Json(true), Json("2"), Json(-1)}) {
    const auto reply = call("POST", "/execution/start",
                            Json{{"mission_id", "x"}, {"revision", 1}, {"from", from}});
    EXPECT_EQ(reply.status, 422u) << from;
    EXPECT_EQ(reply.body["errors"][0]["pointer"], "/from");
  }
  EXPECT_EQ(call("GET", "/execution/preview?from=last").status, 422u);
  EXPECT_EQ(call("POST", "/execution/start", Json{{"mission_id", "x"}}).status, 422u);
}

TEST_F(VehicleApi, WhatHappenedIsFoundAmongTheEvents) {
  until_ready();
  call("POST", "/vehicle/estop");
  until(
      [this] {
        const auto list = call("GET", "/events");
        const Json& items = list.body["items"];
        return std::any_of(items.begin(), items.end(),
                           [](const Json& event) { return event["kind"] == "estop"; });
      },
      "the stop is stored");
  const auto all = call("GET", "/events");
  const Json last = all.body["items"].back();
  const std::string id = std::to_string(last["id"].get<int>());
  EXPECT_TRUE(call("GET", "/events?since=" + id).body["items"].empty());
  EXPECT_EQ(call("GET", "/events?since=1970-01-01T00:00:00Z").body["items"].size(),
            all.body["items"].size());
  EXPECT_TRUE(call("GET", "/events?since=2199-01-01T00:00:00Z").body["items"].empty());
  EXPECT_EQ(call("GET", "/events?limit=1").body["items"].size(), 1u);
  // However late a time or an id: nothing is later.
  for (const char* late : {"9999-12-31T23:59:59Z", "9223372036854775807"}) {
    const auto none = call("GET", std::string("/events?since=") + late);
    EXPECT_EQ(none.status, 200u) << late;
    EXPECT_TRUE(none.body["items"].empty()) << late;
  }
  const std::vector<std::pair<const char*, unsigned>> wrong_ones = {
      {"since=yesterday", 422}, {"since=-5", 422},   {"since=9223372036854775808", 422},
      {"since=1.5", 422},       {"level=loud", 422}, {"limit=x", 422},
      {"limit=0", 422},         {"cursor=x", 400},   {"since=%zz", 400}};
  for (const auto& [wrong, status] : wrong_ones) {
    const auto reply = call("GET", std::string("/events?") + wrong);
    const std::string query = wrong;
    EXPECT_EQ(reply.status, status) << wrong;
    EXPECT_EQ(reply.body["errors"][0]["pointer"], query.substr(0, query.find('='))) << wrong;
  }
}

}  // namespace
}  // namespace roverd::test
