// Teach-in over HTTP and by the radio, through the real store.

#include "house.hpp"

namespace roverd::test {
namespace {

class TeachApi : public HouseTest {
 protected:
  Json teach() { return call("GET", "/teach").body; }
  unsigned post(const std::string& what, const Json& body = Json::object()) {
    return call("POST", "/teach/" + what, body).status;
  }
  /// The receiver goes north by steps that the estimator believes.
  void walk(double to_m) {
    while (house.moved_m < to_m) {
      house.moved_m = house.moved_m + 0.05;
      const auto tick = house.snapshot()->tick;
      until([&] { return house.snapshot()->tick > tick + 10; }, "a fix");
    }
  }
};

TEST_F(TeachApi, ADrivenWayBecomesAMission) {
  until_ready();
  EXPECT_EQ(teach()["state"], "idle");
  EXPECT_EQ(post("pause"), 409u);
  EXPECT_EQ(post("stop"), 409u);
  ASSERT_EQ(post("start", {{"name", "to the gate"}, {"step_m", 0.2}}), 200u);
  EXPECT_EQ(post("start"), 409u);
  until([this] { return teach()["points"] == 1; }, "where it stands");
  EXPECT_EQ(call("GET", "/vehicle").body["teach"]["state"], "recording");
  // Nothing was driven yet: it goes on.
  EXPECT_EQ(post("stop"), 409u);
  EXPECT_EQ(teach()["state"], "recording");
  walk(1.0);
  until([this] { return teach()["points"].get<int>() >= 3; }, "some points");
  ASSERT_EQ(post("pause"), 200u);
  const int points = teach()["points"];
  EXPECT_EQ(teach()["state"], "paused");
  until([this] { return teach()["unsaved_points"] == 0; }, "they are on the disk");
  ASSERT_EQ(post("resume"), 200u);
  walk(1.5);
  const auto made = call("POST", "/teach/stop", Json{{"tolerance_m", 0.0}});
  ASSERT_EQ(made.status, 201u) << made.body;
  EXPECT_GE(made.body["items"].size(), static_cast<std::size_t>(points));
  EXPECT_EQ(made.body["name"], "to the gate");
  // The estimator follows the receiver with a lag.
  EXPECT_GT(made.body["length_m"], 0.7);
  EXPECT_LT(made.body["length_m"], 1.7);
  EXPECT_EQ(teach()["state"], "idle");
  EXPECT_EQ(call("GET", "/missions/" + made.body["id"].get<std::string>()).body, made.body);
}

TEST_F(TeachApi, WhatIsNotTrustedIsNotRecordedAndSaysWhy) {
  until_ready();
  ASSERT_EQ(post("start", {{"sigma_max_m", 0.01}}), 200u);
  until([this] { return !teach()["waiting"].is_null(); }, "a reason");
  EXPECT_NE(teach()["waiting"].get<std::string>().find("uncertain"), std::string::npos);
  EXPECT_EQ(teach()["points"], 0);
  ASSERT_EQ(post("discard"), 200u);
  EXPECT_EQ(teach()["state"], "idle");
  EXPECT_EQ(call("GET", "/missions").body["items"].size(), 0u);
}

TEST_F(TeachApi, EveryWrongMemberIsNamed) {
  const auto pointer = [this](const std::string& what, const Json& body) {
    const auto reply = call("POST", "/teach/" + what, body);
    EXPECT_EQ(reply.status, 422u) << body;
    return reply.body["errors"][0]["pointer"];
  };
  EXPECT_EQ(pointer("start", {{"step_m", 0}}), "/step_m");
  EXPECT_EQ(pointer("start", {{"heading_deg", 1e308}}), "/heading_deg");
  EXPECT_EQ(pointer("start", {{"tolerance_m", "much"}}), "/tolerance_m");
  EXPECT_EQ(pointer("start", {{"sigma_max_m", -1}}), "/sigma_max_m");
  EXPECT_EQ(pointer("start", {{"name", ""}}), "/name");
  EXPECT_EQ(pointer("start", {{"speed", 1}}), "/speed");
  EXPECT_EQ(pointer("stop", {{"tolerance_m", 11}}), "/tolerance_m");
  EXPECT_EQ(pointer("pause", {{"now", true}}), "/now");
}

}  // namespace
}  // namespace roverd::test
