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

TEST_F(RowsApi, NamesWhatIsWrong) {
  EXPECT_EQ(rows_pointers(Json::object()), "/rows /spacing_m ");
  EXPECT_EQ(rows_pointers({{"rows", 0}, {"spacing_m", 2}}), "/rows ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"turn", "up"}, {"gaps", 1}}),
            "/turn /gaps ");
  EXPECT_EQ(
      rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"entry", {{"lat", 58.0}, {"lon", 26.0}}}}),
      "/heading_deg ");
  EXPECT_EQ(rows_pointers({{"rows", 2}, {"spacing_m", 2}, {"entry", {{"lat", 58.0}}}}),
            "/entry/lon ");
}

}  // namespace
}  // namespace roverd::test
