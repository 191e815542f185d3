// What the robot sees, over the interface: the list of things, and the stream's topics.

#include <algorithm>

#include "base/geo.hpp"
#include "house.hpp"
#include "schema.hpp"

namespace roverd::test {
namespace {

std::shared_ptr<const robot::Outlook> a_thing_ahead() {
  auto out = std::make_shared<robot::Outlook>();
  out->stamp = base::steady_now();
  out->seen = out->stamp;
  out->grid = {.cell_m = 0.1, .x_m = -8.0, .y_m = -8.0, .side = 160, .runs = {0x7f, 0x00}};
  out->things.push_back({.ahead_m = 2.0, .clearance_m = 1.5, .size_m = 0.3, .sensor = "front"});
  out->scans.push_back({"front", out->stamp, {{2.0F, 0.0F, robot::Outlook::Dot::Obstacle}}});
  return out;
}

class BlindApi : public HouseTest {};

TEST_F(BlindApi, ARobotWithoutSensorsHasAnEmptyListAndSaysNothingOnTheStream) {
  until([&] { return house.snapshot() != nullptr; }, "the first tick");
  const auto none = call("GET", "/obstacles");
  EXPECT_EQ(none.status, 200u);
  EXPECT_TRUE(none.body["items"].empty());
  EXPECT_TRUE(none.body["age_s"].is_null());
  EXPECT_EQ(call("POST", "/obstacles").status, 405u);
  EXPECT_TRUE(call("GET", "/landmarks").body["landmarks"].empty());
}

class SeenApi : public HouseTest {
 protected:
  SeenApi() : HouseTest(House::Vehicle::Whole, {.sees = true}) {}

