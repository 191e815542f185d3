// What one user may have under way at the same time: streams, and requests that wait.

#include <memory>
#include <vector>

#include "access_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
constexpr int kStreams = 64;
constexpr int kCalls = 48;

class SharesApi : public AccessApi {
 protected:
  std::unique_ptr<Client> waiting(const std::string& caller, const std::string& request) {
    auto client = std::make_unique<Client>(house.port());
    client->send(request + " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n" + as(caller) +
                 "\r\n");
    return client;
  }
};

TEST_F(SharesApi, AUserHasSoManyStreamsAndOthersHaveTheirs) {
  // Given as many streams of one user as there may be,
  std::vector<std::unique_ptr<Client>> streams;
  for (int i = 0; i < kStreams; ++i) {
    streams.push_back(std::make_unique<Client>(house.port()));
    ASSERT_EQ(streams.back()->upgrade("/api/v1/stream", as("operator")), 101u) << i;
    ASSERT_TRUE(streams.back()->frame());  // hello: it is counted
  }
  // then one more is refused, by a token of another user it is not, and a stop needs none.
  Client more(house.port());
  EXPECT_EQ(more.upgrade("/api/v1/stream", as("operator")), 429u);
  Client other(house.port());
  EXPECT_EQ(other.upgrade("/api/v1/stream", as("viewer")), 101u);
  EXPECT_EQ(as("operator", "POST", "/vehicle/estop").status, 200u);
  // When one of them goes, there is room again.
  streams.pop_back();
  until(
      [this] {
        Client again(house.port());
        return again.upgrade("/api/v1/stream", as("operator")) == 101u;
      },
      "there is room again");
}

TEST_F(SharesApi, WhatWaitsOfOneUserLeavesRoomForTheOthers) {
  // Given a loop that hangs, and a script that goes on asking,
  ASSERT_EQ(as("operator", "POST", "/control/take").status, 200u);
  house.ticking = false;
  std::vector<std::unique_ptr<Client>> calls;
  for (int i = 0; i < kCalls; ++i) {
    calls.push_back(waiting("operator", "POST /api/v1/vehicle/acknowledge"));
  }
  until([this] { return as("operator", "GET", "/vehicle").status == 429u; }, "it is too much");
  // then everybody else is served, and its stop is heard.
  EXPECT_EQ(as("admin", "GET", "/vehicle").status, 200u);
  EXPECT_EQ(as("nobody", "GET", "/health").status, 200u);
  const auto stop = waiting("operator", "POST /api/v1/vehicle/estop");
  EXPECT_EQ(as("operator", "GET", "/vehicle").status, 429u);
  house.ticking = true;
  EXPECT_EQ(stop->answer()->status, 200u);
  until([this] { return as("operator", "GET", "/vehicle").status == 200u; }, "it is over");
}

}  // namespace
}  // namespace roverd::test
