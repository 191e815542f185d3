// A PIN instead of the password, the invitation of another phone, and one's own account.

#include <algorithm>
#include <regex>

#include "access_house.hpp"

namespace roverd::test {
namespace {

constexpr const char* kPin = "2580";
const std::string kOrigin = "Origin: http://127.0.0.1\r\n";

class PairingApi : public AccessApi {
 protected:
  /// Of our cookies in an answer: "name=value".
  static std::string cookie_of(const Reply& reply, const std::string& name) {
    const std::string all = reply.raw.header("set-cookie");
    const std::size_t at = all.find(name + "=");
    return at == std::string::npos ? "" : all.substr(at, all.find(';', at) - at);
  }
  /// The cookie of a device of that caller.
  std::string pair(const std::string& caller) {
    const auto made = as(caller, "POST", "/devices", Json{{"name", "glove"}, {"pin", kPin}}.dump());
    EXPECT_EQ(made.status, 201u) << made.raw.body;
    return cookie_of(made, "roverd_device");
  }
  Reply enter(const std::string& device, const std::string& pin) {
    return call("POST", "/session", Json{{"pin", pin}}, "Cookie: " + device + "\r\n" + kOrigin);
  }
  Reply with(const std::string& cookies, const std::string& method, const std::string& path,
             const Json& body = {}) {
    return call(method, path, body.is_null() ? "" : body.dump(),
                "Cookie: " + cookies + "\r\n" + kOrigin);
  }
  /// Until there is nothing to wait for.
  Reply patiently(const std::function<Reply()>& ask) {
    Reply reply;
    until(
        [&] {
          reply = ask();
          return reply.status != 429;
        },
        "the wait is over");
    return reply;
  }
};

TEST_F(PairingApi, APairedDeviceOpensWithItsPinOnly) {
  const auto made =
      as("operator", "POST", "/devices", R"({"name":"glove","pin":"2580","role":"admin"})");
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  EXPECT_EQ(made.body["role"], "operator");  // at most the caller's
  EXPECT_NE(
      made.raw.header("set-cookie").find("; Path=/; HttpOnly; SameSite=Strict; Max-Age=31536000"),
      std::string::npos)
      << made.raw.header("set-cookie");
  const std::string device = cookie_of(made, "roverd_device");
  EXPECT_EQ(with(device, "GET", "/vehicle").status, 401u);
  const auto state = with(device, "GET", "/session").body;
  EXPECT_EQ(state["user"], nullptr);
  EXPECT_EQ(state["paired"]["user"], "operator");
  EXPECT_EQ(state["paired"]["name"], "glove");
  EXPECT_EQ(state["paired"]["locked"], false);
  EXPECT_EQ(call("GET", "/session").body["paired"], nullptr);

  const auto wrong = enter(device, "8520");
  EXPECT_EQ(wrong.status, 401u);
  EXPECT_EQ(wrong.body["detail"], "the PIN is wrong; it may be tried 4 more times");
  const auto in = enter(device, kPin);
  ASSERT_EQ(in.status, 200u) << in.raw.body;
  EXPECT_EQ(in.body["user"], "operator");
  EXPECT_EQ(in.body["role"], "operator");
  EXPECT_EQ(cookie_of(in, "roverd_device"), device);  // for another year
  const std::string session = cookie_of(in, "roverd_session");
  EXPECT_EQ(with(session, "POST", "/vehicle/disarm").status, 200u);
  const auto list = with(session + "; " + device, "GET", "/devices");
  ASSERT_EQ(list.body["items"].size(), 1u);
  EXPECT_EQ(list.body["items"][0]["current"], true);
  EXPECT_FALSE(list.body["items"][0]["used"].is_null());
  EXPECT_EQ(list.raw.body.find(device.substr(device.find('=') + 1)), std::string::npos);
  EXPECT_EQ(list.raw.body.find("argon2"), std::string::npos);

  // Others have no say in it; with the pairing goes its session.
  const std::string id = made.body["id"];
  EXPECT_EQ(as("viewer", "DELETE", "/devices/" + id).status, 404u);
  EXPECT_EQ(as("operator", "DELETE", "/devices/" + id).status, 204u);
  EXPECT_EQ(with(session, "GET", "/vehicle").status, 401u);
  EXPECT_EQ(enter(device, kPin).status, 401u);
}

TEST_F(PairingApi, FivePinsLockTheDeviceUntilThePassword) {
  const std::string device = pair("operator");
  for (int i = 0; i < 5; ++i) {
    const auto wrong = patiently([&] { return enter(device, "8520"); });
    EXPECT_EQ(wrong.status, 401u);
    EXPECT_EQ(wrong.raw.body.find("is locked now") != std::string::npos, i == 4);
  }
  const auto right = patiently([&] { return enter(device, kPin); });
  EXPECT_EQ(right.status, 401u);
  EXPECT_NE(right.raw.body.find("is locked after too many"), std::string::npos) << right.raw.body;
  EXPECT_EQ(with(device, "GET", "/session").body["paired"]["locked"], true);
  const auto in = patiently([&] {
    return with(device, "POST", "/session", {{"user", "operator"}, {"password", kPassword}});
  });
  ASSERT_EQ(in.status, 200u) << in.raw.body;
  EXPECT_EQ(enter(device, kPin).status, 200u);
  // The tries are written down with the user and the device, and never the PIN.
  const Json audit = as("admin", "GET", "/audit?limit=100&call=/session").body["items"];
  const auto by_pin = std::find_if(audit.begin(), audit.end(), [](const Json& row) {
    return row["status"] == 200 && !row["credential"].is_null();
  });
  ASSERT_NE(by_pin, audit.end()) << audit.dump(1);
  EXPECT_EQ((*by_pin)["user"], "operator");
  EXPECT_EQ((*by_pin)["credential"].get<std::string>().substr(0, 7), "device ");
  // As a word: four digits stand in some hash or other by chance.
  EXPECT_FALSE(std::regex_search(audit.dump(), std::regex("\\b(2580|8520)\\b"))) << audit.dump(1);
}

TEST_F(PairingApi, APinNeedsAPairedDeviceAndABrowser) {
  EXPECT_EQ(call("POST", "/session", Json{{"pin", kPin}}).status, 401u);
  EXPECT_EQ(enter("roverd_device=forged", kPin).status, 401u);
  EXPECT_EQ(enter("roverd_device=" + std::string(5000, 'x'), kPin).status, 401u);
  const std::string device = pair("operator");
  EXPECT_EQ(call("POST", "/session", Json{{"pin", kPin}}, "Cookie: " + device + "\r\n").status,
            403u);
  for (const char* slip : {"", "258", "258025802"}) EXPECT_EQ(enter(device, slip).status, 422u);
  EXPECT_EQ(with(device, "GET", "/session").body["paired"]["locked"], false);
  EXPECT_EQ(enter(device, kPin).status, 200u);
  EXPECT_EQ(with(device, "POST", "/session", {{"pin", 2580}}).status, 422u);
}

TEST_F(PairingApi, WhoMayPairAndWithWhichPin) {
  const std::string good = R"({"name":"glove","pin":"2580"})";
  EXPECT_EQ(as("viewer", "POST", "/devices", good).status, 403u);
  EXPECT_EQ(as("token of admin", "POST", "/devices", good).status, 409u);
  EXPECT_EQ(as("token of admin", "POST", "/invitations", "{}").status, 409u);
  const auto weak = as("admin", "POST", "/devices", R"({"name":"","pin":"1234","role":"king"})");
  EXPECT_EQ(weak.status, 422u);
  EXPECT_EQ(weak.body["errors"].size(), 3u) << weak.raw.body;
  EXPECT_EQ(weak.raw.body.find("\"1234\""), std::string::npos);
  const auto unnamed = as("admin", "POST", "/devices", R"({"name":"  ","pin":"2580"})");
  EXPECT_EQ(unnamed.status, 422u);
  EXPECT_EQ(unnamed.body["errors"][0]["pointer"], "/name") << unnamed.raw.body;
}

TEST_F(PairingApi, AnotherPhoneIsInvitedOnceAndForWhatTheInviterChose) {
  const auto invited = as("admin", "POST", "/invitations", R"({"role":"operator"})");
  ASSERT_EQ(invited.status, 201u) << invited.raw.body;
  EXPECT_EQ(invited.body["user"], "admin");
  EXPECT_EQ(invited.body["expires_in_s"], 600.0);
  const Json answer = {{"code", invited.body["code"]}, {"name", "new phone"}, {"pin", kPin}};
  Json weak = answer;
  weak["pin"] = "0000";
  EXPECT_EQ(call("POST", "/invitations/accept", weak).status, 422u);  // and may be tried again
  const auto in = call("POST", "/invitations/accept", answer);
  ASSERT_EQ(in.status, 200u) << in.raw.body;
  EXPECT_EQ(in.body["user"], "admin");
  EXPECT_EQ(in.body["role"], "operator");
  const std::string session = cookie_of(in, "roverd_session");
  EXPECT_EQ(with(session, "GET", "/users").status, 403u);
  EXPECT_EQ(with(session, "POST", "/vehicle/disarm").status, 200u);
  EXPECT_EQ(enter(cookie_of(in, "roverd_device"), kPin).status, 200u);
  EXPECT_EQ(call("POST", "/invitations/accept", answer).status, 401u);
  // It makes nobody more than the phone is.
  const auto more = with(session, "POST", "/invitations", {{"role", "admin"}});
  EXPECT_EQ(more.body["role"], "operator");
}

TEST_F(PairingApi, OnlyAnAdminInvitesForOthers) {
  EXPECT_EQ(as("operator", "POST", "/invitations", R"({"user":"admin"})").status, 403u);
  EXPECT_EQ(as("admin", "POST", "/invitations", R"({"user":"nobody"})").status, 404u);
  const auto invited = as("admin", "POST", "/invitations", R"({"user":"viewer"})");
  ASSERT_EQ(invited.status, 201u);
  const auto in = call("POST", "/invitations/accept",
                       Json{{"code", invited.body["code"]}, {"name", "tab"}, {"pin", kPin}});
  ASSERT_EQ(in.status, 200u);
  EXPECT_EQ(in.body["user"], "viewer");
  EXPECT_EQ(in.body["role"], "viewer");
}

TEST_F(PairingApi, ANewPasswordWantsTheOldOneAndEndsTheRest) {
  const std::string lost = pair("operator");
  const auto in = call("POST", "/session", Json{{"user", "operator"}, {"password", kPassword}});
  const std::string here = cookie_of(in, "roverd_session");
  const auto change = [&](const std::string& old, const std::string& next) {
    return with(here, "POST", "/session/password", {{"password", old}, {"new_password", next}});
  };
  EXPECT_EQ(change("wrong horse", "tractor blue").status, 403u);
  EXPECT_EQ(change(kPassword, "short").status, 422u);
  EXPECT_EQ(as("token of operator", "POST", "/session/password",
               R"({"password":"correct horse","new_password":"tractor blue"})")
                .status,
            409u);
  EXPECT_EQ(change(kPassword, "tractor blue").status, 204u);
  EXPECT_EQ(with(here, "GET", "/vehicle").status, 200u);
  EXPECT_EQ(as("operator", "GET", "/vehicle").status, 401u);
  EXPECT_EQ(enter(lost, kPin).status, 401u);
  EXPECT_EQ(call("POST", "/session", Json{{"user", "operator"}, {"password", kPassword}}).status,
            401u);
  EXPECT_EQ(
      call("POST", "/session", Json{{"user", "operator"}, {"password", "tractor blue"}}).status,
      200u);
}

TEST_F(PairingApi, AllOtherSessionsEndAtOnce) {
  const std::string device = pair("operator");
  const std::string by_pin = cookie_of(enter(device, kPin), "roverd_session");
  EXPECT_EQ(as("operator", "GET", "/sessions").body["items"].size(), 2u);
  EXPECT_EQ(as("operator", "DELETE", "/sessions").status, 204u);
  EXPECT_EQ(as("operator", "GET", "/sessions").body["items"].size(), 1u);
  EXPECT_EQ(with(by_pin, "GET", "/vehicle").status, 401u);
  EXPECT_EQ(as("viewer", "GET", "/vehicle").status, 200u);
  EXPECT_EQ(enter(device, kPin).status, 200u);
}

class NoPairing : public HouseTest {};

TEST_F(NoPairing, WithoutAccessControlThereIsNothingToPair) {
  EXPECT_EQ(call("GET", "/session").body["paired"], nullptr);
  EXPECT_TRUE(call("GET", "/devices").body["items"].empty());
  EXPECT_EQ(call("POST", "/devices", R"({"name":"a","pin":"2580"})").status, 409u);
  EXPECT_EQ(call("DELETE", "/devices/1").status, 404u);
  EXPECT_EQ(call("DELETE", "/sessions").status, 409u);
  EXPECT_EQ(call("POST", "/invitations", "{}").status, 409u);
  EXPECT_EQ(call("POST", "/invitations/accept", "{}").status, 409u);
  EXPECT_EQ(call("POST", "/session/password", "{}").status, 409u);
}

}  // namespace
}  // namespace roverd::test
