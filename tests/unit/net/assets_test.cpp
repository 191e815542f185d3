#include "net/assets.hpp"

#include <array>

#include <gtest/gtest.h>

#include "net/page.hpp"

namespace roverd::net {
namespace {

namespace http = boost::beast::http;

const std::array<FileEntry, 3> kEntries = {
    FileEntry{"/index.html", "text/html; charset=utf-8", false, "<p>hello", "GZ", "BR"},
    FileEntry{"/assets/app-1a2b.js", "text/javascript", true, "let a = 1", "GZJS", {}},
    FileEntry{"/icon.png", "image/png", false, "PNG", {}, {}}};

Request get(std::string_view target, std::string_view accept_encoding = {}) {
  Request request{http::verb::get, boost::beast::string_view(target.data(), target.size()), 11};
  if (!accept_encoding.empty())
    request.set(http::field::accept_encoding, std::string(accept_encoding));
  return request;
}

std::string field(const Response& response, const char* name) {
  const auto value = response[name];
  return {value.data(), value.size()};
}

TEST(Files, TheRootIsTheIndexAndIsAskedForAgainEachTime) {
  const Files files(kEntries);
  const auto answer = files.answer(get("/?tab=2"));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->body(), "<p>hello");
  EXPECT_EQ(field(*answer, "Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(field(*answer, "Cache-Control"), "no-cache");
  EXPECT_EQ(field(*answer, "Vary"), "Accept-Encoding");
  EXPECT_EQ(field(*answer, "X-Content-Type-Options"), "nosniff");
  EXPECT_NE(field(*answer, "Content-Security-Policy").find("frame-ancestors 'none'"),
            std::string::npos);
  EXPECT_EQ(field(*answer, "Content-Security-Policy").find("unsafe"), std::string::npos);
}

TEST(Files, NamesWithAHashAreKeptForAYear) {
  const auto answer = Files(kEntries).answer(get("/assets/app-1a2b.js"));
  ASSERT_TRUE(answer);
  EXPECT_EQ(field(*answer, "Cache-Control"), "public, max-age=31536000, immutable");
}

TEST(Files, WhatIsNotThereIsNotAnswered) {
  const Files files(kEntries);
  EXPECT_FALSE(files.answer(get("/nothing")));
  EXPECT_FALSE(files.answer(get("/assets/")));
  EXPECT_FALSE(files.answer(get("/../etc/passwd")));
  Request post = get("/");
  post.method(http::verb::post);
  EXPECT_FALSE(files.answer(post));
}

TEST(Files, BrotliIsBetterThanGzipIsBetterThanNothing) {
  const Files files(kEntries);
  const auto both = files.answer(get("/", "gzip, deflate, br"));
  EXPECT_EQ(both->body(), "BR");
  EXPECT_EQ(field(*both, "Content-Encoding"), "br");
  EXPECT_EQ(files.answer(get("/", "gzip"))->body(), "GZ");
  EXPECT_EQ(files.answer(get("/assets/app-1a2b.js", "br, gzip"))->body(), "GZJS");
  const auto plain = files.answer(get("/icon.png", "br, gzip"));
  EXPECT_EQ(plain->body(), "PNG");
  EXPECT_EQ(field(*plain, "Content-Encoding"), "");
}

TEST(Files, AcceptEncodingIsReadAsTheStandardSays) {
  EXPECT_EQ(choose_coding("", true, true), Coding::Identity);
  EXPECT_EQ(choose_coding("*", true, true), Coding::Brotli);
  EXPECT_EQ(choose_coding("br;q=0, *", true, true), Coding::Gzip);
  EXPECT_EQ(choose_coding("br; q=0.0 , gzip;q=0.5", true, true), Coding::Gzip);
  EXPECT_EQ(choose_coding("GZIP", true, false), Coding::Gzip);
  EXPECT_EQ(choose_coding("identity, *;q=0", true, true), Coding::Identity);
  EXPECT_EQ(choose_coding(",,;q=,", true, true), Coding::Identity);
}

TEST(Files, ATagThatStillHoldsIsAnsweredWithoutTheBody) {
  // Given a browser that has the file,
  const Files files(kEntries);
  const std::string tag = field(*files.answer(get("/", "br")), "ETag");
  Request again = get("/", "br");
  again.set(http::field::if_none_match, "\"other\", W/" + tag);
  // when it asks again, then nothing is sent twice.
  const auto answer = files.answer(again);
  EXPECT_EQ(answer->result_int(), 304u);
  EXPECT_TRUE(answer->body().empty());
  EXPECT_EQ(field(*answer, "ETag"), tag);
  // Another coding has another tag: they are different bytes.
  EXPECT_NE(field(*files.answer(get("/")), "ETag"), tag);
}

TEST(Files, NoneMatchComparesWeaklyAndKnowsTheStar) {
  EXPECT_TRUE(none_match_hits("*", "\"a\""));
  EXPECT_TRUE(none_match_hits("W/\"a\"", "\"a\""));
  EXPECT_TRUE(none_match_hits("\"b\" , \"a\"", "W/\"a\""));
  EXPECT_FALSE(none_match_hits("", "\"a\""));
  EXPECT_FALSE(none_match_hits("\"ab\"", "\"a\""));
}

TEST(Page, IsBuiltInOrSaysThatItIsNot) {
  const Files files(page_entries());
  const auto index = files.answer(get("/"));
  ASSERT_TRUE(index);
  EXPECT_NE(index->body().find("<html"), std::string::npos);
  EXPECT_EQ(field(*index, "Content-Type"), "text/html; charset=utf-8");
}

}  // namespace
}  // namespace roverd::net
