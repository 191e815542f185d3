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

}  // namespace
}  // namespace roverd::test
