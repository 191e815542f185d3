// POST, GET and DELETE /safety/drill, with a program that says what the test says.

#include "house.hpp"

namespace roverd::test {
namespace {

class DrillApi : public HouseTest {
 protected:
  Json drill() { return call("GET", "/safety/drill").body; }
  void until_state(const char* state) {
    until([&] { return drill()["state"] == state; }, state);
  }
};

const char* const kBegins =
    R"({"begins": {"at_m": 20.0, "length_m": 40.0, "speed_mps": 1.0, "lat": 58.3, "lon": 26.7,
        "failures": ["drive_link", "bumper"]}})";
const char* const kStands =
    R"({"result": {"failure": "drive_link", "title": "Drive link dead", "end": "stands",
        "reason": "no word from the base for 0.4 s", "zero_s": 0.4, "stands_s": 1.4, "way_m": 1.0,
        "speed_mps": 1.0, "begins": {"lat": 58.3, "lon": 26.7, "heading_deg": 0.0},
        "last": {"lat": 58.3, "lon": 26.7, "heading_deg": 0.0}, "off_way_m": 0.1,
        "fence_distance_m": null, "inside_fence": null, "mode": "HOLD", "armed": true,
        "estop": false, "said": [{"id": "base_lost", "detail": "no word"}],
        "track": [{"lat": 58.3, "lon": 26.7}]}})";
const char* const kNone =
    R"({"result": {"failure": "bumper", "title": "Bumper hit", "end": "not_played",
        "reason": "there is none"}})";

TEST_F(DrillApi, TellsHowFarItIs) {
  // Given a stored mission and no drill yet
  EXPECT_EQ(drill()["state"], "none");
  const std::string id = make_mission();
  until([&] { return house.snapshot() != nullptr; }, "the loop runs");
  // When one is asked for
  const auto begun = call("POST", "/safety/drill",
                          Json{{"mission_id", id}, {"failures", {"bumper", "drive_link"}}});
  // Then it runs, and the program was told the mission as it is stored
  ASSERT_EQ(begun.status, 202u) << begun.body;
  EXPECT_EQ(begun.raw.header("location"), "/api/v1/safety/drill");
  EXPECT_EQ(begun.body["state"], "running");
  EXPECT_EQ(begun.body["mission"]["id"], id);
  const Json order = Json::parse(house.drill_order());
  EXPECT_EQ(order["mission"]["plan"]["items"].size(), 2U);
  EXPECT_EQ(order["sim"], "plant");
  EXPECT_EQ(order["failures"], (Json{"bumper", "drive_link"}));
  EXPECT_TRUE(order["fence"].is_null());
  // and a second one is refused
  EXPECT_EQ(call("POST", "/safety/drill", Json{{"mission_id", id}}).status, 409u);
  // When the program speaks, then what it says is there
  house.drill_says(kBegins);
  house.drill_says("no JSON");
  house.drill_says("[1]");
  house.drill_says(kStands);
  until([&] { return drill()["results"].size() == 1; }, "a result");
  EXPECT_EQ(drill()["begins"]["at_m"], 20.0);
  house.drill_says(kNone);
  house.drill_ends("");
  until_state("done");
  EXPECT_EQ(drill()["results"].size(), 2U);
  EXPECT_TRUE(drill()["detail"].is_null());
  // and the next one begins with nothing
  const auto next = call("POST", "/safety/drill", Json{{"mission_id", id}});
  EXPECT_EQ(next.body["id"], 2);
  EXPECT_TRUE(next.body["results"].empty());
}

TEST_F(DrillApi, FailsWithWhatTheProgramSaysOrHowItEnded) {
  const std::string id = make_mission();
  until([&] { return house.snapshot() != nullptr; }, "the loop runs");
  ASSERT_EQ(call("POST", "/safety/drill", Json{{"mission_id", id}}).status, 202u);
  house.drill_says(R"({"error": {"detail": "no such place", "fields": [
      {"pointer": "/at_m", "detail": "no such place"}]}})");
  house.drill_ends("roverd-study ended with exit code 2");
  until_state("failed");
  EXPECT_EQ(drill()["detail"], "no such place");
  EXPECT_EQ(drill()["errors"][0]["pointer"], "/at_m");
  ASSERT_EQ(call("POST", "/safety/drill", Json{{"mission_id", id}}).status, 202u);
  house.drill_ends("roverd-study was ended by signal 11");
  until_state("failed");
  EXPECT_EQ(drill()["detail"], "roverd-study was ended by signal 11");
}

TEST_F(DrillApi, IsEndedOnceAndNotHeardAfterwards) {
  const std::string id = make_mission();
  until([&] { return house.snapshot() != nullptr; }, "the loop runs");
  EXPECT_EQ(call("DELETE", "/safety/drill").status, 409u);
  ASSERT_EQ(call("POST", "/safety/drill", Json{{"mission_id", id}}).status, 202u);
  const auto ended = call("DELETE", "/safety/drill");
  EXPECT_EQ(ended.status, 200u);
  EXPECT_EQ(ended.body["state"], "cancelled");
  EXPECT_EQ(house.drills_stopped, 1);
  house.drill_says(kStands);
  house.drill_ends("");
  EXPECT_EQ(call("DELETE", "/safety/drill").status, 409u);
  EXPECT_EQ(drill()["state"], "cancelled");
  EXPECT_TRUE(drill()["results"].empty());
}

}  // namespace
}  // namespace roverd::test
