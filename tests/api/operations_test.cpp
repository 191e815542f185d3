// POST /missions/{id}/operations: each change is a new revision that says what was done.

#include "house.hpp"

namespace roverd::test {
namespace {

class OperationsApi : public HouseTest {
 protected:
  Reply operate(const std::string& id, const Json& body, int revision) {
    return call("POST", "/missions/" + id + "/operations", body,
                "If-Match: \"rev-" + std::to_string(revision) + "\"\r\n");
  }
  Json newest(const std::string& id) {
    return call("GET", "/missions/" + id + "/revisions").body["items"][0];
  }
};

TEST_F(OperationsApi, AnOffsetIsANewRevisionAndItsOppositeTheStart) {
  const std::string id = make_mission();
  const Json before = call("GET", "/missions/" + id).body;
  const auto moved = operate(id, {{"op", "offset"}, {"distance_m", 3}, {"bearing_deg", 45}}, 1);
  ASSERT_EQ(moved.status, 200u);
  EXPECT_EQ(moved.raw.header("etag"), "\"rev-2\"");
  EXPECT_EQ(moved.body["done"]["what"], "moved all items 2.121 m north, 2.121 m east");
  EXPECT_EQ(newest(id)["what"], moved.body["done"]["what"]);
  EXPECT_EQ(newest(id)["author"], "local");
  EXPECT_NEAR(moved.body["items"][0]["lat"].get<double>() - before["items"][0]["lat"].get<double>(),
              2.1213 / 111'384, 1e-8);
  const auto back = operate(id, {{"op", "offset"}, {"distance_m", -3}, {"bearing_deg", 45}}, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(back.body["items"][i]["lat"], before["items"][i]["lat"].get<double>(), 1e-9);
    EXPECT_NEAR(back.body["items"][i]["lon"], before["items"][i]["lon"].get<double>(), 1e-9);
  }
}

TEST_F(OperationsApi, AMissionIsAlignedWithTheVehicleAndLookedAtBefore) {
  until_ready();
  const std::string id = make_mission();
  const Json before = call("GET", "/missions/" + id).body;
  // given a dry run, nothing is kept,
  const Json body{{"op", "align"}, {"item", 1}, {"dry_run", true}};
  const auto shown = operate(id, body, 1);
  ASSERT_EQ(shown.status, 200u) << shown.raw.body;
  EXPECT_EQ(shown.body["dry_run"], true);
  EXPECT_NEAR(shown.body["items"][0]["lat"], kStart.lat, 1e-5);
  EXPECT_EQ(shown.raw.header("etag"), "\"rev-1\"");
  EXPECT_EQ(call("GET", "/missions/" + id).body, before);
  // then it is done.
  const auto done = operate(id, {{"op", "align"}, {"item", 1}}, 1);
  EXPECT_EQ(done.body["revision"], 2);
  EXPECT_NEAR(done.body["items"][0]["lat"], kStart.lat, 1e-5);
  EXPECT_NEAR(done.body["length_m"], before["length_m"].get<double>(), 0.001);
  // Two items turn it.
  const auto turned = operate(id,
                              {{"op", "align"},
                               {"item", 1},
                               {"lat", 58.0},
                               {"lon", 26.0},
                               {"second", {{"item", 2}, {"lat", 58.0}, {"lon", 26.001}}}},
                              2);
  ASSERT_EQ(turned.status, 200u) << turned.raw.body;
  EXPECT_NEAR(turned.body["items"][1]["lat"], 58.0, 1e-8);
  const auto bad = operate(id, {{"op", "align"}, {"item", 1}, {"second", {{"lat", 95}}}}, 3);
  EXPECT_EQ(bad.status, 422u);
  EXPECT_EQ(operate(id, {{"op", "split"}, {"after", 1}, {"dry_run", true}}, 3).status, 422u);
}

TEST_F(OperationsApi, WaypointsAreAddedWhereTheVehicleIsOrWhereOneSays) {
  until_ready();
  const std::string id = make_mission();
  const auto here = operate(id, {{"op", "add_waypoint"}}, 1);
  ASSERT_EQ(here.status, 200u);
  EXPECT_EQ(here.body["done"]["item"], 3);
  EXPECT_NEAR(here.body["items"][2]["lat"], kStart.lat, 1e-5);
  const auto there = operate(id,
                             {{"op", "add_waypoint"},
                              {"lat", 58.379},
                              {"lon", 26.73},
                              {"hold_s", 2},
                              {"turn", "pivot"},
                              {"after", 0}},
                             2);
  EXPECT_EQ(there.body["items"][0], Json({{"type", "waypoint"},
                                          {"lat", 58.379},
                                          {"lon", 26.73},
                                          {"hold_s", 2.0},
                                          {"turn", "pivot"}}));
  EXPECT_EQ(operate(id, {{"op", "remove_waypoint"}, {"first", 2}, {"last", "last"}}, 3)
                .body["items"]
                .size(),
            1u);
  // No item is the current one while nothing is loaded.
  EXPECT_EQ(operate(id, {{"op", "remove_waypoint"}, {"item", "current"}}, 4).status, 409u);
  EXPECT_EQ(operate(id, {{"op", "clear"}, {"home", "vehicle"}}, 4).body["items"], Json::array());
  EXPECT_NEAR(call("GET", "/missions/" + id).body["home"]["lat"], kStart.lat, 1e-5);
}

TEST_F(OperationsApi, AroundAPointThereAndBack) {
  const std::string id = make_mission();
  const Json before = call("GET", "/missions/" + id).body;
  const auto turned = operate(id, {{"op", "scale_rotate"}, {"factor", 2}, {"turn_deg", 30}}, 1);
  ASSERT_EQ(turned.status, 200u);
  EXPECT_NEAR(turned.body["length_m"], 2 * before["length_m"].get<double>(), 0.001);
  const auto back = operate(id,
                            {{"op", "scale_rotate"},
                             {"factor", 0.5},
                             {"turn_deg", -30},
                             {"about", turned.body["done"]["about"]}},
                            2);
  EXPECT_NEAR(back.body["items"][0]["lat"], before["items"][0]["lat"].get<double>(), 1e-9);
  const auto mirrored = operate(id, {{"op", "mirror"}, {"axis_deg", 0}}, 3);
  EXPECT_EQ(mirrored.status, 200u);
  // What changes nothing keeps nothing.
  EXPECT_EQ(operate(id, {{"op", "simplify"}, {"tolerance_m", 1}}, 4).body["revision"], 4);
}

TEST_F(OperationsApi, AMissionIsSplitAndJoined) {
  const std::string id = make_mission("long");
  const auto cut = operate(id, {{"op", "split"}, {"after", 1}, {"shared", true}}, 1);
  ASSERT_EQ(cut.status, 200u);
  EXPECT_EQ(cut.body["items"].size(), 1u);
  const Json rest = cut.body["done"]["created"];
  EXPECT_EQ(rest["name"], "long (2)");
  EXPECT_EQ(rest["items"].size(), 2u);
  const auto joined = operate(id, {{"op", "join"}, {"mission_id", rest["id"]}}, 2);
  EXPECT_EQ(joined.body["items"].size(), 3u);
  EXPECT_EQ(newest(id)["what"], "joined 2 items of \"long (2)\"");
  EXPECT_EQ(newest(rest["id"])["what"], "split from long");
  const auto lost = operate(id, {{"op", "join"}, {"mission_id", "nobody"}}, 3);
  EXPECT_EQ(lost.status, 422u);
  EXPECT_EQ(lost.body["errors"][0]["pointer"], "/mission_id");
  // A split that is refused makes no second mission.
  EXPECT_EQ(operate(id, {{"op", "split"}, {"after", 3}}, 3).status, 422u);
  EXPECT_EQ(operate(id, {{"op", "split"}, {"after", 1}}, 2).status, 412u);
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 2u);
}

TEST_F(OperationsApi, NeedsTheRevisionThatItIsMeantFor) {
  const std::string id = make_mission();
  const std::string path = "/missions/" + id + "/operations";
  EXPECT_EQ(call("POST", path, Json{{"op", "reverse"}}).status, 428u);
  const auto late = operate(id, {{"op", "reverse"}}, 7);
  EXPECT_EQ(late.status, 412u);
  EXPECT_EQ(late.body["current"]["revision"], 1);
  EXPECT_EQ(late.raw.header("etag"), "\"rev-1\"");
  EXPECT_EQ(operate("nobody", {{"op", "reverse"}}, 1).status, 404u);
  EXPECT_EQ(call("POST", path, std::string("{"), "If-Match: *\r\n").status, 400u);
}

TEST_F(OperationsApi, EveryWrongMemberIsNamed) {
  const std::string id = make_mission();
  const auto pointers = [&](const Json& body) {
    const auto reply = operate(id, body, 1);
    EXPECT_EQ(reply.status, 422u) << body;
    std::string out;
    for (const Json& error : reply.body["errors"]) {
      out += error["pointer"].get<std::string>() + ' ';
    }
    return out;
  };
  EXPECT_EQ(pointers(Json::object()), "/op ");
  EXPECT_EQ(pointers({{"op", "fold"}, {"x", 1}}), "/op ");
  EXPECT_EQ(pointers({{"op", "reverse"}, {"x", 1}}), "/x ");
  EXPECT_EQ(pointers({{"op", "offset"}}), "/distance_m ");
  EXPECT_EQ(pointers({{"op", "offset"}, {"east_m", "far"}, {"item", 3.5}}), "/item /east_m ");
  EXPECT_EQ(pointers({{"op", "offset"}, {"east_m", 1}, {"item", 3}}), "/item ");
  EXPECT_EQ(pointers({{"op", "offset"}, {"east_m", 1}, {"first", 2}}), "/last ");
  EXPECT_EQ(pointers({{"op", "scale_rotate"}, {"factor", 1e308}}), "/factor ");
  EXPECT_EQ(pointers({{"op", "scale_rotate"}, {"factor", 2}, {"about", {{"lat", 91}}}}),
            "/about/lon /about/lat ");
  EXPECT_EQ(pointers({{"op", "scale_rotate"}, {"factor", 2}, {"about", "home"}}), "/about ");
  EXPECT_EQ(pointers({{"op", "add_waypoint"}, {"lat", 1}, {"lon", 2}, {"turn", "left"}}), "/turn ");
  EXPECT_EQ(pointers({{"op", "add_waypoint"}, {"lat", 1}}), "/lon ");
  EXPECT_EQ(pointers({{"op", "renumber"}, {"item", 1}}), "/to ");
  EXPECT_EQ(pointers({{"op", "densify"}, {"at_most_m", 0}}), "/at_most_m ");
  EXPECT_EQ(call("GET", "/missions/" + id).body["revision"], 1);
}

}  // namespace
}  // namespace roverd::test
