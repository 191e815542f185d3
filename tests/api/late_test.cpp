// A command is never late: what moves, arms or resumes and is older than its life time is refused,
// and nothing happens. What stops is never too late.

#include <thread>

#include "house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

class LateApi : public HouseTest {
 protected:
  double mono_s() { return call("GET", "/health").body["mono_s"]; }
  static std::string seen(double at_s) { return "Roverd-Seen: " + Json(at_s).dump() + "\r\n"; }
  static bool is_late(const Reply& reply) {
    return reply.status == 409 && reply.body["type"].get<std::string>().ends_with("late");
  }
  bool armed() { return call("GET", "/vehicle").body["armed"]; }
  static std::string arm_request(const std::string& more = "") {
    return "POST /api/v1/vehicle/arm HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more + "\r\n";
  }
};

struct Command {
  const char* method;
  const char* path;
  Json body;
};

std::vector<Command> all_that_move(const std::string& mission) {
  const Json start = {{"mission_id", mission}, {"revision", 1}};
  return {{"POST", "/vehicle/arm", Json::object()},
          {"PUT", "/vehicle/mode", {{"mode", "MANUAL"}}},
          {"PUT", "/vehicle/mode", {{"mode", "AUTO"}}},
          {"PUT", "/vehicle/mode", {{"mode", "RTL"}}},
          {"POST", "/vehicle/goto", {{"lat", kStart.lat}, {"lon", kStart.lon}}},
          {"POST", "/vehicle/move", {{"forward_m", 1}}},
          {"PUT", "/vehicle/target", {{"lat", kStart.lat}, {"lon", kStart.lon}}},
          {"POST", "/vehicle/estop/reset", Json::object()},
          {"POST", "/execution/start", start},
          {"POST", "/execution/resume", Json::object()},
          {"POST", "/execution/skip", Json::object()},
          {"POST", "/drivers/gnss/restart", Json::object()},
          {"PUT", "/vehicle/lights", {{"front", {{"mode", "on"}}}}},
          {"POST", "/vehicle/errors/clear", Json::object()}};
}

TEST_F(LateApi, EveryCommandThatMovesIsRefusedWhenWhatItAnswersToIsTooOld) {
  until_ready();
  const std::string id = make_mission();
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  for (const Command& c : all_that_move(id)) {
    const Reply reply = call(c.method, c.path, c.body, seen(mono_s() - 1.1));
    EXPECT_TRUE(is_late(reply)) << c.path << ' ' << reply.status << ' ' << reply.raw.body;
  }
  EXPECT_FALSE(armed());
  EXPECT_EQ(house.restarts, 0);
  EXPECT_EQ(house.errors_cleared, -1);
}

TEST_F(LateApi, TheAgeCountsFromWhatWasSeenAndTheLifeTimeCanBeUpToFiveSeconds) {
  until_ready();
  EXPECT_TRUE(is_late(call("POST", "/vehicle/arm", Json{{"valid_for_s", 0.3}},  //
                           seen(mono_s() - 0.5))));
  EXPECT_FALSE(armed());
  EXPECT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}, seen(mono_s() - 1.5)).status,
            200u);
  EXPECT_TRUE(armed());
  const Reply longer = call("POST", "/vehicle/arm", Json{{"valid_for_s", 5.1}});
  EXPECT_EQ(longer.status, 422u);
  EXPECT_EQ(longer.body["errors"][0]["pointer"], "/valid_for_s");
}

TEST_F(LateApi, ATimeThatCannotHaveBeenSeenIsInvalid) {
  until_ready();
  const double now_s = mono_s();
  for (const std::string& value :
       {Json(now_s + 60.0).dump(), std::string("-1"), std::string("nan"), std::string("inf"),
        std::string("1e999"), std::string("soon"), std::string("1,5"), std::string(),
        std::string("0x10"), std::string("12 s")}) {
    const Reply reply = call("POST", "/vehicle/arm", "", "Roverd-Seen: " + value + "\r\n");
    EXPECT_EQ(reply.status, 422u) << value;
    EXPECT_EQ(reply.body["errors"][0]["pointer"], "Roverd-Seen") << value;
  }
  EXPECT_EQ(call("POST", "/vehicle/arm", "", seen(now_s) + seen(now_s)).status, 422u);
  EXPECT_FALSE(armed());
}

TEST_F(LateApi, WhatStopsIsNeverTooLateWhateverItSays) {
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  const std::string old = seen(0.001);
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "HOLD"}}, old).status, 200u);
  EXPECT_EQ(call("POST", "/vehicle/disarm", Json{{"valid_for_s", 0.000001}}, old).status, 200u);
  EXPECT_FALSE(armed());
  EXPECT_EQ(call("POST", "/vehicle/estop", "", "Roverd-Seen: nonsense\r\n").status, 200u);
  EXPECT_EQ(call("GET", "/vehicle").body["estop"], true);
}

