// The live stream over a real WebSocket: hello, state, events, teleoperation, nonsense.

#include <tuple>

#include "house.hpp"
#include "schema.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

class StreamApi : public HouseTest {
 protected:
  std::unique_ptr<Client> connect() {
    auto client = std::make_unique<Client>(house.port());
    EXPECT_EQ(client->upgrade("/api/v1/stream"), 101u);
    return client;
  }
  /// The next message of a topic; others are passed over.
  static Json next(Client& client, const std::string& topic) {
    while (const auto frame = client.frame()) {
      if (frame->opcode != 1) continue;
      const Json message = Json::parse(frame->payload);
      if (message["topic"] == topic) return message;
    }
    ADD_FAILURE() << "the stream ended without a message of " << topic;
    return {};
  }
  static std::string fault(const char* schema, const Json& message) {
    return schema_fault(document(), document()["components"]["schemas"][schema], message);
  }
  static void say(Client& client, const Json& message) { client.send_frame(1, message.dump()); }
  static Json drive(double speed_mps, double yaw_rate_dps, bool deadman) {
    return {{"drive",
             {{"speed_mps", speed_mps}, {"yaw_rate_dps", yaw_rate_dps}, {"deadman", deadman}}}};
  }
  void start_a_mission() {
    until_ready();
    const std::string id = make_mission();
    ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
    ASSERT_EQ(call("POST", "/execution/load", Json{{"mission_id", id}}).status, 200u);
    const Json begin = {{"mission_id", id}, {"revision", 1}};
    ASSERT_EQ(call("POST", "/execution/start", begin).status, 200u);
  }
  /// Sticks in the middle, dead-man off, until the robot has seen it.
  void let_go(Client& client) {
    until(
        [&] {
          say(client, drive(0.0, 0.0, false));
          std::this_thread::sleep_for(20ms);
          return house.snapshot()->teleop.phase == base::TeleopPhase::Ready;
        },
        "the robot has seen that the stick is free");
  }
  void arm_in_manual() {
    until_ready();
    ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
    ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).status, 200u);
  }
  /// Holds a stick for so long. @return whether the base was told to move
  bool push(Client& client, std::chrono::milliseconds for_ms = 300ms) {
    bool moved = false;
    const auto end = std::chrono::steady_clock::now() + for_ms;
    while (std::chrono::steady_clock::now() < end) {
      say(client, drive(0.4, 0.0, true));
      std::this_thread::sleep_for(20ms);
      moved = moved || house.sent().twist != base::BodyTwist{};
    }
    return moved;
  }
};

TEST_F(StreamApi, HelloComesFirstThenTheWholeStateAtTheWantedRate) {
  until_ready();
  const auto client = connect();
  const Json hello = Json::parse(client->frame()->payload);
  EXPECT_EQ(hello["topic"], "hello");
  EXPECT_EQ(fault("StreamHello", hello), "");
  say(*client, {{"subscribe", {{"vehicle", 20}, {"events", 0}}}});
  const Json first = next(*client, "vehicle");
  EXPECT_EQ(fault("StreamVehicle", first), "");
  const auto begin = std::chrono::steady_clock::now();
  int seq = first["seq"];
  for (int i = 0; i < 10; ++i) EXPECT_EQ(next(*client, "vehicle")["seq"], ++seq);
  EXPECT_GT(std::chrono::steady_clock::now() - begin, 400ms);
}

TEST_F(StreamApi, EventsMissionsAndExecutionAreToldAsTheyHappen) {
  until_ready();
  const auto client = connect();
  say(*client, {{"subscribe", {{"events", 0}, {"missions", 0}, {"execution", 0}, {"vehicle", 1}}}});
  next(*client, "vehicle");  // the subscription is in force
  const std::string id = make_mission();
  const Json made = next(*client, "missions");
  EXPECT_EQ(fault("StreamMissions", made), "");
  EXPECT_EQ(made["data"]["id"], id);
  call("POST", "/execution/load", Json{{"mission_id", id}});
  const Json loaded = next(*client, "execution");
  EXPECT_EQ(fault("StreamExecution", loaded), "");
  EXPECT_EQ(loaded["data"]["state"], "loaded");
  call("POST", "/vehicle/estop");
  Json event;
  do {
    event = next(*client, "events");
    ASSERT_EQ(fault("StreamEvent", event), "");
  } while (event["data"]["kind"] != "estop");
}

