// Who has control: over the API and on the stream, with access control on.

#include <algorithm>
#include <cctype>
#include <set>
#include <thread>

#include "access_house.hpp"
#include "schema.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

const std::string kWithMe = R"({"ask":true})";

class ControlApi : public AccessApi {
 protected:
  explicit ControlApi(base::Duration grace = 60s) : AccessApi(grace) {}

  void take(const std::string& caller) {
    ASSERT_EQ(as(caller, "POST", "/control/take").status, 200u);
  }
  std::string holder() {
    const Json now = as("viewer", "GET", "/control").body["holder"];
    return now.is_null() ? ""
                         : now["user"].get<std::string>() + " " + now["kind"].get<std::string>();
  }
  std::unique_ptr<Client> connect(const std::string& caller) {
    auto client = std::make_unique<Client>(house.port());
    EXPECT_EQ(client->upgrade("/api/v1/stream", as(caller)), 101u);
    return client;
  }
  static Json next(Client& client, const std::string& topic) {
    while (const auto frame = client.frame()) {
      if (frame->opcode != 1) continue;
      Json message = Json::parse(frame->payload);
      if (message["topic"] == topic) return message;
    }
    ADD_FAILURE() << "the stream ended without a message of " << topic;
    return {};
  }
  /// The next change, as "what from -> to".
  std::string change(Client& client) {
    const Json message = next(client, "control");
    EXPECT_EQ(
        schema_fault(document(), document()["components"]["schemas"]["StreamControl"], message),
        "");
    if (!message["data"].contains("change")) return change(client);
    const Json& it = message["data"]["change"];
    const auto name = [](const Json& one) {
      return one.is_null() ? std::string("-") : one["user"].get<std::string>();
    };
    return it["what"].get<std::string>() + " " + name(it["from"]) + " " + name(it["to"]);
  }
  static void say(Client& client, const Json& message) { client.send_frame(1, message.dump()); }
  std::unique_ptr<Client> listener(const std::string& caller) {
    auto client = connect(caller);
    say(*client, {{"subscribe", {{"control", 0}}}});
    (void)next(*client, "control");
    return client;
  }
  std::set<std::string> kinds_of_events() {
    std::set<std::string> out;
    const Json page = as("viewer", "GET", "/events?limit=1000").body;
    for (const Json& event : page["items"]) out.insert(event["kind"].get<std::string>());
    return out;
  }
};

TEST_F(ControlApi, WhoIsConnectedIsToldWithRoleAndKindAndGoesWithTheConnection) {
  const auto here = [this] {
    const auto answer = as("viewer", "GET", "/control");
    EXPECT_EQ(schema_fault(document(), document()["components"]["schemas"]["Control"], answer.body),
              "");
    std::vector<std::string> out;
    for (const Json& one : answer.body["here"]) {
      out.push_back(one["user"].get<std::string>() + " " + one["role"].get<std::string>() + " " +
                    one["kind"].get<std::string>() + " " + one["streams"].dump());
    }
    return out;
  };
  // given: nobody but callers
  EXPECT_TRUE(here().empty());
  // when: one watches on two tabs, and another one comes
  auto first = listener("viewer");
  auto second = listener("viewer");
  auto other = listener("operator");
  // then: each person once
  const auto both = here();
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NE(both[0].find(" operator "), std::string::npos) << both[0];
  EXPECT_NE(both[1].find(" viewer "), std::string::npos) << both[1];
  EXPECT_EQ(both[1].back(), '2');
  // and: gone with the connection, not before
  second.reset();
  const auto counts = [&](const std::string& end) {
    for (int tries = 0; tries < 200; ++tries) {
      if (here().back().ends_with(end)) return true;
      std::this_thread::sleep_for(20ms);
    }
    return false;
  };
  EXPECT_TRUE(counts(" 1"));
  first.reset();
  other.reset();
  for (int tries = 0; tries < 200 && !here().empty(); ++tries) std::this_thread::sleep_for(20ms);
  EXPECT_TRUE(here().empty());
}

TEST_F(ControlApi, TheDocumentAndTheTableSayTheSame) {
  // given: what the document says of each call that changes something
  std::map<std::string, std::string> written;
  for (const auto& [path, methods] : document()["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string name = method;
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      name += " " + path;
      // then: what only reads never needs it, and says nothing; everything else says it
      EXPECT_EQ(operation.contains("x-control"), method != "get") << name;
      written[name] = operation.value("x-control", "not needed");
    }
  }
  // and: it is what the server keeps to
  std::map<std::string, std::string> held;
  for (const auto& [name, need] : house.api().control_needs()) held[name] = need;
  EXPECT_EQ(held, written);
}

