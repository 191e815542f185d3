#include "base/network.hpp"

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

TEST(Network, OfIpv6IsItsFirstHalf) {
  EXPECT_EQ(network_of("2001:db8:0:1:aa:bb:cc:dd"), "2001:db8:0:1/64");
  EXPECT_EQ(network_of("2001:db8:0:1::1"), "2001:db8:0:1/64");
  EXPECT_EQ(network_of("2001:db8::1:2:3:4:5"), "2001:db8:0:1/64");
  EXPECT_EQ(network_of("2001:db8::"), "2001:db8:0:0/64");
  EXPECT_EQ(network_of("::2:1:0:0:0:0"), "0:0:2:1/64");
  EXPECT_EQ(network_of("::"), "0:0:0:0/64");
  EXPECT_NE(network_of("2001:db8:0:2::1"), network_of("2001:db8:0:1::1"));
  // Each interface has its own fe80::.
  EXPECT_EQ(network_of("fe80::1%eth0"), "fe80:0:0:0/64%eth0");
  EXPECT_NE(network_of("fe80::1%2"), network_of("fe80::1%3"));
}

TEST(Network, OthersHaveNone) {
  for (const char* one :
       {"", "10.0.0.1", "127.0.0.1", "::1", "::ffff:10.0.0.1", "robot", "2001:", "2001:db8", ":1",
        "1:2:3:4:5:6:7:8:9", "1::2::3", "1:2:3:4::5:6:7:8", "12345::", "fe80::g", "%eth0"}) {
    EXPECT_EQ(network_of(one), "") << one;
  }
}

}  // namespace
}  // namespace roverd::base