TEST_F(StreamApi, TheRobotHearsOfAnOperatorWhoWatchesAndSpeaks) {
  until_ready();
  ASSERT_EQ(call("PUT", "/parameters/robot.safety.link_lost", Json{{"value", "hold"}}).status,
            200u);
  ASSERT_EQ(call("PUT", "/parameters/robot.safety.link_timeout_s", Json{{"value", 1}}).status,
            200u);
  const auto lost = [&] {
    const auto s = house.snapshot();
    return std::any_of(s->safety.begin(), s->safety.end(),
                       [](const auto& c) { return c.id == "link_lost"; });
  };
  until(lost, "nobody has been heard");
  const auto client = connect();
  say(*client, {{"ping", 1}});
  say(*client, {{"subscribe", {{"events", 0}}}});
  next(*client, "pong");
  EXPECT_TRUE(lost()) << "who does not watch the vehicle watches over nothing";
  say(*client, {{"subscribe", {{"vehicle", 10}}}});
  until([&] { return !lost(); }, "the operator is heard");
  until(lost, "an operator who is silent counts as gone");
  until(
      [&] {
        say(*client, {{"ping", 2}});
        return !lost();
      },
      "a ping is enough");
}

TEST_F(StreamApi, AnUnknownTopicIsSaidAndTheConnectionStays) {
  until_ready();
  const auto client = connect();
  say(*client, {{"subscribe", {{"weather", 5}, {"vehicle", 10}}}});
  const Json error = next(*client, "error");
  EXPECT_EQ(fault("StreamError", error), "");
  EXPECT_EQ(error["data"]["errors"][0]["pointer"], "/subscribe/weather");
  EXPECT_FALSE(next(*client, "vehicle").is_null());
}

TEST_F(StreamApi, NonsenseIsAnsweredAndNonsenseWithoutEndIsClosed) {
  const auto client = connect();
  for (const char* text :
       {"hello", "[]", "{}", "{\"subscribe\":5}", "{\"subscribe\":{\"vehicle\":\"fast\"}}",
        "{\"subscribe\":{},\"drive\":{}}", "{\"drive\":{\"speed_mps\":NaN}}",
        "{\"subscribe\":{\"vehicle\":-1}}", "{\"fly\":1}"}) {
    client->send_frame(1, text);
    EXPECT_EQ(fault("StreamError", next(*client, "error")), "") << text;
  }
  client->send_frame(1, "and once more");
  while (const auto frame = client->frame()) {
    if (frame->opcode != 8) continue;
    EXPECT_EQ(frame->close_code(), 1008u);
    return;
  }
  FAIL() << "not closed";
}

TEST_F(StreamApi, DrivingByHandMovesTheBaseAndLettingGoStopsIt) {
  // Given an armed robot in MANUAL,
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).status, 200u);
  auto client = connect();
  const auto hold = [&](double speed_mps, double yaw_rate_dps) {
    let_go(*client);
    until(
        [&] {
          say(*client, drive(speed_mps, yaw_rate_dps, true));
          std::this_thread::sleep_for(20ms);
          return std::abs(house.sent().twist.linear_mps) > 0.1;
        },
        "the base is told to move");
  };
  // when somebody holds the switch, then it moves: left is positive,
  hold(0.4, 20.0);
  EXPECT_GT(house.sent().twist.linear_mps, 0.0);
  EXPECT_GT(house.sent().twist.angular_radps, 0.0);
  EXPECT_EQ(house.snapshot()->control, base::Driver::Teleop);
  // when he lets go, it stops at once;
  say(*client, drive(0.4, 0.0, false));
  const auto stopped = [this] { return house.sent().twist == base::BodyTwist{}; };
  until(stopped, "the base stands");
  // and when his connection breaks, too.
  hold(-0.4, 0.0);
  EXPECT_LT(house.sent().twist.linear_mps, 0.0);
  client.reset();
  until(stopped, "the base stands after the connection broke");
}

TEST_F(StreamApi, WhatHaltsIsCarriedOutOverTheOpenSocketAndAnUnknownWordIsNot) {
  until_ready();
  ASSERT_EQ(call("POST", "/vehicle/arm", Json{{"valid_for_s", 5}}).status, 200u);
  ASSERT_EQ(call("PUT", "/vehicle/mode", Json{{"mode", "MANUAL"}}).status, 200u);
  const auto client = connect();
  for (const Json& wrong : {Json("sleep"), Json(true), Json({{"halt", 1}})}) {
    say(*client, {{"halt", wrong}});
    EXPECT_EQ(next(*client, "error")["data"]["errors"][0]["pointer"], "/halt") << wrong;
  }
  say(*client, {{"halt", "hold"}, {"ping", 1}});
  EXPECT_EQ(fault("StreamError", next(*client, "error")), "");
  EXPECT_EQ(house.snapshot()->mode, base::Mode::Manual);
  say(*client, {{"halt", "hold"}});
  until([this] { return house.snapshot()->mode == base::Mode::Hold; }, "it holds");
  EXPECT_TRUE(house.snapshot()->armed);
  say(*client, {{"halt", "disarm"}});
  until([this] { return !house.snapshot()->armed; }, "it is disarmed");
}

