#include "config/reach.hpp"

#include <gtest/gtest.h>

namespace roverd {
namespace {

/// As the file of a test says it.
Settings said(const std::string& listen) {
  Settings s;
  s.server.listen = listen;
  return s;
}

TEST(Reach, LoopbackAloneNeedsNothing) {
  Settings s = said("loopback");
  ASSERT_TRUE(settle_server(s));
  EXPECT_EQ(addresses_of(s.server), std::vector<std::string>{"127.0.0.1"});
  EXPECT_FALSE(reaches_out(s.server));
  EXPECT_FALSE(s.server.tls);
  EXPECT_FALSE(s.server.access);
}

TEST(Reach, InANetworkTlsAndAccessAreOn) {
  for (const char* listen : {"lan", "192.168.4.1", "127.0.0.1 fd00::2", "0.0.0.0", "::"}) {
    Settings s = said(listen);
    ASSERT_TRUE(settle_server(s)) << listen;
    EXPECT_TRUE(reaches_out(s.server)) << listen;
    EXPECT_TRUE(s.server.tls) << listen;
    EXPECT_TRUE(s.server.access) << listen;
  }
  EXPECT_EQ(addresses_of(said("lan").server), std::vector<std::string>{"::"});
  EXPECT_EQ(addresses_of(said(" 127.0.0.1  fd00::2 ").server),
            (std::vector<std::string>{"127.0.0.1", "fd00::2"}));
}

TEST(Reach, ListedAddressesOfLoopbackReachNobodyElse) {
  Settings s = said("127.0.0.2 ::1");
  ASSERT_TRUE(settle_server(s));
  EXPECT_FALSE(reaches_out(s.server));
  EXPECT_FALSE(s.server.access);
}

TEST(Reach, WhoeverTurnsOneOffIsToldWhichKey) {
  for (const char* key : {"server.tls", "server.access"}) {
    // Given a file that says false, not one that says nothing,
    Settings s = said("lan");
    s.places[key] = "robot.toml:7";
    // when the network is asked for,
    const auto done = settle_server(s);
    // then it is refused, with file, line and key.
    ASSERT_FALSE(done) << key;
    EXPECT_EQ(done.error().code, base::Code::Invalid);
    EXPECT_TRUE(
        done.error().detail.starts_with("robot.toml:7: " + std::string(key) + " must not be false"))
        << done.error().detail;
  }
}

TEST(Reach, BindOpensNoNetworkUnlessBothAreOn) {
  for (const char* address :
       {"0.0.0.0", "::", "192.168.1.5", "127.evil.example", "", "localhost", "1127.0.0.1"}) {
    Settings s;
    s.server.bind = address;
    s.places["server.bind"] = "robot.toml:3";
    for (const bool tls : {false, true}) {
      s.server.tls = tls;
      s.server.access = !tls;
      const auto done = settle_server(s);
      ASSERT_FALSE(done) << address;
      EXPECT_TRUE(done.error().detail.starts_with("robot.toml:3: server.bind must be"))
          << done.error().detail;
    }
    s.server.tls = s.server.access = true;
    EXPECT_TRUE(settle_server(s)) << address;
  }
  for (const char* address : {"127.0.0.1", "127.0.0.53", "::1"}) {
    Settings s;
    s.server.bind = address;
    EXPECT_TRUE(settle_server(s)) << address;
  }
}

TEST(Reach, AddressesStandInUrlsAsUrlsWantThem) {
  EXPECT_EQ(authority_of("192.168.4.1", 8080), "192.168.4.1:8080");
  EXPECT_EQ(authority_of("fd00::1", 80), "[fd00::1]:80");
}

TEST(Reach, WhatIsNoAddressIsRefused) {
  for (const char* listen :
       {"", "world", "lan 192.168.4.1", "192.168.4.1,127.0.0.1", "robot.local"}) {
    Settings s = said(listen);
    const auto done = settle_server(s);
    ASSERT_FALSE(done) << listen;
    EXPECT_TRUE(done.error().detail.starts_with("server.listen must be loopback, lan or addresses"))
        << done.error().detail;
  }
}

}  // namespace
}  // namespace roverd
