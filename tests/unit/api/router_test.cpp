#include "api/router.hpp"

#include <gtest/gtest.h>

namespace roverd::api {
namespace {

Router router() {
  Router out;
  const auto nothing = [](const CallPtr&) {};
  out.add({http::verb::get, "/missions", {200}, nothing});
  out.add({http::verb::post, "/missions", {201}, nothing});
  out.add({http::verb::get, "/missions/{id}", {200}, nothing});
  out.add({http::verb::put, "/missions/{id}", {200}, nothing});
  out.add({http::verb::post, "/missions/import", {201}, nothing});
  out.add({http::verb::get, "/tiles/{set}/{z}/{x}/{y}", {200}, nothing});
  return out;
}

std::string pattern(http::verb method, std::string_view path) {
  const Router table = router();
  const auto found = table.find(method, path);
  if (const auto* match = std::get_if<Router::Match>(&found)) return match->route->pattern;
  if (const auto* wrong = std::get_if<Router::WrongMethod>(&found)) return "405 " + wrong->allow;
  return "404";
}

TEST(Router, ALiteralWinsOverAParameter) {
  EXPECT_EQ(pattern(http::verb::post, "/missions/import"), "/missions/import");
  EXPECT_EQ(pattern(http::verb::get, "/missions/abc"), "/missions/{id}");
}

TEST(Router, AWrongMethodIsToldTheRightOnes) {
  EXPECT_EQ(pattern(http::verb::patch, "/missions"), "405 GET, HEAD, POST, OPTIONS");
  EXPECT_EQ(pattern(http::verb::delete_, "/missions/abc"), "405 GET, HEAD, PUT, OPTIONS");
  EXPECT_EQ(pattern(http::verb::get, "/missions/import"), "405 POST, OPTIONS");
}

TEST(Router, HeadCountsAsGet) {
  EXPECT_EQ(pattern(http::verb::head, "/missions"), "/missions");
}

TEST(Router, WhatIsNotInTheTableIsNotFound) {
  for (const char* path : {"", "/", "missions", "/missions/", "/missions/a/b", "/mission",
                           "/tiles/a/1/2", "/missions/%zz", "/missions/%00"}) {
    EXPECT_EQ(pattern(http::verb::get, path), "404") << path;
  }
}

TEST(Router, ParametersAreDecoded) {
  const Router table = router();
  const auto found = table.find(http::verb::get, "/tiles/my%20map/3/4/5.png");
  const auto& match = std::get<Router::Match>(found);
  EXPECT_EQ(match.params.at("set"), "my map");
  EXPECT_EQ(match.params.at("y"), "5.png");
}

TEST(Target, IsSplitIntoPathAndQuery) {
  const auto target = parse_target("/events?since=a%2Bb+c&level=error&flag&=x&&");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/events");
  EXPECT_EQ(target->query.at("since"), "a+b c");
  EXPECT_EQ(target->query.at("level"), "error");
  EXPECT_EQ(target->query.at("flag"), "");
  EXPECT_EQ(target->query.size(), 3u);
}

TEST(Target, TheAbsoluteFormOfAProxyWorks) {
  EXPECT_EQ(parse_target("http://127.0.0.1:8080/a/b?c=1")->path, "/a/b");
  EXPECT_EQ(parse_target("http://127.0.0.1:8080")->path, "/");
}

TEST(Target, BrokenPercentSignsAreMalformed) {
  for (const char* text : {"/a?b=%", "/a?b=%4", "/a?b=%zz", "/a?%00=1"}) {
    const auto target = parse_target(text);
    ASSERT_FALSE(target) << text;
    EXPECT_EQ(target.error().code, base::Code::Malformed);
  }
}

}  // namespace
}  // namespace roverd::api
