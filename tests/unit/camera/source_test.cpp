#include "camera/source.hpp"

#include <gtest/gtest.h>

namespace roverd::camera {
namespace {

TEST(CameraSource, AddressesAreTakenApart) {
  const auto s = parse_source("http://user:p%40ss@192.168.0.20:8081/video.mjpg?size=640").value();
  EXPECT_EQ(s.host, "192.168.0.20");
  EXPECT_EQ(s.port, 8081);
  EXPECT_EQ(s.path, "/video.mjpg?size=640");
  EXPECT_EQ(s.login, "user:p@ss");
  EXPECT_EQ(s.address(), "tcp:192.168.0.20:8081");
  EXPECT_EQ(s.name(), "http://192.168.0.20:8081/video.mjpg") << "neither login nor query";
  const auto tls = parse_source("https://cam.local").value();
  EXPECT_EQ(tls.address(), "tls:cam.local:443");
  EXPECT_EQ(tls.path, "/");
  EXPECT_EQ(parse_source("http://[fe80::1]:81?a").value().address(), "tcp:[fe80::1]:81");
  EXPECT_EQ(parse_source("http://[fe80::1]:81?a").value().path, "/?a");
}

TEST(CameraSource, WhatIsNoAddressIsRefusedWithoutBeingQuoted) {
  for (const char* text :
       {"", "rtsp://u:secret@h/", "http://", "http://:80/", "http://h:0/", "http://h:65536/",
        "http://h:8x/", "http://user@h/", "http://u:secret %/", "http://u:secret%zz@h/",
        "http://u:secret%0a@h/", "http://h/\r\nX: secret"}) {
    const auto s = parse_source(text);
    ASSERT_FALSE(s) << text;
    EXPECT_EQ(s.error().detail.find("secret"), std::string::npos) << s.error().detail;
    EXPECT_TRUE(s.error().detail.starts_with("a camera's address ")) << s.error().detail;
  }
}

TEST(CameraSource, TheLoginIsToldOnlyAsItIsAskedFor) {
  const auto s = parse_source("http://rover:secret@h/v").value();
  const std::string plain = request(s, {}, "c").value();
  EXPECT_TRUE(plain.starts_with("GET /v HTTP/1.1\r\nHost: h:80\r\n")) << plain;
  EXPECT_TRUE(plain.ends_with("\r\n\r\n"));
  EXPECT_EQ(plain.find("Authorization"), std::string::npos);
  const std::string basic = request(s, {.basic = true}, "c").value();
  EXPECT_NE(basic.find("Authorization: Basic cm92ZXI6c2VjcmV0\r\n"), std::string::npos);
  const ntrip::Challenge challenge{
      .realm = "cam", .nonce = "n", .opaque = "", .algorithm = "", .auth = true};
  const std::string digest = request(s, {.basic = true, .digest = challenge}, "c").value();
  EXPECT_NE(digest.find("Authorization: Digest "), std::string::npos);
  EXPECT_EQ(digest.find("Basic"), std::string::npos) << "the safer one where both are offered";
  EXPECT_EQ(digest.find("secret"), std::string::npos);
  ntrip::Challenge unknown = challenge;
  unknown.algorithm = "SHA3";
  EXPECT_FALSE(request(s, {.digest = unknown}, "c"));
}

}  // namespace
}  // namespace roverd::camera
