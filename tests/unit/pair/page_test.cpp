#include "pair/page.hpp"

#include <gtest/gtest.h>

#include "pair/code.hpp"

namespace roverd::pair {
namespace {

Facts facts() {
  std::string pairs;
  for (int i = 0; i < 32; ++i)
    pairs += std::string(i > 0 ? ":" : "") + "A" + "0123456789ABCDEF"[i % 16];
  return {.name = "rover <1>",
          .picture = "/robot.svg",
          .address = "https://192.168.4.1:8080",
          .addresses = {"https://rover.local:8080"},
          .fingerprint = pairs,
          .authority = "-----BEGIN CERTIFICATE-----\nAAAA\nBBBB\n-----END CERTIFICATE-----\n",
          .authority_der = "der"};
}

TEST(PairPage, ShowsAddressFingerprintAndDownloadsAndNeedsNoScript) {
  const auto page = file_at("/pair", facts());
  ASSERT_TRUE(page);
  EXPECT_EQ(page->content_type, "text/html; charset=utf-8");
  for (const auto& part :
       {facts().address, facts().fingerprint, facts().addresses[0], std::string("href=\"/ca.crt\""),
        std::string("/ca.mobileconfig"), std::string("Pair with rover &lt;1&gt;"),
        std::string("<title>rover &lt;1&gt; – pair – roverd</title>"),
        std::string("<img src=\"/robot.svg\""),
        std::string("<link rel=\"icon\" href=\"/robot.svg\">")}) {
    EXPECT_NE(page->body.find(part), std::string::npos) << part;
  }
  for (const char* word : {"<script", "style=", "onclick", "rover <1>"}) {
    EXPECT_EQ(page->body.find(word), std::string::npos) << word;
  }
}

TEST(PairPage, TheCertificateComesInTheShapesThatSystemsTake) {
  EXPECT_EQ(file_at("/ca.crt", facts())->body, "der");
  EXPECT_EQ(file_at("/ca.crt", facts())->content_type, "application/x-x509-ca-cert");
  EXPECT_EQ(file_at("/ca.pem", facts())->body, facts().authority);
  const auto profile = file_at("/ca.mobileconfig", facts());
  EXPECT_EQ(profile->content_type, "application/x-apple-aspen-config");
  EXPECT_NE(profile->body.find("<data>\nAAAA\nBBBB\n</data>"), std::string::npos);
  EXPECT_NE(profile->body.find("<key>PayloadType</key><string>com.apple.security.root</string>"),
            std::string::npos);
  EXPECT_EQ(profile->body, file_at("/ca.mobileconfig", facts())->body);
}

TEST(PairPage, NothingElseIsServed) {
  for (const char* path :
       {"/", "", "/pair/", "/pairs", "/ca.key", "/ca.crt/../x", "/api/v1/vehicle"}) {
    EXPECT_FALSE(file_at(path, facts())) << path;
  }
}

TEST(PairPage, TheCodeLeadsToThePageInTheOpenAndCarriesTheFingerprint) {
  const std::string text = code_text(facts());
  EXPECT_TRUE(text.starts_with("http://192.168.4.1:8080/pair#sha256=A0A1A2")) << text;
  EXPECT_EQ(text.find(":", 22), std::string::npos);
  EXPECT_EQ(text.size(), std::string("http://192.168.4.1:8080/pair#sha256=").size() + 64);
}

//  finder pattern: a dark ring of seven modules around a dark square of three
TEST(QrCode, HasItsThreeFinderPatterns) {
  const auto code = qr_code(code_text(facts()));
  ASSERT_TRUE(code);
  const std::size_t far = code->width - 7;
  for (const auto& [row, column] :
       {std::pair<std::size_t, std::size_t>{0, 0}, {0, far}, {far, 0}}) {
    for (std::size_t r = 0; r < 7; ++r) {
      for (std::size_t c = 0; c < 7; ++c) {
        const bool ring = r == 0 || r == 6 || c == 0 || c == 6;
        const bool core = r >= 2 && r <= 4 && c >= 2 && c <= 4;
        EXPECT_EQ(code->at(row + r, column + c), ring || core) << r << " " << c;
      }
    }
  }
}

TEST(QrCode, WhatIsTooLongOrEmptyIsRefused) {
  EXPECT_FALSE(qr_code(""));
  EXPECT_FALSE(qr_code(std::string(5000, 'x')));
}

TEST(QrCode, IsDrawnForScreenAndTerminal) {
  const Code code{2, {true, false, true, true}};
  EXPECT_NE(svg_of(code).find("M4 4h1v1H4zM4 5h2v1H4z"), std::string::npos) << svg_of(code);
  EXPECT_NE(svg_of(code).find("viewBox=\"0 0 10 10\""), std::string::npos);
  EXPECT_EQ(terminal_text_of(code),
            "\x1b[30;107m      \x1b[0m\n\x1b[30;107m  █▄  \x1b[0m\n\x1b[30;107m      \x1b[0m\n");
}

}  // namespace
}  // namespace roverd::pair
