// The guided calibration drive over HTTP, in a house whose robot never gets anywhere: what it
// needs, when it is refused, and what is left of a drive that was broken off.

#include "house.hpp"

namespace roverd::test {
namespace {

class CalibrationApi : public HouseTest {
 protected:
  Json need(const std::string& kind) {
    const Json told = call("GET", "/vehicle/calibration").body;
    for (const Json& one : told["kinds"]) {
      if (one["kind"] == kind) return one;
    }
    ADD_FAILURE() << kind << " is not told";
    return {};
  }
  Reply begin(const std::string& kind) {
    return call("POST", "/vehicle/calibration", Json{{"kind", kind}, {"valid_for_s", 5}});
  }
  /// Where it points is known, as a person says.
  void point() {
    until_ready();
    call("POST", "/vehicle/disarm");
    ASSERT_EQ(call("PUT", "/vehicle/pose", Json{{"heading_deg", 0}}).status, 200u);
  }
};

TEST_F(CalibrationApi, TellsWhatItNeedsBeforeAnythingWasBegun) {
  point();
  const auto told = call("GET", "/vehicle/calibration");
  ASSERT_EQ(told.status, 200u);
  EXPECT_EQ(told.body["kinds"].size(), 4u);
  EXPECT_EQ(told.body["kept"], false);
  const Json drive = need("drive");
  EXPECT_GT(drive["space"]["ahead_m"], 6.0);
  EXPECT_GT(drive["seconds"], 60.0);
  EXPECT_EQ(drive["corners"].size(), 4u);
  EXPECT_EQ(need("steering")["possible"], false);
}

TEST_F(CalibrationApi, IsRefusedInWords) {
  point();
  EXPECT_EQ(begin("drive").body["detail"], "the robot is not armed");
  EXPECT_EQ(begin("drive").status, 409u);
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto steering = begin("steering");
  EXPECT_EQ(steering.status, 409u);
  EXPECT_EQ(steering.body["detail"], "this vehicle has no steered wheels: calibrate its drive");
  EXPECT_EQ(begin("compass").body["detail"], "no compass is heard");
  const auto unknown = begin("wheels");
  EXPECT_EQ(unknown.status, 422u);
  EXPECT_EQ(unknown.body["errors"][0]["pointer"], "/kind");
  const auto none = call("POST", "/vehicle/calibration", Json::object());
  EXPECT_EQ(none.status, 422u);
  EXPECT_EQ(call("DELETE", "/vehicle/calibration").status, 409u);
}

TEST_F(CalibrationApi, IsBegunToldAndBrokenOff) {
  point();
  // A new fixed solution is worth a float one for three seconds: too uncertain to measure by.
  until([&] { return house.snapshot()->pose->horizontal_sigma_m < 0.2; }, "it settles");
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto begun = begin("drive");
  ASSERT_EQ(begun.status, 202u) << begun.body.dump();
  EXPECT_EQ(begun.raw.header("location"), "/api/v1/vehicle/calibration");
  EXPECT_EQ(begun.body["state"], "running");
  EXPECT_EQ(begun.body["kind"], "drive");
  EXPECT_EQ(begun.body["values"].size(), 7u);
  EXPECT_EQ(call("GET", "/vehicle").body["activity"]["kind"], "calibration");
  for (const char* word : {"keep", "discard"}) {
    const auto early = call("POST", std::string("/vehicle/calibration/") + word);
    EXPECT_EQ(early.status, 409u);
    EXPECT_NE(early.body["detail"].get<std::string>().find("still measures"), std::string::npos);
  }
  ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "HOLD"}}).status, 200u);
  const auto ended = call("GET", "/vehicle/calibration").body;
  EXPECT_EQ(ended["state"], "aborted");
  EXPECT_NE(ended["reason"].get<std::string>().find("HOLD"), std::string::npos);
  const auto kept = call("POST", "/vehicle/calibration/keep");
  EXPECT_EQ(kept.status, 409u);
  EXPECT_EQ(call("GET", "/vehicle").body["learned"]["calibrated"], false);
  const auto dropped = call("POST", "/vehicle/calibration/discard");
  ASSERT_EQ(dropped.status, 200u);
  EXPECT_EQ(dropped.body["state"], "none");
  EXPECT_EQ(call("POST", "/vehicle/calibration/discard").status, 409u);
}

}  // namespace
}  // namespace roverd::test
