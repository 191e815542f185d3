#pragma once
// A house with access control on, and callers of each kind.

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "house.hpp"
#include "people/secret.hpp"

namespace roverd::test {

inline constexpr const char* kPassword = "correct horse";

/// The header line that each kind of caller shows; filled by seed().
using Callers = std::map<std::string, std::string>;

inline std::string as_cookie(const std::string& secret) {
  return "Cookie: a=b; roverd_session=" + secret + "\r\nOrigin: http://127.0.0.1\r\n";
}
inline std::string as_token(const std::string& secret) {
  return "Authorization: Bearer " + secret + "\r\n";
}

inline people::Token token_draft(people::Role role) {
  people::Token draft;
  draft.name = "script";
  draft.user = "admin";
  draft.role = role;
  return draft;
}

/// A user of each role, named after it, all with kPassword; what they show, and what is over.
inline void seed(const std::filesystem::path& file, Callers& callers) {
  using namespace std::chrono_literals;
  static const std::string kHash = people::hash_password(kPassword).value_or("");
  const people::Now now{base::steady_now(), base::wall_now()};
  people::Book book;
  book.load({}, now);
  const auto log_in = [&](const std::string& user, people::Now when) {
    return *book.end_login(book.begin_login(user, "127.0.0.1", when), true, "test", when);
  };
  callers["nobody"] = "";
  for (const people::Role role : people::kRoles) {
    const std::string name(to_string(role));
    EXPECT_TRUE(book.add_user(name, role, kHash, now));
    callers[name] = as_cookie(log_in(name, now).secret);
  }
  for (const people::Role role : people::kRoles) {
    const auto made = *book.add_token(token_draft(role), now);
    callers["token of " + std::string(to_string(role))] = as_token(made.secret);
  }
  callers["session of yesterday"] = as_cookie(log_in("admin", {now.mono, now.wall - 13h}).secret);
  const auto ended = log_in("admin", now);
  EXPECT_TRUE(book.end_session("admin", ended.row.id));
  callers["session that was ended"] = as_cookie(ended.secret);
  people::Token old = token_draft(people::Role::Admin);
  old.expires = now.wall - 1s;
  callers["token that is expired"] = as_token(book.add_token(old, now)->secret);
  const auto revoked = *book.add_token(token_draft(people::Role::Admin), now);
  EXPECT_TRUE(book.end_token("admin", revoked.row.id));
  callers["token that was ended"] = as_token(revoked.secret);
  callers["forged session"] = as_cookie(people::random_secret());
  callers["forged token"] = as_token(people::random_secret());
  auto store = store::Store::open(file, [](std::function<void()> answer) { answer(); });
  ASSERT_TRUE(store);
  (*store)->change_people(book.take_change(), [](const base::Result<void>& done) {
    EXPECT_TRUE(done) << done.error().detail;
  });
}

class AccessApi : public HouseTest {
 protected:
  explicit AccessApi(base::Duration control_grace = std::chrono::seconds(10))
      : AccessApi(std::make_shared<Callers>(), control_grace) {}

  const std::string& as(const std::string& caller) const { return callers_->at(caller); }
  Reply as(const std::string& caller, const std::string& method, const std::string& path,
           const std::string& body = "") {
    return call(method, path, body, callers_->at(caller));
  }
  /// -1: not known.
  int rank(const std::string& caller) const {
    const std::string role = caller.substr(caller.rfind(' ') + 1);
    const bool over = caller.find("that") != std::string::npos || caller.starts_with("forged") ||
                      caller.starts_with("session");
    if (over || caller == "nobody") return -1;
    return role == "viewer" ? 0 : role == "operator" ? 1 : 2;
  }
  void SetUp() override {
    until([this] { return as("viewer", "GET", "/vehicle").status == 200; }, "users are read");
  }

  std::shared_ptr<Callers> callers_;

 private:
  AccessApi(std::shared_ptr<Callers> callers, base::Duration control_grace)
      : HouseTest(House::Vehicle::Whole,
                  {.data = [callers](const auto& file) { seed(file, *callers); },
                   .access = true,
                   .control_grace = control_grace}),
        callers_(std::move(callers)) {}
};

}  // namespace roverd::test
