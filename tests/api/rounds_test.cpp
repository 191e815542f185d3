// LOITER and CIRCLE over HTTP, and missions with them.

#include "house.hpp"

namespace roverd::test {
namespace {

using RoundsApi = HouseTest;

TEST_F(RoundsApi, TheModesAreBegunAndTold) {
  until_ready();
  const Json circle = {
      {"mode", "CIRCLE"}, {"lat", kStart.lat + 0.0001}, {"lon", kStart.lon}, {"radius_m", 4},
      {"turns", 2},       {"clockwise", true},          {"valid_for_s", 5}};
  EXPECT_EQ(call("PUT", "/vehicle/mode", circle).status, 409u) << "not armed";
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto begun = call("PUT", "/vehicle/mode", circle);
  ASSERT_EQ(begun.status, 200u) << begun.body.dump();
  EXPECT_EQ(begun.body["mode"], "CIRCLE");
  const Json& round = begun.body["activity"];
  EXPECT_EQ(round["kind"], "circle");
  EXPECT_NEAR(round["goal"]["lat"], kStart.lat + 0.0001, 1e-7);
  EXPECT_EQ(round["radius_m"], 4.0);
  EXPECT_EQ(round["turns"], 2.0);
  EXPECT_EQ(round["clockwise"], true);
  const auto stays = call("PUT", "/vehicle/mode", Json{{"mode", "LOITER"}, {"valid_for_s", 5}});
  ASSERT_EQ(stays.status, 200u) << stays.body.dump();
  EXPECT_EQ(stays.body["mode"], "LOITER");
  EXPECT_EQ(stays.body["activity"]["kind"], "loiter");
  EXPECT_EQ(stays.body["activity"]["radius_m"], 1.0);
  EXPECT_EQ(stays.body["activity"]["turns"], nullptr);
  EXPECT_EQ(stays.body["activity"]["clockwise"], nullptr);
  const Json far = {
      {"mode", "LOITER"}, {"lat", kStart.lat + 1.0}, {"lon", kStart.lon}, {"valid_for_s", 5}};
  EXPECT_EQ(call("PUT", "/vehicle/mode", far).status, 422u);
}

TEST_F(RoundsApi, BadBodiesNameTheirFields) {
  until_ready();
  const auto refused = [this](const Json& body) {
    const auto reply = call("PUT", "/vehicle/mode", body);
    EXPECT_EQ(reply.status, 422u) << body.dump() << reply.body.dump();
    return reply.body["errors"].empty() ? std::string()
                                        : reply.body["errors"][0].value("pointer", "");
  };
  const auto circle = [](const Json& more) {
    Json body = {{"mode", "CIRCLE"}, {"lat", 58}, {"lon", 26}, {"radius_m", 5}};
    body.update(more);
    return body;
  };
  EXPECT_EQ(refused({{"mode", "CIRCLE"}, {"lat", 58}, {"lon", 26}}), "/radius_m");
  EXPECT_EQ(refused({{"mode", "CIRCLE"}, {"radius_m", 5}}), "/lat");
  EXPECT_EQ(refused(circle({{"radius_m", 0.4}})), "/radius_m");
  EXPECT_EQ(refused(circle({{"turns", 0}})), "/turns");
  EXPECT_EQ(refused(circle({{"heading_deg", 90}})), "/heading_deg");
  EXPECT_EQ(refused(circle({{"clockwise", 1}})), "/clockwise");
  EXPECT_EQ(refused({{"mode", "LOITER"}, {"radius_m", 0}}), "/radius_m");
  EXPECT_EQ(refused({{"mode", "LOITER"}, {"lat", 58}}), "/lon");
  EXPECT_EQ(refused({{"mode", "LOITER"}, {"turns", 2}}), "/turns");
}

TEST_F(RoundsApi, AMissionKeepsItsCirclesAndLoiters) {
  Json items = Json::array();
  items.push_back({{"type", "waypoint"}, {"lat", kStart.lat}, {"lon", kStart.lon}});
  items.push_back({{"type", "circle"},
                   {"lat", kStart.lat + 0.0001},
                   {"lon", kStart.lon},
                   {"radius_m", 4},
                   {"turns", 1.5}});
  items.push_back({{"type", "loiter"}, {"radius_m", 2}});
  const auto made = call("POST", "/missions", Json{{"name", "round"}, {"items", items}});
  ASSERT_EQ(made.status, 201u) << made.body.dump();
  const auto read = call("GET", "/missions/" + made.body["id"].get<std::string>());
  EXPECT_EQ(read.body["items"][1]["turns"], 1.5);
  EXPECT_EQ(read.body["items"][2]["type"], "loiter");
  EXPECT_FALSE(read.body["items"][2].contains("seconds"));
}

}  // namespace
}  // namespace roverd::test
