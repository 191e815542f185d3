#include "config/layers.hpp"

#include <gtest/gtest.h>

namespace roverd {
namespace {

std::string wrong_url(const std::string& url) {
  const auto good = check(Layers{{"aerial", {url, "", 19}}});
  return good ? "" : good.error().fields.at(0).detail;
}

TEST(Layers, TakeAnyTemplateOfTheWebsTiles) {
  for (const char* url :
       {"https://tiles.example.org/aerial/{z}/{x}/{y}.jpg", "http://10.0.0.2:8000/{z}/{x}/{-y}",
        "https://wmts.example.org/tile?layer=a&TILEMATRIX={z}&TILEROW={y}&TILECOL={x}"}) {
    EXPECT_EQ(wrong_url(url), "") << url;
  }
}

TEST(Layers, RefuseWhatWouldComeIntoAHeaderOrFetchNothing) {
  const std::string host = "must be http://HOST/… or https://HOST/…, without a login";
  for (const char* url :
       {"", "ftp://a/{z}/{x}/{y}", "https:///{z}/{x}/{y}", "https://a;script-src */{z}/{x}/{y}",
        "https://user:word@a/{z}/{x}/{y}", "https://a'b/{z}/{x}/{y}", "https://a{z}{x}{y}"}) {
    EXPECT_EQ(wrong_url(url), host) << url;
  }
  EXPECT_NE(wrong_url("https://a/{x}/{y}"), "");
  EXPECT_NE(wrong_url("https://a/{z}/{x}"), "");
  EXPECT_NE(wrong_url("https://a/{z}/{x}/{y} b"), "");
}

TEST(Layers, EachOriginIsNamedOnce) {
  const Layers layers{{"a", {"https://a.org/1/{z}/{x}/{y}", "", 19}},
                      {"b", {"https://a.org/2/{z}/{x}/{y}", "", 19}},
                      {"c", {"http://b.org:81/{z}/{x}/{y}", "", 19}}};
  EXPECT_EQ(origins_of(layers), (std::vector<std::string>{"https://a.org", "http://b.org:81"}));
}

}  // namespace
}  // namespace roverd
