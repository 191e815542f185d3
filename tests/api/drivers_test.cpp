// Drivers, lights and errors over HTTP.

#include <algorithm>

#include "house.hpp"

namespace roverd::test {
namespace {

using DriverApi = HouseTest;

class BareVehicleApi : public HouseTest {
 protected:
  BareVehicleApi() : HouseTest(House::Vehicle::Bare) {}
};

TEST_F(DriverApi, ADriverTellsItsStateLinkRatesCountsAndFacts) {
  until([this] { return call("GET", "/drivers/gnss").status == 200; }, "the driver is known");
  const Json driver = call("GET", "/drivers/gnss").body;
  EXPECT_EQ(driver["state"], "up");
  EXPECT_EQ(driver["link"], (Json{{"address", "serial:/dev/ttyACM0:115200"}, {"open", true}}));
  EXPECT_EQ(driver["rates_hz"]["GGA"], 5.0);
  EXPECT_EQ(driver["counts"]["wrong checksum"], 3);
  EXPECT_EQ(driver["facts"]["protocol"], "NMEA");
  EXPECT_EQ(driver["hazards"], Json::array());
  EXPECT_EQ(driver["restarts"], 0);
  EXPECT_TRUE(driver["last_error"].is_null());
  EXPECT_EQ(driver["recording"], "off");
  EXPECT_EQ(call("GET", "/drivers").body["items"].size(), 1u);
  const auto nobody = call("GET", "/drivers/nobody");
  EXPECT_EQ(nobody.status, 404u);
  EXPECT_EQ(nobody.body["detail"], "there is no driver \"nobody\"");
}

TEST_F(DriverApi, AFailedDriverSaysWhyInTheListTheChecksAndTheEvents) {
  until_ready();
  house.phase = base::DriverPhase::Failed;
  until([this] { return call("GET", "/drivers/gnss").body["state"] == "failed"; }, "failed");
  const Json driver = call("GET", "/drivers/gnss").body;
  EXPECT_EQ(driver["reason"], "failed while ticking: a value that cannot be");
  EXPECT_EQ(driver["last_error"]["detail"], driver["reason"]);
  const Json checks = call("GET", "/vehicle/checks").body["checks"];
  const auto check = std::find_if(checks.begin(), checks.end(),
                                  [](const Json& c) { return c["id"] == "drivers"; });
  ASSERT_NE(check, checks.end());
  EXPECT_NE((*check)["detail"].get<std::string>().find("gnss is failed"), std::string::npos);
  until(
      [this] {
        const Json items = call("GET", "/events?level=error").body["items"];
        return std::any_of(items.begin(), items.end(),
                           [](const Json& e) { return e["kind"] == "driver_failed"; });
      },
      "the event is stored");
}

TEST_F(DriverApi, ARestartIsBegunAndRefusedWhileTheRobotIsArmed) {
  until_ready();
  const auto begun = call("POST", "/drivers/gnss/restart");
  EXPECT_EQ(begun.status, 202u);
  EXPECT_EQ(begun.body["name"], "gnss");
  EXPECT_EQ(begun.raw.header("location"), "/api/v1/drivers/gnss");
  EXPECT_EQ(house.restarts, 1);
  EXPECT_EQ(call("POST", "/drivers/nobody/restart").status, 404u);
  EXPECT_EQ(call("POST", "/drivers/gnss/restart", Json{{"hard", true}}).status, 422u);
  EXPECT_EQ(call("GET", "/drivers/gnss/restart").status, 405u);
  // An armed robot may drive by what a working driver says,
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto refused = call("POST", "/drivers/gnss/restart");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body["detail"].get<std::string>().find("disarm"), std::string::npos);
  // not by what a failed one does not say.
  house.phase = base::DriverPhase::Failed;
  until([this] { return call("GET", "/drivers/gnss").body["state"] == "failed"; }, "failed");
  EXPECT_EQ(call("POST", "/drivers/gnss/restart").status, 202u);
  EXPECT_EQ(house.restarts, 2);
}

TEST_F(DriverApi, LightsAreSetAndTold) {
  until_ready();
  EXPECT_TRUE(call("GET", "/vehicle/lights").body["front"].is_null());
  const auto set =
      call("PUT", "/vehicle/lights",
           Json{{"front", {{"mode", "custom"}, {"brightness_pct", 40}}}, {"valid_for_s", 5}});
  EXPECT_EQ(set.status, 202u);
  EXPECT_EQ(house.light_mode, 3);
  until([this] { return !call("GET", "/vehicle/lights").body["front"].is_null(); }, "told");
  const Json told = call("GET", "/vehicle/lights").body;
  EXPECT_EQ(told["commanded"], true);
  EXPECT_EQ(told["front"], (Json{{"mode", "custom"}, {"brightness_pct", 40}}));
  EXPECT_EQ(told["rear"]["mode"], "off");
  // Given back to the vehicle:
  EXPECT_EQ(call("PUT", "/vehicle/lights", Json{{"commanded", false}, {"valid_for_s", 5}}).status,
            202u);
}

TEST_F(DriverApi, WrongLightsAreNamed) {
  const auto pointer = [this](const Json& body) {
    const auto reply = call("PUT", "/vehicle/lights", body);
    EXPECT_EQ(reply.status, 422u) << body;
    return reply.body["errors"][0]["pointer"].get<std::string>();
  };
  EXPECT_EQ(pointer(Json::object()), "/front");
  EXPECT_EQ(pointer({{"front", Json::object()}}), "/front/mode");
  EXPECT_EQ(pointer({{"front", {{"mode", "blinking"}}}}), "/front/mode");
  EXPECT_EQ(pointer({{"front", {{"mode", "custom"}}}}), "/front/brightness_pct");
  EXPECT_EQ(pointer({{"front", {{"mode", "custom"}, {"brightness_pct", 101}}}}),
            "/front/brightness_pct");
  EXPECT_EQ(pointer({{"front", {{"mode", "on"}, {"colour", 1}}}}), "/front/colour");
  EXPECT_EQ(pointer({{"front", "on"}}), "/front");
  EXPECT_EQ(pointer({{"front", {{"mode", "on"}}}, {"rear", {{"mode", 1}}}}), "/rear/mode");
  EXPECT_EQ(house.light_mode, -1) << "nothing was sent";
}

TEST_F(DriverApi, ErrorsAreClearedOnlyWhileDisarmed) {
  until_ready();
  EXPECT_EQ(call("POST", "/vehicle/errors/clear", Json{{"valid_for_s", 5}}).status, 202u);
  EXPECT_EQ(house.errors_cleared, 0);
  EXPECT_EQ(call("POST", "/vehicle/errors/clear", Json{{"motor", 2}, {"valid_for_s", 5}}).status,
            202u);
  EXPECT_EQ(house.errors_cleared, 2);
  EXPECT_EQ(call("POST", "/vehicle/errors/clear", Json{{"motor", 3}}).status, 422u);
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const auto refused = call("POST", "/vehicle/errors/clear");
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body["detail"].get<std::string>().find("disarm first"), std::string::npos);
}

TEST_F(DriverApi, ADriverThatHangsIsAnAnswerToo) {
  until_ready();
  house.driver_answers = false;
  const auto reply = call("PUT", "/vehicle/lights", Json{{"front", {{"mode", "on"}}}});
  EXPECT_EQ(reply.status, 503u);
  EXPECT_NE(reply.body["detail"].get<std::string>().find("hangs"), std::string::npos);
}

TEST_F(BareVehicleApi, HasNoLightsAndNoErrorsAndSaysSo) {
  until_ready();
  const auto lights = call("PUT", "/vehicle/lights", Json{{"front", {{"mode", "on"}}}});
  EXPECT_EQ(lights.status, 409u);
  EXPECT_EQ(lights.body["detail"], "this vehicle has no lights that can be set");
  const auto errors = call("POST", "/vehicle/errors/clear");
  EXPECT_EQ(errors.status, 409u);
  EXPECT_EQ(errors.body["detail"], "this vehicle has no errors that can be cleared");
}

}  // namespace
}  // namespace roverd::test