  std::unique_ptr<Client> watch(const Json& topics) {
    auto client = std::make_unique<Client>(house.port());
    EXPECT_EQ(client->upgrade("/api/v1/stream"), 101u);
    client->send_frame(1, Json{{"subscribe", topics}}.dump());
    return client;
  }
  static Json next(Client& client, const std::string& topic) {
    while (const auto frame = client.frame()) {
      if (frame->opcode != 1) continue;
      Json message = Json::parse(frame->payload);
      if (message["topic"] == topic) return message;
    }
    ADD_FAILURE() << "the stream ended without a message of " << topic;
    return {};
  }
  static std::string fault(const char* schema, const Json& message) {
    return schema_fault(document(), document()["components"]["schemas"][schema], message);
  }
};

TEST_F(SeenApi, WhatStandsAheadIsListedWhereItIs) {
  until_ready();
  house.sees(a_thing_ahead());
  const auto list = call("GET", "/obstacles");
  ASSERT_EQ(list.status, 200u);
  ASSERT_EQ(list.body["items"].size(), 1u);
  const Json& one = list.body["items"][0];
  EXPECT_EQ(one["distance_m"], 2.0);
  EXPECT_EQ(one["bearing_deg"], 0.0);
  EXPECT_EQ(one["sensor"], "front");
  EXPECT_EQ(one["on_way"], false) << "it stands";
  // Where the vehicle says it is and points to, 2 m on.
  const Json position = call("GET", "/vehicle").body["position"];
  if (position["heading_deg"].is_null()) {
    EXPECT_TRUE(one["lat"].is_null());
    return;
  }
  const base::LatLon there =
      base::destination({position["lat"], position["lon"]}, position["heading_deg"], 2.0);
  EXPECT_NEAR(one["lat"], there.lat, 1e-6);
  EXPECT_NEAR(one["lon"], there.lon, 2e-6);
}

TEST_F(SeenApi, LandmarksAndWhatCamerasToldAreListedWithTheirSource) {
  until_ready();
  auto out = a_thing_ahead();
  robot::Outlook seen = *out;
  seen.landmarks.push_back({.id = 7,
                            .name = "cone",
                            .ahead_m = 2.0,
                            .left_m = -0.5,
                            .sigma_m = 0.03,
                            .by_scan = true,
                            .by_vision = true,
                            .believed = true});
  seen.walls.push_back({.id = 3, .by_vision = true, .distance_m = 0.9});
  seen.spots.push_back({"camera", 1.0, 0.2, 0.3, 0.1});
  seen.planes.push_back({{"camera", 2.0, 0.9, 0.4, 0.1}, 0.0, -1.0, 0.0, 5200.0});
  house.sees(std::make_shared<robot::Outlook>(std::move(seen)));
  const auto list = call("GET", "/landmarks");
  ASSERT_EQ(list.status, 200u);
  EXPECT_EQ(fault("KnownMarks", list.body), "");
  const Json& one = list.body["landmarks"].at(0);
  EXPECT_EQ(one["name"], "cone");
  EXPECT_EQ(one["source"], "both");
  EXPECT_EQ(one["ahead_m"], 2.0);
  EXPECT_EQ(one["left_m"], -0.5);
  EXPECT_TRUE(one["radius_m"].is_null());
  EXPECT_EQ(list.body["walls"].at(0)["source"], "vision");
  EXPECT_EQ(list.body["obstacles"].at(0)["sensor"], "camera");
  EXPECT_EQ(list.body["planes"].at(0)["size"], 5200.0);
  EXPECT_EQ(list.body["planes"].at(0)["normal"]["left"], -1.0);
  EXPECT_TRUE(list.body["tags"].empty()) << "no camera here reads them";
}

TEST_F(SeenApi, TheTopicsAreAsTheDocumentSaysAndNoFasterThanTheyAreMade) {
  until_ready();
  house.sees(a_thing_ahead());
  auto client = watch({{"scan", 50}, {"grid", 2}, {"obstacles", 0}, {"row", 2}});
  const Json hello = next(*client, "hello");
  for (const char* topic : {"scan", "grid", "obstacles", "row"}) {
    const auto& all = hello["data"]["topics"];
    EXPECT_NE(std::find(all.begin(), all.end(), topic), all.end()) << topic;
  }
  const Json scan = next(*client, "scan");
  EXPECT_EQ(fault("StreamScan", scan), "");
  EXPECT_EQ(scan["data"]["sensors"][0]["obstacle_cm"], Json({200, 0}));
  EXPECT_EQ(scan["data"]["sensor"], "all");
  EXPECT_EQ(scan["data"]["angle_min_deg"], -180);
  ASSERT_EQ(scan["data"]["ranges_m"].size(), scan["data"]["hit_cm"].size());
  for (std::size_t i = 0; i < scan["data"]["hit_cm"].size(); ++i) {
    const int cm = scan["data"]["hit_cm"][i];
    const Json& m = scan["data"]["ranges_m"][i];
    EXPECT_TRUE(cm == 0 ? m.is_null() : std::abs(m.get<double>() - 0.01 * cm) < 0.006) << i;
  }
  const Json row = next(*client, "row");
  EXPECT_EQ(fault("StreamRow", row), "");
  EXPECT_TRUE(row["data"]["offset_m"].is_null()) << "no row is driven";
  const Json grid = next(*client, "grid");
  EXPECT_EQ(fault("StreamGrid", grid), "");
  EXPECT_EQ(grid["data"]["runs"], "fwA=");
  const Json obstacles = next(*client, "obstacles");
  EXPECT_EQ(fault("StreamObstacles", obstacles), "");
  EXPECT_EQ(obstacles["data"]["items"].size(), 1u);
  // 50 a second were asked for; five come.
  const double from_s = next(*client, "scan")["mono_s"];
  for (int i = 0; i < 4; ++i) (void)next(*client, "scan");
  const double to_s = next(*client, "scan")["mono_s"];
  EXPECT_GT(to_s - from_s, 0.6);
}

TEST_F(SeenApi, WhoDoesNotSubscribeGetsNone) {
  until_ready();
  house.sees(a_thing_ahead());
  auto client = watch({{"vehicle", 50}});
  (void)next(*client, "hello");
  for (int i = 0; i < 20; ++i) {
    const auto frame = client->frame();
    ASSERT_TRUE(frame);
    if (frame->opcode == 1) {
      EXPECT_EQ(Json::parse(frame->payload)["topic"], "vehicle");
    }
  }
}

}  // namespace
}  // namespace roverd::test
