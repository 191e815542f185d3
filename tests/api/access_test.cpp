// Who may call what, with access control on.

#include <algorithm>
#include <cctype>
#include <set>

#include "access_house.hpp"
#include "people/secret.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
using people::Role;

/// "/tiles/{set}/{z}/{x}/{y}" with something in each.
std::string filled(std::string path) {
  for (std::size_t at = path.find('{'); at != std::string::npos; at = path.find('{')) {
    path.replace(at, path.find('}') - at + 1, "1");
  }
  return path;
}

/// 401: not known; 403: role too low; 0: anything else, so also who does not hold control.
int verdict(unsigned status, const std::string& body) {
  const bool control = body.find("/docs#problem-control") != std::string::npos;
  return !control && (status == 401 || status == 403) ? static_cast<int>(status) : 0;
}

int expected(const std::string& need, int rank) {
  if (need == "anyone") return 0;
  if (rank < 0) return 401;
  const int needed = need == "viewer" ? 0 : need == "operator" ? 1 : 2;
  return rank >= needed ? 0 : 403;
}

TEST_F(AccessApi, EveryOperationIsOpenToWhomTheDocumentSaysAndToNobodyElse) {
  int tried = 0;
  int wrong = 0;
  std::set<std::string> needs;
  const auto try_one = [&](const std::string& method, const std::string& path,
                           const std::string& need) {
    for (const auto& [caller, line] : *callers_) {
      std::string request = method + " /api/v1" + filled(path) + " HTTP/1.1\r\nHost: 127.0.0.1\r\n";
      request += line;
      if (method != "GET") request += "Content-Type: application/json\r\nContent-Length: 2\r\n";
      const auto reply = raw(request + "\r\n" + (method != "GET" ? "{}" : ""));
      ++tried;
      // A session is asked for a log-in; a log-in that is refused would be 401, too.
      if (verdict(reply.status, reply.raw.body) == expected(need, rank(caller))) continue;
      ++wrong;
      ADD_FAILURE() << caller << ": " << method << " " << path << " needs " << need << ", was "
                    << reply.status << " " << reply.raw.body;
    }
  };
  for (const auto& [path, methods] : document()["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string name = method;
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      needs.insert(operation["x-role"].get<std::string>());
      if (name + path != "DELETE/session") try_one(name, path, operation["x-role"]);
    }
  }
  try_one("DELETE", "/session", "viewer");  // the last: afterwards they are logged out
  EXPECT_EQ(needs, (std::set<std::string>{"anyone", "viewer", "operator", "admin"}));
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(tried, 1000);
  std::printf("role matrix: %d calls tried, %d wrong answers\n", tried, wrong);
}

TEST_F(AccessApi, TheDocumentAndTheTableSayTheSame) {
  std::map<std::string, std::string> written;
  for (const auto& [path, methods] : document()["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string name = method;
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      written[name + " " + path] = operation["x-role"];
      const bool open = operation["x-role"] == "anyone";
      EXPECT_EQ(operation.contains("security"), open) << name << " " << path;
    }
  }
  std::map<std::string, std::string> held;
  for (const auto& [name, need] : house.api().needs()) held[name] = need;
  EXPECT_EQ(held, written);
}

TEST_F(AccessApi, AnyoneMayStopAndItIsToldWhoDid) {
  const auto stopped_by = [this](const std::string& words) {
    until(
        [&] {
          const Json items = as("viewer", "GET", "/events").body["items"];
          return std::ranges::any_of(
              items, [&](const Json& e) { return e["kind"] == "estop" && e["detail"] == words; });
        },
        words.c_str());
  };
  EXPECT_EQ(as("nobody", "POST", "/vehicle/estop").status, 200u);
  stopped_by("emergency stop by the page or a script");
  EXPECT_EQ(as("viewer", "GET", "/vehicle").body["estop"], true);
  EXPECT_EQ(as("nobody", "POST", "/vehicle/estop/reset").status, 401u);
  EXPECT_EQ(as("viewer", "POST", "/vehicle/estop/reset").status, 403u);
  EXPECT_EQ(as("operator", "POST", "/control/take").status, 200u);
  EXPECT_EQ(as("operator", "POST", "/vehicle/estop/reset").status, 200u);
  EXPECT_EQ(as("viewer", "POST", "/vehicle/estop").status, 200u);
  stopped_by("emergency stop by viewer");
}

