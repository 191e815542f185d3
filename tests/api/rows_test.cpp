// POST /missions/rows: planned, stored, refused.

#include "house.hpp"

namespace roverd::test {
namespace {

class RowsApi : public HouseTest {
 protected:
  std::string rows_pointers(const Json& request) {
    const auto reply = call("POST", "/missions/rows", request);
    EXPECT_EQ(reply.status, 422u) << reply.body;
    std::string out;
    for (const Json& error : reply.body.value("errors", Json::array())) {
      out += error["pointer"].get<std::string>() + ' ';
    }
    return out;
  }
};

TEST_F(RowsApi, AnswersWithAMissionThatCanBePosted) {
  const Json request = {
      {"rows", 3}, {"spacing_m", 2.5}, {"turn", "left"}, {"speed_mps", 0.4}, {"seeing", "rays"}};
  const auto planned = call("POST", "/missions/rows", request);
  ASSERT_EQ(planned.status, 200u) << planned.body;
  EXPECT_EQ(planned.body["order"], (Json{1, 2, 3}));
  const Json& items = planned.body["mission"]["items"];
  ASSERT_EQ(items.size(), 12u);
  EXPECT_EQ(items[0]["type"], "row");
  EXPECT_EQ(items[0]["speed_mps"], 0.4);
  EXPECT_EQ(items[0]["seeing"], "rays");
  EXPECT_EQ(items[1], (Json{{"type", "move"}, {"forward_m", 1.5}}));
  EXPECT_EQ(items[2], (Json{{"type", "turn"}, {"turn_deg", -90.0}}));
  EXPECT_EQ(items[3], (Json{{"type", "move"}, {"forward_m", 2.5}}));
  EXPECT_EQ(items[7], (Json{{"type", "turn"}, {"turn_deg", 90.0}}));  // on the way back
  const auto made = call("POST", "/missions", planned.body["mission"]);
  EXPECT_EQ(made.status, 201u) << made.body;
}

TEST_F(RowsApi, WithANameItIsStored) {
  const auto made = call("POST", "/missions/rows",
                         Json{{"rows", 2},
                              {"spacing_m", 3},
                              {"entry", {{"lat", kStart.lat}, {"lon", kStart.lon}}},
                              {"heading_deg", 45},
                              {"name", "berries"}});
  ASSERT_EQ(made.status, 201u) << made.body;
  const std::string id = made.body["mission"]["id"];
  EXPECT_EQ(made.raw.header("location"), "/api/v1/missions/" + id);
  EXPECT_EQ(made.body["mission"]["items"][1]["heading_deg"], 45.0);
}

TEST_F(RowsApi, TurnsAsItIsToldAndTellsTheRoomThatThisNeeds) {
  const auto planned =
      call("POST", "/missions/rows", Json{{"rows", 2}, {"spacing_m", 2.5}, {"turn_kind", "arc"}});
  ASSERT_EQ(planned.status, 200u) << planned.body;
  EXPECT_EQ(planned.body["headland_m"], 1.5 + 1.25);
  const Json& items = planned.body["mission"]["items"];
  ASSERT_EQ(items.size(), 5u);
  EXPECT_EQ(items[2], (Json{{"type", "turn"}, {"turn_deg", 180.0}, {"radius_m", 1.25}}));
  const auto made = call("POST", "/missions", planned.body["mission"]);
  EXPECT_EQ(made.status, 201u) << made.body;
  EXPECT_EQ(made.body["items"][2], items[2]);
}

//   3 ── 2     2.5 m apart there is room for three rows; row 1 leads north
//   4 ── 1
TEST_F(RowsApi, ABlockTellsHowManyRowsWhereTheyBeginAndEnd) {
  const base::LocalFrame frame(1, kStart);
  const auto at = [&frame](double east_m, double north_m) {
    const auto p = frame.to_global({east_m, north_m});
    return Json{{"lat", p.lat}, {"lon", p.lon}};
  };
  const auto planned =
      call("POST", "/missions/rows",
           Json{{"spacing_m", 2.5}, {"block", {at(0, 0), at(0, 20), at(-6, 20), at(-6, 0)}}});
  ASSERT_EQ(planned.status, 200u) << planned.body;
  EXPECT_EQ(planned.body["order"], (Json{1, 2, 3}));
  const Json& items = planned.body["mission"]["items"];
  EXPECT_EQ(items[0]["type"], "waypoint");
  EXPECT_EQ(items[1]["heading_deg"], 0.0);
  ASSERT_EQ(items[2]["type"], "row");
  const auto until =
      frame.to_local({items[2]["until_lat"].get<double>(), items[2]["until_lon"].get<double>()});
  EXPECT_NEAR(until.east_m, 0.0, 0.02);
  EXPECT_NEAR(until.north_m, 21.0, 0.02);
  EXPECT_EQ(items[4]["turn_deg"], -90.0);  // they lie to the left
}

TEST_F(RowsApi, NamesWhatIsWrong) {
  EXPECT_EQ(rows_pointers(Json::object()), "/spacing_m /rows ");
  EXPECT_EQ(rows_pointers({{"rows", 0}, {"spacing_m", 2}}), "/rows ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"turn", "up"}, {"gaps", 1}}),
            "/turn /gaps ");
  EXPECT_EQ(
      rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"entry", {{"lat", 58.0}, {"lon", 26.0}}}}),
      "/heading_deg ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"entry", {{"lat", 58.0}}}}),
            "/entry/lon ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"turn_kind", "u"}, {"radius_m", 0.0}}),
            "/turn_kind /radius_m ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"turn_kind", "shunt"}}), "/radius_m ");
  const Json begin = {{"lat", 58.0}, {"lon", 26.0}};
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"block", {begin}}}), "/block ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"block", {begin, {{"lat", 58.0}}}}}),
            "/block/1/lon ");
  EXPECT_EQ(rows_pointers({{"rows", 2},
                           {"spacing_m", 2},
                           {"heading_deg", 3},
                           {"block", {begin, {{"lat", 58.001}, {"lon", 26.0}}}}}),
            "/heading_deg ");
}

}  // namespace
}  // namespace roverd::test
