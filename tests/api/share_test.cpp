// The share that one address may have of a server's connections.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "net_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
namespace http = boost::beast::http;
using Crowd = std::vector<std::unique_ptr<Client>>;

constexpr const char* kNear = "127.0.0.1";
constexpr const char* kOne = "127.0.0.2";
constexpr const char* kOther = "127.0.0.3";

net::Limits shared() {
  net::Limits limits;
  limits.connections = 8;
  limits.reserve = 8;
  limits.per_address = 3;
  limits.reserve_time = 60s;
  return limits;
}

/// Serves everything; "/stop" is urgent.
net::Handlers open_house() {
  net::Handlers h;
  h.on_request = [](const net::Request&, base::Time, const net::Respond& respond) {
    respond(net::Response{http::status::ok, 11});
  };
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  h.urgency = [](const net::Request& header) {
    return header.target() == "/stop" ? net::Urgency::Whole : net::Urgency::None;
  };
  return h;
}

std::unique_ptr<Client> from(const NetHouse& house, const char* source) {
  return std::make_unique<Client>(house.port(), kNear, source);
}

unsigned ask(Client& client, const std::string& path) {
  client.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const auto answer = client.answer();
  return answer ? answer->status : 0;
}

Crowd streams(const NetHouse& house, const char* source, int count) {
  Crowd crowd;
  for (int i = 0; i < count; ++i) {
    crowd.push_back(from(house, source));
    EXPECT_EQ(crowd.back()->upgrade("/stream"), 101u) << source << " " << i;
  }
  return crowd;
}

TEST(Share, BeyondItAnAddressMayOnlyStopAndTheOthersAreServed) {
  // Given as many busy connections of one address as it may have,
  NetHouse house(shared(), open_house());
  const Crowd busy = streams(house, kOne, 3);
  // then it gets nothing more but a stop,
  EXPECT_EQ(ask(*from(house, kOne), "/more"), 503u);
  EXPECT_EQ(ask(*from(house, kOne), "/stop"), 200u);
  // others are served, and nothing of its own is closed.
  EXPECT_EQ(ask(*from(house, kOther), "/more"), 200u);
  EXPECT_EQ(ask(*from(house, kNear), "/more"), 200u);
  for (const auto& one : busy) EXPECT_FALSE(one->closed_within(1ms));
}

TEST(Share, ThisComputerHasNone) {
  NetHouse house(shared(), open_house());
  const Crowd busy = streams(house, kNear, 7);
  EXPECT_EQ(ask(*from(house, kNear), "/more"), 200u);
}

TEST(Share, ItsOwnWaitingOnesMakeRoomAndNobodyElses) {
  // Given one that waits of another address, and then as many as may be of this one,
  NetHouse house(shared(), open_house());
  const auto elsewhere = from(house, kOther);
  ASSERT_EQ(ask(*elsewhere, "/a"), 200u);
  Crowd waiting;
  for (int i = 0; i < 3; ++i) {
    waiting.push_back(from(house, kOne));
    ASSERT_EQ(ask(*waiting.back(), "/b"), 200u);
  }
  // when one more comes, then it is served and the first of its own is gone.
  EXPECT_EQ(ask(*from(house, kOne), "/c"), 200u);
  EXPECT_TRUE(waiting[0]->closed_within(5s));
  EXPECT_EQ(ask(*elsewhere, "/d"), 200u);
}

TEST(Share, OneAddressHasAQuarterOfTheReserve) {
  // Given a full house and somebody on the reserve who has not said yet what is wanted,
  NetHouse house(shared(), open_house());
  const Crowd busy = streams(house, kNear, 8);
  const auto slow = from(house, kOther);
  slow->send("GET /stop HTTP/1.1\r\n");
  // when another address opens connection after connection,
  Crowd flood;
  for (int i = 0; i < 50; ++i) flood.push_back(from(house, kOne));
  EXPECT_TRUE(flood.front()->closed_within(5s));
  // then they push out each other alone.
  slow->send("Host: localhost\r\n\r\n");
  const auto answer = slow->answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200u);
}

}  // namespace
}  // namespace roverd::test