TEST_F(AccessApi, LogInGivesACookieThatLogOutEnds) {
  const auto in = call("POST", "/session", Json{{"user", "operator"}, {"password", kPassword}});
  ASSERT_EQ(in.status, 200u) << in.raw.body;
  EXPECT_EQ(in.body["user"], "operator");
  EXPECT_EQ(in.body["role"], "operator");
  const std::string cookie = in.raw.header("set-cookie");
  EXPECT_NE(cookie.find("; Path=/; HttpOnly; SameSite=Strict; Max-Age=604800"), std::string::npos)
      << cookie;
  EXPECT_EQ(cookie.find("Secure"), std::string::npos);  // no TLS here
  const std::string line =
      "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\nOrigin: http://127.0.0.1\r\n";
  EXPECT_EQ(call("GET", "/session", "", line).body["user"], "operator");
  const auto list = call("GET", "/sessions", "", line);
  ASSERT_EQ(list.body["items"].size(), 2u);
  EXPECT_EQ(list.body["items"][1]["current"], true);
  EXPECT_EQ(list.body["items"][1]["address"], "127.0.0.1");
  const auto out = call("DELETE", "/session", "", line);
  EXPECT_EQ(out.status, 204u);
  EXPECT_NE(out.raw.header("set-cookie").find("roverd_session=; "), std::string::npos);
  EXPECT_EQ(call("GET", "/vehicle", "", line).status, 401u);
  EXPECT_EQ(as("operator", "GET", "/vehicle").status, 200u);  // the other device
}

TEST_F(AccessApi, WrongPasswordsAndNamesSoundAlikeAndSoonMustWait) {
  const auto wrong = call("POST", "/session", Json{{"user", "admin"}, {"password", "wrong horse"}});
  EXPECT_EQ(wrong.status, 401u);
  EXPECT_EQ(wrong.body["detail"], "user or password is wrong");
  const auto nobody = call("POST", "/session", Json{{"user", "nil"}, {"password", "wrong horse"}});
  EXPECT_EQ(nobody.status, 401u);
  EXPECT_EQ(nobody.body["detail"], wrong.body["detail"]);
  // Each makes the wait longer, so that it is met however slowly they are answered.
  auto later = wrong;
  for (int i = 0; i < 20 && later.status == 401; ++i) {
    later = call("POST", "/session", Json{{"user", "admin"}, {"password", "wrong horse"}});
  }
  ASSERT_EQ(later.status, 429u);
  EXPECT_GE(std::stoi(later.raw.header("retry-after")), 1);
}

