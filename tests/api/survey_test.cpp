// POST /missions/survey: planned, stored, refused.

#include "house.hpp"

namespace roverd::test {
namespace {

/// 58 m by 56 m, east and north of kStart.
Json square(double share = 1.0) {
  const double lat = 0.0005 * share;
  const double lon = 0.001 * share;
  return {{{"lat", kStart.lat}, {"lon", kStart.lon}},
          {{"lat", kStart.lat}, {"lon", kStart.lon + lon}},
          {{"lat", kStart.lat + lat}, {"lon", kStart.lon + lon}},
          {{"lat", kStart.lat + lat}, {"lon", kStart.lon}}};
}

class SurveyApi : public HouseTest {
 protected:
  Json body() { return {{"polygon", {square()}}, {"spacing_m", 2}}; }

  /// The pointers of a refusal, each with a blank.
  std::string pointers(const Json& request, unsigned status = 422) {
    const auto reply = call("POST", "/missions/survey", request);
    EXPECT_EQ(reply.status, status) << request.dump().substr(0, 300) << reply.body;
    std::string out;
    for (const Json& error : reply.body.value("errors", Json::array())) {
      out += error["pointer"].get<std::string>() + ' ';
    }
    return out;
  }
};

TEST_F(SurveyApi, AnswersWithAMissionThatCanBePosted) {
  const auto planned = call("POST", "/missions/survey", body());
  ASSERT_EQ(planned.status, 200u) << planned.body;
  EXPECT_NEAR(planned.body["field_m2"], 58.6 * 55.7, 40.0);
  EXPECT_GT(planned.body["covered_share"], 0.995);
  EXPECT_EQ(planned.body["tight_turns"], 0);
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 0u);
  const auto made = call("POST", "/missions", planned.body["mission"]);
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_NEAR(made.body["length_m"], planned.body["length_m"], 0.1);
  // It begins in the south-west.
  EXPECT_NEAR(made.body["items"][0]["lat"], kStart.lat + 0.9e-5, 0.2e-5);
}

TEST_F(SurveyApi, WithANameItIsStored) {
  Json request = body();
  request["name"] = "lawn";
  request["speed_mps"] = 0.6;
  request["direction_deg"] = "best";
  request["start"] = "north_east";
  const auto made = call("POST", "/missions/survey", request);
  ASSERT_EQ(made.status, 201u) << made.body;
  const std::string id = made.body["mission"]["id"];
  EXPECT_EQ(made.raw.header("location"), "/api/v1/missions/" + id);
  EXPECT_EQ(made.raw.header("etag"), "\"rev-1\"");
  EXPECT_EQ(call("GET", "/missions/" + id).body, made.body["mission"]);
  EXPECT_EQ(made.body["mission"]["settings"]["speed_mps"], 0.6);
  EXPECT_EQ(call("GET", "/missions/" + id + "/revisions").body["items"][0]["what"],
            "planned as a survey");
}

TEST_F(SurveyApi, TakesGeoJsonHolesArcsAndTheVehicle) {
  until_ready();
  Json outer = Json::array();
  for (const Json& p : square()) outer.push_back({p["lon"], p["lat"]});
  outer.push_back(outer[0]);
  Json hole = Json::array();
  for (const auto& [e, n] : {std::pair{0.0004, 0.0002}, {0.0006, 0.0002}, {0.0005, 0.0003}}) {
    hole.push_back({kStart.lon + e, kStart.lat + n, 55.0});
  }
  const Json request = {{"polygon", {{"type", "Polygon"}, {"coordinates", {outer, hole}}}},
                        {"spacing_m", 1.5},
                        {"turn", "arc"},
                        {"radius_m", 1.2},
                        {"headland_passes", 3},
                        {"order", "skip"},
                        {"start", "vehicle"},
                        {"pattern", "tracks"},
                        {"overshoot_m", 0.5},
                        {"border_m", 1.0}};
  const auto planned = call("POST", "/missions/survey", request);
  ASSERT_EQ(planned.status, 200u) << planned.body;
  EXPECT_GT(planned.body["tracks"], 20);
  for (const char* pattern : {"perimeter", "spiral"}) {
    Json other = body();
    other["pattern"] = pattern;
    EXPECT_EQ(call("POST", "/missions/survey", other).status, 200u) << pattern;
  }
}

TEST_F(SurveyApi, EveryWrongMemberIsNamedAndNothingIsStored) {
  const auto with = [this](const char* name, const Json& value) {
    Json request = body();
    request["name"] = "x";
    request[name] = value;
    return pointers(request);
  };
  EXPECT_EQ(pointers(Json::object()), "/polygon /spacing_m ");
  EXPECT_EQ(pointers(Json::array()), " ");
  EXPECT_EQ(with("spacing_m", 0), "/spacing_m ");
  EXPECT_EQ(with("spacing_m", 500), "/spacing_m ");
  EXPECT_EQ(with("spacing_m", "wide"), "/spacing_m ");
  EXPECT_EQ(with("direction_deg", "north"), "/direction_deg ");
  EXPECT_EQ(with("direction_deg", 1e308), "/direction_deg ");
  EXPECT_EQ(with("pattern", "zigzag"), "/pattern ");
  EXPECT_EQ(with("turn", "arc"), "/radius_m ");
  EXPECT_EQ(with("start", "middle"), "/start ");
  EXPECT_EQ(with("start", {{"lat", 91}, {"lon", 0}}), "/start/lat ");
  EXPECT_EQ(with("headland_passes", 1.5), "/headland_passes ");
  EXPECT_EQ(with("skip", 2), "/skip ");
  EXPECT_EQ(with("order", "random"), "/order ");
  EXPECT_EQ(with("width_m", 2), "/width_m ");
  EXPECT_EQ(with("name", ""), "/name ");
  EXPECT_EQ(with("polygon", 7), "/polygon ");
  EXPECT_EQ(with("polygon", Json::array()), "/polygon ");
  EXPECT_EQ(with("polygon", Json::array({Json::array()})), "/polygon ");
  EXPECT_EQ(with("polygon", Json::array({Json::array({7})})), "/polygon/0/0 ");
  EXPECT_EQ(with("polygon", {{{{"lat", 1}, {"lon", "x"}}}}), "/polygon/0/0 ");
  Json bow = square();
  std::swap(bow[1], bow[2]);
  EXPECT_EQ(with("polygon", Json::array({bow})).substr(0, 11), "/polygon/0/");
  EXPECT_EQ(with("polygon", Json::array({square(), square(3)})).substr(0, 9), "/polygon/");
  EXPECT_EQ(with("polygon", {{"type", "Point"}}), "/polygon ");
  EXPECT_EQ(with("polygon", {{"type", "Polygon"}, {"coordinates", {{{181, 0}, {1, 1}, {2, 0}}}}}),
            "/polygon/coordinates/0/0 ");
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 0u);
  EXPECT_EQ(call("POST", "/missions/survey", std::string("{\"spacing_m\": 1e999}")).status, 422u);
  EXPECT_EQ(call("POST", "/missions/survey", std::string("{")).status, 400u);
  EXPECT_EQ(
      call("POST", "/missions/survey", std::string("{}"), "Content-Type: text/plain\r\n").status,
      415u);
}

}  // namespace
}  // namespace roverd::test
