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

TEST(BindAddress, OnlyLoopbackIsAllowedAndTheReasonIsSaid) {
  EXPECT_TRUE(check_bind_address("127.0.0.1"));
  EXPECT_TRUE(check_bind_address("127.0.0.53"));
  EXPECT_TRUE(check_bind_address("::1"));
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5", "10.0.0.1", "127.evil.example", "",
                              "localhost", "1127.0.0.1"}) {
    const auto result = check_bind_address(address);
    ASSERT_FALSE(result) << address;
    EXPECT_NE(result.error().detail.find("access control is not there yet"), std::string::npos);
  }
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

TEST(Guard, TheNetworkIsRefusedUntilThereIsAccessControl) {
  EXPECT_TRUE(check_bind_address("127.0.0.1"));
  EXPECT_FALSE(check_bind_address("127.0.0.1", true));
}

}  // namespace
}  // namespace roverd::api