TEST_F(AccessApi, GuessingManyAtOnceIsRefusedNotQueued) {
  std::vector<std::unique_ptr<Client>> guessers;
  const std::string body = R"({"user":"admin","password":"wrong horse"})";
  for (int i = 0; i < 30; ++i) {
    guessers.push_back(std::make_unique<Client>(house.port()));
    guessers.back()->send(
        "POST /api/v1/session HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        "Content-Length: " +
        std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  // Others are served meanwhile.
  EXPECT_EQ(as("nobody", "POST", "/vehicle/estop").status, 200u);
  EXPECT_EQ(as("viewer", "GET", "/missions").status, 200u);
  std::map<unsigned, int> statuses;
  for (const auto& guesser : guessers) {
    if (const auto answer = guesser->answer()) ++statuses[answer->status];
  }
  EXPECT_LE(statuses[401], 4);
  EXPECT_EQ(statuses[401] + statuses[429], 30);
}

TEST_F(AccessApi, ACookieChangesNothingForAForeignPage) {
  const std::string& line = as("admin");
  const std::string bare = line.substr(0, line.find("Origin"));
  EXPECT_EQ(call("GET", "/vehicle", "", bare).status, 200u);
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", bare).status, 403u);
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", bare + "Origin: http://evil.example\r\n").status,
            403u);
  EXPECT_EQ(call("POST", "/missions", "{}", line + "Content-Type: text/plain\r\n").status, 415u);
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", line).status, 200u);
  // A token is no cookie: no browser sends it by itself.
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", as("token of operator")).status, 200u);
}

TEST_F(AccessApi, UglyHeadersAreNobody) {
  for (const std::string& line :
       {std::string("Cookie: roverd_session\r\n"), std::string("Cookie: roverd_session=\r\n"),
        "Cookie: roverd_session=" + std::string(9000, 'x') + "\r\n",
        std::string("Cookie: ;;;=;\r\n"), std::string("Cookie: xroverd_session=1\r\n"),
        std::string("Authorization: Bearer \r\n"), std::string("Authorization: Basic YTpi\r\n"),
        std::string("Authorization: bearer\r\n"),
        "Authorization: Bearer " + std::string(9000, 'x') + "\r\n"}) {
    EXPECT_EQ(call("GET", "/vehicle", "", line).status, 401u) << line.substr(0, 60);
  }
  // Two tokens are none, and a wrong token does not fall back to the cookie.
  EXPECT_EQ(call("GET", "/vehicle", "", as("token of admin") + as("token of admin")).status, 401u);
  EXPECT_EQ(call("GET", "/vehicle", "", as("forged token") + as("admin")).status, 401u);
}

TEST_F(AccessApi, WhoMayNotSendALargeBodyIsNotHeardOut) {
  const auto big = [this](const std::string& caller) {
    return raw("POST /api/v1/missions/import HTTP/1.1\r\nHost: 127.0.0.1\r\n" + as(caller) +
               "Content-Length: 1000000\r\n\r\n")
        .status;
  };
  EXPECT_EQ(big("nobody"), 413u);
  EXPECT_EQ(big("viewer"), 413u);
}

TEST_F(AccessApi, ATokenIsShownOnceDoesWhatItIsForAndEnds) {
  const auto made =
      as("admin", "POST", "/tokens",
         R"({"name":"logger","role":"viewer","methods":["GET"],"expires":"2190-01-01T00:00:00Z"})");
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  const std::string secret = made.body["token"];
  const std::string line = as_token(secret);
  EXPECT_EQ(call("GET", "/vehicle", "", line).status, 200u);
  EXPECT_EQ(call("POST", "/vehicle/arm", "", line).status, 403u);
  const auto list = as("admin", "GET", "/tokens");
  EXPECT_EQ(list.raw.body.find(secret), std::string::npos);
  EXPECT_EQ(list.body["items"].back()["name"], "logger");
  EXPECT_EQ(as("admin", "DELETE", "/tokens/" + made.body["id"].get<std::string>()).status, 204u);
  EXPECT_EQ(call("GET", "/vehicle", "", line).status, 401u);
  // A token cannot make one that lives longer.
  EXPECT_EQ(as("token of admin", "POST", "/tokens", R"({"name":"x","role":"admin"})").status, 409u);
  EXPECT_EQ(as("admin", "POST", "/tokens",
               R"({"name":"x","role":"king","methods":["BREW"],)"
               R"("expires":"yesterday"})")
                .body["errors"]
                .size(),
            3u);
  for (const char* name : {"", " ", "   "}) {
    const auto unnamed =
        as("admin", "POST", "/tokens", Json{{"name", name}, {"role", "viewer"}}.dump());
    EXPECT_EQ(unnamed.status, 422u);
    EXPECT_EQ(unnamed.body["errors"][0]["pointer"], "/name") << unnamed.raw.body;
  }
  EXPECT_EQ(as("admin", "POST", "/tokens",
               R"({"name":"x","role":"viewer","expires":"2001-01-01T00:00:00Z"})")
                .status,
            422u);
}

TEST_F(AccessApi, UsersAreMadeChangedAndRemoved) {
  const std::string carl = R"({"name":"carl","role":"viewer","password":"tractor blue"})";
  EXPECT_EQ(as("admin", "POST", "/users", carl).status, 201u);
  EXPECT_EQ(as("admin", "POST", "/users", carl).status, 409u);
  const auto in = call("POST", "/session", Json{{"user", "carl"}, {"password", "tractor blue"}});
  ASSERT_EQ(in.status, 200u);
  const std::string cookie = in.raw.header("set-cookie");
  const std::string line =
      "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\nOrigin: http://127.0.0.1\r\n";
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", line).status, 403u);
  EXPECT_EQ(as("admin", "PATCH", "/users/carl", R"({"role":"operator"})").status, 200u);
  EXPECT_EQ(call("POST", "/vehicle/disarm", "", line).status, 200u);  // at once
  EXPECT_EQ(as("admin", "PATCH", "/users/carl", R"({"password":"tractor crimson"})").status, 200u);
  EXPECT_EQ(call("GET", "/vehicle", "", line).status, 401u);
  EXPECT_EQ(as("admin", "DELETE", "/users/carl").status, 204u);
  EXPECT_EQ(as("admin", "DELETE", "/users/carl").status, 404u);
  EXPECT_EQ(as("admin", "DELETE", "/users/admin").status, 409u);
  EXPECT_EQ(as("admin", "PATCH", "/users/admin", R"({"role":"viewer"})").status, 409u);
  const auto weak =
      as("admin", "POST", "/users", R"({"name":"a b","role":"boss","password":"short"})");
  EXPECT_EQ(weak.status, 422u);
  EXPECT_EQ(weak.body["errors"].size(), 3u);
  EXPECT_EQ(weak.raw.body.find("\"short\""), std::string::npos);
  for (const char* name : {"", " "}) {
    const auto unnamed =
        as("admin", "POST", "/users",
           Json{{"name", name}, {"role", "viewer"}, {"password", kPassword}}.dump());
    EXPECT_EQ(unnamed.status, 422u);
    EXPECT_EQ(unnamed.body["errors"][0]["pointer"], "/name") << unnamed.raw.body;
  }
}

TEST_F(AccessApi, ARepeatedKeyOfSomebodyElseIsAnotherRequest) {
  const std::string body = R"({"name":"twice","role":"viewer"})";
  const std::string key = "Idempotency-Key: k\r\n";
  const auto first = call("POST", "/tokens", body, as("admin") + key);
  const auto again = call("POST", "/tokens", body, as("admin") + key);
  ASSERT_EQ(first.status, 201u);
  EXPECT_EQ(again.body["token"], first.body["token"]);
  EXPECT_EQ(call("POST", "/tokens", body, key).status, 401u);
  EXPECT_EQ(call("POST", "/tokens", body, as("viewer") + key).status, 403u);
}

TEST_F(AccessApi, TheStreamNeedsALogInAndEndsWithIt) {
  Client nobody(house.port());
  EXPECT_EQ(nobody.upgrade("/api/v1/stream"), 401u);
  Client foreign(house.port());
  const std::string& line = as("operator");
  EXPECT_EQ(foreign.upgrade("/api/v1/stream", line.substr(0, line.find("Origin"))), 403u);
  Client client(house.port());
  ASSERT_EQ(client.upgrade("/api/v1/stream", as("operator")), 101u);
  const auto id = as("operator", "GET", "/session").body["id"].get<std::string>();
  EXPECT_EQ(as("operator", "DELETE", "/sessions/" + id).status, 204u);
  std::optional<Client::Frame> frame;
  do {
    frame = client.frame();
  } while (frame && frame->opcode != 8);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->close_code(), 4401u);
}

