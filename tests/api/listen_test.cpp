// On which addresses a server listens, and what its handlers are told of them.

#include <gtest/gtest.h>

#include "net_house.hpp"

namespace roverd::test {
namespace {

namespace http = boost::beast::http;
using Addresses = std::vector<std::string>;

std::string of(const net::Request& request, std::string_view name) {
  const auto value = request[boost::beast::string_view(name.data(), name.size())];
  return {value.data(), value.size()};
}

/// Says from where to where each request came.
net::Handlers told() {
  net::Handlers handlers;
  handlers.on_request = [](net::Request request, base::Time, net::Respond respond) {
    net::Response response{http::status::ok, 11};
    response.body() = of(request, net::kPeerHeader) + " to " + of(request, net::kHereHeader);
    respond(std::move(response));
  };
  return handlers;
}

std::string ask(std::uint16_t port, const std::string& address) {
  Client client(port, address);
  client.send("GET / HTTP/1.1\r\nHost: x\r\nRoverd-Peer: 6.6.6.6\r\nRoverd-Here: 7.7.7.7\r\n\r\n");
  const auto answer = client.answer();
  return answer ? answer->body : "nothing";
}

TEST(Listen, SeveralAddressesAtOnePort) {
  NetHouse house({}, told(), {}, {"127.0.0.2", "127.0.0.3", "::1"});
  EXPECT_EQ(ask(house.port(), "127.0.0.2"), "127.0.0.1 to 127.0.0.2");
  EXPECT_EQ(ask(house.port(), "127.0.0.3"), "127.0.0.1 to 127.0.0.3");
  EXPECT_EQ(ask(house.port(), "::1"), "::1 to ::1");
  EXPECT_THROW(Client(house.port(), "127.0.0.1"), std::runtime_error);
}

TEST(Listen, EveryAddressIsOfBothKindsAndThoseOfIpv4ReadAsSuch) {
  NetHouse house({}, told(), {}, {"::"});
  EXPECT_EQ(ask(house.port(), "127.0.0.2"), "127.0.0.1 to 127.0.0.2");
  EXPECT_EQ(ask(house.port(), "::1"), "::1 to ::1");
}

TEST(Listen, AnAddressThatThisComputerDoesNotHaveYetDoesNotPreventTheOthers) {
  NetHouse house({}, told(), {}, {"198.51.100.7", "127.0.0.1"});
  EXPECT_EQ(ask(house.port(), "127.0.0.1"), "127.0.0.1 to 127.0.0.1");
}

TEST(Listen, ABusyPortAtOneOfThemIsNamed) {
  NetHouse house({}, told(), {}, {"127.0.0.2"});
  boost::asio::io_context io;
  const auto second =
      net::Server::listen(io, Addresses{"127.0.0.1", "127.0.0.2"}, house.port(), {}, told());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().detail, "port " + std::to_string(house.port()) + " is in use");
}

}  // namespace
}  // namespace roverd::test
