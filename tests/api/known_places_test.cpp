// Tags and poles whose place is known, over the interface.

#include <vector>

#include "house.hpp"
#include "schema.hpp"

namespace roverd::test {
namespace {

class KnownPlacesApi : public HouseTest {
 protected:
  static std::string fault(const Json& place) {
    return schema_fault(document(), document()["components"]["schemas"]["KnownPlace"], place);
  }
};

TEST_F(KnownPlacesApi, AreEnteredChangedAndForgotten) {
  until_ready();
  EXPECT_TRUE(call("GET", "/known-places").body["items"].empty());
  const auto gate = call("PUT", "/known-places/gate",
                         Json{{"tag", 5}, {"lat", 58.378}, {"lon", 26.729}, {"heading_deg", 180}});
  ASSERT_EQ(gate.status, 200u) << gate.body;
  EXPECT_EQ(fault(gate.body), "");
  EXPECT_EQ(gate.body["heading_deg"], 180.0);
  EXPECT_EQ(gate.body["accuracy_m"], 0.05);
  EXPECT_EQ(gate.body["state"], "unseen");
  EXPECT_EQ(gate.body["configured"], false);
  const auto pole = call("PUT", "/known-places/pole",
                         Json{{"east_m", 2.0}, {"north_m", 3.0}, {"accuracy_m", 0.2}});
  ASSERT_EQ(pole.status, 200u) << pole.body;
  EXPECT_TRUE(pole.body["tag"].is_null());
  const auto moved =
      call("PUT", "/known-places/gate", Json{{"tag", 6}, {"lat", 58.37}, {"lon", 26.7}});
  ASSERT_EQ(moved.status, 200u);
  const Json items = call("GET", "/known-places").body["items"];
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0]["tag"], 6);
  EXPECT_TRUE(items[0]["heading_deg"].is_null());
  EXPECT_NEAR(items[1]["lat"].get<double>(),
              house.snapshot()->frame->origin().lat + 3.0 / 111'400.0, 1e-6);
  EXPECT_EQ(call("DELETE", "/known-places/gate").status, 204u);
  EXPECT_EQ(call("DELETE", "/known-places/gate").status, 404u);
  EXPECT_EQ(call("GET", "/known-places").body["items"].size(), 1u);
}

TEST_F(KnownPlacesApi, WhatCannotBeIsRefusedWithItsName) {
  until_ready();
  struct Wrong {
    Json body;
    const char* names;
  };
  const std::vector<Wrong> all{
      {{{"lat", 58.378}}, "lon"},
      {{{"lat", 91.0}, {"lon", 0.0}}, "lat"},
      {{{"east_m", 1.0}}, "north_m"},
      {{{"lat", 58.378}, {"lon", 26.7}, {"east_m", 1.0}, {"north_m", 1.0}}, "east_m"},
      {{{"lat", 58.378}, {"lon", 26.7}, {"heading_deg", 90}}, "heading_deg"},
      {{{"lat", 58.378}, {"lon", 26.7}, {"tag", 587}}, "tag"},
      {{{"lat", 58.378}, {"lon", 26.7}, {"accuracy_m", 0.0}}, "accuracy_m"},
      {{{"lat", 58.378}, {"lon", 26.7}, {"colour", "red"}}, "colour"}};
  for (const Wrong& wrong : all) {
    const auto answer = call("PUT", "/known-places/gate", wrong.body);
    EXPECT_EQ(answer.status, 422u) << wrong.body;
    EXPECT_NE(answer.body.dump().find(wrong.names), std::string::npos) << answer.body;
  }
  const Json good{{"lat", 58.378}, {"lon", 26.7}, {"tag", 5}};
  EXPECT_EQ(call("PUT", "/known-places/The%20Gate", good).status, 422u);
  ASSERT_EQ(call("PUT", "/known-places/gate", good).status, 200u);
  const auto twice = call("PUT", "/known-places/door", good);
  EXPECT_EQ(twice.status, 409u);
  EXPECT_NE(twice.body["detail"].get<std::string>().find("gate"), std::string::npos);
  EXPECT_EQ(call("GET", "/known-places").body["items"].size(), 1u);
}

}  // namespace
}  // namespace roverd::test