TEST_F(AccessApi, OnTheStreamTheRoleCountsForEachMessage) {
  const auto answer = [](Client& client, const std::string& text) -> std::string {
    client.send_frame(1, text);
    client.send_frame(1, R"({"ping":1})");
    std::string error;
    while (const auto frame = client.frame()) {
      if (frame->opcode != 1) continue;
      const Json message = Json::parse(frame->payload);
      if (message["topic"] == "error") error = message["data"]["detail"];
      if (message["topic"] == "pong") return error;
    }
    return "closed";
  };
  Client viewer(house.port());
  ASSERT_EQ(viewer.upgrade("/api/v1/stream", as("token of viewer")), 101u);
  EXPECT_EQ(answer(viewer, R"({"subscribe":{"events":0}})"), "");
  const std::string low = "the role viewer is too low: this needs operator";
  EXPECT_EQ(answer(viewer, R"({"halt":"hold"})"), low);
  EXPECT_EQ(answer(viewer, R"({"drive":{"speed_mps":1,"yaw_rate_dps":0,"deadman":true}})"), low);
  EXPECT_EQ(answer(viewer, R"({"throttle":{"share":1,"held":true}})"), low);
  Client driver(house.port());
  ASSERT_EQ(driver.upgrade("/api/v1/stream", as("token of operator")), 101u);
  EXPECT_EQ(answer(driver, R"({"halt":"hold"})"), "");
  EXPECT_EQ(answer(viewer, R"({"estop":true})"), "");
  until([this] { return as("viewer", "GET", "/vehicle").body["estop"] == true; }, "it stopped");
}

