#include "api/body.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "api/json/plain_json.hpp"
#include "api/json/rfc3339.hpp"
#include "api/json/words.hpp"
#include "api/problem.hpp"

namespace roverd::api {
namespace {

using namespace std::chrono_literals;

Request with_body(const char* type, std::string body) {
  Request request{http::verb::post, "/", 11};
  if (type != nullptr) request.set(http::field::content_type, type);
  request.body() = std::move(body);
  return request;
}

base::Code code(const base::Result<Json>& result) {
  EXPECT_FALSE(result);
  return result ? base::Code::Late : result.error().code;
}

TEST(JsonBody, MustBeSentAsJson) {
  EXPECT_TRUE(json_body(with_body("application/json", "{}")));
  EXPECT_TRUE(json_body(with_body("Application/JSON ; charset=utf-8", "{}")));
  // What a foreign page's form can send without being asked first:
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                           "", static_cast<const char*>(nullptr)}) {
    EXPECT_EQ(code(json_body(with_body(type, "{}"))), base::Code::Unsupported);
  }
}

TEST(JsonBody, MayBeLeftOutOnlyWhereThatIsSensible) {
  EXPECT_EQ(*json_body(with_body(nullptr, ""), true), Json::object());
  EXPECT_EQ(code(json_body(with_body("application/json", ""))), base::Code::Malformed);
}

TEST(JsonBody, NanAndBrokenTextAreMalformed) {
  for (const char* text : {"{\"lat\": NaN}", "{\"lat\": Infinity}", "{", "nul", "{\"a\":1,}",
                           "\xff\xfe", "{\"a\":1}{"}) {
    EXPECT_EQ(code(json_body(with_body("application/json", text))), base::Code::Malformed) << text;
  }
}

TEST(Members, EveryOffendingFieldIsNamed) {
  // Given a body with four mistakes,
  const Json body = {{"lat", "58"}, {"lon", 181.0}, {"count", 1.5}, {"what/ever", 1}};
  Members members(body);
  members.number("lat", -90, 90);
  members.number("lon", -180, 180);
  members.whole("count", 0, 10);
  members.require("mode");
  // when it is read, then each of them is named by JSON pointer, escaped as RFC 6901 says.
  const auto read = members.finish();
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, base::Code::Invalid);
  const std::vector<base::FieldError> expected = {{"/lat", "must be a number"},
                                                  {"/lon", "must be from -180 to 180, is 181"},
                                                  {"/count", "must be a whole number"},
                                                  {"/mode", "is required"},
                                                  {"/what~1ever", "is not a known member"}};
  EXPECT_EQ(read.error().fields, expected);
}

TEST(Members, NullIsAbsentAndAnArrayIsNoObject) {
  const Json body = {{"item", nullptr}};
  Members members(body);
  EXPECT_FALSE(members.whole("item", 1, 9));
  EXPECT_TRUE(members.finish());
  const Json list = Json::array({1});
  Members wrong(list);
  wrong.require("mode");
  EXPECT_EQ(wrong.finish().error().fields.at(0).pointer, "");
}

TEST(Limit, IsBounded) {
  Call call;
  EXPECT_EQ(*limit_of(call), 100);
  call.query["limit"] = "1000";
  EXPECT_EQ(*limit_of(call), 1000);
  for (const char* text : {"0", "1001", "-1", "ten", "", "1.5", "99999999999999999999"}) {
    call.query["limit"] = text;
    EXPECT_FALSE(limit_of(call)) << text;
  }
}

TEST(ETag, HoldsTheRevision) {
  EXPECT_EQ(etag_of(3), "\"rev-3\"");
  EXPECT_EQ(revision_of("\"rev-3\""), 3);
  for (const char* tag :
       {"rev-3", "W/\"rev-3\"", "\"rev-\"", "\"rev-03\"", "\"rev-3x\"", "\"", "", "\"rev--3\"",
        "\"rev--00\"", "\"rev-0\"", "\"rev-+3\"", "\"rev-99999999999999999999\""}) {
    EXPECT_FALSE(revision_of(tag)) << tag;
  }
}