TEST_F(StreamApi, ARunningMissionIsPausedAndStoppedOverTheOpenSocket) {
  ASSERT_NO_FATAL_FAILURE(start_a_mission());
  const auto client = connect();
  const auto is = [this](base::ExecutionState s) { return house.snapshot()->mission.state == s; };
  say(*client, {{"halt", "pause"}});
  until([&] { return is(base::ExecutionState::Paused); }, "it is paused");
  say(*client, {{"halt", "stop"}});
  until([&] { return is(base::ExecutionState::Aborted); }, "it is stopped");
}

TEST_F(StreamApi, AHandOnTheSpeedSlowsAMissionAndStopsItWhenItsConnectionBreaks) {
  // Given a mission that runs,
  ASSERT_NO_FATAL_FAILURE(start_a_mission());
  EXPECT_EQ(call("GET", "/vehicle").body["teleop"]["auto_share"], nullptr);
  auto client = connect();
  const auto hand = [](const Json& share, bool held) {
    return Json{{"throttle", {{"share", share}, {"held", held}}}};
  };
  const auto keep = [&](double share, const std::function<bool()>& claim, const char* what) {
    until(
        [&] {
          say(*client, hand(share, true));
          std::this_thread::sleep_for(20ms);
          return claim();
        },
        what);
  };
  const auto speed = [this] { return std::abs(house.sent().twist.linear_mps); };
  // when a hand asks for less, then it is told so and it is slower;
  keep(
      1.0, [&] { return speed() > 0.25; }, "it drives");
  keep(
      0.2, [&] { return speed() < 0.2 && speed() > 0.05; }, "it is slower");
  const Json told = call("GET", "/vehicle").body;
  EXPECT_EQ(fault("Vehicle", told), "");
  EXPECT_EQ(told["teleop"]["auto_share"], 0.2);
  // let go it stands, held again it drives;
  say(*client, hand(0.0, false));
  until([&] { return speed() == 0.0; }, "it stands");
  keep(
      1.0, [&] { return speed() > 0.1; }, "it drives again");
  // what is not understood is told, and stops it;
  say(*client, hand(1.5, true));
  EXPECT_EQ(next(*client, "error")["data"]["errors"][0]["pointer"], "/throttle/share");
  until([&] { return speed() == 0.0; }, "it stands after a word that is none");
  for (const char* text :
       {R"({"throttle":{"share":"all","held":true}})", R"({"throttle":{"share":NaN,"held":true}})",
        R"({"throttle":{"share":-0.1,"held":true}})", R"({"throttle":{"held":true}})",
        R"({"throttle":{"share":0.5,"held":true},"ping":1})"}) {
    client->send_frame(1, text);
    EXPECT_EQ(fault("StreamError", next(*client, "error")), "") << text;
    say(*client, hand(0.0, false));
  }
  keep(
      1.0, [&] { return speed() > 0.1; }, "it drives after a fresh grip");
  // and when the connection breaks it stops, and says why.
  client.reset();
  until([&] { return speed() == 0.0; }, "it stands after the connection broke");
  const Json after = call("GET", "/vehicle").body;
  EXPECT_EQ(after["teleop"]["auto_share"], 0.0);
  bool said = false;
  for (const Json& c : after["safety"]) said = said || c["id"] == "auto_hand";
  EXPECT_TRUE(said) << after["safety"].dump();
  EXPECT_EQ(after["mission"]["state"], "running");
}

TEST_F(StreamApi, OneDrivesAtATimeAndWhoeverTakesOverMustLetGoFirst) {
  arm_in_manual();
  const auto first = connect();
  const auto second = connect();
  let_go(*first);
  ASSERT_TRUE(push(*first));
  // When the second pushes, too, he hears why nothing comes of it;
  say(*second, drive(-0.4, 0.0, true));
  const Json refused = next(*second, "error");
  EXPECT_EQ(refused["data"]["status"], 409);
  EXPECT_EQ(refused["data"]["detail"], "another client is driving");
  EXPECT_GE(house.sent().twist.linear_mps, 0.0);
  // once the first lets go, his stick is still held, and is not obeyed
  say(*first, drive(0.0, 0.0, false));
  until([this] { return house.sent().twist == base::BodyTwist{}; }, "the base stands");
  EXPECT_FALSE(push(*second));
  EXPECT_EQ(next(*second, "error")["data"]["status"], 409);
  // until he has let go.
  let_go(*second);
  EXPECT_TRUE(push(*second));
}