TEST_F(AccessApi, ATokenForReadingHaltsNothingOnTheStreamEither) {
  const auto made =
      as("admin", "POST", "/tokens", R"({"name":"reader","role":"operator","methods":["GET"]})");
  ASSERT_EQ(made.status, 201u) << made.raw.body;
  Client reader(house.port());
  ASSERT_EQ(reader.upgrade("/api/v1/stream", as_token(made.body["token"])), 101u);
  reader.send_frame(1, R"({"halt":"disarm"})");
  std::string error;
  while (const auto frame = reader.frame()) {
    if (frame->opcode != 1) continue;
    const Json message = Json::parse(frame->payload);
    if (message["topic"] != "error") continue;
    error = message["data"]["detail"];
    break;
  }
  EXPECT_EQ(error, "this token is not good for POST");
}

TEST_F(AccessApi, TwoRequestsOfOneKeyOnTheirWayAreBothAnswered) {
  const std::string home = "{\"lat\":58.37802,\"lon\":26.7289}";
  ASSERT_EQ(as("token of operator", "POST", "/control/take").status, 200u);
  const std::string ask =
      "PUT /api/v1/vehicle/home HTTP/1.1\r\nHost: 127.0.0.1\r\n"
      "Content-Type: application/json\r\nIdempotency-Key: both\r\n" +
      as("token of operator") + "Content-Length: " + std::to_string(home.size()) + "\r\n\r\n" +
      home;
  house.ticking = false;
  Client first(house.port());
  Client again(house.port());
  first.send(ask);
  again.send(ask);
  (void)as("viewer", "GET", "/missions");  // both were read by then
  house.ticking = true;
  const auto one = first.answer();
  const auto two = again.answer();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->body, two->body);
  EXPECT_EQ(one->status, two->status);
}

TEST_F(AccessApi, SecretsAreInNoEventAndNoAnswer) {
  (void)call("POST", "/session", Json{{"user", "admin"}, {"password", "wrong horse"}});
  const std::string events = as("admin", "GET", "/events").raw.body;
  const std::string users = as("admin", "GET", "/users").raw.body;
  const std::string sessions = as("admin", "GET", "/sessions").raw.body;
  for (const std::string& text : {events, users, sessions}) {
    EXPECT_EQ(text.find("horse"), std::string::npos);
    EXPECT_EQ(text.find("argon2"), std::string::npos);
    EXPECT_EQ(text.find("hash"), std::string::npos);
  }
}

