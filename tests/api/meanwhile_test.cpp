// Who asked may have lost the right by the time it is done: what takes long is asked again.

#include <poll.h>

#include "access_house.hpp"

namespace roverd::test {
namespace {

class Meanwhile : public AccessApi {
 protected:
  /// Sends it as that caller, and waits until it was read: keep_busy() before.
  std::unique_ptr<Client> begin(const std::string& line, const std::string& method,
                                const std::string& path, const std::string& body,
                                const std::string& type = "application/json") {
    auto client = std::make_unique<Client>(house.port());
    client->send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + line +
                 "Content-Type: " + type + "\r\nContent-Length: " + std::to_string(body.size()) +
                 "\r\n\r\n" + body);
    // What comes after it finds it read: a large body takes its time on a busy machine.
    until([this] { return house.large_waiting() > begun_; }, "it was read");
    ++begun_;
    return client;
  }
  /// What costs much waits, until go_on().
  void keep_busy() { held_ = house.hold(net::Lane::Large); }
  void go_on() { held_.reset(); }
  /// It was not answered yet.
  static bool waits(const Client& client) {
    pollfd look{client.handle(), POLLIN, 0};
    return ::poll(&look, 1, 0) == 0;
  }
  static Json answer_of(Client& client, unsigned status) {
    const auto answer = client.answer();
    EXPECT_TRUE(answer);
    if (!answer) return {};
    EXPECT_EQ(answer->status, status) << answer->body;
    return answer->body.empty() ? Json() : Json::parse(answer->body);
  }
  static std::string fence(double radius_m) {
    return Json{
        {"name", "field"},
        {"areas",
         {{{"kind", "inclusion"},
           {"circle", {{"lat", kStart.lat}, {"lon", kStart.lon}, {"radius_m", radius_m}}}}}},
        {"rally", Json::array()}}
        .dump();
  }
  void change(const std::string& user, const char* role) {
    EXPECT_EQ(as("admin", "PATCH", "/users/" + user, Json{{"role", role}}.dump()).status, 200u);
  }
  /// A second admin, logged in.
  std::string other_admin() {
    EXPECT_EQ(as("admin", "POST", "/users",
                 R"({"name":"bert","role":"admin","password":"correct horse"})")
                  .status,
              201u);
    const auto in = call("POST", "/session", Json{{"user", "bert"}, {"password", kPassword}});
    EXPECT_EQ(in.status, 200u);
    const std::string cookie = in.raw.header("set-cookie");
    return "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\nOrigin: http://127.0.0.1\r\n";
  }

 private:
  std::shared_ptr<void> held_;
  std::size_t begun_ = 0;
};

TEST_F(Meanwhile, AFenceThatIsMadeActiveMeanwhileIsNotReplacedWithoutControl) {
  until_ready();
  const std::string id = as("operator", "POST", "/fences", fence(100)).body["id"];
  ASSERT_EQ(as("admin", "POST", "/control/take").status, 200u);
  // Given an operator's large change of a fence that acts on nothing,
  keep_busy();
  const auto change = begin(as("operator") + "If-Match: \"rev-1\"\r\n", "PUT", "/fences/" + id,
                            fence(7) + std::string(300'000, ' '));
  // when whoever holds control activates that fence before the change is read,
  ASSERT_EQ(as("admin", "PUT", "/fence", Json{{"fence_id", id}}.dump()).status, 200u);
  ASSERT_TRUE(waits(*change));
  go_on();
  // then the fence in force stays as it was.
  EXPECT_EQ(answer_of(*change, 403)["type"], "/docs#problem-control");
  const Json active = as("viewer", "GET", "/fence").body["fence"];
  EXPECT_EQ(active["revision"], 1);
  EXPECT_EQ(active["areas"][0]["circle"]["radius_m"], 100.0);
  EXPECT_EQ(as("viewer", "GET", "/fences/" + id).body["revision"], 1);
}

TEST_F(Meanwhile, ACommandOfWhomControlWasTakenFromWhileItWaitedIsRefused) {
  until_ready();
  Json items = Json::array();
  for (int i = 0; i < 600; ++i) {
    items.push_back({{"type", "waypoint"}, {"lat", kStart.lat + 1e-5 * i}, {"lon", kStart.lon}});
  }
  const auto made =
      as("operator", "POST", "/missions", Json{{"name", "long"}, {"items", items}}.dump());
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  // Given a load by the holder of control that is checked beside,
  ASSERT_EQ(as("operator", "POST", "/control/take").status, 200u);
  keep_busy();
  const auto load = begin(as("operator"), "POST", "/execution/load",
                          Json{{"mission_id", made.body["id"]}}.dump());
  // when somebody else takes control meanwhile,
  ASSERT_EQ(as("admin", "POST", "/control/take", R"({"force":true,"reason":"a test"})").status,
            200u);
  ASSERT_TRUE(waits(*load));
  go_on();
  // then nothing is loaded.
  EXPECT_EQ(answer_of(*load, 403)["holder"]["user"], "admin");
  EXPECT_EQ(as("viewer", "GET", "/execution").body["state"], "idle");
}

TEST_F(Meanwhile, AnAdminNoMoreMakesNoUserAndSetsNoPassword) {
  const std::string bert = other_admin();
  // Given a new user and a new password whose hashes are to be computed,
  keep_busy();
  const auto make =
      begin(bert, "POST", "/users", R"({"name":"carl","role":"admin","password":"correct horse"})");
  const auto change = begin(bert, "PATCH", "/users/viewer", R"({"password":"tractor blue"})");
  // when the admin who asked is one no more,
  this->change("bert", "operator");
  ASSERT_TRUE(waits(*make) && waits(*change));
  go_on();
  // then neither is done.
  (void)answer_of(*make, 403);
  (void)answer_of(*change, 403);
  EXPECT_EQ(as("admin", "GET", "/users").raw.body.find("carl"), std::string::npos);
  EXPECT_EQ(call("POST", "/session", Json{{"user", "viewer"}, {"password", kPassword}}).status,
            200u);
}

TEST_F(Meanwhile, AnInvitationEndsWithItsInvitersRightAlsoWhileThePinIsHashed) {
  const std::string bert = other_admin();
  const auto invited = call("POST", "/invitations", R"({"user":"operator"})", bert).body["code"];
  ASSERT_TRUE(invited.is_string());
  // Given a phone that was invited and whose PIN is being hashed,
  keep_busy();
  const auto accept = begin("", "POST", "/invitations/accept",
                            Json{{"code", invited}, {"name", "phone"}, {"pin", "2580"}}.dump());
  // when whoever invited it may do so no more,
  change("bert", "viewer");
  ASSERT_TRUE(waits(*accept));
  go_on();
  // then it is not paired.
  (void)answer_of(*accept, 401);
  EXPECT_TRUE(as("operator", "GET", "/devices").body["items"].empty());
}

}  // namespace
}  // namespace roverd::test