TEST_F(LateApi, ARequestThatTookLongToComeIsTooLateWithoutATimeOfItsOwn) {
  until_ready();
  {  // A connection that was opened long before anything came through it;
    Client client(house.port());
    std::this_thread::sleep_for(1200ms);
    client.send(arm_request());
    EXPECT_EQ(client.answer()->status, 409u);
  }
  {  // a header that trickled in through one that was kept;
    Client client(house.port());
    client.send("GET /api/v1/health HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    ASSERT_EQ(client.answer()->status, 200u);
    const std::string request = arm_request();
    client.send(request.substr(0, 9));
    std::this_thread::sleep_for(1200ms);
    client.send(request.substr(9));
    EXPECT_EQ(client.answer()->status, 409u);
  }
  EXPECT_FALSE(armed());
  {  // but nobody knows better how old it is than who sent it.
    Client client(house.port());
    std::this_thread::sleep_for(1200ms);
    client.send(arm_request(seen(mono_s())));
    EXPECT_EQ(client.answer()->status, 200u);
  }
  EXPECT_TRUE(armed());
}

TEST_F(LateApi, AKeptConnectionMayRestBetweenTwoRequests) {
  until_ready();
  Client client(house.port());
  client.send("GET /api/v1/health HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  ASSERT_EQ(client.answer()->status, 200u);
  std::this_thread::sleep_for(1200ms);
  client.send(arm_request());
  EXPECT_EQ(client.answer()->status, 200u);
}

/// A click that a stop overtook on its way, however young it is.
TEST_F(LateApi, AStopRefusesWhatWasClickedBeforeItAndComesAfterIt) {
  until_ready();
  const std::string id = make_mission();
  ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
  const std::vector<Command> stops{{"PUT", "/vehicle/mode", {{"mode", "HOLD"}}},
                                   {"POST", "/execution/pause", Json::object()},
                                   {"POST", "/execution/stop", Json::object()},
                                   {"POST", "/vehicle/disarm", Json::object()},
                                   {"POST", "/vehicle/estop", Json::object()}};
  for (const Command& stop : stops) {
    const double seen_s = mono_s();
    std::this_thread::sleep_for(30ms);
    call(stop.method, stop.path, stop.body);  // with nothing to stop: 409, and heard all the same
    for (const Command& c : all_that_move(id)) {
      if (c.path == std::string("/drivers/gnss/restart")) break;  // and what follows: nothing moves
      Json body = c.body;
      body["valid_for_s"] = 5;
      const Reply reply = call(c.method, c.path, body, seen(seen_s));
      EXPECT_TRUE(is_late(reply)) << stop.path << ' ' << c.path << ' ' << reply.raw.body;
      EXPECT_EQ(reply.body["detail"],
                "the robot was stopped after this was clicked, so it was not carried out: look, "
                "then click again");
    }
  }
  EXPECT_FALSE(armed());
  ASSERT_EQ(call("POST", "/vehicle/estop/reset", Json::object(), seen(mono_s())).status, 200u);
  EXPECT_EQ(call("POST", "/vehicle/arm", Json::object(), seen(mono_s())).status, 200u);
}

/// By WebSocket.
class LateStream : public LateApi {
 protected:
  void SetUp() override {
    until_ready();
    ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
    ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).status, 200u);
    client = std::make_unique<Client>(house.port());
    ASSERT_EQ(client->upgrade("/api/v1/stream"), 101u);
  }
  Json next(const std::string& topic) {
    while (const auto frame = client->frame()) {
      if (frame->opcode != 1) continue;
      Json message = Json::parse(frame->payload);
      if (message["topic"] == topic) return message;
    }
    ADD_FAILURE() << "no " << topic;
    return {};
  }
  void say(const Json& message) { client->send_frame(1, message.dump()); }
  /// As the stream tells it.
  double stream_mono_s() {
    say({{"ping", 7}});
    const Json pong = next("pong");
    EXPECT_EQ(pong["data"]["ping"], 7);
    return pong["mono_s"];
  }
  static Json drive(double seen_s) {
    return {{"drive", {{"speed_mps", 0.4}, {"yaw_rate_dps", 0}, {"deadman", true}}},
            {"seen_s", seen_s}};
  }

  std::unique_ptr<Client> client;
};

