// Users, sessions and tokens, in the file.

#include <future>

#include <gtest/gtest.h>

#include "folder.hpp"
#include "people/book.hpp"
#include "store/store.hpp"

namespace roverd::store {
namespace {

using people::Change;
using people::Everybody;
using people::Role;

constexpr base::WallTime kNoon{std::chrono::seconds(1'800'000'000)};

class PeopleStore : public testing::Test {
 protected:
  PeopleStore() { open(); }
  void open() {
    store_.reset();
    auto opened = Store::open(folder_.file(), [](std::function<void()> answer) { answer(); });
    ASSERT_TRUE(opened) << opened.error().detail;
    store_ = std::move(*opened);
  }
  Everybody read() {
    std::promise<base::Result<Everybody>> answer;
    store_->read_people([&](base::Result<Everybody> all) { answer.set_value(std::move(all)); });
    return answer.get_future().get().value_or(Everybody{});
  }
  base::Result<void> change(Change what) {
    std::promise<base::Result<void>> answer;
    store_->change_people(std::move(what),
                          [&](base::Result<void> done) { answer.set_value(std::move(done)); });
    return answer.get_future().get();
  }
  /// Two users, a session and a token of anna's.
  static Change some() {
    Change c;
    c.now.users = {{"anna", Role::Admin, "hash a", kNoon}, {"bert", Role::Viewer, "hash b", {}}};
    c.now.sessions = {{"s1", "cookie", "anna", "phone", "10.0.0.2", kNoon, kNoon, ""}};
    c.now.tokens = {{"t1",
                     "shown",
                     "script",
                     "anna",
                     Role::Operator,
                     {"GET", "POST"},
                     kNoon,
                     kNoon + std::chrono::hours(1),
                     std::nullopt}};
    return c;
  }

  Folder folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(PeopleStore, EverybodyIsThereAfterARestart) {
  EXPECT_TRUE(read().users.empty());
  ASSERT_TRUE(change(some()));
  open();
  const Everybody all = read();
  ASSERT_EQ(all.users.size(), 2u);
  EXPECT_EQ(all.users[0].name, "anna");
  EXPECT_EQ(all.users[0].role, Role::Admin);
  EXPECT_EQ(all.users[0].password, "hash a");
  EXPECT_EQ(all.users[0].created, kNoon);
  ASSERT_EQ(all.sessions.size(), 1u);
  EXPECT_EQ(all.sessions[0].hash, "cookie");
  EXPECT_EQ(all.sessions[0].device, "phone");
  EXPECT_EQ(all.sessions[0].address, "10.0.0.2");
  EXPECT_EQ(all.sessions[0].seen, kNoon);
  ASSERT_EQ(all.tokens.size(), 1u);
  EXPECT_EQ(all.tokens[0].role, Role::Operator);
  EXPECT_EQ(all.tokens[0].methods, (std::vector<std::string>{"GET", "POST"}));
  EXPECT_EQ(all.tokens[0].expires, kNoon + std::chrono::hours(1));
  EXPECT_FALSE(all.tokens[0].used);
}

TEST_F(PeopleStore, PairedDevicesAreKeptWithTheirTries) {
  Change c = some();
  c.now.devices = {
      {"d1", "shown", "anna", "glove phone", Role::Operator, "hash of the PIN", 2, kNoon, {}}};
  c.now.sessions[0].paired = "d1";
  ASSERT_TRUE(change(c));
  open();
  Everybody all = read();
  ASSERT_EQ(all.devices.size(), 1u);
  EXPECT_EQ(all.devices[0].hash, "shown");
  EXPECT_EQ(all.devices[0].user, "anna");
  EXPECT_EQ(all.devices[0].name, "glove phone");
  EXPECT_EQ(all.devices[0].role, Role::Operator);
  EXPECT_EQ(all.devices[0].pin, "hash of the PIN");
  EXPECT_EQ(all.devices[0].wrong, 2);
  EXPECT_EQ(all.devices[0].created, kNoon);
  EXPECT_FALSE(all.devices[0].used);
  EXPECT_EQ(all.sessions[0].paired, "d1");
  // when it was tried and used
  all.devices[0].wrong = 5;
  all.devices[0].used = kNoon;
  ASSERT_TRUE(change({.now = {.users = {}, .sessions = {}, .tokens = {}, .devices = all.devices}}));
  EXPECT_EQ(read().devices[0].wrong, 5);
  EXPECT_EQ(read().devices[0].used, kNoon);
  // then it goes with its sessions, as with its user
  ASSERT_TRUE(change({.gone_devices = {"d1"}}));
  EXPECT_TRUE(read().devices.empty());
  EXPECT_TRUE(read().sessions.empty());
  ASSERT_TRUE(change(c));
  ASSERT_TRUE(change({.gone_users = {"anna"}}));
  EXPECT_TRUE(read().devices.empty());
}

TEST_F(PeopleStore, ASessionMayPassToTheDeviceThatReplacesItsOwn) {
  Change c = some();
  c.now.devices = {{"d1", "one", "anna", "phone", Role::Admin, "h", 0, kNoon, {}}};
  c.now.sessions[0].paired = "d1";
  ASSERT_TRUE(change(c));
  Change next;
  next.now.devices = {{"d2", "two", "anna", "phone", Role::Admin, "h", 0, kNoon, {}}};
  next.now.sessions = c.now.sessions;
  next.now.sessions[0].paired = "d2";
  next.gone_devices = {"d1"};
  ASSERT_TRUE(change(next));
  ASSERT_EQ(read().sessions.size(), 1u);
  EXPECT_EQ(read().sessions[0].paired, "d2");
}

TEST_F(PeopleStore, ARowIsWrittenOver) {
  ASSERT_TRUE(change(some()));
  Change later = some();
  later.now.users[0].role = Role::Viewer;
  later.now.users[0].password = "new";
  later.now.sessions[0].seen = kNoon + std::chrono::hours(1);
  later.now.tokens[0].used = kNoon;
  ASSERT_TRUE(change(later));
  const Everybody all = read();
  EXPECT_EQ(all.users.size(), 2u);
  EXPECT_EQ(all.users[0].role, Role::Viewer);
  EXPECT_EQ(all.users[0].password, "new");
  EXPECT_EQ(all.sessions[0].seen, kNoon + std::chrono::hours(1));
  EXPECT_EQ(all.tokens[0].used, kNoon);
}

TEST_F(PeopleStore, WithAUserGoesWhatTheUserHad) {
  ASSERT_TRUE(change(some()));
  ASSERT_TRUE(change({.gone_users = {"anna"}}));
  const Everybody all = read();
  ASSERT_EQ(all.users.size(), 1u);
  EXPECT_EQ(all.users[0].name, "bert");
  EXPECT_TRUE(all.sessions.empty());
  EXPECT_TRUE(all.tokens.empty());
}

TEST_F(PeopleStore, WhatIsGoneIsGoneAndTwiceIsFine) {
  ASSERT_TRUE(change(some()));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(change({.gone_sessions = {"s1"}, .gone_tokens = {"t1", "unknown"}}));
  }
  EXPECT_EQ(read().users.size(), 2u);
  EXPECT_TRUE(read().sessions.empty());
  EXPECT_TRUE(read().tokens.empty());
}

TEST_F(PeopleStore, AChangeIsWholeOrNotAtAll) {
  Change wrong = some();
  wrong.now.sessions[0].user = "nobody";
  EXPECT_FALSE(change(wrong));
  EXPECT_TRUE(read().users.empty());
}

TEST_F(PeopleStore, TheBooksChangesMakeTheSameBookAgain) {
  people::Book book;
  const people::Now now{base::Time(std::chrono::seconds(9)), kNoon};
  book.load(read(), now);
  ASSERT_TRUE(book.add_user("anna", Role::Admin, "hash", now));
  const auto cookie = book.end_login(book.begin_login("anna", "here", now), true, "tab", now);
  ASSERT_TRUE(cookie);
  ASSERT_TRUE(change(book.take_change()));
  open();
  people::Book again;
  again.load(read(), now);
  const auto who = again.by_session(cookie->secret, now);
  ASSERT_TRUE(who);
  EXPECT_EQ(who->user, "anna");
}

}  // namespace
}  // namespace roverd::store
