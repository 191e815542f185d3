// What every request meets: the document, methods, hosts, origins, and addresses outside the API.

#include "house.hpp"

namespace roverd::test {
namespace {

class ServerApi : public HouseTest {};

TEST_F(ServerApi, TheDocumentAndTheTableOfRoutesAreEqual) {
  // Given the paths, methods and statuses of the document,
  std::map<std::string, std::vector<unsigned>> written;
  for (const auto& [path, methods] : document()["paths"].items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string name = method;
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      auto& statuses = written[name + " " + path];
      for (const auto& [status, response] : operation["responses"].items()) {
        if (status != "default") statuses.push_back(static_cast<unsigned>(std::stoul(status)));
      }
      std::sort(statuses.begin(), statuses.end());
    }
  }
  // then the server has exactly these.
  EXPECT_EQ(house.api().documented(), written);
}

TEST_F(ServerApi, TheDocumentAndItsPageAreServed) {
  for (const char* path : {"/openapi.json", "/api/v1/openapi.json"}) {
    const auto reply = raw("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(reply.body, document());
    const auto again = raw("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n" +
                           "If-None-Match: " + reply.raw.header("etag") + "\r\n\r\n");
    EXPECT_EQ(again.status, 304u);
  }
  const auto docs = raw("GET /docs HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(docs.status, 200u);
  EXPECT_EQ(docs.raw.body, "the page's file /docs.html");
  const std::string policy = docs.raw.header("content-security-policy");
  EXPECT_NE(policy.find("default-src 'none'; script-src 'self';"), std::string::npos) << policy;
  EXPECT_EQ(raw("GET /docs/other HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 404u);
}

TEST_F(ServerApi, HealthAndMetricsNeedNoBasePath) {
  until_ready();
  EXPECT_EQ(call("GET", "/health").body["version"], "test");
  EXPECT_EQ(raw("GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200u);
  const auto metrics = raw("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(metrics.raw.body.find("roverd_loop_ticks_total "), std::string::npos);
}

TEST_F(ServerApi, HeadIsGetWithoutTheBodyAndOptionsTellTheMethods) {
  const auto get = raw("GET /api/v1/missions HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const auto head = raw("HEAD /api/v1/missions HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(head.raw.header("content-length"), get.raw.header("content-length"));
  const auto options = raw("OPTIONS /api/v1/missions HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(options.status, 204u);
  EXPECT_EQ(options.raw.header("allow"), "GET, HEAD, POST, OPTIONS");
  EXPECT_EQ(raw("OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 204u);
}

TEST_F(ServerApi, WrongAddressesAndMethodsAreProblems) {
  const auto nothing = call("GET", "/nothing");
  EXPECT_EQ(nothing.status, 404u);
  EXPECT_EQ(nothing.raw.header("content-type"), "application/problem+json");
  EXPECT_EQ(nothing.body["title"], "Not found");
  const auto wrong = raw("DELETE /api/v1/vehicle HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(wrong.status, 405u);
  EXPECT_EQ(wrong.raw.header("allow"), "GET, HEAD, OPTIONS");
  EXPECT_EQ(raw("BREW /api/v1/vehicle HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 405u);
  EXPECT_EQ(raw("GET /no/page HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 404u);
  EXPECT_EQ(raw("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n").status, 405u);
  EXPECT_EQ(raw("GET /api/v1/events?since=%zz HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 400u);
  EXPECT_EQ(raw("GET /api/v1x/vehicle HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 404u);
}

TEST_F(ServerApi, ForeignHostsAndPagesAreKeptOut) {
  // A name that somebody pointed at 127.0.0.1:
  EXPECT_EQ(raw("GET /api/v1/vehicle HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 403u);
  EXPECT_EQ(raw("GET /api/v1/vehicle HTTP/1.1\r\n\r\n").status, 400u);
  // A page of another site in the user's browser:
  const auto post = [this](const std::string& origin) {
    return raw("POST /api/v1/vehicle/estop HTTP/1.1\r\nHost: 127.0.0.1:8080\r\nOrigin: " + origin +
               "\r\nContent-Length: 0\r\n\r\n")
        .status;
  };
  EXPECT_EQ(post("http://evil.example"), 403u);
  EXPECT_EQ(post("null"), 403u);
  until([this] { return call("GET", "/vehicle").status == 200; }, "a first state");
  EXPECT_EQ(call("GET", "/vehicle").body["estop"], false);
  EXPECT_EQ(post("http://127.0.0.1:8080"), 200u);
}

TEST_F(ServerApi, TooMuchIsRefusedAsAProblem) {
  const auto big =
      raw("POST /api/v1/missions HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
          "application/json\r\nContent-Length: 50000000\r\n\r\n");
  EXPECT_EQ(big.status, 413u);
  EXPECT_EQ(big.body["title"], "Too large");
  const auto broken = raw("this is no HTTP\r\n\r\n");
  EXPECT_EQ(broken.status, 400u);
  EXPECT_EQ(broken.raw.header("content-type"), "application/problem+json");
}

}  // namespace
}  // namespace roverd::test