TEST_F(LateStream, AStickThatAnswersToWhatIsTooOldDoesNotMoveTheRobot) {
  for (int i = 0; i < 20; ++i) {
    say(drive(stream_mono_s() - 0.3));
    const Json error = next("error");
    EXPECT_TRUE(error["data"]["type"].get<std::string>().ends_with("late")) << error;
    EXPECT_EQ(house.sent().twist, base::BodyTwist{});
  }
  // A hand on the speed likewise: it is as if it had said nothing.
  say({{"throttle", {{"share", 0.2}, {"held", true}}}, {"seen_s", stream_mono_s() - 0.3}});
  EXPECT_TRUE(next("error")["data"]["type"].get<std::string>().ends_with("late"));
  EXPECT_FALSE(house.snapshot()->teleop.auto_share);
  // The same with a life time of its own is in time, once the stick was let go.
  const Json free = {{"drive", {{"speed_mps", 0}, {"yaw_rate_dps", 0}, {"deadman", false}}}};
  until(
      [&] {
        say(free);
        std::this_thread::sleep_for(20ms);
        return house.snapshot()->teleop.phase == base::TeleopPhase::Ready;
      },
      "the robot has seen that the stick is free");
  Json longer = drive(0.0);
  longer["drive"]["valid_for_s"] = 5;
  until(
      [&] {
        longer["seen_s"] = stream_mono_s() - 0.3;
        say(longer);
        return house.sent().twist.linear_mps > 0.1;
      },
      "the base is told to move");
  // It is obeyed, slowly, and told so.
  longer["seen_s"] = stream_mono_s() - 0.3;
  say(longer);
  until(
      [this] {
        const Json state = call("GET", "/vehicle").body;
        return state["teleop"]["delay_s"].is_number() && state["teleop"]["delay_s"] >= 0.3 &&
               state["speed_reason"] == "link_delay";
      },
      "the delay is told");
}

TEST_F(LateStream, AHaltOnTheStreamOvertakesAClickToo) {
  const double seen_s = stream_mono_s();
  std::this_thread::sleep_for(30ms);
  say({{"halt", "hold"}});
  until([this] { return call("GET", "/vehicle").body["mode"] == "HOLD"; }, "it holds");
  const Reply late =
      call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}, {"valid_for_s", 5}}, seen(seen_s));
  EXPECT_TRUE(is_late(late)) << late.raw.body;
  EXPECT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}, seen(mono_s())).status, 200u);
}

TEST_F(LateStream, AStickOfTheFutureIsRefusedByName) {
  say(drive(stream_mono_s() + 10.0));
  const Json error = next("error");
  EXPECT_EQ(error["data"]["status"], 422);
  EXPECT_EQ(error["data"]["errors"][0]["pointer"], "/seen_s");
  EXPECT_EQ(house.sent().twist, base::BodyTwist{});
}

TEST_F(LateStream, AStickWhoseMessageTrickledInIsTooLate) {
  const std::string text = R"({"drive":{"speed_mps":0.4,"yaw_rate_dps":0,"deadman":true}})";
  std::string frame = {'\x81', static_cast<char>(0x80 | text.size()), 0, 0, 0, 0};
  frame += text;
  stream_mono_s();  // nothing of an earlier message is under way
  client->send(frame.substr(0, 20));
  std::this_thread::sleep_for(500ms);
  client->send(frame.substr(20));
  const Json error = next("error");
  EXPECT_TRUE(error["data"]["type"].get<std::string>().ends_with("late")) << error;
  EXPECT_EQ(house.sent().twist, base::BodyTwist{});
}

TEST_F(LateStream, TheStopOnTheStreamLatchesAndIsConfirmed) {
  say({{"estop", true}});
  EXPECT_EQ(next("estop")["data"]["estop"], true);
  const Json state = call("GET", "/vehicle").body;
  EXPECT_EQ(state["estop"], true);
  EXPECT_EQ(state["armed"], false);
}

TEST_F(LateStream, AStopStopsWhateverElseTheMessageSays) {
  say({{"estop", true}, {"drive", 5}, {"fly", 1}, {"seen_s", -1}});
  until([this] { return call("GET", "/vehicle").body["estop"] == true; }, "stopped");
  // The other half was nonsense, and is said so.
  EXPECT_EQ(next("error")["data"]["status"], 422);
  // A stop that is none is no stop.
  ASSERT_EQ(call("POST", "/vehicle/estop/reset", Json{{"valid_for_s", 5}}).status, 200u);
  say({{"estop", false}});
  EXPECT_EQ(next("error")["data"]["errors"][0]["pointer"], "/estop");
  EXPECT_EQ(call("GET", "/vehicle").body["estop"], false);
}

}  // namespace
}  // namespace roverd::test
