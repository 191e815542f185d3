#include "api/guard.hpp"

#include <gtest/gtest.h>

namespace roverd::api {
namespace {

Request request(http::verb method, const char* host, const char* origin = nullptr) {
  Request out{method, "/api/v1/vehicle/arm", 11};
  if (host != nullptr) out.set(http::field::host, host);
  if (origin != nullptr) out.set(http::field::origin, origin);
  return out;
}

unsigned status(const std::optional<Response>& refusal) {
  return refusal ? refusal->result_int() : 0;
}

TEST(Host, LoopbackNamesWithAnyPortPass) {
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8080", "localhost", "LOCALHOST:1", "[::1]", "[::1]:65535"}) {
    EXPECT_TRUE(is_loopback_host(host)) << host;
  }
}

TEST(Host, OtherNamesDoNotPassWhateverTheyResembleOrResolveTo) {
  for (const char* host : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                           "localhost.evil.example", "localhost:", "localhost:8080@evil.example",
                           "127.0.0.1:80:80", "[::1", "[::1]evil", "192.168.0.1", "127.0.0.2"}) {
    EXPECT_FALSE(is_loopback_host(host)) << host;
  }
}

TEST(Guard, AForeignHostIsRefusedEvenForReading) {
  EXPECT_EQ(status(guard_request(request(http::verb::get, "robot.evil.example:8080"))), 403u);
  EXPECT_EQ(status(guard_request(request(http::verb::get, nullptr))), 400u);
  EXPECT_EQ(status(guard_request(request(http::verb::get, "localhost:8080"))), 0u);
}

TEST(Guard, AForeignPageMayNotChangeAnything) {
  const auto post = [](const char* origin) {
    return status(guard_request(request(http::verb::post, "127.0.0.1:8080", origin)));
  };
  EXPECT_EQ(post(nullptr), 0u);  // a script
  EXPECT_EQ(post("http://127.0.0.1:8080"), 0u);
  EXPECT_EQ(post("http://127.0.0.1:3000"), 403u);  // another program's page on this machine
  EXPECT_EQ(post("https://127.0.0.1:8080"), 403u);
  EXPECT_EQ(post("http://evil.example"), 403u);
  EXPECT_EQ(post("null"), 403u);  // a sandboxed frame
  EXPECT_EQ(post(""), 403u);
}

TEST(Guard, AWebSocketNeedsTheOwnOriginToo) {
  EXPECT_EQ(status(guard_upgrade(request(http::verb::get, "localhost:1", "http://localhost:1"))),
            0u);
  EXPECT_EQ(status(guard_upgrade(request(http::verb::get, "localhost:1"))), 0u);
  EXPECT_EQ(status(guard_upgrade(request(http::verb::get, "localhost:1", "http://evil.example"))),
            403u);
  EXPECT_EQ(status(guard_upgrade(request(http::verb::get, "evil.example", "http://evil.example"))),
            403u);
}

TEST(Guard, UnderTlsOnlyThePageThatCameThroughItIsOurs) {
  const auto post = [](const char* origin) {
    return status(guard_request(request(http::verb::post, "localhost:8080", origin), true));
  };
  const auto upgrade = [](const char* origin) {
    return status(guard_upgrade(request(http::verb::get, "localhost:8080", origin), true));
  };
  for (const auto& ask : {+post, +upgrade}) {
    EXPECT_EQ(ask("https://localhost:8080"), 0u);
    EXPECT_EQ(ask("http://localhost:8080"), 403u);
    EXPECT_EQ(ask("https://localhost:8081"), 403u);
  }
}

TEST(Host, ABareNameHasNoPortNoBracketsAndSmallLetters) {
  EXPECT_EQ(bare_name("Rover.local:8080"), "rover.local");
  EXPECT_EQ(bare_name("192.168.4.1"), "192.168.4.1");
  EXPECT_EQ(bare_name("[FD00::2]:443"), "fd00::2");
  for (const char* host : {"", ":80", "rover:", "rover:x", "[rover]", "[::1", "::1", "[::1]x"}) {
    EXPECT_EQ(bare_name(host), "") << host;
  }
}

TEST(Guard, InANetworkItsOwnNamesPassAndAForeignOneThatIsPointedHereDoesNot) {
  const IsOurs ours = [](const std::string& name) { return name == "rover.local"; };
  const auto get = [&ours](const char* host) {
    return status(guard_request(request(http::verb::get, host), true, ours));
  };
  EXPECT_EQ(get("rover.local:8080"), 0u);
  EXPECT_EQ(get("ROVER.local"), 0u);
  EXPECT_EQ(get("localhost:8080"), 0u);
  EXPECT_EQ(get("rover.local.evil.example"), 403u);
  EXPECT_EQ(get("evil.example"), 403u);
  EXPECT_EQ(get(""), 403u);
  const auto upgrade = [&ours](const char* host, const char* origin) {
    return status(guard_upgrade(request(http::verb::get, host, origin), true, ours));
  };
  EXPECT_EQ(upgrade("rover.local", "https://rover.local"), 0u);
  EXPECT_EQ(upgrade("rover.local", "https://evil.example"), 403u);
  EXPECT_EQ(upgrade("evil.example", "https://evil.example"), 403u);
}

TEST(Guard, TheAddressThatARequestCameToIsOursHoweverNewItIs) {
  const auto came_to = [](const char* here, const char* host) {
    Request out = request(http::verb::get, host);
    out.set("Roverd-Here", here);
    return status(guard_request(out, true, [](const std::string&) { return false; }));
  };
  EXPECT_EQ(came_to("192.168.4.1", "192.168.4.1:8080"), 0u);
  EXPECT_EQ(came_to("fd00::2", "[fd00::2]:8080"), 0u);
  EXPECT_EQ(came_to("192.168.4.1", "192.168.4.2"), 403u);
  EXPECT_EQ(came_to("", ""), 403u);
}

}  // namespace
}  // namespace roverd::api
