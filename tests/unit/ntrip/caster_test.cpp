#include "ntrip/caster.hpp"

#include <gtest/gtest.h>

namespace roverd::ntrip {
namespace {

TEST(Caster, AddressesAreReadInTheirOrder) {
  const auto all = parse_casters(
      "ntrip://rover:secret@10.0.0.1:2102/TEST0 ntrips://a%40b:p%3A/q@caster.example/VRS "
      "ntrip://[::1]");
  ASSERT_TRUE(all) << all.error().detail;
  ASSERT_EQ(all->size(), 3u);
  EXPECT_EQ((*all)[0].login, "rover:secret");
  EXPECT_EQ((*all)[0].address(), "tcp:10.0.0.1:2102");
  EXPECT_EQ((*all)[0].mountpoint, "TEST0");
  EXPECT_EQ((*all)[1].login, "a@b:p:/q");
  EXPECT_EQ((*all)[1].address(), "tls:caster.example:443");
  EXPECT_EQ((*all)[1].mountpoint, "VRS");
  EXPECT_EQ((*all)[2].address(), "tcp:[::1]:2101");
  EXPECT_EQ((*all)[2].mountpoint, "");
}

TEST(Caster, ANameHoldsNoLogin) {
  const auto all = parse_casters("ntrip://rover:secret@10.0.0.1/TEST0");
  EXPECT_EQ(all->at(0).name(), "ntrip://10.0.0.1:2101/TEST0");
}

TEST(Caster, WhatIsWrongIsSaidWithoutTheLogin) {
  for (const char* text :
       {"", "http://rover:secret@x/y", "ntrip://rover:secret@/y", "ntrip://rover:secret@x:0/y",
        "ntrip://rover:secret@x:99999/y", "ntrip://secret@x/y", "ntrip://ro%GGver:secret@x/y",
        "ntrip://rover:secret@x/y/z", "ntrip://a/b ntrip://rover:secret\r\n@x/y"}) {
    const auto all = parse_casters(text);
    ASSERT_FALSE(all) << text;
    EXPECT_EQ(all.error().detail.find("secret"), std::string::npos) << all.error().detail;
  }
  EXPECT_EQ(parse_casters("ntrip://a/b ntrip://x:0/y").error().detail,
            "caster number 2 wants a port of 1..65535 after the host: "
            "ntrip://USER:PASSWORD@HOST:PORT/MOUNTPOINT");
}

TEST(Caster, TheRequestIsThatOfItsVersion) {
  const Caster caster = parse_casters("ntrip://rover:secret@10.0.0.1/TEST0")->at(0);
  EXPECT_EQ(request(caster, 1),
            "GET /TEST0 HTTP/1.0\r\nUser-Agent: NTRIP roverd/1\r\n"
            "Authorization: Basic cm92ZXI6c2VjcmV0\r\nAccept: */*\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(request(caster, 2),
            "GET /TEST0 HTTP/1.1\r\nHost: 10.0.0.1:2101\r\nNtrip-Version: Ntrip/2.0\r\n"
            "User-Agent: NTRIP roverd/1\r\nAuthorization: Basic cm92ZXI6c2VjcmV0\r\n"
            "Accept: */*\r\nConnection: close\r\n\r\n");
}

TEST(Caster, Base64FillsUp) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("a"), "YQ==");
  EXPECT_EQ(base64("ab"), "YWI=");
  EXPECT_EQ(base64("abc"), "YWJj");
}

TEST(Gga, IsTheFactSheetsLine) {
  base::GnssFix fix;
  fix.fix = base::FixType::Single;
  fix.position = base::LatLon{60.167, 24.0 + 56.11 / 60.0};
  fix.satellites = 12;
  fix.hdop = 0.9;
  fix.alt_msl_m = 25.4;
  fix.geoid_sep_m = 17.9;
  fix.utc = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1} + std::chrono::hours{8} +
            std::chrono::minutes{15};
  EXPECT_EQ(gga_of(fix),
            "$GPGGA,081500.00,6010.02000,N,02456.11000,E,1,12,0.9,25.40,M,17.90,M,,*56\r\n");
  fix.position = base::LatLon{-0.99999999999, -179.99999999999};
  fix.fix = base::FixType::RtkFixed;
  EXPECT_NE(gga_of(fix).find(",0100.00000,S,18000.00000,W,4,"), std::string::npos)
      << "a minute never becomes 60: " << gga_of(fix);
  fix.position.reset();
  EXPECT_EQ(gga_of(fix), "");
}

}  // namespace
}  // namespace roverd::ntrip
