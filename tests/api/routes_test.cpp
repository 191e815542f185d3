// Node maps and ways through them over HTTP.

#include "house.hpp"

namespace roverd::test {
namespace {

class RoutesApi : public HouseTest {
 protected:
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

}  // namespace
}  // namespace roverd::test