TEST_F(ControlApi, WhatStopsOrIsOnlyStoredNeverNeedsItWhatMovesDoes) {
  const auto needs = house.api().control_needs();
  for (const char* stop : {"POST /vehicle/estop", "POST /vehicle/disarm", "POST /execution/pause",
                           "POST /execution/stop", "PUT /missions/{id}", "POST /session"}) {
    EXPECT_EQ(needs.at(stop), "not needed") << stop;
  }
  for (const char* move :
       {"POST /vehicle/arm", "POST /vehicle/goto", "POST /vehicle/move", "POST /execution/start",
        "POST /vehicle/estop/reset", "PUT /fence", "PUT /parameters/{name}"}) {
    EXPECT_EQ(needs.at(move), "needed") << move;
  }
}

TEST_F(ControlApi, WithoutControlNothingMovesAndTheRefusalNamesTheHolder) {
  // given: nobody has it
  const auto nobody = as("operator", "POST", "/vehicle/arm");
  EXPECT_EQ(nobody.status, 403u);
  EXPECT_EQ(nobody.body["type"], "/docs#problem-control");
  EXPECT_EQ(nobody.body["holder"], nullptr);
  // when: another takes it
  take("token of operator");
  EXPECT_EQ(holder(), "admin script");
  // then
  const auto refused = as("operator", "POST", "/vehicle/move", R"({"forward_m":1})");
  EXPECT_EQ(refused.status, 403u);
  EXPECT_EQ(refused.body["holder"]["user"], "admin");
  EXPECT_EQ(refused.body["holder"]["name"], "script");
  EXPECT_EQ(refused.body["holder"]["kind"], "script");
  const auto taken = as("operator", "POST", "/control/take");
  EXPECT_EQ(taken.status, 409u);
  EXPECT_EQ(taken.body["holder"]["name"], "script");
}

TEST_F(ControlApi, AnyoneMayStopWhoeverHasControl) {
  until_ready();
  take("operator");
  ASSERT_EQ(as("operator", "POST", "/vehicle/arm").status, 200u);
  EXPECT_EQ(as("token of operator", "PUT", "/vehicle/mode", R"({"mode":"HOLD"})").status, 200u);
  EXPECT_EQ(as("token of operator", "PUT", "/vehicle/mode", R"({"mode":"MANUAL"})").status, 403u);
  EXPECT_EQ(as("token of operator", "PUT", "/vehicle/mode", R"({"mode":7})").status, 403u);
  EXPECT_EQ(as("token of operator", "POST", "/vehicle/disarm").status, 200u);
  EXPECT_EQ(as("nobody", "POST", "/vehicle/estop").status, 200u);
  EXPECT_EQ(as("token of operator", "POST", "/vehicle/estop/reset").status, 403u);
  EXPECT_EQ(as("operator", "POST", "/vehicle/estop/reset").status, 200u);
}

TEST_F(ControlApi, OnlyTheFenceInForceActsOnTheRobot) {
  // given
  const Json yard{{"name", "yard"},
                  {"areas",
                   {{{"kind", "inclusion"},
                     {"circle", {{"lat", kStart.lat}, {"lon", kStart.lon}, {"radius_m", 100.0}}}}}},
                  {"rally", Json::array()}};
  const std::string fence = yard.dump();
  const auto made = as("operator", "POST", "/fences", fence);
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  const std::string id = made.body["id"];
  // when: it is in force
  take("operator");
  ASSERT_EQ(as("operator", "PUT", "/fence", Json{{"fence_id", id}}.dump()).status, 200u);
  // then: another edits others, not this one
  EXPECT_EQ(as("token of operator", "POST", "/fences", fence).status, 201u);
  const auto refused =
      call("PUT", "/fences/" + id, fence, as("token of operator") + "If-Match: \"rev-1\"\r\n");
  EXPECT_EQ(refused.status, 403u);
  EXPECT_EQ(call("PUT", "/fences/" + id, fence, as("operator") + "If-Match: \"rev-1\"\r\n").status,
            200u);
}