TEST_F(StreamApi, AStickThatWasHeldBeforeMovesNothingAfterArmingAnotherModeOrANewConnection) {
  until_ready();
  const auto client = connect();
  const auto ask = [this](const char* method, const char* path, const Json& body) {
    EXPECT_EQ(call(method, path, body).status, 200u) << path;
  };
  const Json soon = {{"valid_for_s", 5}};
  // Held while the robot is disarmed and holds: each push tells why it does nothing.
  EXPECT_FALSE(push(*client, 100ms));
  EXPECT_EQ(next(*client, "error")["data"]["detail"], "the sticks do nothing in mode HOLD");
  ask("PUT", "/vehicle/mode", {{"mode", "MANUAL"}});
  EXPECT_FALSE(push(*client, 100ms));
  EXPECT_EQ(next(*client, "error")["data"]["detail"], "the robot is not armed");
  ask("POST", "/vehicle/arm", soon);
  EXPECT_FALSE(push(*client));
  const Json refused = next(*client, "error");
  EXPECT_EQ(refused["data"]["status"], 409);
  EXPECT_NE(refused["data"]["detail"].get<std::string>().find("release the stick"),
            std::string::npos);
  const Json teleop = call("GET", "/vehicle").body["teleop"];
  EXPECT_EQ(teleop["state"], "release");
  EXPECT_EQ(teleop["reason"], refused["data"]["detail"]);
  // Sticks in the middle with the dead-man on, or pushed with it off, are not let go.
  for (const Json& half : {drive(0.0, 0.0, true), drive(0.4, 0.0, false)}) {
    say(*client, half);
    EXPECT_FALSE(push(*client, 100ms)) << half;
  }
  let_go(*client);
  EXPECT_EQ(call("GET", "/vehicle").body["teleop"]["state"], "ready");
  EXPECT_TRUE(push(*client));
  // Another mode and back, an emergency stop and its end, the same stick held all the time.
  ask("PUT", "/vehicle/mode", {{"mode", "HOLD"}});
  EXPECT_FALSE(push(*client, 100ms));
  ask("PUT", "/vehicle/mode", {{"mode", "MANUAL"}});
  EXPECT_FALSE(push(*client));
  ask("POST", "/vehicle/estop", Json::object());
  ask("POST", "/vehicle/estop/reset", soon);
  ask("PUT", "/vehicle/mode", {{"mode", "MANUAL"}});
  ask("POST", "/vehicle/arm", soon);
  EXPECT_FALSE(push(*client));
  // A new connection with a stick that is held, while the old one had let go.
  let_go(*client);
  const auto other = connect();
  EXPECT_FALSE(push(*other));
  let_go(*other);
  EXPECT_TRUE(push(*other));
}

TEST_F(StreamApi, OnlyTheOwnPageMayOpenIt) {
  const std::string own = "Origin: http://127.0.0.1\r\n";
  EXPECT_EQ(Client(house.port()).upgrade("/api/v1/stream", own), 101u);
  EXPECT_EQ(Client(house.port()).upgrade("/api/v1/stream", "Origin: http://evil.example\r\n"),
            403u);
  EXPECT_EQ(Client(house.port()).upgrade("/api/v1/vehicle"), 404u);
  EXPECT_EQ(call("GET", "/stream").status, 426u);
}

TEST_F(StreamApi, ARefusedUpgradeIsAProblemThatNamesTheCause) {
  const auto ask = [this](const std::string& path, const std::string& version,
                          const std::string& key, const std::string& more = "") {
    return raw("GET " + path +
               " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" +
               version + key + more + "\r\n");
  };
  const std::string here = "/api/v1/stream";
  const std::string version = "Sec-WebSocket-Version: 13\r\n";
  const std::string key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const std::vector<std::tuple<Reply, unsigned, const char*>> cases = {
      {ask(here, version, key, "Origin: http://evil.example\r\n"), 403, "evil.example"},
      {ask("/api/v1/vehicle", version, key), 404, "/api/v1/stream"},
      {ask("/%zz", version, key), 404, "/api/v1/stream"},
      {ask(here, "Sec-WebSocket-Version: 8\r\n", key), 426, "version 13"},
      {ask(here, "", key), 426, "version 13"},
      {ask(here, version, ""), 400, "Sec-WebSocket-Key"},
      {ask(here, version, "Sec-WebSocket-Key: short\r\n"), 400, "Sec-WebSocket-Key"},
  };
  for (const auto& [reply, status, named] : cases) {
    EXPECT_EQ(reply.status, status) << named;
    EXPECT_EQ(reply.raw.header("content-type"), "application/problem+json") << named;
    EXPECT_NE(reply.body["detail"].get<std::string>().find(named), std::string::npos) << reply.body;
  }
  EXPECT_EQ(std::get<0>(cases[3]).raw.header("sec-websocket-version"), "13");
}

}  // namespace
}  // namespace roverd::test
