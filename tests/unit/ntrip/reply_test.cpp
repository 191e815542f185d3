#include "ntrip/reply.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "bytes.hpp"

namespace roverd::ntrip {
namespace {

struct Answer {
  Reply reply;
  std::string data;
  void hear(const std::string& text, std::size_t piece) {
    const auto all = bytes_from(text);
    for (std::size_t at = 0; at < all.size(); at += piece) {
      reply.feed(Bytes(all).subspan(at, std::min(piece, all.size() - at)),
                 [this](Bytes b) { data.append(b.begin(), b.end()); });
    }
  }
};

void expect_stream(const std::string& text, const std::string& data, int version) {
  for (const std::size_t piece : {1u, 3u, 5000u}) {
    Answer a;
    a.hear(text, piece);
    EXPECT_EQ(a.data, data) << piece;
    EXPECT_EQ(a.reply.version(), version);
    EXPECT_EQ(a.reply.refusal(), "");
  }
}

std::string refusal_of(const std::string& text) {
  Answer a;
  a.hear(text, 1);
  EXPECT_EQ(a.reply.state(), Reply::State::Refused) << text;
  EXPECT_EQ(a.data, "");
  return a.reply.refusal();
}

TEST(Reply, AFirstVersionStreamMayFollowAtOnceOrAfterAnEmptyLine) {
  expect_stream("ICY 200 OK\r\n" + k1005, k1005, 1);
  expect_stream("ICY 200 OK\r\n\r\n" + k1005, k1005, 1);
  expect_stream("ICY 200 OK\r\nServer: x\r\n\r\n" + k1005, k1005, 1);
}

TEST(Reply, ASecondVersionStreamMayComeInChunks) {
  const std::string head = "HTTP/1.1 200 OK\r\nContent-Type: gnss/data\r\n";
  expect_stream(head + "\r\n" + k1005, k1005, 2);
  expect_stream(head + "Transfer-Encoding: chunked\r\n\r\n" + "19\r\n" + k1005 + "\r\n0\r\n\r\n",
                k1005, 2);
}

TEST(Reply, ChunkBordersNeedNotBeThoseOfFrames) {
  Answer a;
  a.hear("HTTP/1.1 200 OK\r\nTransfer-Encoding: Chunked\r\n\r\n", 1);
  EXPECT_EQ(a.reply.state(), Reply::State::Stream);
  a.hear("9\r\n" + k1005.substr(0, 9) + "\r\n15;ext=1\r\n" + k1005.substr(9) + k1006.substr(0, 5) +
             "\r\n16\r\n" + k1006.substr(5) + "\r\n0\r\n\r\n",
         1);
  EXPECT_EQ(a.data, k1005 + k1006);
  EXPECT_EQ(a.reply.state(), Reply::State::Ended);
}

TEST(Reply, DamagedChunksAreRefused) {
  EXPECT_EQ(refusal_of("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"),
            "the caster's chunks are damaged");
  EXPECT_EQ(refusal_of("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nffffffff\r\n"),
            "the caster's chunks are damaged");
}

TEST(Reply, ATableIsReadRowByRow) {
  Answer a;
  a.hear(
      "SOURCETABLE 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 99\r\n\r\n"
      "CAS;x;2101\r\n"
      "STR;TEST0;Town;RTCM 3.2;1005(1);2;GPS+GLO;NET;FIN;60.17;24.94;1;0;gen;none;B;N;9600;\r\n"
      "STR;SHORT\r\nENDSOURCETABLE\r\n",
      1);
  EXPECT_EQ(a.reply.state(), Reply::State::Ended);
  ASSERT_EQ(a.reply.sources().size(), 2u);
  EXPECT_EQ(a.reply.sources()[0].mountpoint, "TEST0");
  EXPECT_EQ(a.reply.sources()[0].format, "RTCM 3.2");
  EXPECT_EQ(a.reply.sources()[0].systems, "GPS+GLO");
  EXPECT_TRUE(a.reply.sources()[0].wants_gga);
  EXPECT_EQ(a.reply.sources()[1].mountpoint, "SHORT");
  EXPECT_FALSE(a.reply.sources()[1].wants_gga);
}

TEST(Reply, RefusalsAreSaidInWords) {
  EXPECT_EQ(refusal_of("HTTP/1.0 401 Unauthorized\r\n\r\n"),
            "the caster does not accept the login");
  EXPECT_EQ(refusal_of("ERROR - Bad Pasword\r\n"), "the caster does not accept the login");
  EXPECT_EQ(refusal_of("HTTP/1.1 404 Not Found\r\n"), "the caster has no such mountpoint");
  EXPECT_EQ(refusal_of("ERROR - \x01\r\n"), "the caster answers \"ERROR - ?\"");
  EXPECT_EQ(refusal_of("HTTP/1.1 503 Busy\r\n"), "the caster answers \"HTTP/1.1 503 Busy\"");
  EXPECT_EQ(refusal_of("HTTP/1.1 200 OK\r\n" + std::string(9000, 'x')),
            "the caster's answer does not end");
}

TEST(Digest, IsThatOfTheStandardsExample) {
  // RFC 2617, section 3.5.
  const auto asked = parse_challenge(
      " Digest realm=\"testrealm@host.com\", qop=\"auth,auth-int\", "
      "nonce=\"dcd98b7102dd2f0e8b11d0f600bfb0c093\", opaque=\"5ccc069c403ebaf9f0171e9517f40e41\"");
  ASSERT_TRUE(asked);
  EXPECT_TRUE(asked->auth);
  const auto answer = digest_answer(*asked, "Mufasa:Circle Of Life", "/dir/index.html", "0a4f113b");
  ASSERT_TRUE(answer);
  EXPECT_NE(answer->find("response=\"6629fae49393a05397450978507c4ef1\""), std::string::npos)
      << *answer;
  EXPECT_FALSE(parse_challenge("Basic realm=\"x\""));
  EXPECT_FALSE(parse_challenge("Digest realm=\"x\""));
  EXPECT_FALSE(digest_answer({.realm = "", .nonce = "n", .opaque = "", .algorithm = "MD5-sess"},
                             "a:b", "/", "c"));
}

TEST(Source, TellsPlaceAndLogin) {
  const Source s = parse_source(
      "STR;TALLINN0;Tallinn;RTCM "
      "3.2;1005(1);2;GPS+GLO;NET;EST;59.44;204.75;1;0;gen;none;D;N;9600;");
  EXPECT_EQ(s.country, "EST");
  EXPECT_NEAR(s.lat.value(), 59.44, 1e-9);
  EXPECT_NEAR(s.lon.value(), -155.25, 1e-9);
  EXPECT_EQ(s.login, 'D');
  EXPECT_FALSE(parse_source("STR;X;;RTCM 3;;;;;;0.00;0.00;;").lat);
}

}  // namespace
}  // namespace roverd::ntrip