TEST_F(ControlApi, ItIsAskedForAndHandedOver) {
  const auto watching = listener("viewer");
  take("operator");
  // when
  const auto asked = as("token of operator", "POST", "/control/take", kWithMe);
  ASSERT_EQ(asked.status, 202u);
  EXPECT_EQ(asked.body["mine"], false);
  ASSERT_EQ(asked.body["requests"].size(), 1u);
  const Json request = asked.body["requests"][0];
  EXPECT_EQ(request["user"], "admin");
  const std::string yes = Json{{"accept", true}, {"to", request["request"]}}.dump();
  // then: not by whoever likes
  EXPECT_EQ(as("token of operator", "POST", "/control/handover", yes).status, 403u);
  EXPECT_EQ(as("operator", "POST", "/control/handover", R"({"accept":true,"to":99})").status, 404u);
  const auto done = as("operator", "POST", "/control/handover", yes);
  EXPECT_EQ(done.status, 200u);
  EXPECT_EQ(done.body["mine"], false);
  EXPECT_EQ(holder(), "admin script");
  EXPECT_EQ(change(*watching), "taken - operator");
  EXPECT_EQ(change(*watching), "asked operator admin");
  EXPECT_EQ(change(*watching), "handed_over operator admin");
  EXPECT_TRUE(kinds_of_events().contains("control_handed_over"));
}

TEST_F(ControlApi, ARequestIsRefusedOrTakenBack) {
  const auto watching = listener("viewer");
  take("operator");
  auto asked = as("token of operator", "POST", "/control/take", kWithMe);
  const std::string no =
      Json{{"accept", false}, {"to", asked.body["requests"][0]["request"]}}.dump();
  EXPECT_EQ(as("operator", "POST", "/control/handover", no).status, 200u);
  EXPECT_EQ(as("token of operator", "POST", "/control/take", kWithMe).status, 202u);
  EXPECT_EQ(as("token of operator", "POST", "/control/release").status, 200u);
  EXPECT_EQ(as("token of operator", "POST", "/control/release").status, 409u);
  EXPECT_EQ(holder(), "operator browser");
  for (const char* what : {"taken - operator", "asked operator admin", "refused operator admin",
                           "asked operator admin", "withdrawn operator admin"}) {
    EXPECT_EQ(change(*watching), what);
  }
}

TEST_F(ControlApi, ForceNeedsAReasonAndIsTold) {
  const auto watching = listener("viewer");
  take("operator");
  for (const std::string& body :
       {std::string(R"({"force":true})"), std::string(R"({"force":true,"reason":""})"),
        std::string(R"({"force":true,"reason":"  "})"),
        std::string(R"({"force":true,"reason":"a\nb"})"),
        Json{{"force", true}, {"reason", std::string(201, 'x')}}.dump(),
        std::string(R"({"force":true,"ask":true,"reason":"x"})"), std::string(R"({"reason":"x"})"),
        std::string(R"({"force":1})"), std::string(R"({"frce":true})")}) {
    EXPECT_EQ(as("token of operator", "POST", "/control/take", body).status, 422u) << body;
  }
  EXPECT_EQ(holder(), "operator browser");
  EXPECT_EQ(as("viewer", "POST", "/control/take", R"({"force":true,"reason":"x"})").status, 403u);
  const std::string why =
      Json{{"force", true}, {"reason", std::string("ö") + std::string(199, 'x')}}.dump();
  EXPECT_EQ(as("token of operator", "POST", "/control/take", why).status, 200u);
  EXPECT_EQ(holder(), "admin script");
  EXPECT_EQ(change(*watching), "taken - operator");
  EXPECT_EQ(change(*watching), "forced operator admin");
  EXPECT_TRUE(kinds_of_events().contains("control_forced"));
  EXPECT_EQ(as("operator", "POST", "/vehicle/estop/reset").status, 403u);
}

TEST_F(ControlApi, TheStateOfTheVehicleNamesTheHolder) {
  take("operator");
  until([this] { return as("viewer", "GET", "/vehicle").body["holder"].is_object(); }, "a holder");
  EXPECT_EQ(as("viewer", "GET", "/vehicle").body["holder"]["user"], "operator");
  ASSERT_EQ(as("operator", "POST", "/control/release").status, 200u);
  until([this] { return as("viewer", "GET", "/vehicle").body["holder"].is_null(); }, "nobody");
}

