// What IP cameras answer: streams as several makes write them, cut anywhere, and what is wrong.

#include "camera/answer.hpp"

#include <gtest/gtest.h>

#include "pictures.hpp"

namespace roverd::camera {
namespace {

using namespace std::chrono_literals;
using Pictures = std::vector<std::string>;

struct Heard {
  Answer answer;
  Pictures pictures;
  std::vector<Time> began;

  /// @param piece bytes at a time, a millisecond each.
  explicit Heard(const std::string& text, std::size_t piece = 100'000) { feed(text, piece); }
  void feed(const std::string& text, std::size_t piece = 100'000) {
    for (std::size_t at = 0; at < text.size(); at += piece) {
      const std::string some = text.substr(at, piece);
      answer.feed({reinterpret_cast<const std::uint8_t*>(some.data()), some.size()}, now, take);
      now += 1ms;
    }
  }
  std::uint64_t refused(const std::string& cause) const {
    const auto at = answer.refused().find(cause);
    return at == answer.refused().end() ? 0 : at->second;
  }
  Time now{};
  OnPart take = [this](Bytes b, Time t) {
    pictures.emplace_back(b.begin(), b.end());
    began.push_back(t);
  };
};

const std::string kA = picture(10);
const std::string kB = picture(200);
const std::string kC = picture(90);

TEST(CameraAnswer, StreamsWithAndWithoutLengthsAreCutIntoTheirPictures) {
  const std::string sized = kStream + sized_part(kA) + sized_part(kB) + sized_part(kC);
  const std::string open = kStream + open_part(kA) + open_part(kB) + open_part(kC) + "--frame\r\n";
  for (const std::size_t piece : {1U, 2U, 3U, 7U, 100U, 100'000U}) {
    EXPECT_EQ(Heard(sized, piece).pictures, (Pictures{kA, kB, kC})) << piece;
    EXPECT_EQ(Heard(open, piece).pictures, (Pictures{kA, kB, kC})) << piece;
  }
  EXPECT_EQ(Heard(sized).answer.state(), Answer::State::Stream);
  EXPECT_FALSE(Heard(sized).answer.single());
}

TEST(CameraAnswer, EachMakesBoundaryIsUnderstood) {
  const auto body = [](const std::string& line, const std::string& end) {
    const std::string length = "content-length:" + std::to_string(kA.size()) + end;
    return line + end + "Content-type: image/jpeg" + end + length + end + kA + end + line + end +
           "Content-type: image/jpeg" + end + end + kB + end + line + end;
  };
  const auto of = [](const std::string& declared) {
    return "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=" + declared +
           "\r\n\r\n";
  };
  const Pictures both{kA, kB};
  EXPECT_EQ(Heard(of("\"frame\"") + "\r\n" + body("--frame", "\r\n")).pictures, both);
  EXPECT_EQ(Heard(of("--myboundary") + body("--myboundary", "\r\n")).pictures, both);
  EXPECT_EQ(Heard(of("--myboundary") + body("----myboundary", "\n")).pictures, both);
  EXPECT_EQ(Heard(of("BoundaryString") + body("--another than was told", "\r\n")).pictures, both);
}

TEST(CameraAnswer, ChunksAreTakenApart) {
  const std::string head =
      "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n"
      "Transfer-Encoding: chunked\r\n\r\n";
  const std::string body = sized_part(kA) + sized_part(kB);
  std::string chunks;
  for (std::size_t at = 0; at < body.size(); at += 50) {
    const std::string some = body.substr(at, 50);
    char size[16];
    std::snprintf(size, sizeof size, "%zx;note\r\n", some.size());
    chunks += size + some + "\r\n";
  }
  for (const std::size_t piece : {1U, 13U, 100'000U}) {
    EXPECT_EQ(Heard(head + chunks, piece).pictures, (Pictures{kA, kB})) << piece;
  }
  Heard whole(head + chunks + "0\r\n\r\n");
  EXPECT_EQ(whole.answer.state(), Answer::State::Ended);
  EXPECT_EQ(Heard(head + "zz\r\n").answer.refusal(), "its chunks make no sense");
}

TEST(CameraAnswer, APictureIsAsOldAsItsFirstByte) {
  Heard heard(kStream);
  heard.now = Time{} + 1s;
  heard.feed(sized_part(kA).substr(0, 100));  // the head and some of the picture
  heard.now = Time{} + 9s;
  heard.feed(sized_part(kA).substr(100) + open_part(kB));
  heard.now = Time{} + 20s;
  heard.feed("--frame\r\n");
  ASSERT_EQ(heard.began.size(), 2U);
  EXPECT_EQ(heard.began[0], Time{} + 1s);
  EXPECT_EQ(heard.began[1], Time{} + 9s);
}

TEST(CameraAnswer, ASinglePictureIsWholeByItsLengthOrWhenTheConnectionCloses) {
  const std::string head = "HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\n";
  const std::string length = "Content-Length: " + std::to_string(kA.size()) + "\r\n\r\n";
  Heard sized(head + length + kA, 9);
  EXPECT_EQ(sized.pictures, Pictures{kA});
  EXPECT_TRUE(sized.answer.single());
  EXPECT_EQ(sized.answer.state(), Answer::State::Ended);
  Heard open(head + "\r\n" + kA, 9);
  EXPECT_TRUE(open.pictures.empty());
  open.answer.end(open.take);
  EXPECT_EQ(open.pictures, Pictures{kA});
  Heard cut(head + length + kA.substr(0, 50));
  cut.answer.end(cut.take);
  EXPECT_TRUE(cut.pictures.empty()) << "half of it";
}

TEST(CameraAnswer, WhatLiesOrIsNoPictureSpoilsItselfOnly) {
  // A length that is too large takes the next part with it; the one after that is found.
  std::string lie = sized_part(kA);
  lie.replace(lie.find("Length: ") + 8, 3, std::to_string(kA.size() + 40));
  Heard lied(kStream + lie + sized_part(kB) + sized_part(kC));
  ASSERT_GE(lied.pictures.size(), 2U);
  EXPECT_EQ(lied.pictures.back(), kC);
  EXPECT_GT(lied.refused("line outside of any part"), 0U);
  Heard text(kStream + "--frame\r\nContent-Type: text/plain\r\n\r\nlow light\r\n" + open_part(kA) +
             "--frame\r\n");
  EXPECT_EQ(text.pictures, Pictures{kA});
  EXPECT_EQ(text.refused("part that is no JPEG"), 1U);
  Heard number(kStream + "--frame\r\nContent-Length: 12x\r\n\r\n" + kA + "\r\n" + sized_part(kB));
  EXPECT_EQ(number.pictures, (Pictures{kA, kB}));
  EXPECT_EQ(number.refused("part whose length is no number"), 1U);
}

TEST(CameraAnswer, APartWithoutAnEndIsDroppedAndTheNextOneIsFound) {
  Heard heard(kStream + "--frame\r\nContent-Type: image/jpeg\r\n\r\n");
  const std::string much(1'000'000, 'x');
  for (int i = 0; i < 9; ++i) heard.feed(much);
  EXPECT_TRUE(heard.pictures.empty());
  EXPECT_EQ(heard.refused("picture of more than 4 MB"), 1U);
  heard.feed("\r\n" + sized_part(kA));
  EXPECT_EQ(heard.pictures, Pictures{kA});
  Heard told(kStream + "--frame\r\nContent-Length: 4000001\r\n\r\n\r\n" + sized_part(kB));
  EXPECT_EQ(told.refused("picture of more than 4 MB"), 1U);
  EXPECT_EQ(told.pictures, Pictures{kB}) << "no megabytes were waited for";
}

TEST(CameraAnswer, RefusalsSayWhatTheCameraSaid) {
  const auto why = [](const std::string& text) { return Heard(text).answer.refusal(); };
  EXPECT_EQ(why("HTTP/1.1 404 Not Found\r\n\r\n"), "it answers 404 Not Found");
  EXPECT_EQ(why("HTTP/1.1 302 Found\r\nLocation: /login.html\r\n\r\n"),
            "it sends to another address: /login.html");
  EXPECT_EQ(why("HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n\r\n"),
            "it gives no pictures but text/html");
  EXPECT_EQ(why("RTSP/1.0 400 Bad\r\n\r\n"), "it speaks no HTTP: \"RTSP/1.0 400 Bad\"");
  EXPECT_EQ(why("HTTP/1.1 200 OK\r\nContent-Length: -1\r\n\r\n"),
            "the length of its answer is no number");
  EXPECT_EQ(why("HTTP/1.1 200 OK\r\nX: " + std::string(20'000, 'a')),
            "the head of its answer does not end");
  EXPECT_EQ(why("HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: 4000001\r\n\r\n"),
            "its picture has more than 4 MB");
  Heard login(
      "HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic realm=\"cam\"\r\n"
      "WWW-Authenticate: Digest realm=\"cam\", nonce=\"abc\", qop=\"auth\"\r\n\r\n");
  EXPECT_TRUE(login.answer.unauthorized());
  EXPECT_TRUE(login.answer.wish().basic);
  EXPECT_EQ(login.answer.wish().digest.value().nonce, "abc");
}

}  // namespace
}  // namespace roverd::camera
