// Node maps and ways through them over HTTP.

#include <cmath>
#include <string>

#include "house.hpp"

namespace roverd::test {
namespace {

class RoutesApi : public HouseTest {
 protected:
  using HouseTest::HouseTest;
  /// 1 ── 2 ── 3, 10 m apart to the east of kStart; 4 stands alone.
  std::string import_yard(const std::string& query = {}) {
    const std::string text =
        "Node id=1 pose=0 0 0 links=2 ~\nNode id=2 pose=10 0 0 links=1 3 ~\n"
        "Node id=3 pose=20 0 0 links=2 ~\nNode id=4 pose=0 50 0 ~\nHome id=3 ~\n";
    const auto reply = call("POST", "/routes/import?name=yard&" + query, text, kText);
    EXPECT_EQ(reply.status, 201u) << reply.body;
    if (reply.status != 201u) return {};
    EXPECT_EQ(reply.body["notes"].size(), 1u);
    const std::string id = reply.body["id"];
    EXPECT_EQ(reply.raw.header("location"), "/api/v1/routes/" + id);
    return id;
  }
  std::string outdoors() {
    return "origin_lat=" + std::to_string(kStart.lat) + "&origin_lon=" + std::to_string(kStart.lon);
  }
  Reply plan(const Json& body) { return call("POST", "/routes/plan", body); }

  static constexpr const char* kText = "Content-Type: text/plain\r\n";
};

TEST_F(RoutesApi, AMapIsImportedListedReadAndDeleted) {
  const std::string id = import_yard(outdoors());
  const auto list = call("GET", "/routes");
  ASSERT_EQ(list.body["items"].size(), 1u);
  EXPECT_EQ(list.body["items"][0]["nodes"], 4);
  const auto map = call("GET", "/routes/" + id);
  ASSERT_EQ(map.status, 200u);
  EXPECT_EQ(map.body["home"], 3);
  EXPECT_EQ(map.body["node_list"][1]["links"], Json({1, 3}));
  EXPECT_NEAR(map.body["node_list"][0]["lat"], kStart.lat, 1e-6);
  EXPECT_EQ(call("DELETE", "/routes/" + id).status, 204u);
  EXPECT_EQ(call("DELETE", "/routes/" + id).status, 404u);
  EXPECT_EQ(call("GET", "/routes/" + id).status, 404u);
}

TEST_F(RoutesApi, AWayIsAMission) {
  until_ready();
  import_yard(outdoors());
  // From where the vehicle stands, which is nearest to node 1.
  const auto way = plan({{"from", "here"}, {"to", "home"}});
  ASSERT_EQ(way.status, 200u) << way.body;
  EXPECT_EQ(way.body["nodes"], Json({1, 2, 3}));
  EXPECT_NEAR(way.body["length_m"], 20.0, 1e-6);
  EXPECT_EQ(call("POST", "/missions", way.body["mission"]).status, 201u);
  const auto stored = plan({{"from", 3}, {"to", 1}, {"name", "back"}, {"speed_mps", 0.5}});
  ASSERT_EQ(stored.status, 201u) << stored.body;
  const std::string id = stored.body["mission"]["id"];
  EXPECT_EQ(stored.raw.header("location"), "/api/v1/missions/" + id);
  EXPECT_EQ(call("GET", "/missions/" + id).body["items"].size(), 3u);
  EXPECT_EQ(plan({{"from", 1}, {"to", 4}}).status, 409u);
}

TEST_F(RoutesApi, IndoorsTheItemsAreLocal) {
  import_yard("heading_deg=0");
  const auto way = plan({{"from", 1}, {"to", 3}});
  ASSERT_EQ(way.status, 200u);
  const Json last = way.body["mission"]["items"][2];
  EXPECT_EQ(last["type"], "local");
  EXPECT_NEAR(last["north_m"], 20.0, 1e-9);
  EXPECT_NEAR(last["heading_deg"], 0.0, 1e-9);
  EXPECT_EQ(plan({{"from", "here"}, {"to", 3}}).body["errors"][0]["pointer"], "/from");
}

TEST_F(RoutesApi, WhatIsWrongIsNamedAndNothingIsStored) {
  const auto bad =
      call("POST", "/routes/import", "Node id=1 pose=0 0 0 links=9 ~\nNode id=x ~\n", kText);
  EXPECT_EQ(bad.status, 422u);
  EXPECT_EQ(bad.body["errors"][0]["pointer"], "line 2");
  EXPECT_EQ(bad.body["errors"][1]["pointer"], "line 1");
  EXPECT_EQ(call("POST", "/routes/import?origin_lat=58", "Node id=1 pose=0 0 0 ~", kText).status,
            422u);
  EXPECT_EQ(call("POST", "/routes/import?origin_lat=nan&origin_lon=1", "x", kText).status, 422u);
  EXPECT_EQ(call("GET", "/routes").body["items"].size(), 0u);
  const auto pointer = [this](const Json& body) {
    const auto reply = plan(body);
    EXPECT_EQ(reply.status, 422u) << body;
    return reply.body["errors"][0]["pointer"];
  };
  EXPECT_EQ(pointer({{"from", 1}, {"to", 2}}), "/graph");
  const std::string id = import_yard();
  EXPECT_EQ(pointer({{"from", 1}}), "/to");
  EXPECT_EQ(pointer({{"from", 1.5}, {"to", 2}}), "/from");
  EXPECT_EQ(pointer({{"from", 1}, {"to", "there"}}), "/to");
  EXPECT_EQ(pointer({{"from", 77}, {"to", 2}}), "/from");
  EXPECT_EQ(pointer({{"from", 1}, {"to", 2}, {"graph", "nobody"}}), "/graph");
  EXPECT_EQ(pointer({{"from", 1}, {"to", 2}, {"name", ""}}), "/name");
  import_yard();
  EXPECT_EQ(pointer({{"from", 1}, {"to", 2}}), "/graph");
  EXPECT_EQ(plan({{"from", 1}, {"to", 2}, {"graph", id}}).status, 200u);
}

/// A graph in the metres of the map "shed", which lies nowhere; its node 5 lies on the street.
class RoutesInAMapApi : public RoutesApi {
 protected:
  RoutesInAMapApi() : RoutesApi(House::Vehicle::Whole, seeing()) {}