TEST(Problem, HasTypeTitleStatusDetailAndPointers) {
  const Json body = problem_json({base::Code::Invalid, "too far", {{"/lat", "must be less"}}});
  EXPECT_EQ(body["type"], "/docs#problem-invalid");
  EXPECT_EQ(body["title"], "Invalid values");
  EXPECT_EQ(body["status"], 422);
  EXPECT_EQ(body["detail"], "too far");
  EXPECT_EQ(body["errors"], Json::parse(R"([{"pointer":"/lat","detail":"must be less"}])"));
  const Response response = problem({base::Code::Unavailable, "busy"});
  EXPECT_EQ(response.result_int(), 503u);
  EXPECT_EQ(response[http::field::content_type], "application/problem+json");
  EXPECT_EQ(response[http::field::retry_after], "1");
}

TEST(Rfc3339, ReadsOffsetsAndFractions) {
  EXPECT_EQ(from_rfc3339("1970-01-01T00:00:00Z"), base::WallTime{});
  EXPECT_EQ(from_rfc3339("2024-02-29T12:35:30.25Z"), base::WallTime(1'709'210'130'250ms));
  EXPECT_EQ(from_rfc3339("2024-02-29t14:35:30+02:00"), base::WallTime(1'709'210'130s));
  EXPECT_EQ(from_rfc3339("2024-02-29T07:05:30-05:30"), base::WallTime(1'709'210'130s));
}

TEST(Rfc3339, WhatIsBeyondTheClockIsItsEnd) {
  const auto end = from_rfc3339("2201-01-01T00:00:00Z");
  ASSERT_TRUE(end);
  EXPECT_EQ(from_rfc3339("9999-12-31T23:59:59Z"), end);
  EXPECT_LT(*from_rfc3339("2200-12-31T23:59:59Z"), *end);
}

TEST(PlainJson, HasNoExponentsAndChangesNothingElse) {
  const Json value = {{"small", 1e-7},       {"smaller", -2.5e-11}, {"large", 1e25},
                      {"usual", 58.3781},    {"whole", 7},          {"text", "1e-7 \"2e-9\" \\"},
                      {"none", std::nan("")}};
  const std::string text = plain_json(value);
  EXPECT_EQ(text,
            R"({"large":10000000000000000905969664.0,"none":null,"small":0.0000001,)"
            R"("smaller":-0.000000000025,"text":"1e-7 \"2e-9\" \\","usual":58.3781,"whole":7})");
  // and reads back as the same numbers.
  const Json back = Json::parse(text);
  for (const char* name : {"small", "smaller", "large", "usual"}) {
    EXPECT_EQ(back[name].get<double>(), value[name].get<double>()) << name;
  }
  EXPECT_EQ(plain_json({{"bytes", "\xff"}}), "{\"bytes\":\"\xEF\xBF\xBD\"}");
  for (const double number : {5e-324, 1.7976931348623157e308, -1.2345678901234567e-5}) {
    const std::string plain = plain_json(number);
    EXPECT_EQ(plain.find('e'), std::string::npos) << plain;
    EXPECT_EQ(Json::parse(plain).get<double>(), number);
  }
}

TEST(Rfc3339, RefusesWhatIsNoTime) {
  for (const char* text : {"", "yesterday", "2024-02-30T00:00:00Z", "2023-02-29T00:00:00Z",
                           "2024-02-29T24:00:00Z", "2024-02-29T12:35:30", "2024-02-29T12:35:30.Z",
                           "2024-02-29T12:35:30Zx", "24-02-29T12:35:30Z", "2024-13-01T00:00:00Z",
                           "1969-12-31T23:59:59Z", "2024-02-29T12:35:30+2:00"}) {
    EXPECT_FALSE(from_rfc3339(text)) << text;
  }
}

}  // namespace
}  // namespace roverd::api
