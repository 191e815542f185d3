#pragma once
// A book with an admin "anna" whose password's hash is "hash of anna", and its clock.

#include <gtest/gtest.h>

#include "people/book.hpp"

namespace roverd::people {

using namespace std::chrono_literals;

inline constexpr base::WallTime kNoon{std::chrono::seconds(1'800'000'000)};

class BookTest : public testing::Test {
 protected:
  BookTest() {
    book.load({}, now);
    EXPECT_TRUE(book.add_user("anna", Role::Admin, "hash of anna", now));
  }
  void pass(base::Duration time) {
    now.mono += time;
    now.wall += time;
  }
  Opened<Session> log_in(const std::string& user = "anna",
                         const std::string& address = "10.0.0.2") {
    auto opened = book.end_login(book.begin_login(user, address, now), true, "phone", now);
    EXPECT_TRUE(opened);
    return opened.value_or(Opened<Session>{});
  }
  /// What the store would have after this.
  void keep() {
    const Change c = book.take_change();
    for (const User& u : c.now.users) put(kept.users, u, &User::name);
    for (const Session& s : c.now.sessions) put(kept.sessions, s, &Session::id);
    for (const Token& t : c.now.tokens) put(kept.tokens, t, &Token::id);
    for (const Device& d : c.now.devices) put(kept.devices, d, &Device::id);
    for (const auto& id : c.gone_devices) {
      std::erase_if(kept.devices, [&](const Device& d) { return d.id == id; });
    }
    for (const auto& id : c.gone_sessions) {
      std::erase_if(kept.sessions, [&](const Session& s) { return s.id == id; });
    }
  }
  /// The program ends and begins again: the monotonic clock, too. @param wall then
  void start_again(base::WallTime wall) {
    keep();
    book = Book();
    now = {base::Time(5s), wall};
    book.load(kept, now);
  }

  Book book;
  Now now{base::Time(1000s), kNoon};
  Everybody kept;

 private:
  template <class T>
  static void put(std::vector<T>& rows, const T& row, std::string T::*key) {
    std::erase_if(rows, [&](const T& old) { return old.*key == row.*key; });
    rows.push_back(row);
  }
};

}  // namespace roverd::people
