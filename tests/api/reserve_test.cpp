// The reserve of a full house, for those who are slow to say that they want to stop.

#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "net_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

net::Handlers with_stop_only() {
  net::Handlers h;
  h.on_request = [](const net::Request&, base::Time, const net::Respond& respond) {
    respond(net::Response{boost::beast::http::status::ok, 11});
  };
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  h.urgency = [](const net::Request&) { return net::Urgency::Whole; };
  return h;
}

TEST(Reserve, ASlowLinkHasItsWholeSecond) {
  // Given a full house,
  net::Limits limits;
  limits.connections = 3;
  limits.request = 20s;
  limits.reserve_time = 8s;
  NetHouse house(limits, with_stop_only());
  std::vector<std::unique_ptr<Client>> streams;
  for (int i = 0; i < 3; ++i) {
    streams.push_back(std::make_unique<Client>(house.port()));
    ASSERT_EQ(streams.back()->upgrade("/stream"), 101u);
  }
  // when a stop comes in pieces, some of the sweeps apart,
  Client stop(house.port());
  for (const char* piece :
       {"POST /st", "op HTTP/1.1\r\nHost: x\r\n", "Content-Length: 0\r\n\r\n"}) {
    EXPECT_TRUE(stop.send(piece));
    std::this_thread::sleep_for(600ms);
  }
  // then it is heard.
  const auto answer = stop.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200u);
}

TEST(Reserve, WhoeverSendsHalfABodyThereKeepsNobodyFromStopping) {
  // Given a full house, and a reserve full of stops whose bodies do not come,
  net::Limits limits;
  limits.connections = 3;
  limits.reserve = 4;
  limits.request = 60s;
  limits.reserve_time = 60s;
  NetHouse house(limits, with_stop_only());
  std::vector<std::unique_ptr<Client>> crowd;
  for (int i = 0; i < 3; ++i) {
    crowd.push_back(std::make_unique<Client>(house.port()));
    ASSERT_EQ(crowd.back()->upgrade("/stream"), 101u);
  }
  for (int i = 0; i < 4; ++i) {
    crowd.push_back(std::make_unique<Client>(house.port()));
    crowd.back()->send("POST /stop HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nhalf");
  }
  // (they sent all of that before the stop comes, and are read in order)
  std::this_thread::sleep_for(500ms);
  // when somebody stops, then that is heard.
  Client stop(house.port());
  EXPECT_TRUE(stop.send("POST /stop HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n"));
  const auto answer = stop.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200u);
}

}  // namespace
}  // namespace roverd::test