  static Before seeing() {
    Before before;
    before.sees = true;
    return before;
  }
  std::string import_shed() {
    const auto reply = call("POST", "/routes/import?name=shed%20ways&map=shed",
                            "Node id=1 pose=1 2 0 links=2 ~\nNode id=2 pose=4 6 1.5 links=1 5 ~\n"
                            "Node id=5 latlon=58.0002 26 links=2 ~\nHome id=1 ~\n",
                            kText);
    EXPECT_EQ(reply.status, 201u) << reply.body;
    EXPECT_EQ(reply.body["map"], "shed");
    return reply.body["id"];
  }
  void keep_shed() {
    const std::string files =
        "--x\r\nContent-Disposition: form-data; name=\"yaml\"; filename=\"shed.yaml\"\r\n\r\n"
        "image: shed.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n\r\n"
        "--x\r\nContent-Disposition: form-data; name=\"image\"\r\n\r\n"
        "P2 2 1 255 254 0\n\r\n--x--\r\n";
    const auto kept =
        call("POST", "/maps", files, "Content-Type: multipart/form-data; boundary=x\r\n");
    ASSERT_EQ(kept.status, 201u) << kept.body;
    // Its x axis looks north.
    const Json anchor = {{"lat", 58.0}, {"lon", 26.0}, {"heading_deg", 0.0}};
    ASSERT_EQ(call("PATCH", "/maps/1", Json{{"anchor", anchor}}).status, 200u);
  }
  /// Until the robot has heard it.
  void found_at(double x_m, double y_m) {
    const auto heard = [&] {
      base::PlaceState place;
      place.stamp = base::steady_now();
      place.phase = base::PlacePhase::Known;
      place.map = "shed";
      place.in_map = base::MapPlace{x_m, y_m, 0.0};
      house.hear(place);
      const auto snapshot = house.snapshot();
      return snapshot->place && snapshot->place->phase == base::PlacePhase::Known;
    };
    until(heard, "it is found in the map");
  }
};

TEST_F(RoutesInAMapApi, AWayIsAMissionThatCountsFromTheMap) {
  const std::string id = import_shed();
  const auto way = plan({{"from", 1}, {"to", 2}, {"name", "to the shelf"}});
  ASSERT_EQ(way.status, 201u) << way.body;
  EXPECT_EQ(way.body["length_m"], 5.0);
  const Json mission =
      call("GET", "/missions/" + way.body["mission"]["id"].get<std::string>()).body;
  EXPECT_EQ(mission["frame"], (Json{{"map", "shed"}}));
  EXPECT_EQ(mission["items"][0]["type"], "map_point");
  EXPECT_EQ(mission["items"][1]["x_m"], 4.0);
  EXPECT_NEAR(mission["items"][1]["yaw_deg"], 85.94, 0.01);
  const Json node = call("GET", "/routes/" + id).body["node_list"][0];
  EXPECT_EQ(node["x_m"], 1.0);
  EXPECT_TRUE(node["lat"].is_null()) << "nobody knows where it lies";
}

TEST_F(RoutesInAMapApi, HereIsWhereTheRobotIsFoundInIt) {
  until_ready();
  const std::string shed =
      call("POST", "/routes/import?map=shed",
           "Node id=1 pose=1 2 0 links=2 ~\nNode id=2 pose=4 6 0 links=1 ~\n", kText)
          .body["id"];
  const Json wish = {{"from", "here"}, {"to", 1}, {"graph", shed}};
  const auto lost = plan(wish);
  EXPECT_EQ(lost.status, 409u);
  EXPECT_EQ(lost.body["detail"], "the mission counts from the map \"shed\": no map is in use");
  found_at(4.5, 7.0);
  const auto way = plan(wish);
  ASSERT_EQ(way.status, 200u) << way.body;
  EXPECT_EQ(way.body["nodes"], Json({2, 1}));
}

TEST_F(RoutesInAMapApi, WhereItLiesJoinsItWithTheEarth) {
  const std::string id = import_shed();
  const auto apart = plan({{"from", 1}, {"to", 5}});
  EXPECT_EQ(apart.status, 409u);
  const std::string why = apart.body["detail"];
  EXPECT_NE(why.find("nobody knows where on the earth that lies. Give it an anchor"),
            std::string::npos)
      << why;
  keep_shed();
  const auto way = plan({{"from", 1}, {"to", 5}});
  ASSERT_EQ(way.status, 200u) << way.body;
  const Json mission = way.body["mission"];
  EXPECT_EQ(mission["frame"], (Json{{"map", "shed"}}));
  EXPECT_EQ(mission["items"][1]["type"], "map_point");
  EXPECT_EQ(mission["items"][2]["type"], "waypoint");
  EXPECT_EQ(mission["items"][2]["lat"], 58.0002);
  // 5 m in the shed, then from 4 m north and 6 m west of its origin to 22.3 m north of it.
  EXPECT_NEAR(way.body["length_m"], 5.0 + std::hypot(22.27 - 4.0, 6.0), 0.1);
  const Json nodes = call("GET", "/routes/" + id).body["node_list"];
  EXPECT_NEAR(nodes[0]["lat"].get<double>(), 58.0 + 1.0 / 111'360.0, 1e-7);
  EXPECT_LT(nodes[0]["lon"].get<double>(), 26.0);
  EXPECT_TRUE(nodes[2]["x_m"].is_null());
  // Outside alone it is a mission of places on the earth.
  const auto outside = plan({{"from", 5}, {"to", 5}});
  EXPECT_FALSE(outside.body["mission"].contains("frame")) << outside.body;
}

TEST_F(RoutesInAMapApi, AGraphCountsFromOneThing) {
  const auto refused = [this](const std::string& query, const std::string& text) {
    const auto reply = call("POST", "/routes/import?" + query, text, kText);
    EXPECT_EQ(reply.status, 422u) << reply.body;
    return reply.body["detail"].get<std::string>();
  };
  const std::string one = "Node id=1 pose=0 0 0 ~";
  EXPECT_NE(refused("map=shed&" + outdoors(), one).find("map cannot stand beside origin_lat"),
            std::string::npos);
  EXPECT_NE(refused("map=shed&heading_deg=9", one).find("beside heading_deg"), std::string::npos);
  EXPECT_NE(refused("", "Node id=7 latlon=58 26 ~").find("node 7 lies on the earth"),
            std::string::npos);
  EXPECT_EQ(call("GET", "/routes").body["items"].size(), 0u);
}

}  // namespace
}  // namespace roverd::test
