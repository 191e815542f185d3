// The cookies of log-ins and devices, with TLS and without.

#include <gtest/gtest.h>

#include "api/access.hpp"

namespace roverd::api {
namespace {

class Cookie : public testing::Test {
 protected:
  Cookie() {
    book.load({}, Access::now());
    EXPECT_TRUE(book.add_user("anna", people::Role::Viewer, "hash", Access::now()));
    const auto attempt = book.begin_login("anna", "10.0.0.2", Access::now());
    secret = book.end_login(attempt, true, "phone", Access::now())->secret;
  }
  static Request with(const std::string& cookies) {
    Request request{http::verb::get, "/api/v1/vehicle", 11};
    request.set(http::field::cookie, cookies);
    return request;
  }
  bool opens(bool tls, const std::string& name) {
    return Access(&book, tls).would_pass(with("a=b; " + name + "=" + secret), Need::Viewer);
  }

  people::Book book;
  std::string secret;
};

TEST_F(Cookie, OverTlsItIsBoundToThisHostAndNoOtherIsLookedAt) {
  const Access access(&book, true);
  EXPECT_EQ(access.cookie("x"),
            "__Host-roverd_session=x; Path=/; HttpOnly; SameSite=Strict; Secure; Max-Age=604800");
  EXPECT_TRUE(access.device_cookie("x").starts_with("__Host-roverd_device=x; Path=/; HttpOnly;"));
  EXPECT_TRUE(opens(true, "__Host-roverd_session"));
  // What a page without TLS may have set there,
  EXPECT_FALSE(opens(true, "roverd_session"));
  EXPECT_EQ(access.device_secret(with("roverd_device=x; __Host-roverd_device=y")), "y");
}

TEST_F(Cookie, WithoutTlsItHasItsPlainName) {
  const Access access(&book, false);
  EXPECT_EQ(access.cookie("x"),
            "roverd_session=x; Path=/; HttpOnly; SameSite=Strict; Max-Age=604800");
  EXPECT_TRUE(opens(false, "roverd_session"));
  EXPECT_FALSE(opens(false, "__Host-roverd_session"));
  EXPECT_EQ(access.device_secret(with("roverd_device=x")), "x");
}

}  // namespace
}  // namespace roverd::api