TEST_F(ControlApi, EndsAtOnceWithSessionTokenRoleAndUser) {
  // A log-out.
  take("operator");
  EXPECT_EQ(as("operator", "DELETE", "/session").status, 204u);
  EXPECT_EQ(holder(), "");
  // A token that is ended, while another one asks: that one has it.
  take("token of operator");
  ASSERT_EQ(as("admin", "POST", "/control/take", kWithMe).status, 202u);
  const Json tokens = as("admin", "GET", "/tokens").body["items"];
  const auto mine = std::find_if(tokens.begin(), tokens.end(),
                                 [](const Json& t) { return t["role"] == "operator"; });
  ASSERT_NE(mine, tokens.end());
  EXPECT_EQ(as("admin", "DELETE", "/tokens/" + (*mine)["id"].get<std::string>()).status, 204u);
  EXPECT_EQ(holder(), "admin browser");
  ASSERT_EQ(as("admin", "POST", "/control/release").status, 200u);
  // A role that is lowered, and a user who is removed.
  const Json log_in{{"user", "operator"}, {"password", kPassword}};
  for (const bool lowered : {true, false}) {
    const auto in = call("POST", "/session", log_in);
    ASSERT_EQ(in.status, 200u);
    const std::string cookie = in.raw.header("set-cookie");
    const std::string line =
        "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\nOrigin: http://127.0.0.1\r\n";
    ASSERT_EQ(call("POST", "/control/take", "", line).status, 200u);
    EXPECT_EQ(holder(), "operator browser");
    if (lowered) {
      EXPECT_EQ(as("admin", "PATCH", "/users/operator", R"({"role":"viewer"})").status, 200u);
      EXPECT_EQ(holder(), "");
      EXPECT_EQ(as("admin", "PATCH", "/users/operator", R"({"role":"operator"})").status, 200u);
    } else {
      EXPECT_EQ(as("admin", "DELETE", "/users/operator").status, 204u);
      EXPECT_EQ(holder(), "");
    }
  }
  EXPECT_TRUE(kinds_of_events().contains("control_lost"));
}

class ShortGrace : public ControlApi {
 protected:
  ShortGrace() : ControlApi(2s) {}
};

TEST_F(ShortGrace, AScriptThatFallsSilentLosesItAStreamKeepsIt) {
  // given: a stream of the holder
  auto stream = connect("operator");
  (void)next(*stream, "hello");
  take("operator");
  std::this_thread::sleep_for(3s);
  EXPECT_EQ(holder(), "operator browser");
  EXPECT_EQ(as("viewer", "GET", "/control").body["holder"]["grace_left_s"], nullptr);
  // when: it is gone
  stream.reset();
  // then: it is told to all, once the grace is over
  const auto watching = listener("viewer");
  EXPECT_EQ(change(*watching), "lost operator -");
  EXPECT_EQ(holder(), "");
  // A script has no stream, and is heard as long as it calls.
  take("token of operator");
  const Json left = as("viewer", "GET", "/control").body["holder"]["grace_left_s"];
  EXPECT_GT(left.get<double>(), 0.0);
  EXPECT_LE(left.get<double>(), 2.0);
  EXPECT_EQ(change(*watching), "taken - admin");
  EXPECT_EQ(change(*watching), "lost admin -");
  EXPECT_TRUE(kinds_of_events().contains("control_lost"));
}

class ControlSticks : public ControlApi {
 protected:
  static Json drive(double speed_mps, bool deadman) {
    return {{"drive", {{"speed_mps", speed_mps}, {"yaw_rate_dps", 0.0}, {"deadman", deadman}}}};
  }
  bool moves() { return house.sent().twist != base::BodyTwist{}; }
  /// Says it again and again until `claim` holds.
  void keep_saying(Client& client, const Json& message, const std::function<bool()>& claim,
                   const char* what) {
    until(
        [&] {
          say(client, message);
          std::this_thread::sleep_for(20ms);
          return claim();
        },
        what);
  }
  void arm_in_manual(const std::string& caller) {
    until_ready();
    ASSERT_EQ(as(caller, "POST", "/vehicle/arm", R"({"valid_for_s":5})").status, 200u);
    ASSERT_EQ(as(caller, "PUT", "/vehicle/mode", R"({"mode":"MANUAL"})").status, 200u);
  }
  bool ready() { return house.snapshot()->teleop.phase == base::TeleopPhase::Ready; }
};