class FirstAdmin : public HouseTest {
 protected:
  FirstAdmin() : HouseTest(House::Vehicle::Whole, {.access = true}) {}
};

TEST_F(FirstAdmin, IsMadeOnceWithTheCodeThatWasTold) {
  until([this] { return !house.code().empty(); }, "a code");
  EXPECT_EQ(call("GET", "/session").body["setup"], true);
  EXPECT_EQ(call("GET", "/vehicle").status, 401u);
  const auto set_up = [this](const std::string& code) {
    return call("POST", "/setup",
                Json{{"code", code}, {"user", "anna"}, {"password", kPassword}, {"device", "tab"}});
  };
  EXPECT_EQ(set_up("AAAA-AAAA").status, 401u);
  std::string typed = house.code();
  std::transform(typed.begin(), typed.end(), typed.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto made = set_up(typed);
  ASSERT_EQ(made.status, 200u) << made.raw.body;
  EXPECT_EQ(made.body["role"], "admin");
  const std::string cookie = made.raw.header("set-cookie");
  const std::string line = "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
  EXPECT_EQ(call("GET", "/users", "", line).body["items"][0]["name"], "anna");
  EXPECT_EQ(set_up(house.code()).status, 409u);
  EXPECT_EQ(call("GET", "/session").body["setup"], false);
}

TEST_F(FirstAdmin, IsMadeAnewWithANewCodeWhenTheLastUserLeft) {
  until([this] { return !house.code().empty(); }, "a code");
  const std::string first = house.code();
  const auto set_up = [this](const std::string& code) {
    return call("POST", "/setup", Json{{"code", code}, {"user", "anna"}, {"password", kPassword}});
  };
  const auto made = set_up(first);
  ASSERT_EQ(made.status, 200u) << made.raw.body;
  // when the only user leaves,
  const std::string cookie = made.raw.header("set-cookie");
  const std::string line =
      "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\nOrigin: http://127.0.0.1\r\n";
  EXPECT_EQ(call("DELETE", "/users/anna", "", line).status, 204u);
  // then another code is told, and that one alone opens.
  EXPECT_EQ(call("GET", "/session").body["setup"], true);
  EXPECT_NE(house.code(), first);
  EXPECT_EQ(set_up(first).status, 401u);
  EXPECT_EQ(set_up(house.code()).status, 200u);
}

class NoAccess : public HouseTest {};

TEST_F(NoAccess, WithoutAccessControlThereIsNothingToLogInTo) {
  const auto state = call("GET", "/session").body;
  EXPECT_EQ(state["access"], false);
  EXPECT_EQ(state["setup"], false);
  const auto in = call("POST", "/session", Json{{"user", "anna"}, {"password", kPassword}});
  EXPECT_EQ(in.status, 409u);
  EXPECT_EQ(call("POST", "/users", "{}").status, 409u);
  EXPECT_EQ(call("PATCH", "/users/anna", "{}").status, 409u);
  EXPECT_EQ(call("DELETE", "/users/anna").status, 409u);
  EXPECT_EQ(call("POST", "/tokens", "{}").status, 409u);
  EXPECT_EQ(call("DELETE", "/tokens/1").status, 404u);
  EXPECT_EQ(call("DELETE", "/session").status, 409u);
  EXPECT_EQ(call("DELETE", "/sessions/1").status, 404u);
  for (const char* list : {"/users", "/tokens", "/sessions"}) {
    EXPECT_TRUE(call("GET", list).body["items"].empty());
  }
  // Whatever is shown.
  EXPECT_NE(call("GET", "/vehicle", "", "Authorization: Bearer x\r\n").status, 401u);
}

}  // namespace
}  // namespace roverd::test
