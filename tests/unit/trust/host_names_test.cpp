#include "trust/host_names.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace roverd::trust {
namespace {

using List = std::vector<std::string>;

TEST(HostNames, AHostIsKnownByItsNameTheLocalOneAndLoopback) {
  const auto names = all_names("Rover", {"192.168.4.1", "127.0.0.1", "fd00::7"}, "");
  ASSERT_TRUE(names);
  EXPECT_EQ(names->hosts, (List{"rover", "rover.local", "localhost"}));
  EXPECT_EQ(names->addresses, (List{"127.0.0.1", "::1", "192.168.4.1", "fd00::7"}));
}

TEST(HostNames, AWholeNameGivesItsFirstLabelAsTheLocalOne) {
  EXPECT_EQ(all_names("rover.farm.example", {}, "")->hosts,
            (List{"rover.farm.example", "rover.local", "localhost"}));
}

TEST(HostNames, WhatIsNoHostNameIsLeftOut) {
  for (const char* odd :
       {"", "a b", "über", "-a", "a-", "a..b", ".a", "a.", "x,DNS:evil.example"}) {
    EXPECT_EQ(all_names(odd, {}, "")->hosts, (List{"localhost"})) << odd;
    EXPECT_FALSE(is_host_name(odd)) << odd;
  }
  EXPECT_FALSE(is_host_name(std::string(64, 'a')));
  EXPECT_TRUE(is_host_name(std::string(63, 'a') + ".b"));
  EXPECT_EQ(all_names("localhost", {}, "")->hosts, (List{"localhost"}));
}

TEST(HostNames, MoreAreConfiguredAndWrongOnesRefused) {
  const auto names = all_names("rover", {}, " R2.example.org  10.0.0.1 2001:DB8:0::1 rover ");
  ASSERT_TRUE(names);
  EXPECT_EQ(names->hosts, (List{"rover", "rover.local", "localhost", "r2.example.org"}));
  EXPECT_EQ(names->addresses, (List{"10.0.0.1", "2001:db8::1", "127.0.0.1", "::1"}));

  const auto wrong = all_names("rover", {}, "a, b");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().detail, "\"a,\" is neither a name nor an address");
}

TEST(HostNames, AComputerFullOfContainersGets64Addresses) {
  List many;
  for (int i = 0; i < 250; ++i) many.push_back("10.0.0." + std::to_string(i));
  EXPECT_EQ(all_names("rover", many, "")->addresses.size(), 64U);
}

TEST(HostNames, ThisComputerHasLoopback) {
  const auto all = interface_addresses();
  EXPECT_NE(std::find(all.begin(), all.end(), "127.0.0.1"), all.end());
}

TEST(HostNames, TheAddressThatFacesTheWorldIsOneOfThisComputersOrThereIsNone) {
  const auto all = interface_addresses();
  const std::string outward = outward_address();
  EXPECT_TRUE(outward.empty() || std::find(all.begin(), all.end(), outward) != all.end())
      << outward;
}

}  // namespace
}  // namespace roverd::trust