TEST_F(ControlSticks, OnlyTheHoldersStickIsHeardAndForceDropsItAtOnce) {
  // given: anna drives, ben holds his stick all the time
  const auto anna = connect("operator");
  const auto ben = connect("token of operator");
  take("operator");
  arm_in_manual("operator");
  keep_saying(
      *anna, drive(0, false), [this] { return ready(); }, "anna let go");
  say(*ben, drive(0, false));
  say(*ben, drive(0.4, true));
  const Json error = next(*ben, "error");
  EXPECT_EQ(error["data"]["type"], "/docs#problem-control");
  EXPECT_EQ(error["data"]["holder"]["user"], "operator");
  keep_saying(
      *anna, drive(0.4, true), [this] { return moves(); }, "anna drives");
  // when: ben takes control by force
  ASSERT_EQ(as("token of operator", "POST", "/control/take",
               R"({"force":true,"reason":"the dog is out"})")
                .status,
            200u);
  // then: anna's stick is dropped, for no silence of hers, and although she holds it and says so
  until([this] { return house.snapshot()->teleop.phase == base::TeleopPhase::Release; }, "locked");
  EXPECT_NE(house.snapshot()->teleop.reason.find("whoever drove has left"), std::string::npos)
      << house.snapshot()->teleop.reason;
  keep_saying(
      *anna, drive(0.4, true), [this] { return !moves(); }, "the robot stands");
  // and: ben's acts only after it was let go
  for (int i = 0; i < 15; ++i) {
    say(*ben, drive(0.4, true));
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(moves());
  }
  keep_saying(
      *ben, drive(0, false), [this] { return ready(); }, "ben let go");
  keep_saying(
      *ben, drive(0.4, true), [this] { return moves(); }, "ben drives");
}

TEST_F(ControlSticks, OnlyTheHoldersHandSlowsTheRobotAndItIsLostWithControl) {
  const auto anna = connect("operator");
  const auto ben = connect("token of operator");
  take("operator");
  const Json held = {{"throttle", {{"share", 0.5}, {"held", true}}}};
  const auto share = [this] { return house.snapshot()->teleop.auto_share; };
  // Who does not hold control is told so, and nothing is slower.
  say(*ben, held);
  EXPECT_EQ(next(*ben, "error")["data"]["type"], "/docs#problem-control");
  EXPECT_FALSE(share());
  keep_saying(
      *anna, held, [&] { return share() == 0.5; }, "anna's hand is there");
  ASSERT_EQ(as("token of operator", "POST", "/control/take",
               R"({"force":true,"reason":"the dog is out"})")
                .status,
            200u);
  until([&] { return share() == 0.0; }, "her hand is lost");
}

TEST_F(ControlSticks, GivingUpControlEndsTheStickAndAStickHeldMeanwhileDoesNotActWithControl) {
  const auto anna = connect("operator");
  take("operator");
  arm_in_manual("operator");
  keep_saying(
      *anna, drive(0, false), [this] { return ready(); }, "anna let go");
  keep_saying(
      *anna, drive(0.4, true), [this] { return moves(); }, "anna drives");
  ASSERT_EQ(as("operator", "POST", "/control/release").status, 200u);
  keep_saying(
      *anna, drive(0.4, true), [this] { return !moves(); }, "the robot stands");
  // What was let go without control does not count.
  for (int i = 0; i < 5; ++i) say(*anna, drive(0, false));
  say(*anna, {{"ping", 1}});
  (void)next(*anna, "pong");
  take("operator");
  for (int i = 0; i < 15; ++i) {
    say(*anna, drive(0.4, true));
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(moves());
  }
}

class WithoutAccess : public HouseTest {};

TEST_F(WithoutAccess, NobodyIsAskedForControlAndTakingItDoesNoHarm) {
  until_ready();
  const auto state = call("GET", "/control");
  EXPECT_EQ(state.body["on"], false);
  EXPECT_EQ(state.body["mine"], true);
  EXPECT_EQ(state.body["holder"], nullptr);
  EXPECT_EQ(call("POST", "/control/take").status, 200u);
  EXPECT_EQ(call("POST", "/control/release").status, 200u);
  EXPECT_EQ(call("POST", "/control/handover", R"({"accept":true,"to":1})").status, 404u);
  EXPECT_EQ(call("POST", "/vehicle/arm").status, 200u);
}

}  // namespace
}  // namespace roverd::test
